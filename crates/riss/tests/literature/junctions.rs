//! Cracks that meet: stars, crosses, T and Y.
//!
//! Goal: the sectors between cracks do not see each other, and every arm's tip has its own K.
//!
//! ```text
//!        |              |            /
//!        o          ----+----    ---<        K at every end
//!       / \             |            \
//! ```
//!
//! References: Rooke and Sneddon (1969) for the cross in an infinite plate; else an independent finite element program
//! (quadratic triangles with quarter-point tips, interaction integral) on three meshes with 4500 to 23000 nodes, which
//! differ by 0.02 % of |K| at most. Tolerance: 0.5 % of |K|, what the defaults promise.

use super::bodies::{edge_crack, inner_crack, rectangle, solve, tips};
use riss::analysis::Settings;
use riss::approximation::{CrackSmoothing, HoleSmoothing, SmoothingSettings};
use riss::crack::meetings::join;
use riss::crack::{CrackPath, EndKind};
use riss::math::{Matrix2, direction};
use riss::model::{BoundaryLoad, Domain, Model, RigidMotion, TractionValue};
use std::f64::consts::PI;

const TOLERANCE: f64 = 0.005;

fn stretched(domain: Domain, mut cracks: Vec<CrackPath>, [xx, yy]: [f64; 2]) -> Model {
    join(&mut cracks, 1e-6).expect("they meet in single points");
    let mut model = Model { cracks, rigid_motion: RigidMotion::MeanIsZero, ..Model::plain(domain) };
    let value = TractionValue::UniformStress(Matrix2::new(xx, 0.0, 0.0, yy));
    model.loads.push(BoundaryLoad { part: None, value });
    model
}

/// `n` arms of length 1 from the middle of a square of 20 pulled on all sides.
fn star(n: usize) -> Model {
    let arm = |k: usize| {
        let d = direction(PI / 2.0 + 2.0 * PI * k as f64 / n as f64);
        inner_crack(&[[0.0, 0.0], [d.x, d.y]])
    };
    stretched(rectangle([-10.0, -10.0], [10.0, 10.0], &[]), (0..n).map(arm).collect(), [1.0; 2])
}

/// Two cracks of length 2 across each other in a square of half width `half` pulled on all sides.
fn cross(half: f64) -> Model {
    let cracks = vec![inner_crack(&[[-1.0, 0.0], [1.0, 0.0]]), inner_crack(&[[0.0, -1.0], [0.0, 1.0]])];
    stretched(rectangle([-half, -half], [half, half], &[]), cracks, [1.0; 2])
}

/// A slanted crack that ends at another one.
fn tee() -> Model {
    let cracks = vec![inner_crack(&[[-2.0, 0.0], [2.0, 0.0]]), inner_crack(&[[0.5, 0.0], [0.8, 1.5]])];
    stretched(rectangle([-6.0, -5.0], [6.0, 5.0], &[]), cracks, [0.6, 1.0])
}

/// An edge crack that branches.
fn branched() -> Model {
    let arms = [[[2.0, 5.0], [3.0, 5.8]], [[2.0, 5.0], [3.2, 4.4]]];
    let mut cracks: Vec<CrackPath> = arms.iter().map(|a| inner_crack(a)).collect();
    cracks.push(edge_crack(&[[0.0, 5.0], [2.0, 5.0]]));
    stretched(rectangle([0.0, 0.0], [8.0, 10.0], &[]), cracks, [0.0, 1.0])
}

/// K of all tips, within `tolerance` of |K|.
fn check_with(model: &Model, settings: &Settings, references: &[[f64; 2]], tolerance: f64) {
    let result = solve(model, settings);
    let found: Vec<[f64; 2]> = tips(&result).iter().map(|t| [t.k1.unwrap(), t.k2.unwrap()]).collect();
    assert_eq!(found.len(), references.len(), "{found:?}");
    for (k, r) in found.iter().zip(references) {
        let difference = (k[0] - r[0]).hypot(k[1] - r[1]) / r[0].hypot(r[1]);
        assert!(difference <= tolerance, "{difference}: {found:?} instead of {references:?}");
    }
}

fn check(model: &Model, references: &[[f64; 2]]) {
    check_with(model, &Settings::default(), references, TOLERANCE);
}

#[test]
fn star_of_three_arms() {
    check(&star(3), &[[1.6789, 0.0]; 3]);
}

#[test]
fn star_of_five_arms() {
    check(&star(5), &[[1.4231, 0.0]; 5]);
}

#[test]
fn cross_of_two_cracks() {
    check(&cross(10.0), &[[1.5408, 0.0]; 4]);
}

#[test]
fn rooke_sneddon_1969_cross_in_a_large_plate() {
    check(&cross(40.0), &[[0.8636 * PI.sqrt(), 0.0]; 4]);
}

#[test]
fn crack_that_ends_at_a_crack() {
    check(&tee(), &[[3.0512, 0.0075], [2.9919, 0.0037], [0.68435, 0.3923]]);
}

#[test]
fn edge_crack_that_branches() {
    check(&branched(), &[[4.8220, 0.7888], [6.0757, -0.7057]]);
    let mouth = branched().cracks[2].ends;
    assert_eq!(mouth, [EndKind::Mouth, EndKind::Junction]);
}

#[test]
fn smoothing_keeps_sectors_apart() {
    let one = 1.0;
    let cracks =
        [CrackSmoothing::Diffraction { lambda: one }, CrackSmoothing::Transparency { kappa: one, lambda: 2.0 }];
    for cracks in cracks {
        let mut settings = Settings::default();
        let holes = Some(HoleSmoothing::Diffraction { lambda: one });
        settings.approximation.smoothing = SmoothingSettings { cracks: Some(cracks), holes };
        check_with(&star(3), &settings, &[[1.6789, 0.0]; 3], 0.01);
        check_with(&tee(), &settings, &[[3.0512, 0.0075], [2.9919, 0.0037], [0.68435, 0.3923]], 0.01);
    }
}
