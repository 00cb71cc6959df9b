//! Results on the terminal.

use riss::analysis::{RefinementRecord, StaticResult, TipRecord, Warning};
use riss::case::Case;
use riss::model::UnitNames;
use std::fmt::Write;

/// Tips and reactions as text.
pub fn summary(result: &StaticResult) -> String {
    let mut text = String::new();
    let rows: Vec<Vec<String>> = tips(result).map(|(name, tip)| tip_row(name, tip)).collect();
    if !rows.is_empty() {
        let head = ["crack", "end", "x", "y", "K_I", "K_II", "K_uncertainty", "J", "T", "status"];
        text += &aligned(&head, &rows, &[0, 1, 9]);
    }
    if !result.step.reactions.is_empty() {
        let row = |(part, force): &(String, riss::math::Vector2)| vec![part.clone(), number(force.x), number(force.y)];
        let rows: Vec<_> = result.step.reactions.iter().map(row).collect();
        text += if text.is_empty() { "" } else { "\n" };
        text += &aligned(&["reaction of", "x", "y"], &rows, &[0]);
    }
    if let Some(error) = result.energy_error {
        writeln!(text, "\nerror in the energy norm: {:.4} %", 100.0 * error).expect("a string takes all");
    }
    if let Some(last) = result.refinements.last() {
        writeln!(text, "\nafter {} refinements: {}", result.refinements.len() - 1, refinement_line(last))
            .expect("a string takes all");
    }
    text
}

/// The warnings of a result, a line each, with the places in the case that they are about.
pub fn warnings(case: &Case, result: &StaticResult) -> String {
    let line = |w: &Warning| {
        let place = w.key.as_ref().map_or(String::new(), |key| format!("{}: ", case.place_of(key)));
        format!("warning: {place}{w}\n")
    };
    result.warnings.iter().map(line).collect()
}

/// The units of a case as a line, if it says them.
pub fn units_line(units: Option<&UnitNames>) -> String {
    let line = |u: &UnitNames| format!("in {}, {}, {}; K in {}\n", u.length, u.force, u.stress, u.stress_intensity());
    units.map_or(String::new(), line)
}

/// A solution on the way to an accuracy.
pub fn refinement_line(record: &RefinementRecord) -> String {
    let percent = |v: f64| format!("{} %", number(100.0 * v));
    let mut text = format!("{} nodes, stress good to {}", record.n_nodes, percent(record.error_estimate));
    if let Some(error) = record.energy_error {
        text += &format!(" (in truth {})", percent(error));
    }
    if let Some(error) = record.k_error {
        text += &format!(", K good to {}", percent(error));
    }
    text
}

fn tips(result: &StaticResult) -> impl Iterator<Item = (&str, &TipRecord)> {
    result.step.cracks.iter().flat_map(|c| c.tips.iter().map(|t| (c.name.as_str(), t)))
}

fn tip_row(name: &str, tip: &TipRecord) -> Vec<String> {
    let known = |v: Option<f64>| v.map_or("-".to_string(), number);
    let end = match tip.end {
        riss::crack::End::Start => "start",
        riss::crack::End::End => "end",
    };
    vec![
        name.into(),
        end.into(),
        number(tip.position.x),
        number(tip.position.y),
        known(tip.k1),
        known(tip.k2),
        known(tip.k_uncertainty),
        known(tip.j),
        known(tip.t_stress),
        tip.status.name().into(),
    ]
}

/// Columns of equal width, right-aligned but for those in `left`.
pub fn aligned(head: &[&str], rows: &[Vec<String>], left: &[usize]) -> String {
    let width = |k: usize| rows.iter().map(|r| r[k].chars().count()).chain([head[k].len()]).max().unwrap_or(0);
    let widths: Vec<usize> = (0..head.len()).map(width).collect();
    let head: Vec<String> = head.iter().map(|s| s.to_string()).collect();
    let mut text = String::new();
    for row in std::iter::once(&head).chain(rows) {
        let cell = |k: usize| match left.contains(&k) {
            true => format!("{:<1$}", row[k], widths[k]),
            false => format!("{:>1$}", row[k], widths[k]),
        };
        let line: Vec<String> = (0..row.len()).map(cell).collect();
        text += line.join("  ").trim_end();
        text.push('\n');
    }
    text
}

/// Six significant digits.
pub fn number(v: f64) -> String {
    if v == 0.0 || !v.is_finite() {
        return if v == 0.0 { "0".into() } else { v.to_string() };
    }
    let scientific = format!("{v:.5e}");
    let exponent: i32 = scientific.split_once('e').and_then(|s| s.1.parse().ok()).unwrap_or(0);
    match exponent {
        -4..=5 => format!("{v:.*}", (5 - exponent) as usize),
        _ => scientific,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_six_digits() {
        let texts = [34.0425, -0.00045371, 1234567.8, 0.0, 1e-9, 999999.7, 210e3].map(number);
        assert_eq!(texts, ["34.0425", "-0.000453710", "1.23457e6", "0", "1.00000e-9", "1.00000e6", "210000"]);
    }

    #[test]
    fn columns_line_up() {
        let rows = vec![vec!["a".to_string(), "1.5".into()], vec!["long".into(), "-22.25".into()]];
        assert_eq!(aligned(&["part", "x"], &rows, &[0]), "part       x\na        1.5\nlong  -22.25\n");
    }
}
