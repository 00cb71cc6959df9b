//! Belytschko (1997), sections 5.1, 5.2 and 5.6.1: tip functions as unknowns besides those of nodes.
//!
//! Goal: the near-tip square of `enrichment.rs` as well as with the longer basis, by a partition of unity and with the
//! stress intensity factors themselves as unknowns.

use super::bodies::{solve, tips};
use super::enrichment::{check_square, everywhere, grid, square};
use riss::analysis::Settings;
use riss::approximation::EnrichmentKind;
use riss::system::{ConstraintMethod, LinearSolver};

fn all_over(n: usize, kind: EnrichmentKind) -> Settings {
    everywhere(grid(n, n, kind))
}

#[test]
fn belytschko_1997_section_5_6_1_partition_of_unity() {
    for n in [9, 17, 25] {
        let settings = all_over(n, EnrichmentKind::ExtrinsicFull);
        check_square([1.0, 0.0], &settings, [0.0005, 1e-8]);
        check_square([1.0, 1.0], &settings, [0.001; 2]);
        check_square([0.0, 1.0], &settings, [1e-8, 0.001]);
    }
}

#[test]
fn belytschko_1997_section_5_6_1_moving_least_squares() {
    for n in [9, 17, 25] {
        let settings = all_over(n, EnrichmentKind::ExtrinsicMls);
        check_square([1.0, 0.0], &settings, [0.0001, 1e-8]);
        check_square([1.0, 1.0], &settings, [0.0005; 2]);
        check_square([0.0, 1.0], &settings, [1e-8, 0.0005]);
    }
}

/// The unknowns are K, as far as integration and supports let the exact field be the solution.
#[test]
fn belytschko_1997_section_5_1_unknowns_are_the_stress_intensity_factors() {
    for n in [9, 17, 25] {
        for k in [[1.0, 0.0], [1.0, 1.0], [-0.5, 2.0]] {
            let result = solve(&square(k[0], k[1]).0, &all_over(n, EnrichmentKind::ExtrinsicMls));
            let found = tips(&result)[0];
            for (direct, exact) in [found.k1_direct, found.k2_direct].into_iter().zip(k) {
                let error = (direct.unwrap() - exact).abs() / k[0].hypot(k[1]);
                assert!(error <= 0.0005, "{n}: {direct:?} of {exact}");
            }
        }
    }
    for kind in [EnrichmentKind::None, EnrichmentKind::IntrinsicFull, EnrichmentKind::ExtrinsicFull] {
        let result = solve(&square(1.0, 1.0).0, &grid(17, 17, kind));
        assert_eq!([tips(&result)[0].k1_direct, tips(&result)[0].k2_direct], [None; 2]);
    }
}

/// Where the functions of a tip fade, their multiples are not K, and none are told.
#[test]
fn unknowns_of_faded_functions_are_left_out_with_a_warning() {
    let result = solve(&square(1.0, 0.0).0, &everywhere(grid(9, 9, EnrichmentKind::ExtrinsicMls)));
    assert!(tips(&result)[0].k1_direct.is_some() && result.warnings.is_empty(), "{:?}", result.warnings);
    let mut settings = grid(9, 9, EnrichmentKind::ExtrinsicMls);
    settings.approximation.enrichment.r2 = Some(0.5);
    let result = solve(&square(1.0, 0.0).0, &settings);
    assert_eq!(tips(&result)[0].k1_direct, None);
    assert!(result.warnings.iter().any(|w| w.message.contains("K_I_direct")), "{:?}", result.warnings);
}

/// Unlike the basis, the nodes within the automatic region are enough on the coarsest grid.
#[test]
fn partition_of_unity_near_the_tip() {
    for (n, bound) in [(9, 0.003), (17, 0.001), (25, 0.0005)] {
        check_square([1.0, 0.0], &grid(n, n, EnrichmentKind::ExtrinsicFull), [bound, 1e-8]);
    }
}

#[test]
fn root_by_a_partition_of_unity_within_3_percent_on_the_finer_grids() {
    for n in [17, 25] {
        check_square([1.0, 0.0], &all_over(n, EnrichmentKind::ExtrinsicRadial), [0.03, 1e-8]);
    }
}

#[test]
fn belytschko_1997_figure_40_energy_errors() {
    let error = |settings: &Settings| solve(&square(1.0, 0.0).0, settings).energy_error.unwrap();
    for n in [9, 17, 25] {
        let linear = error(&grid(n, n, EnrichmentKind::None));
        for kind in [EnrichmentKind::ExtrinsicFull, EnrichmentKind::ExtrinsicMls] {
            let enriched = error(&all_over(n, kind));
            assert!(enriched <= 0.1 * linear, "{n} {kind:?}: {enriched} against {linear}");
        }
    }
}

/// Multipliers and the linear solver for large systems, which bear less ill-conditioning.
#[test]
fn other_constraints_and_solvers() {
    let nitsche = ConstraintMethod::default();
    let others = [
        (ConstraintMethod::LagrangeMultipliers, LinearSolver::Automatic),
        (ConstraintMethod::ModifiedVariational, LinearSolver::Automatic),
        (ConstraintMethod::Penalty { factor: 1e4 }, LinearSolver::Automatic),
        (nitsche, LinearSolver::MixedPrecision),
    ];
    for (constraints, solver) in others {
        for kind in [EnrichmentKind::ExtrinsicFull, EnrichmentKind::ExtrinsicMls] {
            let settings = Settings { constraints, solver, ..all_over(9, kind) };
            check_square([1.0, 0.0], &settings, [0.002, 1e-6]);
        }
    }
}
