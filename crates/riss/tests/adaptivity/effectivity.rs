//! The estimated error over the error itself: between 0.5 and 2 on every body whose stress is known.
//!
//! Measured with linear (quadratic) bases: cantilever 1.03 to 1.14 (1.10 to 1.98), plate with a hole 1.17 to 1.35 (1.22 to
//! 1.84), ring 0.95 to 1.26 (1.14 to 1.15), L-shape 0.79 to 1.11 (0.94 to 1.07), opening crack 0.74 to 1.03 (0.95 to 1.04),
//! mixed mode 1.10 to 1.29 (1.20 to 1.25).

use crate::bodies::*;
use crate::problems::*;
use riss::adaptivity::AccuracySettings;
use riss::analysis::{RefinementRecord, Settings, Silent, solve_refined};
use riss::approximation::Basis;
use riss::exact::LinearField;
use riss::material::Elasticity;
use riss::math::{Matrix2, Vector2};
use riss::model::Model;
use riss::nodes::NodeSettings;
use std::sync::Arc;

/// All solutions on the way to an error.
fn way(model: &Model, nodes: NodeSettings, basis: Basis, percent: f64, refinements: usize) -> Vec<RefinementRecord> {
    let mut settings = Settings { nodes, ..Settings::default() };
    settings.approximation.basis = basis;
    let accuracy = AccuracySettings { energy_percent: Some(percent), refinements, ..AccuracySettings::default() };
    solve_refined(model, &settings, &accuracy, &mut Silent).unwrap_or_else(|e| panic!("{e}")).refinements
}

/// Uniform refinement, and refinement to a target.
fn check_effectivity(name: &str, model: &Model, layouts: &[NodeSettings], percent: f64) {
    for nodes in layouts {
        for (basis, percent, refinements) in
            [(Basis::Linear, 1e-3, 2), (Basis::Linear, percent, 4), (Basis::Quadratic, 1e-3, 1)]
        {
            for record in way(model, nodes.clone(), basis, percent, refinements) {
                let index = record.error_estimate / record.energy_error.expect("the field is known");
                assert!((0.5..=2.0).contains(&index), "{name}, {basis:?}, {} nodes: {index}", record.n_nodes);
            }
        }
    }
}

#[test]
fn smooth_bodies() {
    check_effectivity("cantilever", &cantilever(), &[structured(33, 9), graded(0.12)], 1.0);
    check_effectivity("plate with a hole", &plate_with_hole(), &[graded(0.5)], 0.5);
    check_effectivity("ring", &ring(), &[graded(0.2)], 1.0);
}

#[test]
fn singular_bodies() {
    check_effectivity("L-shape", &l_shape(), &[graded(0.1)], 1.0);
    check_effectivity("opening crack", &near_tip(1.0, 0.0), &[structured(17, 17), graded(0.1)], 2.0);
    check_effectivity("crack in mixed mode", &near_tip(0.5, 1.0), &[structured(17, 17), graded(0.1)], 2.0);
}

/// A uniform stress is recovered as it is.
#[test]
fn patch_has_no_error() {
    let field = LinearField { constant: Vector2::new(0.1, 0.2), gradient: Matrix2::new(1e-3, 2e-3, -1e-3, 3e-3) };
    for plane in [riss::material::PlaneState::Strain, riss::material::PlaneState::Stress] {
        let material = Elasticity { plane, ..MATERIAL };
        let model = moved_by(Arc::new(field), rectangle((0.0, 0.0), (2.0, 1.0)), material);
        for basis in [Basis::Linear, Basis::Quadratic] {
            let found = way(&model, graded(0.15), basis, 1.0, 1);
            assert!(found.len() == 1 && found[0].error_estimate < 1e-8, "{basis:?}: {found:?}");
        }
    }
}
