//! `report.html` of a solid: its cracks in space, factors and T-stress along every front as curves and tables, without a network.
//! Without scripts all but the view in space is there.
//!
//! What the user wrote is escaped, always.

use super::color_map::VIRIDIS;
use super::report::solid_scene::Scenes;
use super::report::{RunSource, SOLID_VIEW, html, push_data, push_solid_script};
use super::solid_results::{FrontPointResults, FrontResults, LoadCurvePoint, SolidResults};
use std::fmt::Write;

const STYLE: &str = "
:root { color-scheme: light dark; --page: #f4f5f7; --card: #fff; --text: #1b2430; --quiet: #5b6675; --line: #d8dde4; }
@media (prefers-color-scheme: dark) {
  :root { --page: #12161c; --card: #1b212a; --text: #e6e9ee; --quiet: #9fabb9; --line: #323b47; } }
body { margin: 0 auto; max-width: 1100px; padding: 20px; background: var(--page); color: var(--text);
  font: 15px/1.5 system-ui, -apple-system, 'Segoe UI', Roboto, 'Noto Sans', Arial, sans-serif; }
h1 { font-size: 26px; margin: 0 0 4px; overflow-wrap: anywhere; } h2 { font-size: 17px; margin: 0 0 8px; }
section { background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 16px 18px; margin: 16px 0; }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 420px), 1fr)); gap: 16px; }
.scroll { overflow-x: auto; } .quiet { color: var(--quiet); margin: 0; }
svg { width: 100%; height: auto; } svg text { fill: var(--text); font-size: 12px; }
svg .grid { stroke: var(--line); stroke-width: 1; } svg .line { fill: none; stroke-width: 2; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: 14px; }
th, td { padding: 3px 14px 3px 0; text-align: right; white-space: nowrap; border-bottom: 1px solid var(--line); }
.view { position: relative; margin-top: 8px; } .axis { position: absolute; left: 0; top: 0; pointer-events: none; font-size: 13px; }
[hidden] { display: none !important; }
canvas { width: 100%; aspect-ratio: 1 / 0.62; touch-action: none; cursor: grab; border: 1px solid var(--line); border-radius: 6px; }
.controls { display: flex; flex-wrap: wrap; gap: 8px 20px; align-items: center; margin-top: 8px; }
.controls input { vertical-align: middle; } .scale { display: inline-block; width: 90px; height: 10px; print-color-adjust: exact; }
@media print { button, input, select, #view-status, #view-keys { display: none; } section { break-inside: avoid; } }
pre { font-size: 13px; } .scroll button { float: right; }
th { color: var(--quiet); } th:first-child, td:first-child { text-align: left; }
";

/// Width and height of a chart, and its margins: left, right, top, bottom [pixels].
const SIZE: [f64; 2] = [620.0, 280.0];
const MARGINS: [f64; 4] = [74.0, 12.0, 26.0, 40.0];
/// Colors that also the color-blind tell apart, on white and black.
const COLORS: [&str; 3] = ["#0072b2", "#d55e00", "#009e73"];

/// A curve with its name and half the height of its error bars.
struct Series<'a> {
    name: &'a str,
    value: fn(&FrontPointResults) -> Option<f64>,
    bar: fn(&FrontPointResults) -> Option<f64>,
}

/// A curve through points with half the height of their error bars.
struct Curve<'a> {
    name: &'a str,
    points: Vec<[f64; 3]>,
    has_marks: bool,
}

const FACTORS: [Series; 3] = [
    Series { name: "K_I", value: |p| p.k1, bar: |p| p.k_uncertainty },
    Series { name: "K_II", value: |p| p.k2, bar: |p| p.k_uncertainty },
    Series { name: "K_III", value: |p| p.k3, bar: |p| p.k_uncertainty },
];
const T_STRESS: [Series; 1] = [Series { name: "T", value: |p| p.t_stress, bar: |p| p.t_uncertainty }];

/// The page for the results of a solid, with what is drawn of its steps.
pub fn solid_report(results: &SolidResults, scenes: &Scenes) -> String {
    let title = html(&results.case);
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; \
         style-src 'unsafe-inline'\">\n<title>{title}</title>\n\
         <style>{STYLE}</style>\n<h1>{title}</h1>\n<p class=\"quiet\">{}</p>\n",
        html(&summary(results))
    );
    push_warnings(&mut page, results);
    push_view(&mut page, scenes);
    push_growth(&mut page, results);
    push_loading(&mut page, results);
    for (index, front) in results.fronts.iter().enumerate() {
        push_front(&mut page, index, front);
    }
    push_cracks(&mut page, results);
    push_stages(&mut page, results);
    if let Some(source) = scenes.source() {
        push_source(&mut page, source);
    }
    push_script(&mut page, results, scenes);
    page
}

fn push_view(page: &mut String, scenes: &Scenes) {
    if !scenes.is_empty() {
        page.push_str(SOLID_VIEW);
    }
}

fn push_script(page: &mut String, results: &SolidResults, scenes: &Scenes) {
    if scenes.is_empty() {
        return;
    }
    push_data(page, "view", &serde_json::json!({ "viridis": VIRIDIS }).to_string());
    push_data(page, "units", &serde_json::to_string(&results.units).unwrap_or_default());
    push_data(page, "scenes", &scenes.json(results));
    push_solid_script(page);
    page.push_str("<p class=\"quiet\">The view is drawn with twgl.js 7.0.0, © 2019 Gregg Tavares, MIT licence.</p>\n");
}

fn summary(results: &SolidResults) -> String {
    let time = results.wall_time_s.map_or(String::new(), |t| format!(", {t:.1} s"));
    let memory = results.peak_memory_bytes.map_or(String::new(), |b| format!(", {:.1} GB", b as f64 / 1e9));
    let solver = &results.solver;
    let units = results.units.as_ref().map_or(String::new(), |u| {
        format!("; in {}, {}, {}, K in {}", u.length, u.force, u.stress, u.stress_intensity())
    });
    format!(
        "riss {}, {}: {} nodes, {} unknowns{time}{memory}; {} with {} products{units}",
        results.riss, results.method, results.nodes, results.unknowns, solver.method, solver.iterations
    )
}

fn push_warnings(page: &mut String, results: &SolidResults) {
    if results.warnings.is_empty() {
        return;
    }
    page.push_str("<section>\n<h2>Warnings</h2>\n<ul>\n");
    results.warnings.iter().for_each(|w| page.push_str(&format!("<li>{}\n", html(w))));
    page.push_str("</ul>\n</section>\n");
}

fn push_growth(page: &mut String, results: &SolidResults) {
    if results.steps.is_empty() {
        return;
    }
    page.push_str("<section>\n<h2>Growth</h2>\n<div class=\"scroll\"><table>\n");
    page.push_str("<tr><th>step<th>nodes<th>crack area<th>load factor<th>front vertices<th>moving");
    for step in &results.steps {
        let area = step.cracks.iter().map(|c| c.area).sum();
        let counts = [step.front_vertices, step.moving_vertices].map(|n| n.to_string());
        let [vertices, moving] = counts;
        let cells =
            [step.step.to_string(), step.nodes.to_string(), cell(area), cell(step.load_factor), vertices, moving];
        push_row(page, &cells);
    }
    page.push_str("\n</table></div>\n");
    if let Some(end) = &results.growth_end {
        page.push_str(&format!("<p>Growth ended: {}</p>\n", html(&end.reason)));
    }
    page.push_str("</section>\n");
}

fn push_loading(page: &mut String, results: &SolidResults) {
    let Some(loading) = &results.loading else { return };
    let point = |p: &LoadCurvePoint| Some([p.displacement?, p.load?, 0.0]);
    let points: Vec<[f64; 3]> = results.load_curve.iter().filter_map(point).collect();
    let end = points.iter().map(|p| p[0]).fold(f64::MIN_POSITIVE, f64::max);
    let energy = |get: fn(&LoadCurvePoint) -> Option<f64>| {
        results.load_curve.iter().filter_map(|p| Some([p.displacement?, get(p)?, 0.0])).collect()
    };
    let curve = |name, points| Curve { name, points, has_marks: false };
    let energies = [
        curve("work", energy(|p| p.external_work)),
        curve("stored", energy(|p| p.elastic_energy)),
        curve("dissipated", energy(|p| p.dissipated_energy)),
    ];
    page.push_str("<section>\n<h2>Load curve</h2>\n<div class=\"charts\">\n");
    page.push_str(&chart(&[curve("load", points)], end, "displacement", "load over displacement"));
    page.push_str(&chart(&energies, end, "displacement", "energies over displacement"));
    let peak = &loading.peak;
    let _ = write!(
        page,
        "</div>\n<p>Peak: load {} at displacement {}. Dissipated in the end: {}. Loading ended: {}</p>\n</section>\n",
        cell(peak.load),
        cell(peak.displacement),
        cell(loading.dissipated_energy),
        html(&loading.end.reason)
    );
}

fn push_front(page: &mut String, index: usize, front: &FrontResults) {
    let ends = if front.closed { "closed" } else { "open" };
    let (crack, length) = (html(&front.crack), cell(front.length));
    let _ = write!(page, "<section>\n<h2>Front {} of {crack}, {ends}, length {length}</h2>\n", index + 1);
    page.push_str("<div class=\"charts\">\n");
    page.push_str(&front_chart(
        front,
        &FACTORS,
        "stress intensity factors [stress·√length] over the length along the front",
    ));
    page.push_str(&front_chart(front, &T_STRESS, "T-stress [stress] over the length along the front"));
    page.push_str("</div>\n<div class=\"scroll\"><table>\n<tr>");
    let heads = ["s", "x", "y", "z", "K_I", "K_II", "K_III", "± K", "T", "± T", "J", "± J", "disc radius"];
    heads.iter().for_each(|head| page.push_str(&format!("<th>{head}")));
    for p in &front.points {
        let [x, y, z] = p.position;
        let factors = [p.k1, p.k2, p.k3, p.k_uncertainty, p.t_stress, p.t_uncertainty, p.j, p.j_uncertainty];
        let cells = [p.s, x, y, z].into_iter().chain(factors).chain([p.disc_radius]).map(cell);
        push_row(page, &cells.collect::<Vec<_>>());
    }
    page.push_str("\n</table></div>\n</section>\n");
}

fn push_cracks(page: &mut String, results: &SolidResults) {
    page.push_str("<section>\n<h2>Cracks and stress</h2>\n<div class=\"scroll\"><table>\n");
    page.push_str("<tr><th>crack<th>largest opening<th>smallest opening");
    for crack in &results.cracks {
        push_row(page, &[html(&crack.name), cell(crack.largest_opening), cell(crack.smallest_opening)]);
    }
    let place = results.stress.position.map_or(String::new(), |p| format!(" at ({})", p.map(digits).join(", ")));
    let largest = cell(results.stress.largest_principal);
    let _ = write!(
        page,
        "\n</table></div>\n<p>Largest principal stress at a node off the fronts: {largest}{place}</p>\n</section>\n"
    );
}

fn push_stages(page: &mut String, results: &SolidResults) {
    page.push_str("<section>\n<h2>Time</h2>\n<table>\n<tr><th>stage<th>seconds");
    for (stage, time) in &results.stage_time_s {
        push_row(page, &[html(stage), format!("{time:.2}")]);
    }
    page.push_str("\n</table>\n</section>\n");
}

fn push_source(page: &mut String, source: &RunSource) {
    let threads = if source.threads == 1 { "thread" } else { "threads" };
    let _ = write!(
        page,
        "<section>\n<h2>Settings</h2>\n<p>{} on {}, {} {threads}; defaults are filled in.</p>\n<div class=\"scroll\"><table>\n\
         <tr><th>key<th>value",
        html(&source.case_file),
        html(&source.platform),
        source.threads
    );
    source.settings.iter().for_each(|row| push_row(page, &row.each_ref().map(|text| html(text))));
    page.push_str("\n</table></div>\n</section>\n<section>\n<h2>Case file</h2>\n");
    for set in &source.overrides {
        let _ = writeln!(page, "<p>Set beside the file: <code>{}</code></p>", html(set));
    }
    let _ = write!(page, "<pre class=\"scroll\">{}</pre>\n</section>\n", html(&source.case_text));
}

fn push_row(page: &mut String, cells: &[String]) {
    page.push_str("\n<tr>");
    cells.iter().for_each(|c| page.push_str(&format!("<td>{c}")));
}

fn cell(value: Option<f64>) -> String {
    value.map_or("–".into(), digits)
}

/// Five digits.
fn digits(v: f64) -> String {
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

/// Curves over the length along a front; nothing where no point has a value.
fn front_chart(front: &FrontResults, series: &[Series], label: &str) -> String {
    let known = |s: &Series| -> Vec<[f64; 3]> {
        let points = front.points.iter();
        points.filter_map(|p| Some([p.s?, (s.value)(p)?, (s.bar)(p).unwrap_or(0.0)])).collect()
    };
    let curves: Vec<Curve> = series.iter().map(|s| Curve { name: s.name, points: known(s), has_marks: true }).collect();
    chart(&curves, front.length.filter(|l| *l > 0.0).unwrap_or(1.0), "s", label)
}

/// Curves from zero up to `end`.
fn chart(curves: &[Curve], end: f64, axis: &str, label: &str) -> String {
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
