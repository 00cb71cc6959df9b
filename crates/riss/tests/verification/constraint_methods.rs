//! All ways to prescribe displacements, on a cantilever with a known answer [Timoshenko1970, art. 21].
//!
//! | method | energy error, 41×11 grid | energy error, irregular, spacing 0.1 | error of the reaction |
//! | --- | --- | --- | --- |
//! | Nitsche, 40 | 7.42e-3 | 9.66e-3 | 4e-13 |
//! | Lagrange multipliers | 7.42e-3 | 9.66e-3 | 4e-13 |
//! | modified variational | 7.98e-3 | 1.65e-1 | 2e-13 |
//! | penalty, 1e4 | 7.94e-3 | 1.34e-2 | 1e-11 |
//! | row of finite elements | 1.15e-2 | 1.69e-2 | 2e-12 |
//!
//! The modified variational principle has no term that makes it definite: on irregular nodes a motion of the boundary
//! that costs almost nothing spoils the solution. Nitsche's method is the same with that term.

use crate::bodies::*;
use riss::analysis::{Settings, StaticResult};
use riss::exact::{Cantilever, ExactField};
use riss::material::PlaneState;
use riss::math::Vector2;
use riss::model::{BoundaryLoad, Model, TractionValue};
use riss::nodes::NodeSettings;
use riss::system::ConstraintMethod;
use std::sync::Arc;

const METHODS: [ConstraintMethod; 5] = [
    ConstraintMethod::Nitsche { factor: 40.0 },
    ConstraintMethod::LagrangeMultipliers,
    ConstraintMethod::ModifiedVariational,
    ConstraintMethod::Penalty { factor: 1e4 },
    ConstraintMethod::FiniteElementCoupled,
];

fn cantilever() -> Model {
    let field: Arc<dyn ExactField> = Arc::new(Cantilever { length: 4.0, height: 1.0, load: 1.0 });
    let mut model = body(rectangle((0.0, -0.5), (4.0, 0.5)), PlaneState::Stress);
    hold_exactly(&mut model, LEFT, &BOTH, &field);
    model.loads.push(BoundaryLoad { part: Some(RIGHT), value: TractionValue::Exact(field.clone()) });
    model.exact = Some(field);
    model
}

fn solve(method: ConstraintMethod, nodes: NodeSettings) -> StaticResult {
    let mut settings = Settings { constraints: method, ..with_nodes(nodes) };
    // That of the table above, on regular and irregular nodes.
    settings.approximation.dilation = Some(2.5);
    run(&cantilever(), &settings)
}

/// Whatever the method and the nodes: the support carries the unit force of the free end, because the test function
/// `v = 1` belongs to the approximation.
fn check_reaction(method: ConstraintMethod, result: &StaticResult) {
    let gap = (reaction(result, "left") - Vector2::new(0.0, 1.0)).norm();
    // A penalty of 1e4 multiplies the rounding of the displacement.
    assert!(gap < 1e-9, "{method:?}: {gap:.2e}");
}

fn energy_errors(nodes: NodeSettings) -> [f64; 5] {
    METHODS.map(|method| {
        let result = solve(method, nodes.clone());
        check_reaction(method, &result);
        result.energy_error.expect("the field is known")
    })
}

/// A row of elements along the support costs accuracy on coarse grids and less and less on finer ones, since the row
/// becomes thinner: at least the first order of linear fields. With elements everywhere it is the first order.
#[test]
fn krongauz_belytschko_1996_coupled_elements_converge() {
    let solve = |nx, ny, beyond: Option<f64>| {
        let mut settings =
            Settings { constraints: ConstraintMethod::FiniteElementCoupled, ..with_nodes(structured(nx, ny)) };
        settings.approximation.finite_elements_beyond = beyond;
        let result = run(&cantilever(), &settings);
        check_reaction(ConstraintMethod::FiniteElementCoupled, &result);
        result.energy_error.expect("the field is known")
    };
    for beyond in [None, Some(0.1)] {
        let errors = [(21, 6), (41, 11), (81, 21)].map(|(nx, ny)| solve(nx, ny, beyond));
        for e in errors.windows(2) {
            let rate = (e[0] / e[1]).log2();
            assert!(rate > 0.95, "{beyond:?}: {errors:?}");
        }
    }
}

#[test]
fn all_methods_agree_on_a_grid() {
    let [nitsche, multipliers, modified, penalty, coupled] = energy_errors(structured(41, 11));
    assert!(nitsche < 0.01 && (nitsche / multipliers - 1.0).abs() < 0.01, "{nitsche:.3e} {multipliers:.3e}");
    // The strains of bilinear elements along the support are those of the coarse grid.
    assert!(coupled < 1.6 * nitsche, "{coupled:.3e}");
    // Both leave the boundary value to a term of the order of the error itself.
    assert!(modified < 1.5 * nitsche && penalty < 1.5 * nitsche, "{modified:.3e} {penalty:.3e}");
}

#[test]
fn stable_methods_agree_on_irregular_nodes() {
    let [nitsche, multipliers, modified, penalty, coupled] = energy_errors(graded(0.1));
    assert!(nitsche < 0.01 && (nitsche / multipliers - 1.0).abs() < 0.01, "{nitsche:.3e} {multipliers:.3e}");
    assert!(penalty < 1.5 * nitsche && coupled < 1.8 * nitsche, "{penalty:.3e} {coupled:.3e}");
    assert!(modified > penalty, "{modified:.3e}: the table above is out of date");
}
