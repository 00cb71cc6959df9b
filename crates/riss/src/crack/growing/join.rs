//! Fronts that face each other in one plane: when their steps would meet, triangles close the gap between them. So they
//! do in sharp notches of a front, which would close in any case.

use super::strip::{past_end, zip};
use super::{EdgeLimits, FrontStep, GrowingCrack};
use crate::crack::FrontPoint;
use crate::geometry::surface::Surface;
use crate::math::Vector3;
use std::collections::{BTreeMap, BTreeSet};

/// Normals of fronts in one plane are within this sine, and so is the way between them of the plane.
const COPLANAR: f64 = 0.2;
/// Each front sees the other within this cosine of the direction ahead.
const FACING: f64 = 0.5;

/// Cosine of the widest notch that is filled.
const NOTCH: f64 = 1e-6;
/// And the same over the longest edge of a front.
const WIDEST: f64 = 2.0;

/// Strips between fronts, and in notches of them.
#[derive(Default)]
pub(super) struct Bridges {
    pub triangles: Vec<[u32; 3]>,
    pub bases: Vec<[u32; 2]>,
    /// Vertices at them, as front and place in the front.
    held: BTreeSet<(usize, usize)>,
}

impl Bridges {
    /// Whether a vertex of a front is at a bridge, so that it does not move.
    pub fn holds(&self, front: usize, k: usize) -> bool {
        self.held.contains(&(front, k))
    }
}

/// The bridges of the fronts of a crack; new vertices are appended.
pub(super) fn bridges(
    crack: &GrowingCrack,
    vertices: &mut Vec<Vector3>,
    steps: &[Vec<FrontStep>],
    limits: &EdgeLimits,
) -> Bridges {
    let mut bridges = Bridges::default();
    let fronts = &crack.fronts;
    for f in 0..fronts.len() {
        for g in f..fronts.len() {
            let [own, other] = [f, g].map(|i| &fronts[i]);
            let partner = |k: usize, from: usize, to: usize| {
                let (p, q) = (&fronts[from].line.points[k], &fronts[to].line.points);
                let reach = |j: usize| steps[from][k].length + steps[to][j].length + limits.shortest;
                let found = (0..q.len()).filter(|j| is_facing(p, &q[*j], reach(*j)));
                let distance = |j: usize| (q[j].position - p.position).norm();
                found.min_by(|i, j| distance(*i).total_cmp(&distance(*j)))
            };
            let of_own: Vec<Option<usize>> = (0..own.vertices.len()).map(|k| partner(k, f, g)).collect();
            let of_other: Vec<Option<usize>> = (0..other.vertices.len()).map(|k| partner(k, g, f)).collect();
            let moves =
                |i: usize, list: &[Option<usize>]| (0..list.len()).any(|k| list[k].is_some() && steps[i][k].is_move());
            if !moves(f, &of_own) && !moves(g, &of_other) {
                continue;
            }
            for run in runs(&of_own, own.line.is_closed) {
                let facing: BTreeSet<usize> = run.iter().filter_map(|k| of_own[*k]).collect();
                let opposite =
                    runs(&of_other, other.line.is_closed).into_iter().find(|r| r.iter().any(|j| facing.contains(j)));
                // A front that turns back on itself faces itself, from another stretch.
                let is_sound = |o: &Vec<usize>| o.len() + run.len() > 2 && (f != g || o[0] != run[0]);
                let Some(opposite) = opposite.filter(is_sound) else { continue };
                if run.iter().any(|k| bridges.holds(f, *k)) || opposite.iter().any(|j| bridges.holds(g, *j)) {
                    continue;
                }
                let mut old: Vec<u32> = run.iter().map(|k| own.vertices[*k]).collect();
                let mut new: Vec<u32> = opposite.iter().rev().map(|j| other.vertices[*j]).collect();
                for line in [&old, &new] {
                    bridges.bases.extend(line.windows(2).map(|w| [w[0], w[1]]));
                }
                bridges.held.extend(run.iter().map(|k| (f, *k)).chain(opposite.iter().map(|j| (g, *j))));
                let last = |i: usize| fronts[i].vertices.len() - 1;
                let is_open = !own.line.is_closed && !other.line.is_closed;
                for (k, j, sign) in [(0, last(g), 1.0), (last(f), 0, -1.0)] {
                    if is_open && run.contains(&k) && opposite.contains(&j) {
                        // Past the boundary, which cuts it off.
                        let (p, q) = (&own.line.points[k], &other.line.points[j]);
                        let out = past_end(p.tangent, sign, (q.position - p.position).norm(), limits);
                        let n = vertices.len() as u32;
                        vertices.extend([p.position + out, q.position + out]);
                        let place = |list: &mut Vec<u32>, v| if sign > 0.0 { list.insert(0, v) } else { list.push(v) };
                        place(&mut old, n);
                        place(&mut new, n + 1);
                    }
                }
                zip(vertices, &old, &new, &mut bridges.triangles);
            }
        }
    }
    for f in 0..fronts.len() {
        notches(crack, f, &steps[f], limits, &mut bridges);
    }
    bridges
}

/// Fills sharp notches of a front, narrower than a right angle, from their ground.
fn notches(crack: &GrowingCrack, f: usize, steps: &[FrontStep], limits: &EdgeLimits, bridges: &mut Bridges) {
    let front = &crack.fronts[f];
    let mut line: Vec<usize> = (0..front.vertices.len()).collect();
    let at = |k: usize| front.line.points[k].position;
    let mut taken = BTreeSet::new();
    while line.len() > 2 {
        let n = line.len();
        let (first, last) = if front.line.is_closed { (0, n) } else { (1, n - 1) };
        let sharpness = |i: usize| {
            let [a, b, c] = [line[(i + n - 1) % n], line[i], line[(i + 1) % n]];
            let (back, forth) = (at(a) - at(b), at(c) - at(b));
            let is_hollow = forth.cross(&back).dot(&front.line.points[b].normal) > 0.0;
            let is_free = steps[b].is_move() && ![a, b, c].iter().any(|k| bridges.holds(f, *k));
            let cosine = back.dot(&forth) / (back.norm() * forth.norm());
            let is_narrow = cosine > NOTCH && (back - forth).norm() <= WIDEST * limits.longest;
            (is_hollow && is_free && is_narrow).then_some((cosine, i))
        };
        let sharpest = (first..last).filter_map(sharpness).reduce(|a, b| if b.0 > a.0 { b } else { a });
        let Some((_, i)) = sharpest else { break };
        let corners = [line[(i + n - 1) % n], line[i], line[(i + 1) % n]];
        let [a, b, c] = corners.map(|k| front.vertices[k]);
        bridges.triangles.push([a, b, c]);
        bridges.bases.extend([[a, b], [b, c]]);
        taken.extend(corners);
        line.remove(i);
        if front.line.is_closed && line.len() == 2 {
            break;
        }
    }
    bridges.held.extend(taken.into_iter().map(|k| (f, k)));
}

/// Whether two front points lie ahead of each other in one plane, no farther apart than `reach`.
fn is_facing(p: &FrontPoint, q: &FrontPoint, reach: f64) -> bool {
    let way = q.position - p.position;
    let distance = way.norm();
    let is_plane = p.normal.cross(&q.normal).norm() <= COPLANAR
        && p.normal.dot(&q.normal) > 0.0
        && way.dot(&p.normal).abs() <= COPLANAR * distance
        && way.dot(&q.normal).abs() <= COPLANAR * distance;
    let is_ahead = way.dot(&p.ahead) > FACING * distance && way.dot(&q.ahead) < -FACING * distance;
    distance > 0.0 && distance <= reach && is_plane && is_ahead
}

/// Stretches of neighbors that have a partner.
fn runs(partner: &[Option<usize>], is_closed: bool) -> Vec<Vec<usize>> {
    let n = partner.len();
    let gap = (0..n).find(|k| partner[*k].is_none());
    let start = if is_closed { gap.unwrap_or(0) } else { 0 };
    let mut found: Vec<Vec<usize>> = vec![];
    let mut is_in = false;
    for k in (0..n).map(|k| (start + k) % n) {
        if partner[k].is_some() {
            if !is_in {
                found.push(vec![]);
            }
            found.last_mut().expect("there is one").push(k);
        }
        is_in = partner[k].is_some();
    }
    found
}

/// Two cracks whose fronts would meet in one plane as one, with the steps of its fronts; none if they would not.
pub(super) fn united(
    cracks: [&GrowingCrack; 2],
    steps: [&[Vec<FrontStep>]; 2],
    limits: &EdgeLimits,
    body: &Surface,
) -> Option<(GrowingCrack, Vec<Vec<FrontStep>>)> {
    let joint = cracks[0].united(cracks[1], body).ok()?;
    let mut of_vertex = BTreeMap::new();
    for (i, first) in [0, cracks[0].vertices.len() as u32].into_iter().enumerate() {
        for (front, steps) in cracks[i].fronts.iter().zip(steps[i]) {
            of_vertex.extend(front.vertices.iter().map(|v| v + first).zip(steps.iter().copied()));
        }
    }
    let of_front = |front: &super::GrowingFront| {
        front.vertices.iter().map(|v| of_vertex.get(v).copied().unwrap_or_else(FrontStep::none)).collect()
    };
    let steps: Vec<Vec<FrontStep>> = joint.fronts.iter().map(of_front).collect();
    let found = bridges(&joint, &mut joint.vertices.clone(), &steps, limits);
    (!found.triangles.is_empty()).then_some((joint, steps))
}
