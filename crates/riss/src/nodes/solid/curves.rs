//! Nodes along lines: mouths of cracks, sharp edges of the boundary, crack fronts.

use super::sites::{Sites, Stand};
use super::{CLOSENESS, NodesOnFronts};
use crate::crack::{CrackSurface, Mouths};
use crate::geometry::surface::{Chain, Foot, Surface};
use crate::geometry::triangle::Feature;
use crate::math::Vector3;

/// Points nearer than this share of the body's size are the same.
const SAME: f64 = 1e-7;
/// Turn of a mouth from which a point of it is kept [rad].
const TURN: f64 = 0.5;
/// Integration steps for one spacing.
const STEPS: f64 = 8.0;
/// Rounds of projecting a point on two surfaces in turn.
const PROJECTIONS: usize = 8;
/// Nodes along lines keep at least this share of the spacing apart where lines come near each other.
const NARROW: f64 = 0.4;

/// What stands at the end of a stretch of line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    /// A node that is there already.
    Node,
    /// A crack front, from which nodes keep away.
    Front,
}

/// Places nodes along all lines.
pub(super) fn place(sites: &mut Sites<'_>, fronts: NodesOnFronts) {
    if fronts == NodesOnFronts::Single {
        place_on_fronts(sites);
    }
    for crack in 0..sites.cracks.len() {
        place_on_mouth(sites, crack as u32);
    }
    let body = sites.body;
    for vertex in body.corner_vertices() {
        let p = body.vertices()[*vertex as usize];
        place_on_edge(sites, p, *vertex);
    }
    for chain in body.chains() {
        place_on_chain(sites, chain);
    }
    for crack in 0..sites.cracks.len() {
        place_on_folds(sites, crack as u32);
    }
}

/// Nodes along the folds of a crack inside the body.
fn place_on_folds(sites: &mut Sites<'_>, crack: u32) {
    let surface = &sites.cracks[crack as usize].surface;
    for ends in sites.folds[crack as usize].clone() {
        let mut places = along(&ends, false, [End::Node; 2], sites);
        places.extend([(0, 0.0), (0, 1.0)]);
        for (_, t) in places {
            let p = ends[0] + (ends[1] - ends[0]) * t;
            let Some(foot) = surface.locate(p, SAME * sites.size()) else { continue };
            let h = sites.spacing.at(p);
            let clearance = Sites::clearance(h);
            let is_free = sites.body.signed_distance(p) <= -clearance && !sites.is_near_front(p, clearance);
            if is_free && sites.is_clear(p, h, CLOSENESS) {
                sites.push(p, h, Stand::Face { crack, foot });
            }
        }
    }
}

fn place_on_fronts(sites: &mut Sites<'_>) {
    let size = sites.size();
    for (c, crack) in sites.cracks.iter().enumerate() {
        for front in &crack.fronts {
            let positions: Vec<Vector3> = front.points.iter().map(|p| p.position).collect();
            let mut at = along(&positions, front.is_closed, [End::Node; 2], sites);
            if !front.is_closed {
                at.extend([(0, 0.0), (positions.len() - 2, 1.0)]);
            }
            for (k, t) in at {
                let (a, b) = (positions[k], positions[(k + 1) % positions.len()]);
                let s = front.points[k].s + (b - a).norm() * t;
                let point = front.at(s.min(front.length));
                let foot = sites.body.locate(point.position, 1e-4 * size);
                let h = sites.spacing.at(point.position);
                sites.push(point.position, h, Stand::Front { crack: c as u32, point, foot });
            }
        }
    }
}

fn place_on_mouth(sites: &mut Sites<'_>, crack: u32) {
    let (body, surface) = (sites.body, &sites.cracks[crack as usize]);
    let tolerance = SAME * sites.size();
    let mouths = &surface.mouths;
    let feet: Vec<Option<Foot>> = mouths.points.iter().map(|p| body.locate(*p, tolerance)).collect();
    let lines = Lines::new(mouths, |k| feet[k as usize].is_some_and(|f| is_on_sharp_edge(body, &f)));
    for k in &lines.fixed {
        let p = mouths.points[*k as usize];
        let Some(foot) = feet[*k as usize] else { continue };
        let h = sites.spacing.at(p);
        let at = on_both(p, &foot, body, surface);
        if !sites.is_near_front(at, Sites::clearance(h)) && sites.is_clear(at, h, NARROW) {
            sites.push(at, h, Stand::Boundary { foot, crack: Some(crack) });
        }
    }
    for line in &lines.lines {
        let points: Vec<Vector3> = line.iter().map(|k| mouths.points[*k as usize]).collect();
        let is_closed = line.len() > 2 && line.first() == line.last() && !lines.fixed.contains(&line[0]);
        let ends = [points[0], points[points.len() - 1]].map(|p| {
            let is_front = sites.is_near_front(p, 1e-3 * sites.spacing.at(p));
            if is_front { End::Front } else { End::Node }
        });
        let points = if is_closed { points[1..].to_vec() } else { points };
        for (k, t) in along(&points, is_closed, ends, sites) {
            let p = points[k] + (points[(k + 1) % points.len()] - points[k]) * t;
            let Some(foot) = body.locate(p, tolerance) else { continue };
            let at = on_both(p, &foot, body, surface);
            let h = sites.spacing.at(at);
            if sites.is_clear(at, h, NARROW) {
                sites.push(at, h, Stand::Boundary { foot, crack: Some(crack) });
            }
        }
    }
}

/// A point of the mouth, moved onto what the triangles of the boundary stand for.
fn on_both(p: Vector3, foot: &Foot, body: &Surface, crack: &CrackSurface) -> Vector3 {
    let Some(on_crack) = crack.surface.closest_within(p, 1e-2 * body.bounds().size().norm()) else { return p };
    let normal = crack.surface.normal_at(on_crack.triangle, on_crack.position);
    let triangles = touching(body, foot);
    let mut at = p;
    for _ in 0..PROJECTIONS {
        for t in &triangles {
            at = body.parts()[body.part_of(*t) as usize].shape.project(at);
        }
        // Across a crack that ends just here, its plane goes on.
        at -= normal * (at - on_crack.position).dot(&normal);
    }
    at
}

/// The triangles at a foot.
fn touching(body: &Surface, foot: &Foot) -> Vec<u32> {
    match foot.feature {
        Feature::Face => vec![foot.triangle],
        Feature::Edge(k) => [Some(foot.triangle), body.across(foot.triangle, k)].into_iter().flatten().collect(),
        Feature::Corner(k) => body.fan(body.triangles()[foot.triangle as usize][k]).to_vec(),
    }
}

fn is_on_sharp_edge(body: &Surface, foot: &Foot) -> bool {
    match foot.feature {
        Feature::Face => false,
        Feature::Edge(k) => body.is_sharp(foot.triangle, k),
        Feature::Corner(k) => {
            let vertex = body.triangles()[foot.triangle as usize][k];
            let at = |t: u32, e: usize| {
                let c = body.triangles()[t as usize];
                c[e] == vertex || c[(e + 1) % 3] == vertex
            };
            body.fan(vertex).iter().any(|t| (0..3).any(|e| body.is_sharp(*t, e) && at(*t, e)))
        }
    }
}

fn place_on_edge(sites: &mut Sites<'_>, p: Vector3, vertex: u32) {
    let body = sites.body;
    let triangle = body.fan(vertex)[0];
    let k = body.triangles()[triangle as usize].iter().position(|v| *v == vertex).unwrap_or(0);
    let foot = Foot { triangle, feature: Feature::Corner(k), position: p, distance: 0.0 };
    let h = sites.spacing.at(p);
    if !sites.is_near_front(p, Sites::clearance(h)) && sites.is_clear(p, h, NARROW) {
        sites.push(p, h, Stand::Boundary { foot, crack: None });
    }
}

/// Nodes between the ends of a chain and the mouths that cross it.
fn place_on_chain(sites: &mut Sites<'_>, chain: &Chain) {
    let body = sites.body;
    let tolerance = SAME * sites.size();
    let points: Vec<Vector3> = chain.vertices.iter().map(|v| body.vertices()[*v as usize]).collect();
    let is_loop = chain.vertices.first() == chain.vertices.last();
    // Where mouths and fronts cross, as places along the chain.
    let mut stops: Vec<(f64, End)> = vec![];
    let crossings = sites.cracks.iter().flat_map(|c| &c.mouths.points).copied();
    for p in crossings {
        let h = sites.spacing.at(p);
        let end = if sites.is_near_front(p, Sites::clearance(h)) { End::Front } else { End::Node };
        for (k, w) in points.windows(2).enumerate() {
            let e = w[1] - w[0];
            let t = ((p - w[0]).dot(&e) / e.norm_squared()).clamp(0.0, 1.0);
            if (w[0] + e * t - p).norm() <= tolerance {
                stops.push((k as f64 + t, end));
                break;
            }
        }
    }
    stops.sort_by(|a, b| a.0.total_cmp(&b.0));
    stops.dedup_by(|a, b| (a.0 - b.0).abs() < 1e-9);
    let is_corner = |v: &u32| body.corner_vertices().contains(v);
    let is_closed = is_loop && stops.is_empty() && !is_corner(&chain.vertices[0]);
    if is_closed {
        let at = along(&points[1..], true, [End::Node; 2], sites);
        push_on_chain(sites, chain, &points, at.into_iter().map(|(k, t)| ((k + 1) % (points.len() - 1), t)));
        return;
    }
    if is_loop && !is_corner(&chain.vertices[0]) {
        // Starts at a crossing instead of anywhere.
        let (first, end) = stops[0];
        let n = points.len() - 1;
        let turned = Chain { vertices: (0..=n).map(|k| chain.vertices[(first as usize + k) % n]).collect(), ..*chain };
        let around = |s: f64| (s - first.floor()).rem_euclid(n as f64);
        let start = first.fract();
        let mut stops: Vec<(f64, End)> = stops[1..].iter().map(|(s, e)| (around(*s), *e)).collect();
        stops.extend([(start, end), (n as f64 + start, end)]);
        stretches(sites, &turned, &mut stops);
        return;
    }
    stops.extend([(0.0, End::Node), ((points.len() - 1) as f64, End::Node)]);
    stretches(sites, chain, &mut stops);
}

/// Nodes on each stretch of a chain between neighboring stops; places beyond its end go around a loop.
fn stretches(sites: &mut Sites<'_>, chain: &Chain, stops: &mut [(f64, End)]) {
    stops.sort_by(|a, b| a.0.total_cmp(&b.0));
    let n = chain.vertices.len() - 1;
    let at = |k: usize| sites.body.vertices()[chain.vertices[if k > n { k - n } else { k }] as usize];
    let points: Vec<Vector3> = (0..=2 * n).map(at).collect();
    let place = |s: f64| {
        let k = (s as usize).min(points.len() - 2);
        points[k] + (points[k + 1] - points[k]) * (s - k as f64)
    };
    for w in stops.windows(2) {
        let (from, to) = (w[0].0, w[1].0);
        let mut knots = vec![from];
        knots.extend((from.floor() as usize + 1..to.ceil() as usize).map(|k| k as f64));
        knots.push(to);
        let line: Vec<Vector3> = knots.iter().map(|s| place(*s)).collect();
        let found = along(&line, false, [w[0].1, w[1].1], sites);
        let on_chain = found.into_iter().map(|(k, t)| {
            let s = knots[k] + (knots[k + 1] - knots[k]) * t;
            let piece = (s as usize).min(2 * n - 1);
            (piece % n, s - piece as f64)
        });
        let on_chain: Vec<_> = on_chain.collect();
        push_on_chain(sites, chain, &points, on_chain.into_iter());
    }
}

fn push_on_chain(sites: &mut Sites<'_>, chain: &Chain, points: &[Vector3], places: impl Iterator<Item = (usize, f64)>) {
    let body = sites.body;
    for (k, t) in places {
        let p = points[k] + (points[k + 1] - points[k]) * t;
        let Some(foot) = edge_foot(body, [chain.vertices[k], chain.vertices[k + 1]], p) else { continue };
        let mut at = p;
        for _ in 0..PROJECTIONS {
            for triangle in touching(body, &foot) {
                at = body.parts()[body.part_of(triangle) as usize].shape.project(at);
            }
        }
        let h = sites.spacing.at(at);
        if !sites.is_near_front(at, Sites::clearance(h)) && sites.is_clear(at, h, NARROW) {
            sites.push(at, h, Stand::Boundary { foot, crack: None });
        }
    }
}

/// The foot on the edge between two vertices.
fn edge_foot(body: &Surface, ends: [u32; 2], position: Vector3) -> Option<Foot> {
    body.fan(ends[0]).iter().find_map(|t| {
        let corners = body.triangles()[*t as usize];
        let is_edge = |k: &usize| {
            let pair = [corners[*k], corners[(*k + 1) % 3]];
            pair == ends || pair == [ends[1], ends[0]]
        };
        let k = (0..3).find(is_edge)?;
        Some(Foot { triangle: *t, feature: Feature::Edge(k), position, distance: 0.0 })
    })
}

/// Places along a line at the spacing, as a segment and a share of it; nodes at the ends of an open line are left out.
fn along(points: &[Vector3], is_closed: bool, ends: [End; 2], sites: &Sites<'_>) -> Vec<(usize, f64)> {
    let n = points.len();
    let last = if is_closed { n } else { n - 1 };
    // Length over spacing, up to the end of each small step.
    let mut knots = vec![(0.0, 0, 0.0)];
    let mut total = 0.0;
    for k in 0..last {
        let (a, b) = (points[k], points[(k + 1) % n]);
        let length = (b - a).norm();
        let least = sites.spacing.at(a).min(sites.spacing.at(b)).min(sites.spacing.at((a + b) * 0.5));
        let steps = (STEPS * length / least).ceil().clamp(1.0, 1e5) as usize;
        for j in 0..steps {
            let middle = a + (b - a) * ((j as f64 + 0.5) / steps as f64);
            total += length / steps as f64 / sites.spacing.at(middle);
            knots.push((total, k, (j as f64 + 1.0) / steps as f64));
        }
    }
    let gap = |e: End| if e == End::Front { super::CLEARANCE * (1.0 + 1e-6) } else { 0.0 };
    let (from, to) = if is_closed { (0.0, total) } else { (gap(ends[0]), total - gap(ends[1])) };
    if to < from {
        return vec![];
    }
    let pieces = ((to - from).round() as usize).max(if is_closed { 3 } else { 1 });
    let first = usize::from(!is_closed && ends[0] == End::Node);
    let end = if is_closed || ends[1] == End::Node { pieces } else { pieces + 1 };
    let place = |j: usize| {
        let measure = from + (to - from) * j as f64 / pieces as f64;
        let i = knots.partition_point(|k| k.0 < measure).clamp(1, knots.len() - 1);
        let (before, after) = (knots[i - 1], knots[i]);
        let start = if before.1 == after.1 { before.2 } else { 0.0 };
        let share = ((measure - before.0) / (after.0 - before.0)).clamp(0.0, 1.0);
        (after.1, start + (after.2 - start) * share)
    };
    (first..end).map(place).collect()
}

/// Lines between fixed points of a mouth.
struct Lines {
    fixed: Vec<u32>,
    lines: Vec<Vec<u32>>,
}

impl Lines {
    fn new(mouths: &Mouths, is_kept: impl Fn(u32) -> bool) -> Self {
        let mut at_point = vec![vec![]; mouths.points.len()];
        for (i, piece) in mouths.pieces.iter().enumerate() {
            piece.ends.iter().for_each(|k| at_point[*k as usize].push(i));
        }
        let other = |i: usize, k: u32| {
            if mouths.pieces[i].ends[0] == k { mouths.pieces[i].ends[1] } else { mouths.pieces[i].ends[0] }
        };
        let turns = |k: u32| {
            let [i, j] = at_point[k as usize][..] else { return true };
            let p = mouths.points[k as usize];
            let (a, b) = (p - mouths.points[other(i, k) as usize], mouths.points[other(j, k) as usize] - p);
            a.cross(&b).norm().atan2(a.dot(&b)) > TURN
        };
        let is_fixed: Vec<bool> = (0..at_point.len() as u32).map(|k| turns(k) || is_kept(k)).collect();
        let fixed = (0..at_point.len() as u32).filter(|k| is_fixed[*k as usize]).collect();
        let (mut is_used, mut lines) = (vec![false; mouths.pieces.len()], vec![]);
        let ends_fixed = |i: &usize| mouths.pieces[*i].ends.iter().any(|k| is_fixed[*k as usize]);
        for start in (0..mouths.pieces.len()).filter(ends_fixed).chain(0..mouths.pieces.len()) {
            if is_used[start] {
                continue;
            }
            let ends = mouths.pieces[start].ends;
            let mut line =
                vec![if is_fixed[ends[0] as usize] || !is_fixed[ends[1] as usize] { ends[0] } else { ends[1] }];
            let mut piece = start;
            loop {
                is_used[piece] = true;
                let next = other(piece, *line.last().expect("never empty"));
                line.push(next);
                match at_point[next as usize].iter().find(|i| !is_used[**i]) {
                    Some(i) if !is_fixed[next as usize] => piece = *i,
                    _ => break,
                }
            }
            lines.push(line);
        }
        Self { fixed, lines }
    }
}
