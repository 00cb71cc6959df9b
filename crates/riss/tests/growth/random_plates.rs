//! Random plates with random cracks and holes, grown until nothing grows any more: no panic, no number that is none, no
//! crack over another, a reason for every end.

use crate::bodies::{BOTH, Random, body, hold, rectangle};
use crate::steps::{Steps, grow};
use riss::analysis::{GrowthEndKind, GrowthSettings, Settings};
use riss::crack::{CrackPath, EndKind};
use riss::geometry::curve::Curve;
use riss::geometry::predicates::{distance_between_segments, distance_to_segment, segments_cross};
use riss::material::PlaneState;
use riss::math::{Matrix2, Vector2, direction};
use riss::model::{BoundaryLoad, Domain, Model, RigidMotion, TractionValue};
use std::f64::consts::TAU;

/// Plates in an ordinary test run; `RISS_PLATES` asks for more.
const PLATES: u64 = 2;

/// A plate of ten by up to ten, with up to ten holes and one to ten cracks that keep clear of one another.
fn plate(seed: u64) -> Model {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let height = random.between(6.0, 10.0);
    let mut holes: Vec<(Vector2, f64)> = vec![];
    let n_holes = random.between(0.0, 11.0) as usize;
    for _ in 0..200 {
        if holes.len() == n_holes {
            break;
        }
        let radius = random.between(0.15, 0.7);
        let margin = radius + 0.3;
        let center = Vector2::new(random.between(margin, 10.0 - margin), random.between(margin, height - margin));
        if holes.iter().all(|(c, r)| (c - center).norm() > r + radius + 0.25) {
            holes.push((center, radius));
        }
    }
    let outer = rectangle((0.0, 0.0), (10.0, height));
    let loops = holes.iter().map(|(c, r)| vec![Curve::circle(*c, *r)]).collect();
    let mut domain = Domain::new(outer.edges, loops);
    domain.parts = outer.parts;
    let mut model = body(domain, PlaneState::Strain);
    let n_cracks = 1 + random.between(0.0, 10.0) as usize;
    for _ in 0..400 {
        if model.cracks.len() == n_cracks {
            break;
        }
        let crack = random_crack(&mut random, height, &holes, model.cracks.len());
        if is_clear(&crack, &model, height, &holes) {
            model.cracks.push(crack);
        }
    }
    if seed % 2 == 1 {
        // Pulled between clamps: pieces that come off do not end it so soon.
        BOTH.into_iter().for_each(|d| hold(&mut model, 0, d, 0.0));
        hold(&mut model, 2, BOTH[0], random.between(-0.005, 0.005));
        hold(&mut model, 2, BOTH[1], 0.01);
        return model;
    }
    model.rigid_motion = RigidMotion::MeanIsZero;
    let (xx, yy, xy) = (random.between(-0.3, 1.0), random.between(0.5, 1.0), random.between(-0.5, 0.5));
    let stress = TractionValue::UniformStress(Matrix2::new(xx, xy, xy, yy));
    model.loads.push(BoundaryLoad { part: None, value: stress });
    model
}

/// Inside the body, from its left or right side, or from a hole; straight or with a bend.
fn random_crack(random: &mut Random, height: f64, holes: &[(Vector2, f64)], index: usize) -> CrackPath {
    let length = random.between(0.3, 1.5);
    let kind = random.between(0.0, 3.0) as usize;
    let (start, angle, mouth) = match (kind, holes.is_empty()) {
        (0, _) | (2, true) => {
            let start = Vector2::new(random.between(0.5, 9.5), random.between(0.5, height - 0.5));
            (start, random.between(0.0, TAU), EndKind::Tip)
        }
        (1, _) => {
            let y = random.between(0.8, height - 0.8);
            let (x, base) = if random.between(0.0, 1.0) < 0.5 { (0.0, 0.0) } else { (10.0, 0.5 * TAU) };
            (Vector2::new(x, y), base + random.between(-0.8, 0.8), EndKind::Mouth)
        }
        _ => {
            let (center, radius) = holes[random.between(0.0, holes.len() as f64 - 1e-9) as usize];
            let angle = random.between(0.0, TAU);
            (center + direction(angle) * radius, angle, EndKind::Mouth)
        }
    };
    let mut vertices = vec![start, start + direction(angle) * (0.6 * length)];
    let bend = random.between(-0.9, 0.9);
    vertices.push(vertices[1] + direction(angle + bend) * (0.4 * length));
    CrackPath { name: format!("crack-{}", index + 1), vertices, ends: [mouth, EndKind::Tip] }
}

fn is_clear(crack: &CrackPath, model: &Model, height: f64, holes: &[(Vector2, f64)]) -> bool {
    let inside = |p: &Vector2| p.x > 0.15 && p.x < 9.85 && p.y > 0.15 && p.y < height - 0.15;
    let from = usize::from(crack.ends[0] == EndKind::Mouth);
    let own_hole = |c: Vector2, r: f64| from == 1 && ((crack.vertices[0] - c).norm() - r).abs() < 1e-9;
    let clear_of_holes = holes.iter().all(|&(c, r)| {
        let mut segments = crack.segments();
        if own_hole(c, r) {
            let next: Vec<_> = segments.by_ref().take(1).collect();
            return next.iter().all(|s| (s.1 - c).norm() > r + 0.1)
                && segments.all(|(a, b)| distance_to_segment(c, a, b) > r + 0.1);
        }
        segments.all(|(a, b)| distance_to_segment(c, a, b) > r + 0.15)
    });
    let clear_of_cracks = model
        .cracks
        .iter()
        .flat_map(|c| c.segments())
        .all(|(a, b)| crack.segments().all(|(p, q)| distance_between_segments(a, b, p, q) > 0.15));
    crack.vertices[from..].iter().all(inside) && clear_of_holes && clear_of_cracks
}

/// What must hold whatever happened.
fn check(seed: u64, model: &Model, steps: &Steps) {
    for record in &steps.records {
        for tip in record.cracks.iter().flat_map(|c| &c.tips) {
            let numbers = [tip.k1, tip.k2, tip.k_uncertainty, tip.j, tip.t_stress, tip.kink_angle, tip.k_equivalent];
            assert!(numbers.iter().flatten().all(|v| v.is_finite()), "plate {seed}: {tip:?}");
            assert!(tip.reason.is_some() || record.end.is_some(), "plate {seed}: {tip:?}");
        }
    }
    let cracks = steps.cracks();
    let segments: Vec<(Vector2, Vector2)> = cracks.iter().flat_map(|c| c.segments()).collect();
    for (i, s) in segments.iter().enumerate() {
        for t in &segments[i + 1..] {
            assert!(!segments_cross(s.0, s.1, t.0, t.1), "plate {seed}: {s:?} crosses {t:?}");
        }
    }
    for crack in cracks {
        for end in crack.tip_ends() {
            assert!(model.domain.contains(crack.end_position(end)), "plate {seed}: {} left the body", crack.name);
        }
    }
}

#[test]
fn random_plates_grow_to_the_end() {
    let n = std::env::var("RISS_PLATES").ok().and_then(|n| n.parse().ok()).unwrap_or(PLATES);
    let first: u64 = std::env::var("RISS_FIRST_PLATE").ok().and_then(|n| n.parse().ok()).unwrap_or(0);
    let growth = GrowthSettings { increment: Some(0.3), steps: 60, ..GrowthSettings::default() };
    let mut failures = vec![];
    for seed in first..first + n {
        let model = plate(seed);
        let (steps, end) = grow(&model, &Settings::default(), &growth);
        check(seed, &model, &steps);
        if end.kind == GrowthEndKind::Failed {
            failures.push((seed, end.reason));
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}
