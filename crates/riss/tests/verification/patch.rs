//! Patch tests: the program finds linear displacement fields exactly, whatever the nodes.
//!
//! The corrected gradients satisfy the divergence theorem cell by cell on the very points that integrate the boundary,
//! so that only rounding is left: [`ROUNDING`] is 1e-16 times the condition of the matrices (about 1e5) and a margin.

use crate::bodies::*;
use riss::analysis::{Settings, StaticResult};
use riss::approximation::{ApproximationSettings, Basis, EnrichmentKind, SupportShape, WeightFunction};
use riss::crack::EndKind::{Mouth, Tip};
use riss::exact::{ExactField, LinearField};
use riss::geometry::curve::Curve;
use riss::integration::{GradientCorrection, IntegrationSettings, Scheme};
use riss::material::{Elasticity, PlaneState};
use riss::math::{Matrix2, Vector2, direction};
use riss::model::{BoundaryLoad, Domain, Model, RigidMotion, TractionValue};
use riss::nodes::NodeSettings;
use riss::nodes::settings::Layout;
use riss::system::ConstraintMethod;
use std::sync::Arc;

/// Relative error that rounding may leave.
const ROUNDING: f64 = 1e-10;
/// The same with arcs, where four Gauss points on a piece of up to half a radian integrate cosines to 1e-9.
const ARC_RULE: f64 = 1e-8;

const NITSCHE: ConstraintMethod = ConstraintMethod::Nitsche { factor: 40.0 };
const PLANES: [PlaneState; 2] = [PlaneState::Strain, PlaneState::Stress];

/// Any linear field.
const LINEAR: LinearField =
    LinearField { constant: Vector2::new(3e-3, -2e-3), gradient: Matrix2::new(1.0e-3, 0.4e-3, -0.7e-3, 0.6e-3) };
/// A rigid motion: translation and small rotation.
const RIGID: LinearField =
    LinearField { constant: Vector2::new(3e-3, -2e-3), gradient: Matrix2::new(0.0, -1e-3, 1e-3, 0.0) };

/// Uniaxial tension along a direction, with a rotation: no traction on lines in that direction.
fn tension_along(angle: f64, material: &Elasticity) -> LinearField {
    let d = direction(angle);
    let strain = material.strain(&(d * d.transpose()));
    LinearField { constant: Vector2::new(1e-3, 2e-3), gradient: strain + Matrix2::new(0.0, -1e-4, 1e-4, 0.0) }
}

fn square() -> Domain {
    rectangle((0.0, 0.0), (2.0, 2.0))
}

/// A square with a hole off its center.
fn square_with_hole() -> Domain {
    let hole = vec![Curve::circle(Vector2::new(0.8, 1.1), 0.4)];
    let outline = polygon(&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)]);
    with_parts(Domain::new(outline, vec![hole]), &[])
}

fn disk() -> Domain {
    with_parts(Domain::new(vec![Curve::circle(Vector2::new(0.5, 0.2), 1.0)], vec![]), &[])
}

/// Not convex, so that corners hide nodes.
fn angle_bracket() -> Domain {
    let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 0.8), (0.8, 0.8), (0.8, 2.0), (0.0, 2.0)];
    with_parts(Domain::new(polygon(&corners), vec![]), &[])
}

/// Nothing but polynomials.
fn plain() -> Settings {
    let mut settings = Settings::default();
    settings.approximation.enrichment.kind = EnrichmentKind::None;
    settings
}

/// Largest error of displacement and stress, relative to the field: over all vertices, boundary values prescribed.
fn patch_error(mut model: Model, field: LinearField, change: impl Fn(&mut Settings)) -> f64 {
    let exact: Arc<dyn ExactField> = Arc::new(field);
    let everywhere = all(&model.domain);
    hold_exactly(&mut model, everywhere, &BOTH, &exact);
    let mut settings = plain();
    change(&mut settings);
    relative_error(&model, &field, &run(&model, &settings))
}

/// The same in the energy norm, over the whole body.
fn energy_error(mut model: Model, field: LinearField, change: impl Fn(&mut Settings)) -> f64 {
    let exact: Arc<dyn ExactField> = Arc::new(field);
    let everywhere = all(&model.domain);
    hold_exactly(&mut model, everywhere, &BOTH, &exact);
    model.exact = Some(exact);
    let mut settings = Settings::default();
    change(&mut settings);
    run(&model, &settings).energy_error.expect("the field is known")
}

fn relative_error(model: &Model, field: &LinearField, result: &StaticResult) -> f64 {
    let (displacement, stress) = differences(model, field, result);
    // Both against the deformation over the size of the body; a rotation counts as deformation here.
    let gradient = field.gradient.norm();
    let size = model.domain.area().sqrt();
    (displacement / (gradient * size)).max(stress / (model.material.young * gradient))
}

fn label(nodes: &NodeSettings) -> String {
    match &nodes.layout {
        Layout::Graded(_) => "graded".into(),
        Layout::Structured(grid) => format!("{}x{}", grid.nx, grid.ny),
        Layout::Listed(list) => format!("{} random nodes", list.positions.len()),
    }
}

fn check_patch(model: Model, field: LinearField, nodes: &NodeSettings, method: ConstraintMethod, bound: f64) {
    let n_cracks = model.cracks.len();
    let title = format!("{} {method:?} {:?} {n_cracks} cracks", label(nodes), model.material.plane);
    let error = patch_error(model, field, |s| {
        s.nodes = nodes.clone();
        s.constraints = method;
    });
    assert!(error <= bound, "{title}: {error:.2e}");
}

#[test]
fn linear_and_rigid_fields_on_a_square() {
    for plane in PLANES {
        for field in [LINEAR, RIGID] {
            for nodes in [structured(9, 8), graded(0.22), random_nodes(&square(), 9, 1)] {
                for method in [
                    NITSCHE,
                    ConstraintMethod::LagrangeMultipliers,
                    ConstraintMethod::ModifiedVariational,
                    ConstraintMethod::FiniteElementCoupled,
                ] {
                    check_patch(body(square(), plane), field, &nodes, method, ROUNDING);
                }
            }
        }
    }
}

#[test]
fn linear_fields_on_bodies_with_corners_and_arcs() {
    for plane in PLANES {
        for (domain, bound) in [(angle_bracket(), ROUNDING), (square_with_hole(), ARC_RULE), (disk(), ARC_RULE)] {
            for nodes in [structured(16, 16), graded(0.25), random_nodes(&domain, 14, 2)] {
                for method in [NITSCHE, ConstraintMethod::ModifiedVariational, ConstraintMethod::FiniteElementCoupled] {
                    check_patch(body(domain.clone(), plane), LINEAR, &nodes, method, bound);
                }
            }
        }
    }
}

/// Multipliers are linear along an arc, the traction `σ n` is not: the difference falls with the square of the spacing,
/// 7.5e-7 and 1.8e-7 in the energy norm. Pieces of angle t miss t²/12 of the traction, 1e-3 and 3e-4, in waves as short
/// as the spacing that die out within it.
#[test]
fn multipliers_on_arcs_are_good_to_the_square_of_the_spacing() {
    let error = |spacing: f64| {
        energy_error(body(disk(), PlaneState::Strain), LINEAR, |s| {
            s.nodes = graded(spacing);
            s.constraints = ConstraintMethod::LagrangeMultipliers;
        })
    };
    let (coarse, fine) = (error(0.12), error(0.06));
    assert!(coarse < 1e-5 && coarse / fine > 3.5, "{coarse:.2e} {fine:.2e}");
}

/// The penalty method leaves a gap of traction over stiffness, `σ h / (factor (λ + 2 μ))`. The gap alone would give an
/// energy error of about 1 / factor. It jumps at corners, where traces of shape functions are nearly dependent and so
/// feel the penalty less: measured, at dilation 2.5, 7.6e-4, 4.2e-5 and 2.6e-6 for 1e3, 1e5 and 1e7, at least 1 / factor^(1/2) in rate.
#[test]
fn penalty_error_falls_with_the_factor() {
    let error = |factor: f64| {
        energy_error(body(square(), PlaneState::Strain), LINEAR, |s| {
            s.nodes = random_nodes(&square(), 9, 1);
            s.constraints = ConstraintMethod::Penalty { factor };
            s.approximation.dilation = Some(2.5);
        })
    };
    let errors = [1e3, 1e5, 1e7].map(error);
    assert!(errors[0] < 1e-3 && errors.windows(2).all(|e| e[0] / e[1] > 10.0), "{errors:?}");
}

/// Cracks along the tension carry no traction: inside the body, from its boundary, and inclined.
#[test]
fn tension_along_cracks() {
    for plane in PLANES {
        for (angle, vertices, start) in [
            (0.0, [(0.53, 1.03), (1.42, 1.03)], Tip),
            (0.0, [(0.0, 0.91), (1.1, 0.91)], Mouth),
            (0.5, [(0.6, 0.7), (0.6 + 0.9 * 0.5f64.cos(), 0.7 + 0.9 * 0.5f64.sin())], Tip),
        ] {
            let mut model = body(square(), plane);
            model.cracks.push(crack(&vertices, [start, Tip]));
            let field = tension_along(angle, &model.material);
            for nodes in [structured(10, 12), graded_to(0.25, 0.06), random_nodes(&square(), 10, 3)] {
                for method in [NITSCHE, ConstraintMethod::LagrangeMultipliers, ConstraintMethod::FiniteElementCoupled] {
                    check_patch(model.clone(), field, &nodes, method, ROUNDING);
                }
            }
        }
    }
}

/// With functions of the tips at the nodes, as by default on coarse nodes. They are nearly dependent, which takes as many
/// digits as the root of the part of the diagonal that is added to make them unique, 1e-11.
#[test]
fn tension_along_a_crack_with_enriched_tips() {
    let mut model = body(square(), PlaneState::Strain);
    model.cracks.push(crack(&[(0.53, 1.03), (1.42, 1.03)], [Tip; 2]));
    let field = tension_along(0.0, &model.material);
    for method in [NITSCHE, ConstraintMethod::LagrangeMultipliers, ConstraintMethod::FiniteElementCoupled] {
        let error = patch_error(model.clone(), field, |s| {
            s.nodes = structured(10, 12);
            s.constraints = method;
            s.approximation.enrichment.kind = EnrichmentKind::Automatic;
        });
        assert!(error <= 1e-8, "{method:?}: {error:.2e}");
    }
}

/// Elements away from the crack, joined to meshfree nodes around it, held by Nitsche's method and at nodes.
#[test]
fn elements_away_from_a_crack() {
    let mut model = body(square(), PlaneState::Strain);
    model.cracks.push(crack(&[(0.53, 1.03), (1.42, 1.03)], [Tip; 2]));
    let field = tension_along(0.0, &model.material);
    for nodes in [structured(12, 12), graded_to(0.2, 0.06), random_nodes(&square(), 12, 3)] {
        for beyond in [0.05, 0.3] {
            for method in [NITSCHE, ConstraintMethod::FiniteElementCoupled] {
                let error = patch_error(model.clone(), field, |s| {
                    s.nodes = nodes.clone();
                    s.constraints = method;
                    s.approximation.finite_elements_beyond = Some(beyond);
                });
                assert!(error <= ROUNDING, "{} {beyond} {method:?}: {error:.2e}", label(&nodes));
            }
        }
    }
}

/// Every choice of shape functions reproduces the field. The quadratic basis loses one digit more: its moment matrices
/// are conditioned ten times worse.
#[test]
fn all_bases_weights_and_supports() {
    let mut model = body(square(), PlaneState::Strain);
    model.cracks.push(crack(&[(0.53, 1.03), (1.42, 1.03)], [Tip; 2]));
    let field = tension_along(0.0, &model.material);
    for (basis, bound) in [(Basis::Linear, ROUNDING), (Basis::Quadratic, 10.0 * ROUNDING)] {
        for weight_function in [WeightFunction::Gaussian, WeightFunction::QuarticSpline, WeightFunction::CubicSpline] {
            for support in [SupportShape::Circular, SupportShape::Rectangular] {
                for nodes in [structured(9, 9), graded_to(0.3, 0.1), random_nodes(&square(), 8, 4)] {
                    let error = patch_error(model.clone(), field, |s| {
                        s.nodes = nodes.clone();
                        s.approximation = ApproximationSettings { basis, weight_function, support, ..s.approximation };
                    });
                    let title = format!("{basis:?} {weight_function:?} {support:?} {}", label(&nodes));
                    assert!(error <= bound, "{title}: {error:.2e}");
                }
            }
        }
    }
}

/// Uniform stress as tractions on the outline, the mean rigid motion removed: stress and deformation are exact.
#[test]
fn uniform_tractions_without_supports() {
    for plane in PLANES {
        let any = Matrix2::new(1.0, 0.4, 0.4, -0.7);
        let along_x = Matrix2::new(1.0, 0.0, 0.0, 0.0);
        check_tractions(square(), plane, any, None, ROUNDING);
        check_tractions(square(), plane, along_x, Some([(0.5, 1.1), (1.4, 1.1)]), ROUNDING);
        check_tractions(disk(), plane, along_x, Some([(0.0, 0.3), (0.9, 0.3)]), ARC_RULE);
    }
}

fn check_tractions(
    domain: Domain,
    plane: PlaneState,
    stress: Matrix2,
    crack_ends: Option<[(f64, f64); 2]>,
    bound: f64,
) {
    for nodes in [structured(9, 9), graded(0.22), random_nodes(&domain, 9, 5)] {
        let mut model = body(domain.clone(), plane);
        model.cracks.extend(crack_ends.map(|ends| crack(&ends, [Tip; 2])));
        model.loads.push(BoundaryLoad { part: None, value: TractionValue::UniformStress(stress) });
        model.rigid_motion = RigidMotion::MeanIsZero;
        // Mean displacement and rotation of a pure strain vanish about the center of a square or a disk.
        let gradient = model.material.strain(&stress);
        let field = LinearField { constant: -gradient * model.domain.aabb().center(), gradient };
        let error = relative_error(&model, &field, &run(&model, &with_nodes(nodes.clone())));
        assert!(error <= bound, "{} {plane:?}: {error:.2e}", label(&nodes));
    }
}

/// What the correction is worth: relative energy errors of the tension along x on a square, 4×4 points.
///
/// | nodes | crack | elements | elements, plain | cells | cells, plain |
/// | --- | --- | --- | --- | --- | --- |
/// | 9×9 | no | 7e-13 | 5.7e-5 | 1.8e-5 | 1.6e-4 |
/// | 81 random | no | 2e-13 | 6.6e-3 | 7.1e-5 | 1.1e-3 |
/// | 9×9 | yes | 7e-13 | 1.4e-1 | 3.9e-3 | 1.4e-1 |
/// | 81 random | yes | 2e-13 | 1.5e-1 | 1.3e-3 | 1.4e-1 |
///
/// Cells of a background grid have other points along the boundary than the supports, and where a square meets clipped
/// ones; the corrected flux differs by the error of Gauss integration of one shape function there. Without the
/// correction the jumps of the shape functions behind the tips are integrated as if they were not there: on coarse
/// nodes the patch test fails. The bounds are a third above the table, which was measured with the dilation 2.5 of the
/// paper; the corrected element quadrature is at rounding.
#[test]
fn plain_gauss_integration_and_background_cells_fail_the_patch_test_slightly() {
    let cells = Scheme::Cells { size: 0.2 };
    for (nodes, with_crack, bounds) in [
        (structured(9, 9), false, [ROUNDING, 8e-5, 2.5e-5, 2.2e-4]),
        (random_nodes(&square(), 9, 1), false, [ROUNDING, 9e-3, 1e-4, 1.5e-3]),
        (structured(9, 9), true, [ROUNDING, 0.19, 5.5e-3, 0.19]),
        (random_nodes(&square(), 9, 1), true, [ROUNDING, 0.2, 2e-3, 0.19]),
    ] {
        let schemes = [
            (Scheme::Elements, GradientCorrection::Cell),
            (Scheme::Elements, GradientCorrection::None),
            (cells, GradientCorrection::Cell),
            (cells, GradientCorrection::None),
        ];
        for ((scheme, gradient_correction), bound) in schemes.into_iter().zip(bounds) {
            let mut model = body(square(), PlaneState::Strain);
            model.cracks.extend(with_crack.then(|| crack(&[(0.53, 1.03), (1.42, 1.03)], [Tip; 2])));
            let field = tension_along(0.0, &model.material);
            let error = energy_error(model, field, |s| {
                s.nodes = nodes.clone();
                s.approximation.dilation = Some(2.5);
                s.integration = IntegrationSettings { scheme, gradient_correction, ..s.integration };
            });
            assert!(error <= bound, "{} {scheme:?} {gradient_correction:?} {with_crack}: {error:.2e}", label(&nodes));
        }
    }
}
