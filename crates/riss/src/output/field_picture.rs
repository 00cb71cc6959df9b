//! A picture of a field on the deformed body.

use super::color_map::viridis;
use super::contours::Surface;
use super::svg::{LineEnd, MARGIN, Pixel, Svg};
use super::whole_file::write_whole;
use crate::analysis::{Fields, StaticResult};
use crate::geometry::aabb::Aabb;
use crate::math::{Vector2, cross, principal_stresses};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::Path;

/// Number of colors.
const BANDS: usize = 24;
/// Outlines below this size are left out [tenth of a pixel].
const SPECK: i32 = 5;
/// Bytes beyond which the picture is drawn again with half as many colors and without larger specks: noisy fields on
/// fine meshes have an outline around every triangle.
const MAX_BYTES: usize = 4_000_000;
/// Width of the color bar with its numbers [pixel].
const BAR: f64 = 100.0;
/// Greatest displacement in the picture over the size of the body.
const DEFORMATION: f64 = 0.05;
/// Share of the body at each end of the color scale that is beyond it, so that singular stress leaves contrast.
const BEYOND_SCALE: f64 = 0.01;

/// What the colors of a picture show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FieldQuantity {
    /// Von Mises stress.
    #[default]
    VonMises,
    /// Greater in-plane principal stress.
    MaxPrincipalStress,
    /// Length of the displacement.
    Displacement,
    /// Error indicator.
    ErrorIndicator,
}

impl FieldQuantity {
    fn title(self) -> &'static str {
        match self {
            Self::VonMises => "von Mises stress",
            Self::MaxPrincipalStress => "max. principal stress",
            Self::Displacement => "displacement",
            Self::ErrorIndicator => "error indicator",
        }
    }

    fn values(self, fields: &Fields) -> Vec<f64> {
        match self {
            Self::VonMises => fields.von_mises.clone(),
            Self::MaxPrincipalStress => fields.stress.iter().map(|s| principal_stresses(s).0).collect(),
            Self::Displacement => fields.displacement.iter().map(|u| u.norm()).collect(),
            Self::ErrorIndicator => fields.error_indicator.clone(),
        }
    }
}

/// Writes an SVG of the body with its displacement enlarged and its cracks open, colored by a quantity.
///
/// # Errors
/// What the system says; `InvalidData` if the arrays of the fields do not fit together.
pub fn write_field_picture(path: &Path, result: &StaticResult, quantity: FieldQuantity) -> io::Result<()> {
    write_whole(path, field_picture(result, quantity)?.as_bytes())
}

/// The picture itself.
pub(super) fn field_picture(result: &StaticResult, quantity: FieldQuantity) -> io::Result<String> {
    super::fields::check(&result.fields)?;
    let mut picture = String::new();
    for halvings in 0..4 {
        picture = draw(&result.fields, quantity, BANDS >> halvings, SPECK << (2 * halvings));
        if picture.len() <= MAX_BYTES {
            break;
        }
    }
    Ok(picture)
}

fn draw(fields: &Fields, quantity: FieldQuantity, n_bands: usize, speck: i32) -> String {
    let body = Aabb::of_points(fields.positions.iter().copied());
    let greatest = fields.displacement.iter().map(|u| u.norm()).filter(|u| u.is_finite()).fold(0.0, f64::max);
    let factor = if greatest > 0.0 { DEFORMATION * body.size().max() / greatest } else { 0.0 };
    // Where there is no displacement, the point stays.
    let moved = |p: &Vector2, u: &Vector2| if u.norm().is_finite() { p + u * factor } else { *p };
    let deformed: Vec<Vector2> = fields.positions.iter().zip(&fields.displacement).map(|(p, u)| moved(p, u)).collect();
    let bounds = deformed.iter().fold(body, |b, p| b.including(*p));
    let (mut svg, view) = Svg::around(bounds, [MARGIN, MARGIN + BAR]);
    let pixels: Vec<Pixel> = deformed.iter().map(|p| view.pixel(*p)).collect();
    let at_rest: Vec<Pixel> = fields.positions.iter().map(|p| view.pixel(*p)).collect();

    let everywhere = vec![0.0; pixels.len()];
    let outline = Surface::new(&pixels, &everywhere, &fields.triangles).outline();
    svg.paths(outline.iter().cloned(), LineEnd::Closed, "fill=\"#bbbbbb\"");
    let values = quantity.values(fields);
    let surface = Surface::new(&pixels, &values, &fields.triangles);
    let (low, high) = scale(&fields.triangles, &values, |t| twice_area(&fields.positions, t));
    for band in 0..n_bands {
        let level = if band == 0 { f64::NEG_INFINITY } else { low + (high - low) * band as f64 / n_bands as f64 };
        let fill = format!("fill=\"{}\"", viridis((band as f64 + 0.5) / n_bands as f64));
        svg.paths(surface.region(level, speck), LineEnd::Closed, &fill);
    }
    let before = Surface::new(&at_rest, &everywhere, &fields.triangles).outline();
    svg.paths(before, LineEnd::Closed, "fill=\"none\" stroke=\"#aaaaaa\" stroke-width=\"5\"");
    svg.paths(outline, LineEnd::Closed, "fill=\"none\" stroke=\"#333333\" stroke-width=\"8\"");
    let faces = fields.crack_faces.iter().flat_map(|c| [(&c.positions, &c.left), (&c.positions, &c.right)]);
    let faces = faces.map(|(p, u)| p.iter().zip(u).map(|(p, u)| view.pixel(moved(p, u))).collect());
    svg.paths(faces, LineEnd::Open, "fill=\"none\" stroke=\"#d62728\" stroke-width=\"12\"");
    color_bar(&mut svg, low, high, n_bands);
    let title = format!("{}, deformation × {}", quantity.title(), short_number(factor));
    svg.text((MARGIN, 30.0), "font-size=\"180\"", &title);
    svg.finish()
}

/// Ends of the color scale; shares of the body are by area, which counts up to a factor.
pub(super) fn scale(triangles: &[[u32; 3]], values: &[f64], area: impl Fn(&[u32; 3]) -> f64) -> (f64, f64) {
    let mut shares = vec![];
    for t in triangles {
        let area = area(t);
        shares.extend(t.iter().map(|&v| (values[v as usize], area)).filter(|s| s.0.is_finite()));
    }
    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = shares.iter().map(|s| s.1).sum();
    let quantile = |share: f64| {
        let mut below = 0.0;
        let found = shares.iter().find(|s| {
            below += s.1;
            below >= share * total
        });
        found.or(shares.last()).map_or(0.0, |s| s.0)
    };
    (quantile(BEYOND_SCALE), quantile(1.0 - BEYOND_SCALE))
}

/// Twice the area of a triangle.
pub(super) fn twice_area(positions: &[Vector2], triangle: &[u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|v| positions[v as usize]);
    cross(b - a, c - a).abs()
}

/// Draws the colors of a scale with numbers at the right side.
pub(super) fn color_bar(svg: &mut Svg, low: f64, high: f64, n_bands: usize) {
    let (width, height) = svg.size();
    let (x, top, bottom) = (width - BAR - 0.5 * MARGIN, MARGIN, height - MARGIN);
    let step = (bottom - top) / n_bands as f64;
    for band in 0..n_bands {
        let fill = viridis((band as f64 + 0.5) / n_bands as f64);
        // A little taller, so that no seam shows.
        svg.rectangle((x, bottom - step * (band + 1) as f64), (20.0, step + if band > 0 { 0.5 } else { 0.0 }), &fill);
    }
    for tick in 0..=4 {
        let t = f64::from(tick) / 4.0;
        let text = short_number(low + t * (high - low));
        svg.text((x + 26.0, bottom - t * (bottom - top) + 5.0), "", &text);
    }
}

/// Three digits.
fn short_number(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".into()
    } else if (1e-2..1e4).contains(&size) {
        let digits = (2 - size.log10().floor() as i32).max(0) as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.2e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        for (value, text) in
            [(0.0, "0"), (1.23456, "1.23"), (-0.0123, "-0.0123"), (1234.5, "1234"), (1e-7, "1.00e-7"), (5e4, "5.00e4")]
        {
            assert_eq!(short_number(value), text);
        }
    }
}
