//! A small SVG writer: paths with short integer coordinates in a view of the plane.
//!
//! By hand, because pictures need four elements, and `plotters` brings fonts and axes for charts.

use crate::geometry::aabb::Aabb;
use crate::math::Vector2;
use std::fmt::Write;

/// Units per pixel: paths use integers, a tenth of a pixel is below what can be seen. Styles are in units too.
const UNITS: f64 = 10.0;
/// Free space above and below the view [pixel].
pub(super) const MARGIN: f64 = 80.0;

/// Maps a box of the plane to the picture, y upwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    lower_left: Vector2,
    scale: f64,
    origin: Vector2,
}

/// A point of the picture in units.
pub(super) type Pixel = (i32, i32);

impl View {
    /// Units of a point.
    pub fn pixel(&self, p: Vector2) -> Pixel {
        let (x, y) = self.place(p);
        ((x * UNITS).round() as i32, (y * UNITS).round() as i32)
    }

    /// Pixels of a point.
    pub fn place(&self, p: Vector2) -> (f64, f64) {
        let d = (p - self.lower_left) * self.scale;
        (self.origin.x + d.x, self.origin.y - d.y)
    }

    /// Length of the plane that one pixel shows.
    pub fn pixel_length(&self) -> f64 {
        1.0 / self.scale
    }
}

/// A picture while it is drawn.
pub(super) struct Svg {
    width: f64,
    height: f64,
    body: String,
}

impl Svg {
    /// An empty picture around a box, with its view; so many pixels stay free to the left and right of it.
    pub fn around(bounds: Aabb<2>, [left, right]: [f64; 2]) -> (Self, View) {
        const SIZE: f64 = 800.0;
        let size = bounds.size().map(|s| if s.is_finite() { s.max(0.0) } else { 0.0 });
        let longest = size.x.max(size.y);
        let scale = if longest > 0.0 { SIZE / longest } else { 1.0 };
        let lower_left = if longest > 0.0 { bounds.lower } else { Vector2::zeros() };
        let (width, height) = (size.x * scale + left + right, size.y * scale + 2.0 * MARGIN);
        let view = View { lower_left, scale, origin: Vector2::new(left, height - MARGIN) };
        (Self { width, height, body: String::new() }, view)
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (f64, f64) {
        (self.width, self.height)
    }

    /// Polylines or polygons as one path; `style` are SVG attributes.
    pub fn paths(&mut self, lines: impl IntoIterator<Item = Vec<Pixel>>, end: LineEnd, style: &str) {
        let mut data = String::new();
        for line in lines {
            let mut last = match line.first() {
                Some(&first) => first,
                None => continue,
            };
            let _ = write!(data, "M{} {}l", last.0, last.1);
            let mut separator = "";
            for &(x, y) in &line[1..] {
                if (x, y) != last {
                    let _ = write!(data, "{separator}{} {}", x - last.0, y - last.1);
                    (last, separator) = ((x, y), " ");
                }
            }
            // A dot: a line of no length with round ends.
            if separator.is_empty() {
                data.push_str("0 0");
            }
            if end == LineEnd::Closed {
                data.push('z');
            }
        }
        if !data.is_empty() {
            let _ = writeln!(self.body, "<path {style} d=\"{data}\"/>");
        }
    }

    /// A text at pixels.
    pub fn text(&mut self, at: (f64, f64), style: &str, text: &str) {
        let escaped = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        let (x, y) = (at.0 * UNITS, at.1 * UNITS);
        let _ = writeln!(self.body, "<text x=\"{x:.0}\" y=\"{y:.0}\" {style}>{escaped}</text>");
    }

    /// A filled rectangle from its upper left corner in pixels.
    pub fn rectangle(&mut self, at: (f64, f64), size: (f64, f64), fill: &str) {
        let [x, y, w, h] = [at.0, at.1, size.0, size.1].map(|v| (v * UNITS).round());
        let _ = writeln!(self.body, "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" fill=\"{fill}\"/>");
    }

    /// The file.
    pub fn finish(self) -> String {
        let (w, h) = (self.width, self.height);
        let (units_x, units_y) = (w * UNITS, h * UNITS);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w:.0}\" height=\"{h:.0}\" \
             viewBox=\"0 0 {units_x:.0} {units_y:.0}\" font-family=\"sans-serif\" font-size=\"140\" \
             stroke-linecap=\"round\" stroke-linejoin=\"round\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{}</svg>\n",
            self.body
        )
    }
}

/// Whether lines are polygons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LineEnd {
    Open,
    Closed,
}
