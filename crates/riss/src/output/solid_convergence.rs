//! Files of a convergence study of a solid: a table, and a picture of the distance to the limits over the number of nodes.

use super::convergence::{FILES, Line, chart};
use super::whole_file::write_whole;
use crate::analysis::Limit;
use crate::analysis::solid_convergence::{FrontConvergence, SolidConvergenceStudy, ValueConvergence};
use std::fmt::Write;
use std::io;
use std::path::{Path, PathBuf};

/// Writes the table and the picture into a folder; returns their paths.
///
/// # Errors
/// Those of the file system.
pub fn write_solid_convergence(dir: &Path, study: &SolidConvergenceStudy) -> io::Result<Vec<PathBuf>> {
    let content = if study.loading.is_empty() { table(study) } else { loading_table(study) };
    let write = |(name, content): (&str, String)| {
        let path = dir.join(name);
        write_whole(&path, content.as_bytes()).map(|()| path)
    };
    FILES.into_iter().zip([content, picture(study)]).map(write).collect()
}

/// One row for each point of each front in each solution, then one for its limit.
fn table(study: &SolidConvergenceStudy) -> String {
    let mut text = String::from("crack,front,s,x,y,z,factor,nodes,K_I,K_II,K_III,K_uncertainty\n");
    for front in &study.fronts {
        for p in &front.points {
            let name = front.crack.replace('"', "\"\"");
            let place =
                format!("\"{name}\",{},{},{},{},{}", front.front, p.s, p.position.x, p.position.y, p.position.z);
            for ((level, [k1, k2, k3]), bar) in study.levels.iter().zip(&p.factors).zip(&p.uncertainties) {
                let _ = writeln!(text, "{place},{},{},{k1},{k2},{k3},{bar}", level.factor, level.n_nodes);
            }
            if let Some([k1, k2, k3]) = &p.limits {
                let bar = [k1, k2, k3].map(|l| l.uncertainty).into_iter().fold(0.0, f64::max);
                let _ = writeln!(text, "{place},0,,{},{},{},{bar}", k1.value, k2.value, k3.value);
            }
        }
    }
    text
}

/// One row for each solution, then one for the limits.
fn loading_table(study: &SolidConvergenceStudy) -> String {
    let names: Vec<String> = study.loading.iter().map(|v| v.name.replace(' ', "_")).collect();
    let mut text = format!("factor,nodes,{}\n", names.join(","));
    for (k, level) in study.levels.iter().enumerate() {
        let values: Vec<String> = study.loading.iter().map(|v| v.values[k].to_string()).collect();
        let _ = writeln!(text, "{},{},{}", level.factor, level.n_nodes, values.join(","));
    }
    let limits: Option<Vec<String>> = study.loading.iter().map(|v| Some(v.limit?.value.to_string())).collect();
    if let Some(limits) = limits {
        let _ = writeln!(text, "0,,{}", limits.join(","));
    }
    text
}

fn picture(study: &SolidConvergenceStudy) -> String {
    let nodes = || study.levels.iter().map(|l| l.n_nodes as f64);
    if study.loading.is_empty() {
        let name = |f: &FrontConvergence| format!("{}, front {}", f.crack, f.front);
        let line = |f: &FrontConvergence| Line { name: name(f), points: nodes().zip(distances(f)).collect() };
        return chart(
            "distance of K to its limit, root mean square",
            &study.fronts.iter().map(line).collect::<Vec<_>>(),
        );
    }
    let far = |limit: Limit, v: f64| if limit.value == 0.0 { 0.0 } else { (v / limit.value - 1.0).abs() };
    let line = |v: &ValueConvergence| {
        let points = v.limit.map_or(vec![], |l| nodes().zip(v.values.iter().map(|x| far(l, *x))).collect());
        Line { name: v.name.into(), points }
    };
    chart("distance to the limit", &study.loading.iter().map(line).collect::<Vec<_>>())
}

/// Root mean square along a front of the distance to the limits over that of the limits, for each solution.
fn distances(front: &FrontConvergence) -> Vec<f64> {
    let limits = || front.points.iter().filter_map(|p| Some((p, p.limits?)));
    let size: f64 = limits().flat_map(|(_, l)| l).map(|l| l.value.powi(2)).sum();
    let n_levels = front.points.first().map_or(0, |p| p.factors.len());
    let square = |level: usize| -> f64 {
        let one = |(p, l): (&crate::analysis::solid_convergence::PointConvergence, [Limit; 3])| {
            (0..3).map(|mode| (p.factors[level][mode] - l[mode].value).powi(2)).sum::<f64>()
        };
        limits().map(one).sum()
    };
    if size > 0.0 { (0..n_levels).map(|level| (square(level) / size).sqrt()).collect() } else { vec![] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::convergence::limits;
    use crate::analysis::solid_convergence::{PointConvergence, SolidLevel};
    use crate::math::Vector3;

    fn study() -> SolidConvergenceStudy {
        let factors = [1.5, 1.2, 1.0];
        let levels = factors.map(|factor| SolidLevel { factor, n_nodes: (1000.0 / factor) as usize }).to_vec();
        let value = |exact: f64| factors.map(|h: f64| (h, exact + 0.1 * h * h)).to_vec();
        let point = |s: f64| {
            let found = limits(&[value(10.0 + s), value(0.0), value(2.0)]).unwrap();
            PointConvergence {
                s,
                position: Vector3::new(s, 0.0, 0.0),
                factors: (0..3).map(|k| [value(10.0 + s)[k].1, value(0.0)[k].1, value(2.0)[k].1]).collect(),
                uncertainties: vec![0.2; 3],
                limits: Some([found[0], found[1], found[2]]),
            }
        };
        let points = vec![point(0.0), point(1.0)];
        let front = FrontConvergence { crack: "a".into(), front: 0, is_closed: true, length: 2.0, points };
        SolidConvergenceStudy { levels, fronts: vec![front], loading: vec![] }
    }

    #[test]
    fn the_table_has_a_limit_for_each_point() {
        let text = table(&study());
        let mut rows = csv::ReaderBuilder::new().from_reader(text.as_bytes());
        let rows: Vec<csv::StringRecord> = rows.records().map(|r| r.unwrap()).collect();
        assert_eq!((rows.len(), &rows[0][0], &rows[7][6]), (8, "a", "0"));
        // What was put in goes with the square of the spacing to 10 + s, 0 and 2.
        for (column, exact) in [(8, 11.0), (9, 0.0), (10, 2.0)] {
            assert!((rows[7][column].parse::<f64>().unwrap() - exact).abs() < 1e-9);
        }
    }

    #[test]
    fn the_picture_shows_a_line_for_each_front() {
        let svg = picture(&study());
        assert_eq!(svg.matches("<path").count(), 3);
        assert!(svg.contains("a, front 0"));
    }
}
