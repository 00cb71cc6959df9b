//! The estimated error over the error itself.

use crate::bodies::*;
use crate::problems::*;
use riss::adaptivity::AccuracySettings;
use riss::analysis::{RefinementRecord, Settings, Silent, solve_refined};
use riss::approximation::Basis;
use riss::model::Model;
use riss::nodes::NodeSettings;

/// All solutions on the way to an error that is not reached.
fn way(model: &Model, nodes: NodeSettings, basis: Basis, refinements: usize) -> Vec<RefinementRecord> {
    let mut settings = Settings { nodes, ..Settings::default() };
    settings.approximation.basis = basis;
    let accuracy = AccuracySettings { energy_percent: Some(1e-3), refinements, ..AccuracySettings::default() };
    solve_refined(model, &settings, &accuracy, &mut Silent).unwrap_or_else(|e| panic!("{e}")).refinements
}

fn check_effectivity(name: &str, model: &Model, nodes: NodeSettings, basis: Basis, refinements: usize) {
    for record in way(model, nodes, basis, refinements) {
        let truth = record.energy_error.expect("the field is known");
        let index = record.error_estimate / truth;
        eprintln!("{name} {basis:?} {} {:.4e} {index:.3}", record.n_nodes, truth);
        assert!((0.5..2.0).contains(&index), "{name}, {basis:?}, {} nodes: {index}", record.n_nodes);
    }
}

fn both(name: &str, model: &Model, layouts: Vec<NodeSettings>) {
    for nodes in layouts {
        for (basis, refinements) in [(Basis::Linear, 3), (Basis::Quadratic, 2)] {
            check_effectivity(name, model, nodes.clone(), basis, refinements);
        }
    }
}

#[test]
fn cantilever_() {
    both("cantilever", &cantilever(), vec![structured(33, 9), graded(0.12)]);
}

#[test]
fn hole() {
    both("hole", &plate_with_hole(), vec![graded(0.5)]);
}

#[test]
fn ring_() {
    both("ring", &ring(), vec![graded(0.2)]);
}

#[test]
fn corner() {
    both("corner", &l_shape(), vec![graded(0.1)]);
}

#[test]
fn tip() {
    both("tip", &near_tip(1.0, 0.0), vec![structured(17, 17), graded_to(0.1, 0.1), graded(0.1)]);
    both("tip 2", &near_tip(0.5, 1.0), vec![structured(17, 17), graded(0.1)]);
}
