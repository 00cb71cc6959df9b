//! `report.html` of a solid: its cracks in space, factors and T-stress along every front as curves and tables, without a network.
//! Without scripts all but the view in space is there.
//!
//! What the user wrote is escaped, always.

use super::color_map::VIRIDIS;
use super::report::chart::{Curve, cell, chart, digits};
use super::report::loading::loading_section;
use super::report::solid_scene::Scenes;
use super::report::{RunSource, SOLID_VIEW, html, push_data, push_solid_script};
use super::solid_results::{FrontPointResults, FrontResults, SolidResults};
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

/// A curve with its name and half the height of its error bars.
struct Series<'a> {
    name: &'a str,
    value: fn(&FrontPointResults) -> Option<f64>,
    bar: fn(&FrontPointResults) -> Option<f64>,
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
    page.push_str(&loading_section(results.loading.as_ref(), &results.load_curve));
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

/// Curves over the length along a front; nothing where no point has a value.
fn front_chart(front: &FrontResults, series: &[Series], label: &str) -> String {
    let known = |s: &Series| -> Vec<[f64; 3]> {
        let points = front.points.iter();
        points.filter_map(|p| Some([p.s?, (s.value)(p)?, (s.bar)(p).unwrap_or(0.0)])).collect()
    };
    let curves: Vec<Curve> = series.iter().map(|s| Curve { name: s.name, points: known(s), has_marks: true }).collect();
    chart(&curves, front.length.filter(|l| *l > 0.0).unwrap_or(1.0), "s", label)
}
