//! `riss converge` of solids.

use crate::converge::order;
use crate::table::{aligned, number};
use riss::analysis::solid_convergence::{FrontConvergence, SolidConvergenceStudy, ValueConvergence};

/// Factors below this share of the largest of their front are not worth a table.
const NEGLIGIBLE: f64 = 0.01;

/// For each front a table of each factor that matters, for a load curve one of its values.
pub fn summary(study: &SolidConvergenceStudy) -> String {
    let mut parts: Vec<String> = study.fronts.iter().flat_map(|f| front_tables(study, f)).collect();
    if !study.loading.is_empty() {
        let rows: Vec<Vec<String>> = study.loading.iter().map(value_row).collect();
        parts.push(table(study, "load curve", &rows, &[0]));
    }
    if parts.is_empty() {
        return "no crack front has factors in all solutions: nothing converges that could be told\n".into();
    }
    parts.join("\n")
}

fn table(study: &SolidConvergenceStudy, first: &str, rows: &[Vec<String>], left: &[usize]) -> String {
    let nodes: Vec<String> = study.levels.iter().map(|l| format!("{} nodes", l.n_nodes)).collect();
    let mut head = vec![first];
    head.extend(nodes.iter().map(String::as_str));
    head.extend(["limit", "+-", "order"]);
    aligned(&head, rows, left)
}

fn front_tables(study: &SolidConvergenceStudy, front: &FrontConvergence) -> Vec<String> {
    let ends = if front.is_closed { "closed" } else { "open" };
    let title = format!("crack {}, front {} of length {}, {ends}", front.crack, front.front, number(front.length));
    if front.points.is_empty() {
        return vec![format!("{title}\nno disc fits at any point in all solutions: the spacing is too large\n")];
    }
    let size = |mode: usize| {
        let all = front.points.iter().flat_map(|p| &p.factors);
        all.map(|k| k[mode].abs()).fold(0.0, f64::max)
    };
    let largest = (0..3).map(size).fold(0.0, f64::max);
    let modes = (0..3).filter(|mode| size(*mode) > NEGLIGIBLE * largest);
    modes
        .map(|mode| {
            let row = |p: &riss::analysis::solid_convergence::PointConvergence| {
                let mut row = vec![number(p.s)];
                row.extend(p.factors.iter().map(|k| number(k[mode])));
                row.extend(match &p.limits {
                    Some(l) => [number(l[mode].value), number(l[mode].uncertainty), order(&l[mode])],
                    None => ["-", "-", "-"].map(String::from),
                });
                row
            };
            let rows: Vec<Vec<String>> = front.points.iter().map(row).collect();
            format!("{title}: {}\n{}", ["K_I", "K_II", "K_III"][mode], table(study, "s", &rows, &[]))
        })
        .collect()
}

fn value_row(value: &ValueConvergence) -> Vec<String> {
    let mut row = vec![value.name.to_string()];
    row.extend(value.values.iter().map(|v| number(*v)));
    row.extend(match &value.limit {
        Some(l) => [number(l.value), number(l.uncertainty), order(l)],
        None => ["-", "-", "-"].map(String::from),
    });
    row
}
