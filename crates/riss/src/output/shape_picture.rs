//! Pictures of the weight and the shape function of a node: contours and surfaces, as in [EFG, Figs. 8, 10, 12 to 17].

use super::color_map::{shaded_viridis, viridis};
use super::contours::Surface;
use super::field_picture::color_bar;
use super::svg::{LineEnd, MARGIN, Pixel, Svg};
use super::whole_file::write_whole;
use crate::analysis::NodeFunction;
use crate::geometry::aabb::Aabb;
use crate::math::{Vector2, cross, direction};
use crate::model::Model;
use std::io;
use std::path::{Path, PathBuf};

/// Number of colors.
const BANDS: usize = 20;
/// Width of the color bar with its numbers [pixel].
const BAR: f64 = 100.0;
/// From where surfaces are seen: turned by this, and this high [rad].
const TURN: f64 = 0.6;
const ELEVATION: f64 = 0.55;
/// Height of a surface over the support radius.
const HEIGHT: f64 = 1.0;

/// Writes contours and surfaces of the weight and the shape function of a node; returns the paths.
///
/// # Errors
/// What the system says.
pub fn write_shape_pictures(dir: &Path, model: &Model, function: &NodeFunction) -> io::Result<Vec<PathBuf>> {
    let mut written = vec![];
    for (name, values) in [("weight", &function.weight), ("shape", &function.shape)] {
        let title = format!("{name} function of node {}", function.node);
        for (kind, picture) in
            [("contours", contours(model, function, values, &title)), ("surface", surface(function, values, &title))]
        {
            let path = dir.join(format!("{name}-{}-{kind}.svg", function.node));
            write_whole(&path, picture.as_bytes())?;
            written.push(path);
        }
    }
    Ok(written)
}

/// Ends of the scale; zero is always on it.
fn scale(values: &[f64]) -> (f64, f64) {
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    (finite().fold(0.0, f64::min), finite().fold(f64::MIN_POSITIVE, f64::max))
}

/// What is seen of the plane: the support and a little around it.
fn view_box(function: &NodeFunction) -> Aabb<2> {
    Aabb::around(function.position, Vector2::repeat(1.1 * function.support_radius))
}

/// Triangles whose middle is in the picture.
fn seen(function: &NodeFunction) -> Vec<[u32; 3]> {
    let bounds = view_box(function);
    let inside = |t: &&[u32; 3]| {
        let [a, b, c] = t.map(|v| function.points[v as usize]);
        bounds.contains(&((a + b + c) / 3.0))
    };
    function.triangles.iter().filter(inside).copied().collect()
}

fn contours(model: &Model, function: &NodeFunction, values: &[f64], title: &str) -> String {
    let triangles = seen(function);
    let (mut svg, view) = Svg::around(view_box(function), [MARGIN, MARGIN + BAR]);
    let pixels: Vec<Pixel> = function.points.iter().map(|p| view.pixel(*p)).collect();
    let surface = Surface::new(&pixels, values, &triangles);
    svg.paths(surface.outline(), LineEnd::Closed, "fill=\"#f4f4f4\"");
    let (low, high) = scale(values);
    for band in 0..BANDS {
        let level = low + (high - low) * (band as f64 + if band == 0 { 0.2 } else { 0.0 }) / BANDS as f64;
        let style = format!(
            "fill=\"{}\" stroke=\"#ffffff\" stroke-opacity=\"0.35\" stroke-width=\"4\"",
            viridis((band as f64 + 0.5) / BANDS as f64)
        );
        svg.paths(surface.region(level, 5), LineEnd::Closed, &style);
    }
    let bounds = view_box(function);
    let line = |(a, b): (Vector2, Vector2)| Some(bounds.clipped(a, b)?.map(|p| view.pixel(p)).to_vec());
    let flattened = model.domain.edges.iter().map(|e| e.flattened(0.1 * view.pixel_length()));
    let walls = flattened.flat_map(|p| p.windows(2).map(|w| (w[0], w[1])).collect::<Vec<_>>()).filter_map(line);
    svg.paths(walls, LineEnd::Open, "fill=\"none\" stroke=\"#222222\" stroke-width=\"14\"");
    let cracks = model.cracks.iter().flat_map(|c| c.segments()).filter_map(line);
    svg.paths(cracks, LineEnd::Open, "fill=\"none\" stroke=\"#d62728\" stroke-width=\"24\"");
    let dot = |p: &Vector2| vec![view.pixel(*p)];
    svg.paths(function.nodes.iter().map(dot), LineEnd::Open, "stroke=\"#222222\" stroke-width=\"60\"");
    svg.paths([dot(&function.position)], LineEnd::Open, "stroke=\"#d62728\" stroke-width=\"130\"");
    color_bar(&mut svg, low, high, BANDS);
    svg.text((MARGIN, 30.0), "font-size=\"180\"", title);
    svg.finish()
}

/// The surface from obliquely above, farther triangles below nearer ones.
fn surface(function: &NodeFunction, values: &[f64], title: &str) -> String {
    let (low, high) = scale(values);
    let factor = HEIGHT * function.support_radius / (high - low);
    let turned = |p: Vector2| {
        let (d, x) = (p - function.position, direction(-TURN));
        Vector2::new(d.dot(&x), cross(x, d))
    };
    let raised =
        |q: Vector2, value: f64| Vector2::new(q.x, q.y * ELEVATION.sin() + (value - low) * factor * ELEVATION.cos());
    let mut faces: Vec<(f64, [Vector2; 3], [f64; 3])> = vec![];
    for t in seen(function) {
        let z = t.map(|v| values[v as usize]);
        if z.iter().all(|z| z.is_finite()) {
            let q = t.map(|v| turned(function.points[v as usize]));
            faces.push((q[0].y + q[1].y + q[2].y, q, z));
        }
    }
    faces.sort_by(|a, b| b.0.total_cmp(&a.0));
    let corners = || faces.iter().flat_map(|(_, q, z)| (0..3).map(|k| raised(q[k], z[k])));
    let (mut svg, view) = Svg::around(Aabb::of_points(corners()), [MARGIN, MARGIN + BAR]);
    for (_, q, z) in &faces {
        let mean = (z[0] + z[1] + z[2]) / 3.0;
        let color = shaded_viridis((mean - low) / (high - low), light(q, &z.map(|z| z * factor)));
        let pixels = (0..3).map(|k| view.pixel(raised(q[k], z[k]))).collect();
        let style = format!("fill=\"{color}\" stroke=\"{color}\" stroke-width=\"3\"");
        svg.paths([pixels], LineEnd::Closed, &style);
    }
    color_bar(&mut svg, low, high, BANDS);
    svg.text((MARGIN, 30.0), "font-size=\"180\"", title);
    svg.finish()
}

/// Brightness of a face lit from the upper left in front.
fn light(q: &[Vector2; 3], z: &[f64; 3]) -> f64 {
    let ([a, b], [c, d]) = ([q[1] - q[0], q[2] - q[0]], [z[1] - z[0], z[2] - z[0]]);
    let normal = cross_product([a.x, a.y, c], [b.x, b.y, d]);
    let size = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
    let lit = (-0.5 * normal[0] - 0.3 * normal[1] + 0.81 * normal[2]) / size;
    0.55 + 0.45 * lit.abs()
}

fn cross_product(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
