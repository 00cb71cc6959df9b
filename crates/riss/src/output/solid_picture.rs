//! A picture of the nodes of a solid: the body from outside, and three slices.

use crate::math::Vector3;
use crate::model::SolidModel;
use crate::nodes::cloud::{Cloud, Place, SurfaceId};
use std::fmt::Write;

/// Side of each of the four panels, and the margin around what they show [px].
const PANEL: f64 = 480.0;
const MARGIN: f64 = 30.0;
/// Share of the spacing within which nodes belong to a slice.
const SLICE: f64 = 0.5;
/// Panels with more nodes than this show every second, third, ... one.
const MOST_DOTS: usize = 15_000;

/// Where the eye is: the drawing plane is across this direction.
const VIEW: [f64; 3] = [0.56, -0.72, 0.41];

/// Draws the nodes as SVG.
pub fn solid_picture(model: &SolidModel, cloud: &Cloud<3>) -> String {
    let size = 2.0 * PANEL;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{size}\" height=\"{}\" viewBox=\"0 0 {size} {0}\" \
         font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        size + 30.0
    );
    outside(model, cloud, &mut text);
    let center = slice_center(model);
    for axis in 0..3 {
        slice(model, cloud, axis, center[axis], &mut text);
    }
    legend(&mut text, size);
    text.push_str("</svg>\n");
    text
}

/// Slices pass through the middle of the first crack, or of the body.
fn slice_center(model: &SolidModel) -> Vector3 {
    let body = model.body.bounds();
    let of_crack = |c: &crate::crack::CrackSurface| {
        let b = c.surface.bounds();
        0.5 * (b.lower.sup(&body.lower) + b.upper.inf(&body.upper))
    };
    model.cracks.first().map_or_else(|| body.center(), of_crack)
}

/// From the plane of a panel to its pixels.
struct Panel {
    corner: [f64; 2],
    scale: f64,
    middle: [f64; 2],
}

impl Panel {
    /// The panel at a column and row, for points in some bounds.
    fn new(column: usize, row: usize, points: impl Iterator<Item = [f64; 2]>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in points {
            for d in 0..2 {
                low[d] = low[d].min(p[d]);
                high[d] = high[d].max(p[d]);
            }
        }
        let extent = (high[0] - low[0]).max(high[1] - low[1]).max(f64::MIN_POSITIVE);
        Self {
            corner: [column as f64 * PANEL, row as f64 * PANEL],
            scale: (PANEL - 2.0 * MARGIN) / extent,
            middle: [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])],
        }
    }

    fn place(&self, p: [f64; 2]) -> [f64; 2] {
        let x = self.corner[0] + 0.5 * PANEL + (p[0] - self.middle[0]) * self.scale;
        let y = self.corner[1] + 0.5 * PANEL - (p[1] - self.middle[1]) * self.scale;
        [x, y]
    }

    fn dot(&self, p: [f64; 2], radius: f64, color: &str, text: &mut String) {
        let [x, y] = self.place(p);
        let _ = writeln!(text, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{color}\"/>");
    }

    fn line(&self, a: [f64; 2], b: [f64; 2], color: &str, text: &mut String) {
        let ([x, y], [u, v]) = (self.place(a), self.place(b));
        let _ = writeln!(
            text,
            "<line x1=\"{x:.1}\" y1=\"{y:.1}\" x2=\"{u:.1}\" y2=\"{v:.1}\" stroke=\"{color}\" stroke-width=\"1\"/>"
        );
    }

    fn title(&self, title: &str, text: &mut String) {
        let (x, y) = (self.corner[0] + 12.0, self.corner[1] + 20.0);
        let _ = writeln!(text, "<text x=\"{x}\" y=\"{y}\">{title}</text>");
    }
}

fn color(place: &Place<3>) -> &'static str {
    let is_face = |id: SurfaceId| matches!(id, SurfaceId::Face { .. });
    match place {
        Place::Inside => "#9aa0a6",
        Place::Surface(facets) if facets.iter().any(|f| is_face(f.surface)) => "#d93025",
        Place::Surface(facets) if facets.len() > 1 => "#202124",
        Place::Surface(_) => "#1a73e8",
        Place::Front { .. } => "#e37400",
    }
}

/// The body from outside with its edges, and the cracks as if it were glass.
fn outside(model: &SolidModel, cloud: &Cloud<3>, text: &mut String) {
    let view = Vector3::from(VIEW).normalize();
    let right = Vector3::z().cross(&view).normalize();
    let up = view.cross(&right);
    let flat = |p: Vector3| [p.dot(&right), p.dot(&up)];
    let panel = Panel::new(0, 0, model.body.vertices().iter().map(|p| flat(*p)));
    panel.title("from outside", text);
    let vertex = |v: u32| flat(model.body.vertices()[v as usize]);
    for chain in model.body.chains() {
        chain.vertices.windows(2).for_each(|w| panel.line(vertex(w[0]), vertex(w[1]), "#5f6368", text));
    }
    let is_seen = |place: &Place<3>| match place {
        Place::Inside => false,
        Place::Surface(facets) => facets.iter().any(|f| match f.surface {
            SurfaceId::Part(_) => f.normal.dot(&view) > 0.0,
            SurfaceId::Face { .. } => true,
        }),
        Place::Front { .. } => true,
    };
    let seen: Vec<usize> = (0..cloud.len()).filter(|k| is_seen(&cloud.places[*k])).collect();
    for k in seen.iter().step_by(seen.len() / MOST_DOTS + 1) {
        panel.dot(flat(cloud.positions[*k]), 1.2, color(&cloud.places[*k]), text);
    }
    for front in model.cracks.iter().flat_map(|c| &c.fronts) {
        front.segments().for_each(|[a, b]| panel.line(flat(a), flat(b), "#e37400", text));
    }
}

/// The nodes near a plane across an axis.
fn slice(model: &SolidModel, cloud: &Cloud<3>, axis: usize, at: f64, text: &mut String) {
    let (u, v) = [(1, 2), (0, 2), (0, 1)][axis];
    let flat = |p: &Vector3| [p[u], p[v]];
    let (column, row) = [(1, 0), (0, 1), (1, 1)][axis];
    let bounds = model.body.bounds();
    let panel = Panel::new(column, row, [bounds.lower, bounds.upper].iter().map(flat));
    let names = ["x", "y", "z"];
    panel.title(&format!("slice {} = {at:.4}: {} to the right, {} up", names[axis], names[u], names[v]), text);
    let is_near = |k: &usize| (cloud.positions[*k][axis] - at).abs() < SLICE * cloud.spacings[*k];
    let near: Vec<usize> = (0..cloud.len()).filter(is_near).collect();
    for k in near.iter().step_by(near.len() / MOST_DOTS + 1) {
        panel.dot(flat(&cloud.positions[*k]), 1.6, color(&cloud.places[*k]), text);
    }
}

fn legend(text: &mut String, y: f64) {
    let entries = [
        ("inside", "#9aa0a6"),
        ("boundary", "#1a73e8"),
        ("edge or corner", "#202124"),
        ("crack face", "#d93025"),
        ("front", "#e37400"),
    ];
    for (k, (name, color)) in entries.iter().enumerate() {
        let x = 20.0 + 150.0 * k as f64;
        let _ = writeln!(
            text,
            "<circle cx=\"{x}\" cy=\"{}\" r=\"4\" fill=\"{color}\"/><text x=\"{}\" y=\"{}\">{name}</text>",
            y + 10.0,
            x + 10.0,
            y + 15.0
        );
    }
}
