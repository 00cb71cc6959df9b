//! Charts as drawings, for pages that are whole without scripts.

use super::html;
use std::fmt::Write;

/// Width and height of a chart, and its margins: left, right, top, bottom [pixels].
const SIZE: [f64; 2] = [620.0, 280.0];
const MARGINS: [f64; 4] = [74.0, 12.0, 26.0, 40.0];
/// Colors that also the color-blind tell apart, on white and black.
const COLORS: [&str; 3] = ["#0072b2", "#d55e00", "#009e73"];

/// A curve through points with half the height of their error bars.
pub(in crate::output) struct Curve<'a> {
    pub name: &'a str,
    pub points: Vec<[f64; 3]>,
    pub has_marks: bool,
}

/// A number in a table, five digits.
pub(in crate::output) fn cell(value: Option<f64>) -> String {
    value.map_or("–".into(), digits)
}

pub(in crate::output) fn digits(v: f64) -> String {
    let exponent = if v == 0.0 { 0.0 } else { v.abs().log10().floor() };
    if (-4.0..6.0).contains(&exponent) {
        format!("{v:.*}", (4.0 - exponent).max(0.0) as usize)
    } else {
        format!("{v:.4e}")
    }
}

/// Where values go in a chart.
struct Axes {
    lower: [f64; 2],
    upper: [f64; 2],
}

impl Axes {
    fn x(&self, s: f64) -> f64 {
        let width = SIZE[0] - MARGINS[0] - MARGINS[1];
        MARGINS[0] + width * (s - self.lower[0]) / (self.upper[0] - self.lower[0])
    }

    fn y(&self, v: f64) -> f64 {
        let height = SIZE[1] - MARGINS[2] - MARGINS[3];
        SIZE[1] - MARGINS[3] - height * (v - self.lower[1]) / (self.upper[1] - self.lower[1])
    }

    /// Round values along an axis.
    fn ticks(&self, axis: usize) -> Vec<f64> {
        let (low, high) = (self.lower[axis], self.upper[axis]);
        let rough = (high - low) / 5.0;
        let unit = 10f64.powf(rough.log10().floor());
        let step = unit * [1.0, 2.0, 5.0, 10.0].into_iter().find(|f| f * unit >= rough).unwrap_or(10.0);
        let first = (low / step).ceil() as i64;
        (first..).map(|k| k as f64 * step).take_while(|v| *v <= high + 1e-9 * step).take(20).collect()
    }
}

/// Curves from zero up to `end`.
pub(in crate::output) fn chart(curves: &[Curve], end: f64, axis: &str, label: &str) -> String {
    let all = || curves.iter().flat_map(|c| &c.points);
    if all().count() == 0 {
        return String::new();
    }
    let least = all().map(|p| p[1] - p[2]).fold(0.0, f64::min);
    let greatest = all().map(|p| p[1] + p[2]).fold(0.0, f64::max);
    let room = (0.05 * (greatest - least)).max(f64::MIN_POSITIVE);
    let axes = Axes { lower: [0.0, least - room], upper: [end, greatest + room] };
    let [width, height] = SIZE;
    let mut svg = format!("<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{}\">\n", html(label));
    push_grid(&mut svg, &axes, axis);
    for (k, curve) in curves.iter().enumerate() {
        let color = COLORS[k % COLORS.len()];
        let at = |p: &[f64; 3]| format!("{:.1},{:.1}", axes.x(p[0]), axes.y(p[1]));
        let points: Vec<String> = curve.points.iter().map(at).collect();
        let _ = writeln!(svg, "<polyline class=\"line\" stroke=\"{color}\" points=\"{}\"/>", points.join(" "));
        for [s, value, bar] in curve.points.iter().filter(|_| curve.has_marks) {
            let (x, low, high) = (axes.x(*s), axes.y(value - bar), axes.y(value + bar));
            let _ = writeln!(
                svg,
                "<line stroke=\"{color}\" x1=\"{x:.1}\" x2=\"{x:.1}\" y1=\"{low:.1}\" y2=\"{high:.1}\"/>"
            );
            let _ = writeln!(svg, "<circle fill=\"{color}\" cx=\"{x:.1}\" cy=\"{:.1}\" r=\"2.5\"/>", axes.y(*value));
        }
        let x = MARGINS[0] + 70.0 * k as f64;
        let _ = writeln!(svg, "<rect fill=\"{color}\" x=\"{x}\" y=\"8\" width=\"10\" height=\"10\"/>");
        let _ = writeln!(svg, "<text x=\"{}\" y=\"17\">{}</text>", x + 15.0, curve.name);
    }
    svg + "</svg>\n"
}

fn push_grid(svg: &mut String, axes: &Axes, name: &str) {
    let (left, right, bottom) = (MARGINS[0], SIZE[0] - MARGINS[1], SIZE[1] - MARGINS[3]);
    for v in axes.ticks(1) {
        let y = axes.y(v);
        let _ = writeln!(svg, "<line class=\"grid\" x1=\"{left}\" x2=\"{right}\" y1=\"{y:.1}\" y2=\"{y:.1}\"/>");
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{}</text>", left - 6.0, y + 4.0, tick(v));
    }
    for s in axes.ticks(0) {
        let x = axes.x(s);
        let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>", bottom + 18.0, tick(s));
    }
    let _ = writeln!(svg, "<text x=\"{right}\" y=\"{}\" text-anchor=\"end\">{name}</text>", SIZE[1] - 6.0);
}

/// A round number without the traces of binary arithmetic.
fn tick(v: f64) -> String {
    let text = format!("{v:.3e}");
    let exact: f64 = text.parse().unwrap_or(v);
    if exact != 0.0 && !(1e-4..1e6).contains(&exact.abs()) { format!("{exact:e}") } else { format!("{exact}") }
}
