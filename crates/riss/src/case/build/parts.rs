//! Named stretches of the boundary.

use super::boundary::Boundary;
use super::outline::vector;
use super::report::Report;
use crate::case::schema::Part;
use crate::math::Vector2;
use crate::model::PartId;

/// A stretch may end this far from its part, times the size of the body: points on arcs are written with few digits.
const OFF_PART: f64 = 1e-3;

/// Splits the edges at the ends of a stretch and names what lies between them.
pub(super) fn add_part(boundary: &mut Boundary, part: &Part, index: usize, report: &mut Report) -> Option<()> {
    let key = format!("part[{index}]");
    if boundary.find_part(&part.name).is_some() || part.name == super::OUTLINE {
        report.error(format!("{key}.name"), format!("there is already a part named `{}`", part.name));
        return None;
    }
    let Some(on) = boundary.find_part(&part.on) else {
        let names = boundary.names.iter().map(String::as_str);
        report.error(format!("{key}.on"), "unknown part").one_of(&part.on, names);
        return None;
    };
    let start = project(boundary, on, vector(part.from), &format!("{key}.from"), report);
    let end = project(boundary, on, vector(part.to), &format!("{key}.to"), report);
    let (start, end) = (start?, end?);
    if start.0 != end.0 {
        report.error(key, "both ends must lie on the same outline or hole");
        return None;
    }
    match stretch(boundary, on, start, end) {
        Some(edges) if !edges.is_empty() => {
            let id = boundary.part(&part.name);
            edges.iter().for_each(|&e| boundary.loops[start.0][e].parts.push(id));
            Some(())
        }
        Some(_) => {
            report.error(key, "the stretch has no length");
            None
        }
        None => {
            report.error(key, format!("between its ends, the stretch leaves the part `{}`", part.on));
            None
        }
    }
}

/// Loop and position of the point of a part that is closest to `p`.
fn project(boundary: &Boundary, on: PartId, p: Vector2, key: &str, report: &mut Report) -> Option<(usize, Vector2)> {
    let mut best: Option<(f64, usize, Vector2)> = None;
    for (l, edges) in boundary.loops.iter().enumerate() {
        for edge in edges.iter().filter(|e| e.parts.contains(&on)) {
            let q = edge.curve.point(edge.curve.closest_parameter(p));
            let d = (q - p).norm();
            if best.is_none_or(|b| d < b.0) {
                best = Some((d, l, q));
            }
        }
    }
    let (distance, l, q) = best?;
    if distance > OFF_PART * boundary.size() || !distance.is_finite() {
        let message = format!("this point is {distance:.4} away from the part `{}`", boundary.names[on]);
        report.error(key, message).suggest(format!("the closest point of the part is [{}, {}]", q.x, q.y));
        return None;
    }
    Some((l, q))
}

/// Edges from one point to the other: counterclockwise on a closed part, else whichever way stays on it.
fn stretch(boundary: &mut Boundary, on: PartId, start: (usize, Vector2), end: (usize, Vector2)) -> Option<Vec<usize>> {
    let l = start.0;
    split_at(boundary, l, on, start.1);
    split_at(boundary, l, on, end.1);
    // The second split may have moved the first.
    let mut first = split_at(boundary, l, on, start.1);
    let mut last = split_at(boundary, l, on, end.1);
    if first == last {
        return Some(vec![]);
    }
    if l > 0 {
        // Holes run clockwise.
        std::mem::swap(&mut first, &mut last);
    }
    let edges = &boundary.loops[l];
    let walk = |from: usize, to: usize| -> Option<Vec<usize>> {
        let n = edges.len();
        let list: Vec<usize> = (0..(to + n - from) % n).map(|k| (from + k) % n).collect();
        list.iter().all(|&e| edges[e].parts.contains(&on)).then_some(list)
    };
    walk(first, last).or_else(|| walk(last, first))
}

/// The edge of the loop that starts at a point of a part, split if need be.
fn split_at(boundary: &mut Boundary, l: usize, on: PartId, p: Vector2) -> usize {
    let edges = &boundary.loops[l];
    let candidates = edges.iter().enumerate().filter(|(_, e)| e.parts.contains(&on));
    let (edge, curve) = candidates
        .map(|(k, e)| (k, e.curve))
        .min_by(|a, b| a.1.distance(p).total_cmp(&b.1.distance(p)))
        .expect("the point was found on the part");
    boundary.split(l, edge, curve.closest_parameter(p))
}
