//! Timoshenko's cantilever: parabolic shear at one end, the exact displacement prescribed at the other
//! [Timoshenko1970, art. 21].
//!
//! ```text
//!  exact |==================| exact traction    length 4, height 1, plane stress, nu = 0.3
//!    u   |==================|  v
//! ```
//!
//! Rates by `1/√nodes` with the default integration, and with plain Gauss integration in brackets. Grids have 4 to 24
//! steps over the height, irregular nodes 6 to 24:
//!
//! | basis | nodes | energy | displacement |
//! | --- | --- | --- | --- |
//! | linear | grid | 1.14 | 2.35 |
//! | linear | irregular | 1.35 | 2.71 |
//! | quadratic | grid | 2.14 | 4.06 |
//! | quadratic | irregular | 2.15 (0.03) | 3.56 (-0.08) |
//!
//! The constant correction in each cell is exact for linear fields only, and yet the quadratic basis needs it most:
//! without it, 4×4 points leave an energy error of 4e-3 on irregular nodes however fine they are.

use crate::bodies::*;
use riss::analysis::Settings;
use riss::approximation::{ApproximationSettings, Basis};
use riss::exact::{Cantilever, ExactField};
use riss::integration::{GradientCorrection, IntegrationSettings};
use riss::material::PlaneState;
use riss::model::{BoundaryLoad, Model, TractionValue};
use riss::nodes::NodeSettings;
use std::sync::Arc;

/// Rates of the energy norm and of the L2 norm of the displacement.
const LINEAR: [f64; 2] = [1.0, 2.0];
const QUADRATIC: [f64; 2] = [2.0, 3.0];
const MARGINS: [f64; 2] = [0.1, 0.2];

fn cantilever() -> Model {
    let field: Arc<dyn ExactField> = Arc::new(Cantilever { length: 4.0, height: 1.0, load: 1.0 });
    let mut model = body(rectangle((0.0, -0.5), (4.0, 0.5)), PlaneState::Stress);
    hold_exactly(&mut model, LEFT, &BOTH, &field);
    model.loads.push(BoundaryLoad { part: Some(RIGHT), value: TractionValue::Exact(field.clone()) });
    model.exact = Some(field);
    model
}

/// Rates of the energy norm and of the L2 norm of the displacement over the layouts.
fn rates(basis: Basis, layouts: impl Iterator<Item = NodeSettings>) -> [f64; 2] {
    let model = cantilever();
    let (mut energy, mut displacement) = (vec![], vec![]);
    for nodes in layouts {
        let approximation = ApproximationSettings { basis, ..ApproximationSettings::default() };
        let settings = Settings { nodes, approximation, ..Settings::default() };
        let result = run(&model, &settings);
        let h = (result.n_nodes as f64).sqrt().recip();
        energy.push((h, result.energy_error.expect("the field is known")));
        displacement.push((h, displacement_error(&model, &settings, &result)));
    }
    [rate(&energy), rate(&displacement)]
}

fn check_rates(basis: Basis, layouts: impl Iterator<Item = NodeSettings>, theory: [f64; 2]) {
    let found = rates(basis, layouts);
    assert!((0..2).all(|k| found[k] >= theory[k] - MARGINS[k]), "{basis:?}: {found:.3?}");
}

fn grids() -> impl Iterator<Item = NodeSettings> {
    [4, 8, 16, 24].into_iter().map(|n| structured(4 * n + 1, n + 1))
}

fn irregular() -> impl Iterator<Item = NodeSettings> {
    [6.0, 10.0, 16.0, 24.0].into_iter().map(|n| graded(1.0 / n))
}

#[test]
fn linear_basis_on_grids() {
    check_rates(Basis::Linear, grids(), LINEAR);
}

#[test]
fn linear_basis_on_irregular_nodes() {
    check_rates(Basis::Linear, irregular(), LINEAR);
}

#[test]
fn quadratic_basis_on_grids() {
    check_rates(Basis::Quadratic, grids(), QUADRATIC);
}

#[test]
fn quadratic_basis_on_irregular_nodes() {
    check_rates(Basis::Quadratic, irregular(), QUADRATIC);
}

#[test]
fn quadratic_basis_needs_the_gradient_correction() {
    let error = |gradient_correction: GradientCorrection| {
        let settings = Settings {
            nodes: graded(1.0 / 16.0),
            approximation: ApproximationSettings { basis: Basis::Quadratic, ..ApproximationSettings::default() },
            integration: IntegrationSettings { gradient_correction, ..IntegrationSettings::default() },
            ..Settings::default()
        };
        run(&cantilever(), &settings).energy_error.expect("the field is known")
    };
    let (plain, corrected) = (error(GradientCorrection::None), error(GradientCorrection::Cell));
    // 4.4e-3 and 4.7e-4.
    assert!(corrected < 0.2 * plain, "{corrected:.2e} {plain:.2e}");
}
