//! Moves tips: every increment ends where it first meets something, whichever tip arrives there first.

use super::walls::{CLOSE, Ending, Walls, length_of};
use crate::crack::{EndKind, TipId};
use crate::geometry::predicates::{closest_on_segment, segments_cross};
use crate::math::{Vector2, cross};
use crate::model::Model;

/// Two tips that arrive at a meeting within this share of the step have met each other.
const SAME_TIME: f64 = 0.25;

/// How a tip wants to grow.
#[derive(Clone, Debug, PartialEq)]
pub struct Increment {
    /// The tip.
    pub tip: TipId,
    /// Vertices from the tip (the first) to where it wants to stand.
    pub way: Vec<Vector2>,
}

/// Where an increment really went.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// What it ends at.
    pub ending: Ending,
    /// Length of the new stretch [length].
    pub length: f64,
}

/// Moves all tips at once; returns where each increment went.
pub fn advance(model: &mut Model, increments: &[Increment]) -> Vec<Arrival> {
    let walls = Walls::new(model);
    let mut ways: Vec<(Vec<Vector2>, Ending)> = increments.iter().map(|i| walls.clip(i.tip, &i.way)).collect();
    let speeds: Vec<f64> = increments.iter().map(|i| length_of(&i.way)).collect();
    settle_meetings(increments, &speeds, &mut ways);
    for (increment, (way, ending)) in increments.iter().zip(&ways) {
        let kind = match ending {
            Ending::Free => EndKind::Tip,
            Ending::Boundary(_) => EndKind::Mouth,
            Ending::Crack(_) => EndKind::Junction,
        };
        model.cracks[increment.tip.crack].extend(increment.tip.end, &way[1..], kind);
    }
    for (way, ending) in &ways {
        if let Ending::Crack(crack) = ending {
            model.cracks[*crack].join_at(way[way.len() - 1]);
        }
    }
    ways.into_iter().map(|(way, ending)| Arrival { ending, length: length_of(&way) }).collect()
}

/// Where two ways come together.
#[derive(Clone, Copy, Debug)]
struct Meeting {
    pair: [usize; 2],
    /// Length run by each up to the meeting, and the time as the share of the step.
    run: [f64; 2],
    time: [f64; 2],
    point: Vector2,
}

/// Ways that meet end there: both if they arrive at about the same time, else the later one.
fn settle_meetings(increments: &[Increment], speeds: &[f64], ways: &mut [(Vec<Vector2>, Ending)]) {
    let mut meetings = vec![];
    for i in 0..ways.len() {
        for j in i + 1..ways.len() {
            let close = CLOSE * speeds[i].min(speeds[j]);
            if let Some((run, point)) = first_meeting(&ways[i].0, &ways[j].0, close) {
                let time = [run[0] / speeds[i], run[1] / speeds[j]];
                meetings.push(Meeting { pair: [i, j], run, time, point });
            }
        }
    }
    meetings.sort_by(|a, b| a.time[0].max(a.time[1]).total_cmp(&b.time[0].max(b.time[1])));
    let mut stopped_at = vec![f64::INFINITY; ways.len()];
    for m in meetings {
        let [i, j] = m.pair;
        // One of them may have ended before it gets there.
        if m.time[0] > stopped_at[i] || m.time[1] > stopped_at[j] {
            continue;
        }
        let both = (m.time[0] - m.time[1]).abs() <= SAME_TIME;
        for (k, other) in [(0, j), (1, i)] {
            if both || m.time[k] > m.time[1 - k] {
                let this = m.pair[k];
                cut(&mut ways[this].0, m.run[k], m.point);
                ways[this].1 = Ending::Crack(increments[other].tip.crack);
                stopped_at[this] = m.time[k];
            }
        }
    }
}

/// Where two ways first cross or come closer than `close`: the length run by each, and the place.
fn first_meeting(a: &[Vector2], b: &[Vector2], close: f64) -> Option<([f64; 2], Vector2)> {
    let mut best: Option<([f64; 2], Vector2)> = None;
    let mut run_a = 0.0;
    for p in a.windows(2) {
        let mut run_b = 0.0;
        for q in b.windows(2) {
            if let Some((s, t, point)) = meeting_of_segments([p[0], p[1]], [q[0], q[1]], close) {
                let run = [run_a + s, run_b + t];
                if best.is_none_or(|m| run[0].max(run[1]) < m.0[0].max(m.0[1])) {
                    best = Some((run, point));
                }
            }
            run_b += (q[1] - q[0]).norm();
        }
        run_a += (p[1] - p[0]).norm();
    }
    best
}

/// Lengths along both segments at which they cross or come near, and the place.
fn meeting_of_segments(p: [Vector2; 2], q: [Vector2; 2], close: f64) -> Option<(f64, f64, Vector2)> {
    let (d, e) = (p[1] - p[0], q[1] - q[0]);
    if segments_cross(p[0], p[1], q[0], q[1]) {
        let turn = cross(d, e);
        let (s, t) = (cross(q[0] - p[0], e) / turn, cross(q[0] - p[0], d) / turn);
        return Some((s * d.norm(), t * e.norm(), p[0] + d * s));
    }
    let candidates = [
        (p[0], closest_on_segment(p[0], q[0], q[1])),
        (p[1], closest_on_segment(p[1], q[0], q[1])),
        (closest_on_segment(q[0], p[0], p[1]), q[0]),
        (closest_on_segment(q[1], p[0], p[1]), q[1]),
    ];
    let near: Vec<_> = candidates.into_iter().filter(|(a, b)| (a - b).norm() <= close).collect();
    let (a, b) = *near.iter().min_by(|x, y| (x.0 - x.1).norm().total_cmp(&(y.0 - y.1).norm()))?;
    if d.dot(&e) < 0.0 && near.len() > 1 {
        // Head on: they run over each other, and meet where both arrive at the same time.
        let share = d.norm() / (d.norm() + e.norm());
        let point = p[0] + (q[0] - p[0]) * share;
        return Some(((point - p[0]).norm(), (point - q[0]).norm(), point));
    }
    Some(((a - p[0]).norm(), (b - q[0]).norm(), (a + b) * 0.5))
}

/// Ends a way after a given length, at `point`.
fn cut(way: &mut Vec<Vector2>, run: f64, point: Vector2) {
    let mut sum = 0.0;
    let mut kept = 1;
    for w in way.windows(2) {
        sum += (w[1] - w[0]).norm();
        if sum >= run * (1.0 - 1e-12) {
            break;
        }
        kept += 1;
    }
    way.truncate(kept);
    way.push(point);
}

/// The way along an arc that leaves a tip: straight if the curvature is zero.
///
/// - `direction`: of the tangent at the tip [rad]
/// - `curvature`: positive to the left [1/length]
pub fn arc_way(tip: Vector2, direction: f64, curvature: f64, length: f64) -> Vec<Vector2> {
    let turn = curvature * length;
    let n = ((turn.abs() / MAX_TURN).ceil() as usize).min(MAX_PIECES);
    let along = |angle: f64| crate::math::direction(direction + angle);
    if n == 0 {
        return vec![tip, tip + along(0.0) * length];
    }
    // Tangents that meet outside the arc: the first and the last segment point as the arc does at its ends.
    let step = turn / n as f64;
    let leg = (0.5 * step).tan() / curvature;
    let mut way = vec![tip, tip + along(0.0) * leg];
    for k in 1..n {
        way.push(way[k] + along(k as f64 * step) * (2.0 * leg));
    }
    way.push(way[n] + along(turn) * leg);
    way
}

/// Turn of a curved increment in one vertex [rad], and its most vertices.
const MAX_TURN: f64 = 0.05;
const MAX_PIECES: usize = 6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crack::{CrackPath, End};
    use crate::geometry::curve::Curve;
    use crate::model::Domain;

    fn v(x: f64, y: f64) -> Vector2 {
        Vector2::new(x, y)
    }

    type Points<'a> = &'a [(f64, f64)];

    fn plate(cracks: &[(Points, [EndKind; 2])]) -> Model {
        let corners = [v(0.0, 0.0), v(10.0, 0.0), v(10.0, 6.0), v(0.0, 6.0)];
        let outline = (0..4).map(|k| Curve::Line { start: corners[k], end: corners[(k + 1) % 4] }).collect();
        let mut model = Model::plain(Domain::new(outline, vec![vec![Curve::circle(v(5.0, 5.0), 0.5)]]));
        for (k, (vertices, ends)) in cracks.iter().enumerate() {
            let vertices = vertices.iter().map(|p| v(p.0, p.1)).collect();
            model.cracks.push(CrackPath { name: format!("crack-{k}"), vertices, ends: *ends });
        }
        model
    }

    fn straight(model: &Model, crack: usize, end: End, by: (f64, f64)) -> Increment {
        let p = model.cracks[crack].end_position(end);
        Increment { tip: TipId { crack, end }, way: vec![p, p + v(by.0, by.1)] }
    }

    fn endings(model: &mut Model, increments: &[Increment]) -> Vec<Ending> {
        advance(model, increments).into_iter().map(|a| a.ending).collect()
    }

    const EDGE: [EndKind; 2] = [EndKind::Mouth, EndKind::Tip];
    const INNER: [EndKind; 2] = [EndKind::Tip; 2];

    #[test]
    fn free_increments_are_kept_exactly() {
        let mut model = plate(&[(&[(0.0, 3.0), (2.0, 3.0)], EDGE)]);
        let increments = [straight(&model, 0, End::End, (0.5, 0.1))];
        assert_eq!(endings(&mut model, &increments), [Ending::Free]);
        assert_eq!(model.cracks[0].vertices, [v(0.0, 3.0), v(2.0, 3.0), v(2.5, 3.1)]);
    }

    #[test]
    fn boundary_and_holes_stop_a_tip_and_a_sliver_is_not_left() {
        // Past the edge, short of it by less than the look-ahead, and by more.
        for (from, to, ending) in
            [(9.7, 10.0, Ending::Boundary(1)), (9.5, 10.0, Ending::Boundary(1)), (9.4, 9.85, Ending::Free)]
        {
            let mut model = plate(&[(&[(5.0, 3.0), (from, 3.0)], INNER)]);
            let increments = [straight(&model, 0, End::End, (0.45, 0.0))];
            assert_eq!(endings(&mut model, &increments), [ending]);
            assert!((model.cracks[0].vertices[2] - v(to, 3.0)).norm() < 1e-12);
        }
        let mut model = plate(&[(&[(4.0, 5.0), (4.3, 5.0)], INNER)]);
        let increments = [straight(&model, 0, End::End, (0.3, 0.0))];
        assert_eq!(endings(&mut model, &increments), [Ending::Boundary(4)]);
        assert!((model.cracks[0].vertices[2] - v(4.5, 5.0)).norm() < 1e-12);
        assert_eq!(model.cracks[0].ends, [EndKind::Tip, EndKind::Mouth]);
    }

    #[test]
    fn a_tip_that_meets_a_crack_makes_a_junction() {
        let mut model = plate(&[(&[(2.0, 1.0), (2.0, 3.0)], INNER), (&[(0.0, 2.0), (1.8, 2.0)], EDGE)]);
        let increments = [straight(&model, 1, End::End, (0.4, 0.0))];
        assert_eq!(endings(&mut model, &increments), [Ending::Crack(0)]);
        assert_eq!(model.cracks[0].vertices, [v(2.0, 1.0), v(2.0, 2.0), v(2.0, 3.0)]);
        assert_eq!(model.cracks[1].ends, [EndKind::Mouth, EndKind::Junction]);
        assert_eq!(model.cracks[0].ends, INNER);
    }

    #[test]
    fn tips_that_run_at_each_other_coalesce_in_the_middle() {
        for offset in [0.0, 0.01] {
            let mut model = plate(&[(&[(1.0, 3.0), (3.0, 3.0)], INNER), (&[(3.4, 3.0 + offset), (5.0, 3.0)], INNER)]);
            let increments = [straight(&model, 0, End::End, (0.3, 0.0)), straight(&model, 1, End::Start, (-0.3, 0.0))];
            assert_eq!(endings(&mut model, &increments), [Ending::Crack(1), Ending::Crack(0)]);
            let (a, b) = (model.cracks[0].vertices[2], model.cracks[1].vertices[0]);
            assert!(a == b && (a - v(3.2, 3.0 + 0.5 * offset)).norm() < 1e-9, "{a:?} {b:?}");
            assert_eq!((model.cracks[0].ends[1], model.cracks[1].ends[0]), (EndKind::Junction, EndKind::Junction));
        }
    }

    #[test]
    fn ways_that_cross_leave_the_first_comer_alone() {
        // The first arrives at the crossing after a quarter of its way, the second at the end of its own.
        let mut model = plate(&[(&[(0.0, 2.0), (2.0, 2.0)], EDGE), (&[(2.1, 1.0), (2.1, 1.62)], INNER)]);
        let increments = [straight(&model, 0, End::End, (0.4, 0.0)), straight(&model, 1, End::End, (0.0, 0.4))];
        assert_eq!(endings(&mut model, &increments), [Ending::Free, Ending::Crack(0)]);
        assert_eq!(model.cracks[0].vertices.len(), 4);
        assert!((model.cracks[1].vertices[2] - v(2.1, 2.0)).norm() < 1e-12);
        assert!(model.cracks[0].vertices.contains(&model.cracks[1].vertices[2]));
    }

    #[test]
    fn a_path_that_returns_to_itself_joins_itself() {
        let loop_like: &[(f64, f64)] = &[(1.0, 1.0), (3.0, 1.0), (3.0, 2.0), (2.0, 2.0), (2.0, 1.2)];
        let mut model = plate(&[(loop_like, INNER)]);
        let increments = [straight(&model, 0, End::End, (0.0, -0.3))];
        assert_eq!(endings(&mut model, &increments), [Ending::Crack(0)]);
        assert_eq!(model.cracks[0].vertices[1], v(2.0, 1.0));
        assert_eq!(model.cracks[0].ends, [EndKind::Tip, EndKind::Junction]);
    }

    #[test]
    fn arcs_leave_and_arrive_along_their_tangents() {
        let way = arc_way(v(1.0, 1.0), 0.3, 0.8, 0.5);
        let angle = |a: Vector2, b: Vector2| (b - a).y.atan2((b - a).x);
        assert!((angle(way[0], way[1]) - 0.3).abs() < 1e-12);
        assert!((angle(way[way.len() - 2], way[way.len() - 1]) - 0.7).abs() < 1e-12);
        let chord = 2.0 / 0.8 * (0.2f64).sin();
        let end = v(1.0, 1.0) + crate::math::direction(0.5) * chord;
        assert!((way[way.len() - 1] - end).norm() < 1e-12);
        assert_eq!(arc_way(v(0.0, 0.0), 0.0, 0.0, 2.0), [v(0.0, 0.0), v(2.0, 0.0)]);
    }
}
