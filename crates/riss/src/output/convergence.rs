//! Files of a convergence study: a table, and a picture of the distance to the limit over the number of nodes.

use super::svg::{LineEnd, Svg};
use super::whole_file::write_whole;
use crate::analysis::convergence::StudiedTip;
use crate::analysis::{ConvergenceStudy, Limit};
use crate::crack::End;
use crate::geometry::aabb::Aabb;
use crate::math::Vector2;
use std::fmt::Write;
use std::io;
use std::path::{Path, PathBuf};

/// Names of the two files.
pub(super) const FILES: [&str; 2] = ["convergence.csv", "convergence.svg"];
/// Colors of the tips, in turn; none is told from another by hue alone.
const COLORS: [&str; 6] = ["#1b6ca8", "#c8553d", "#2e7d4f", "#7a4ea3", "#8a6d1b", "#444444"];
/// Smallest distance that is drawn, over the value.
const FLOOR: f64 = 1e-6;

/// Writes the table and the picture into a folder; returns their paths.
///
/// # Errors
/// Those of the file system.
pub fn write_convergence(dir: &Path, study: &ConvergenceStudy) -> io::Result<Vec<PathBuf>> {
    let contents = [table(study), picture(study)];
    let write = |(name, content): (&str, String)| {
        let path = dir.join(name);
        write_whole(&path, content.as_bytes()).map(|()| path)
    };
    FILES.into_iter().zip(contents).map(write).collect()
}

/// Name of an end of a crack.
fn end_name(end: End) -> &'static str {
    match end {
        End::Start => "start",
        End::End => "end",
    }
}

/// One row for each tip of each solution, then one for each limit.
fn table(study: &ConvergenceStudy) -> String {
    let mut text = String::from("crack,end,factor,nodes,K_I,K_II,K_uncertainty\n");
    let quoted = |name: &str| format!("\"{}\"", name.replace('"', "\"\""));
    let first = study.levels.first().map_or(&[][..], |l| &l.tips);
    for (k, tip) in first.iter().enumerate() {
        let name = format!("{},{}", quoted(&tip.crack), end_name(tip.end));
        for level in &study.levels {
            let ([k1, k2], bar) = (level.tips[k].factors, level.tips[k].uncertainty);
            let _ = writeln!(text, "{name},{},{},{k1},{k2},{bar}", level.factor, level.n_nodes);
        }
        if let [Some(k1), Some(k2)] = study.limits[k] {
            let bar = k1.uncertainty.max(k2.uncertainty);
            let _ = writeln!(text, "{name},0,,{},{},{bar}", k1.value, k2.value);
        }
    }
    text
}

/// Distance of the factors of a tip to their limits, over the size of the limits, for each solution.
fn distances(study: &ConvergenceStudy, tip: usize) -> Option<Vec<(f64, f64)>> {
    let [k1, k2]: [Limit; 2] = [study.limits[tip][0]?, study.limits[tip][1]?];
    let size = k1.value.hypot(k2.value);
    let distance = |factors: [f64; 2]| (factors[0] - k1.value).hypot(factors[1] - k2.value) / size;
    Some(study.levels.iter().map(|l| (l.n_nodes as f64, distance(l.tips[tip].factors))).collect())
}

fn picture(study: &ConvergenceStudy) -> String {
    let tips = study.levels.first().map_or(&[][..], |l| &l.tips);
    let name = |tip: &StudiedTip| format!("{} {}", tip.crack, end_name(tip.end));
    let line =
        |(k, tip): (usize, &StudiedTip)| Line { name: name(tip), points: distances(study, k).unwrap_or_default() };
    chart("distance of K to its limit", &tips.iter().enumerate().map(line).collect::<Vec<_>>())
}

/// Distances to a limit, over the numbers of nodes.
pub(super) struct Line {
    /// What goes there.
    pub name: String,
    /// Nodes, and the distance over the size of the limit.
    pub points: Vec<(f64, f64)>,
}

/// Both axes are logarithmic, one decade is as long along both.
pub(super) fn chart(title: &str, all_lines: &[Line]) -> String {
    let decimal = |(n, d): &(f64, f64)| Vector2::new(n.log10(), d.max(FLOOR).log10());
    let lines: Vec<Vec<Vector2>> = all_lines.iter().map(|l| l.points.iter().map(decimal).collect()).collect();
    let all = || lines.iter().flatten().copied();
    let bounds = match all().count() {
        0 => Aabb { lower: Vector2::new(2.0, -4.0), upper: Vector2::new(4.0, -2.0) },
        _ => Aabb::of_points(all()),
    };
    let lower = bounds.lower.map(|v| (v - 1e-9).floor());
    let upper = bounds.upper.map(|v| (v + 1e-9).ceil()).sup(&(lower + Vector2::repeat(1.0)));
    let (mut svg, view) = Svg::around(Aabb { lower, upper }, [140.0, 60.0]);
    let grid = |a: Vector2, b: Vector2| vec![view.pixel(a), view.pixel(b)];
    let decades = |k: usize| (lower[k] as i32)..=(upper[k] as i32);
    let vertical = decades(0).map(|d| grid(Vector2::new(d.into(), lower.y), Vector2::new(d.into(), upper.y)));
    let horizontal = decades(1).map(|d| grid(Vector2::new(lower.x, d.into()), Vector2::new(upper.x, d.into())));
    svg.paths(vertical.chain(horizontal), LineEnd::Open, "fill=\"none\" stroke=\"#cccccc\" stroke-width=\"8\"");
    for d in decades(0) {
        let (x, y) = view.place(Vector2::new(d.into(), lower.y));
        svg.text((x, y + 24.0), "text-anchor=\"middle\"", &format!("{}", 10f64.powi(d)));
    }
    for d in decades(1) {
        let (x, y) = view.place(Vector2::new(lower.x, d.into()));
        svg.text((x - 10.0, y + 5.0), "text-anchor=\"end\"", &format!("{} %", 10f64.powi(d + 2)));
    }
    let (width, height) = svg.size();
    svg.text((width / 2.0, height - 20.0), "text-anchor=\"middle\"", "nodes");
    svg.text((140.0, 30.0), "", title);
    for (k, line) in lines.iter().enumerate().filter(|(_, l)| !l.is_empty()) {
        let color = COLORS[k % COLORS.len()];
        let pixels: Vec<_> = line.iter().map(|p| view.pixel(*p)).collect();
        let dots = pixels.iter().map(|p| vec![*p]).collect::<Vec<_>>();
        svg.paths([pixels], LineEnd::Open, &format!("fill=\"none\" stroke=\"{color}\" stroke-width=\"20\""));
        svg.paths(dots, LineEnd::Open, &format!("fill=\"none\" stroke=\"{color}\" stroke-width=\"80\""));
        let at = (width - 70.0, 30.0 + 20.0 * k as f64);
        let style = format!("text-anchor=\"end\" fill=\"{color}\"");
        svg.text(at, &style, &all_lines[k].name);
    }
    svg.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::convergence::{Level, limit};

    fn study() -> ConvergenceStudy {
        let values = [2.0, 1.0, 0.5].map(|h: f64| (h, 10.0 - 0.1 * h));
        let level = |(factor, k1): (f64, f64)| Level {
            factor,
            n_nodes: (1000.0 / (factor * factor)) as usize,
            strain_energy: 1.0,
            tips: vec![StudiedTip { crack: "a,b".into(), end: End::End, factors: [k1, 0.0], uncertainty: 0.2 }],
        };
        let zeros = values.map(|(h, _)| (h, 0.0));
        ConvergenceStudy { levels: values.map(level).to_vec(), limits: vec![[limit(&values), limit(&zeros)]] }
    }

    #[test]
    fn the_table_ends_with_the_limit() {
        let text = table(&study());
        let mut rows = csv::ReaderBuilder::new().from_reader(text.as_bytes());
        let rows: Vec<csv::StringRecord> = rows.records().map(|r| r.unwrap()).collect();
        assert_eq!((rows.len(), &rows[0][0], &rows[0][3]), (4, "a,b", "250"));
        assert_eq!(&rows[3][2], "0");
        assert!((rows[3][4].parse::<f64>().unwrap() - 10.0).abs() < 1e-6);
    }

    #[test]
    fn the_picture_shows_a_point_for_each_solution() {
        let svg = picture(&study());
        // Three dots, the line through them, the grid.
        assert_eq!(svg.matches("<path").count(), 3);
        assert!(svg.contains("a,b end") && svg.contains("1000"));
    }

    #[test]
    fn a_body_without_tips_has_a_picture_too() {
        let empty = ConvergenceStudy { levels: vec![], limits: vec![] };
        assert!(picture(&empty).ends_with("</svg>\n"));
    }
}
