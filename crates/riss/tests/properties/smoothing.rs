//! Weights around cracks, holes and re-entrant corners: they jump across crack faces only, their derivatives are those
//! of finite differences, and the shape functions stay consistent.

use crate::bodies::*;
use riss::analysis::{Settings, Silent, discretize};
use riss::approximation::moving_least_squares::Derivatives;
use riss::approximation::{
    ApproximationSettings, CrackSmoothing, HoleSmoothing, MovingLeastSquares, ShapeFunctions, SmoothingSettings,
    Surroundings,
};
use riss::crack::EndKind::{self, Mouth, Tip};
use riss::crack::meetings::join;
use riss::geometry::curve::Curve;
use riss::geometry::predicates::segments_cross;
use riss::material::PlaneState;
use riss::math::{Matrix2, Vector2};
use riss::model::{Domain, Model};
use std::f64::consts::TAU;

const DIFFRACTION: SmoothingSettings = diffraction(1.0);

const fn diffraction(lambda: f64) -> SmoothingSettings {
    SmoothingSettings {
        cracks: Some(CrackSmoothing::Diffraction { lambda }),
        holes: Some(HoleSmoothing::Diffraction { lambda }),
    }
}

fn smoothings() -> Vec<SmoothingSettings> {
    let transparency = CrackSmoothing::Transparency { kappa: 1.0, lambda: 2.0 };
    let with = |cracks, holes| SmoothingSettings { cracks: Some(cracks), holes: Some(holes) };
    vec![
        DIFFRACTION,
        diffraction(2.0),
        with(transparency, HoleSmoothing::Diffraction { lambda: 1.0 }),
        with(CrackSmoothing::Diffraction { lambda: 1.0 }, HoleSmoothing::SeeThrough),
        with(transparency, HoleSmoothing::SeeThrough),
        with(CrackSmoothing::Transparency { kappa: 0.5, lambda: 3.0 }, HoleSmoothing::Diffraction { lambda: 1.0 }),
        with(CrackSmoothing::SeeThrough, HoleSmoothing::SeeThrough),
        with(CrackSmoothing::SeeThrough, HoleSmoothing::Diffraction { lambda: 1.0 }),
    ]
}

/// An L-shaped plate of unit sides with a hole, an edge crack at the hole, and random cracks of three segments, one
/// behind the other.
fn random_body(random: &mut Random) -> Model {
    let outline = polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 0.45), (0.55, 0.45), (0.55, 1.0), (0.0, 1.0)]);
    let center = Vector2::new(random.between(0.75, 0.8), random.between(0.2, 0.25));
    let mut model = body(Domain::new(outline, vec![vec![Curve::circle(center, 0.1)]]), PlaneState::Strain);
    let mut add = |points: &[(f64, f64)], ends: [EndKind; 2]| model.cracks.push(crack(points, ends));
    let mut around = |x: f64, y: f64| (x + random.between(-0.02, 0.02), y + random.between(-0.02, 0.02));
    add(&[(center.x - 0.1, center.y), around(0.55, 0.3), around(0.5, 0.25)], [Mouth, Tip]);
    add(&[around(0.1, 0.3), around(0.2, 0.35), around(0.3, 0.28), around(0.42, 0.33)], [Tip; 2]);
    add(&[around(0.25, 0.4), around(0.35, 0.42), around(0.4, 0.5)], [Tip; 2]);
    add(&[(0.0, 0.7), around(0.2, 0.75), around(0.25, 0.7)], [Mouth, Tip]);
    add(&[around(0.3, 0.8), around(0.36, 0.84)], [Tip; 2]);
    model
}

/// The same plate with cracks that meet: a star, a cross, a T beside another crack's tip, a branched edge crack, a crack
/// on the crack from the hole, and a curved one along the hole.
fn random_junctions(random: &mut Random) -> Model {
    let outline = polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 0.45), (0.55, 0.45), (0.55, 1.0), (0.0, 1.0)]);
    let center = Vector2::new(random.between(0.75, 0.8), random.between(0.2, 0.25));
    let mut model = body(Domain::new(outline, vec![vec![Curve::circle(center, 0.1)]]), PlaneState::Strain);
    let mut add = |points: &[(f64, f64)], ends: [EndKind; 2]| model.cracks.push(crack(points, ends));
    let mut around = |x: f64, y: f64| (x + random.between(-0.02, 0.02), y + random.between(-0.02, 0.02));
    let star = around(0.2, 0.15);
    for (x, y) in [(0.2, 0.3), (0.08, 0.08), (0.33, 0.07)] {
        add(&[star, around(x, y)], [Tip; 2]);
    }
    add(&[around(0.08, 0.85), around(0.3, 0.93)], [Tip; 2]);
    add(&[around(0.15, 0.95), around(0.2, 0.88), around(0.24, 0.8)], [Tip; 2]);
    let (a, b) = (around(0.36, 0.55), around(0.34, 0.85));
    add(&[a, b], [Tip; 2]);
    add(&[(0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1)), around(0.48, 0.72)], [Tip; 2]);
    let fork = around(0.14, 0.55);
    add(&[(0.0, 0.57), fork], [Mouth, Tip]);
    add(&[fork, around(0.24, 0.63), around(0.3, 0.62)], [Tip; 2]);
    add(&[fork, around(0.22, 0.48), around(0.33, 0.5)], [Tip; 2]);
    let (rim, knee) = ((center.x - 0.1, center.y), around(0.55, 0.22));
    add(&[rim, knee], [Mouth, Tip]);
    add(&[knee, around(0.45, 0.3)], [Tip; 2]);
    add(&[knee, around(0.5, 0.1)], [Tip; 2]);
    let bent = |k: usize| center + riss::math::direction(0.6 + 0.25 * k as f64) * 0.14;
    add(&(0..9).map(bent).map(|p| (p.x, p.y)).collect::<Vec<_>>(), [Tip; 2]);
    join(&mut model.cracks, 1e-6).expect("they meet in points");
    model
}

/// One of the two bodies.
type MakeBody = fn(&mut Random) -> Model;

const BODIES: [MakeBody; 2] = [random_body, random_junctions];

fn approximation(model: &Model, seed: u64, smoothing: SmoothingSettings) -> MovingLeastSquares {
    let approximation = ApproximationSettings { dilation: Some(2.5), smoothing, ..ApproximationSettings::default() };
    let approximation = approximation.without_automatic_enrichment();
    let settings = Settings { nodes: random_nodes(&model.domain, 22, seed), approximation, ..Settings::default() };
    // Random nodes outside the body are no nodes.
    let settings = Settings { nodes: inside(model, &settings), ..settings };
    discretize(model, &settings, &mut Silent).expect("the nodes are dense enough").approximation
}

fn inside(model: &Model, settings: &Settings) -> riss::nodes::NodeSettings {
    let riss::nodes::settings::Layout::Listed(list) = &settings.nodes.layout else { unreachable!("they are listed") };
    let keep = |p: &&[f64; 2]| model.domain.contains(Vector2::new(p[0], p[1]));
    listed(list.positions.iter().filter(keep).copied().collect())
}

/// Weights of all neighbors at a point.
fn weights(mls: &MovingLeastSquares, at: Vector2, around: &mut Surroundings) -> Vec<(u32, f64)> {
    mls.survey(&riss::geometry::aabb::Aabb::of_points([at]), around);
    mls.gather(at, at, Derivatives::First, around);
    around.near.nodes.iter().copied().zip(around.near.weights.iter().copied()).collect()
}

fn weight_of(list: &[(u32, f64)], node: u32) -> f64 {
    list.iter().find(|w| w.0 == node).map_or(0.0, |w| w.1)
}

fn cuts(model: &Model, a: Vector2, b: Vector2) -> bool {
    model.cracks.iter().flat_map(|c| c.segments()).any(|(c, d)| segments_cross(a, b, c, d))
        || model.domain.edges.iter().any(|e| !e.meetings(a, b, 1e-9).is_empty())
}

/// Walks lines through the body and halves every step at which a weight changes by much, down to rounding: what is
/// left there is a jump. Returns the largest one apart from those across crack faces and the boundary.
fn largest_jump(model: &Model, mls: &MovingLeastSquares, random: &mut Random) -> (f64, Vector2) {
    let mut around = Surroundings::default();
    let mut largest = (0.0, Vector2::zeros());
    for _ in 0..24 {
        let end = |random: &mut Random| Vector2::new(random.unit(), random.unit());
        let (from, to) = (end(random), end(random));
        let n = 300;
        for k in 0..n {
            let (mut a, mut b) =
                (from + (to - from) * (k as f64 / n as f64), from + (to - from) * ((k + 1) as f64 / n as f64));
            if !model.domain.contains(a) || !model.domain.contains(b) || cuts(model, a, b) {
                continue;
            }
            let (mut wa, mut wb) = (weights(mls, a, &mut around), weights(mls, b, &mut around));
            let change = |wa: &[(u32, f64)], wb: &[(u32, f64)]| {
                let nodes = wa.iter().chain(wb).map(|w| w.0);
                nodes.map(|i| (weight_of(wa, i) - weight_of(wb, i)).abs()).fold(0.0, f64::max)
            };
            while (b - a).norm() > 1e-9 && change(&wa, &wb) > 1e-4 {
                let middle = (a + b) * 0.5;
                let wm = weights(mls, middle, &mut around);
                if change(&wa, &wm) >= change(&wm, &wb) {
                    (b, wb) = (middle, wm);
                } else {
                    (a, wa) = (middle, wm);
                }
            }
            let jump = change(&wa, &wb);
            if jump > largest.0 {
                largest = (jump, a);
            }
        }
    }
    largest
}

fn check_continuity(make: MakeBody, smoothing: SmoothingSettings) {
    for seed in 0..4 {
        let mut random = Random(seed);
        let model = make(&mut random);
        let mls = approximation(&model, seed, smoothing);
        let (jump, at) = largest_jump(&model, &mls, &mut random);
        assert!(jump <= 1e-4, "{smoothing:?}: a weight jumps by {jump:.2e} at {at}, seed {seed}");
    }
}

#[test]
fn weights_jump_across_faces_only() {
    for smoothing in smoothings() {
        check_continuity(random_body, smoothing);
    }
}

#[test]
fn weights_jump_across_faces_only_where_cracks_meet() {
    for smoothing in smoothings() {
        check_continuity(random_junctions, smoothing);
    }
}

/// The tests above can fail.
#[test]
fn visibility_jumps_elsewhere() {
    for make in BODIES {
        let mut random = Random(1);
        let model = make(&mut random);
        let mls = approximation(&model, 1, SmoothingSettings::VISIBILITY);
        assert!(largest_jump(&model, &mls, &mut random).0 > 0.05);
    }
}

/// Near the center of a star with arms longer than the supports, nodes act in their own sector only.
#[test]
fn sectors_of_a_star_do_not_see_each_other() {
    let n_arms = 5;
    let sector = |p: Vector2| (p.y.atan2(p.x).rem_euclid(TAU) / TAU * f64::from(n_arms)).floor();
    let arm = |k: i32| {
        let tip = riss::math::direction(TAU * f64::from(k) / f64::from(n_arms)) * 0.48;
        crack(&[(0.0, 0.0), (tip.x, tip.y)], [Tip; 2])
    };
    let mut model = body(rectangle((-0.5, -0.5), (0.5, 0.5)), PlaneState::Strain);
    model.cracks = (0..n_arms).map(arm).collect();
    join(&mut model.cracks, 1e-9).expect("they meet in a point");
    for smoothing in smoothings().into_iter().chain([SmoothingSettings::VISIBILITY]) {
        let mls = approximation(&model, 3, smoothing);
        let (mut random, mut around) = (Random(3), Surroundings::default());
        for _ in 0..200 {
            let at = Vector2::new(random.between(-0.05, 0.05), random.between(-0.05, 0.05));
            let found = weights(&mls, at, &mut around);
            assert!(found.len() >= 3);
            for (node, _) in found {
                let sight = mls.nodes().sights[node as usize];
                assert_eq!(sector(sight), sector(at), "{smoothing:?}: {at} sees {sight}");
            }
        }
    }
}

/// Points all over the body, close to tips and corners too.
fn points(model: &Model, random: &mut Random) -> Vec<Vector2> {
    let mut centers: Vec<Vector2> = model.cracks.iter().flat_map(|c| c.vertices.clone()).collect();
    centers.push(Vector2::new(0.55, 0.45));
    let near: Vec<Vector2> = centers
        .iter()
        .flat_map(|c| {
            (0..6)
                .map(|_| c + Vector2::new(random.between(-0.03, 0.03), random.between(-0.03, 0.03)))
                .collect::<Vec<_>>()
        })
        .collect();
    let far = (0..60).map(|_| Vector2::new(random.unit(), random.unit()));
    near.into_iter().chain(far).filter(|p| model.domain.contains(*p)).collect()
}

fn evaluate(mls: &MovingLeastSquares, at: Vector2) -> ShapeFunctions<2> {
    let (mut around, mut shape) = <(Surroundings, ShapeFunctions<2>)>::default();
    mls.evaluate(at, at, Derivatives::Second, &mut around, &mut shape).expect("the fit is regular");
    shape
}

#[test]
fn shape_functions_are_consistent_and_their_derivatives_are_those_of_differences() {
    for (smoothing, make) in smoothings().into_iter().flat_map(|s| BODIES.map(|b| (s, b))) {
        let mut random = Random(5);
        let model = make(&mut random);
        let mls = approximation(&model, 5, smoothing);
        let mut compared = 0;
        for at in points(&model, &mut random) {
            let shape = evaluate(&mls, at);
            let one: f64 = shape.values.iter().sum();
            let positions = |i: &u32| mls.nodes().positions[*i as usize];
            let place =
                shape.neighbors.iter().zip(&shape.values).fold(Vector2::zeros(), |s, (i, v)| s + positions(i) * *v);
            let gradient = shape
                .neighbors
                .iter()
                .zip(&shape.gradients)
                .fold(Matrix2::zeros(), |s, (i, g)| s + positions(i) * g.transpose());
            let size: f64 = shape.gradients.iter().map(|g| g.norm()).sum();
            assert!((one - 1.0).abs() < 1e-10 && (place - at).norm() < 1e-10, "{smoothing:?} at {at}: {one} {place}");
            assert!((gradient - Matrix2::identity()).norm() < 1e-11 * size, "{smoothing:?} at {at}: {gradient}");
            compared += usize::from(differences_agree(&model, &mls, &shape, at, smoothing));
        }
        assert!(compared > 60, "only {compared} points are smooth enough to compare");
    }
}

/// Compares with differences; false where neighbors change, or a way does, so that derivatives jump.
fn differences_agree(
    model: &Model,
    mls: &MovingLeastSquares,
    shape: &ShapeFunctions<2>,
    at: Vector2,
    smoothing: SmoothingSettings,
) -> bool {
    let step = 1e-6;
    let mut smooth = true;
    for d in 0..2 {
        let e = Vector2::ith(d, step);
        if cuts(model, at - e, at + e) || !model.domain.contains(at + e) || !model.domain.contains(at - e) {
            return false;
        }
        let (ahead, behind) = (evaluate(mls, at + e), evaluate(mls, at - e));
        if ahead.neighbors != shape.neighbors || behind.neighbors != shape.neighbors {
            return false;
        }
        let slope = shape.gradients.iter().map(|g| g.norm()).fold(0.0, f64::max);
        let bend = shape.second_derivatives.iter().map(|g| g.norm()).fold(0.0, f64::max);
        for k in 0..shape.neighbors.len() {
            // A way that changes between the three points bends the weight.
            if (ahead.gradients[k] - behind.gradients[k]).norm() > 10.0 * step * bend {
                smooth = false;
                continue;
            }
            let by = (ahead.values[k] - behind.values[k]) / (2.0 * step);
            assert!(
                (by - shape.gradients[k][d]).abs() < 1e-5 * slope,
                "{smoothing:?} at {at}: {by} {}",
                shape.gradients[k][d]
            );
            let by = (ahead.gradients[k] - behind.gradients[k]) / (2.0 * step);
            let found = shape.second_derivatives[k].column(d).into_owned();
            assert!((by - found).norm() < 1e-2 * bend, "{smoothing:?} at {at}: {by} {found}");
        }
    }
    smooth
}
