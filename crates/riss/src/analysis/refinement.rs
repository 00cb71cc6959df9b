//! Solves again and again, with finer nodes where the error is, until the accuracy that was asked for is met.
//!
//! The error bar of a stress intensity factor is that of any solution ([`error_bars`](super::error_bars)), or what follows
//! from the change in the last refinement, whichever is larger. If a refinement leaves the share ρ of an error, a change of Δ leaves
//! `Δ ρ/(1-ρ)`. The factors converge no slower than the stress: ρ is that of its estimated error, the bar at least Δ.

use super::energy::strain_energy;
use super::error_bars::j_bar;
use super::linear_static::{Solved, discretize, discretize_at, solve_on};
use super::record::{CrackRecord, Observer, RefinementRecord, TipRecord};
use super::settings::Settings;
use super::warnings::Warnings;
use crate::adaptivity::{AccuracySettings, ErrorEstimate, Quadtree, estimate_error, mark};
use crate::error::Result;
use crate::math::Vector2;
use crate::model::{Domain, Model};
use crate::nodes::estimated_nodes;
use crate::nodes::settings::{Layout, NodeSettings};
use crate::nodes::spacing::SpacingField;
use crate::system::{Discretization, Solution};

/// Target of the next solution over the error of this one, where the factors and not the error over the body are aimed at.
const NEXT_TARGET: f64 = 0.5;

/// The last solution on the way to an accuracy.
#[derive(Clone, Debug)]
pub struct Refined {
    /// Nodes and cells.
    pub discrete: Discretization,
    /// The solution on them.
    pub solution: Solution,
    /// All solutions on the way.
    pub refinements: Vec<RefinementRecord>,
}

/// Refines for an accuracy and returns the solution itself, for what [`linear_static`](super::linear_static()) does not
/// report.
///
/// # Errors
/// Those of [`linear_static`](super::linear_static()).
pub fn solve_refined(
    model: &Model,
    settings: &Settings,
    accuracy: &AccuracySettings,
    observer: &mut dyn Observer,
) -> Result<Refined> {
    let (solved, refinements) = refine(model, settings, accuracy, &mut Warnings::new(observer))?;
    Ok(Refined { discrete: solved.discrete, solution: solved.solution, refinements })
}

/// A refinement that leaves more of the error than this is taken to leave that much.
const MOST_LEFT: f64 = 0.95;
/// The factors of a tip that is loaded less than this part of the most loaded one are measured by that part.
const SHADOW: f64 = 0.01;

/// Solves on the nodes as placed, then on finer ones; says in a warning what could not be met.
pub(super) fn refine(
    model: &Model,
    settings: &Settings,
    accuracy: &AccuracySettings,
    warnings: &mut Warnings,
) -> Result<(Solved, Vec<RefinementRecord>)> {
    // The estimate of the error does not see what the functions of a tip do.
    let approximation = settings.approximation.without_automatic_enrichment();
    let settings = &Settings { approximation, ..settings.clone() };
    let mut tree = first_tree(model, &settings.nodes);
    let mut records: Vec<RefinementRecord> = vec![];
    let said = warnings.list.len();
    let mut discrete = discretize(model, settings, warnings.observer)?;
    loop {
        // What the coarser solutions warned of is not of the result.
        warnings.list.truncate(said);
        let mut solved = solve_on(model, settings, discrete, warnings)?;
        let estimate = estimate_error(model, &solved.discrete, &solved.solution, &solved.gradients)?;
        let record = record(model, &mut solved, &estimate, records.last())?;
        warnings.observer.refinement(&record);
        records.push(record);
        let record = records.last().expect("it was just added");
        if is_met(accuracy, record) {
            return Ok((solved, records));
        }
        match next_tree(accuracy, &model.domain, &tree, &solved, &estimate, records.len()) {
            Ok(finer) => tree = finer,
            Err(reason) => {
                warnings.about("accuracy", format!("{}: {reason}", shortfall(accuracy, record)));
                return Ok((solved, records));
            }
        }
        discrete = discretize_at(model, settings, &spacing_of(&tree, accuracy.growth), warnings.observer)?;
    }
}

/// Squares as large as the nodes are apart.
fn first_tree(model: &Model, nodes: &NodeSettings) -> Quadtree {
    let bounds = model.domain.aabb();
    let spacing = match &nodes.layout {
        Layout::Graded(graded) => SpacingField::of_model(model, graded),
        Layout::Structured(grid) => {
            let steps = bounds.size().component_div(&Vector2::new((grid.nx - 1) as f64, (grid.ny - 1) as f64));
            SpacingField::uniform(steps.min())
        }
        Layout::Listed(listed) => {
            let positions: Vec<Vector2> = listed.positions.iter().map(|p| Vector2::from(*p)).collect();
            SpacingField::of_nodes(&positions, (model.domain.area() / positions.len().max(1) as f64).sqrt())
        }
    };
    let mut tree = Quadtree::uniform(&bounds, spacing.largest());
    tree.fit(|p| spacing.at(p));
    tree
}

/// The spacing of a tree: nodes stand as far apart as the squares are long.
fn spacing_of(tree: &Quadtree, growth: f64) -> SpacingField {
    let squares: Vec<_> = tree.leaves().into_iter().map(|s| (tree.bounds(s), tree.size(s))).collect();
    SpacingField::of_rectangles(&squares, growth)
}

/// Takes down a solution, and widens the error bars of its tips by what has changed since the one before.
fn record(
    model: &Model,
    solved: &mut Solved,
    estimate: &ErrorEstimate,
    before: Option<&RefinementRecord>,
) -> Result<RefinementRecord> {
    let energy_error = match &model.exact {
        Some(_) => strain_energy(model, &solved.discrete, &solved.gradients).relative_error,
        None => None,
    };
    let factors: Vec<[f64; 2]> = tips(&mut solved.cracks).map(|(_, k)| k).collect();
    let before = before.filter(|b| b.factors.len() == factors.len());
    let mut k_error = before.filter(|_| !factors.is_empty()).map(|_| 0.0f64);
    let largest = factors.iter().map(|[k1, k2]| k1.hypot(*k2)).fold(0.0, f64::max);
    let per_change = before.map_or(1.0, |b| {
        let left = (estimate.relative() / b.error_estimate).min(MOST_LEFT);
        (left / (1.0 - left)).max(1.0)
    });
    for (i, (tip, [k1, k2])) in tips(&mut solved.cracks).enumerate() {
        let Some(before) = before else { break };
        let [b1, b2] = before.factors[i];
        let change = (k1 - b1).abs().max((k2 - b2).abs());
        let bar = tip.k_uncertainty.unwrap_or(0.0).max(per_change * change);
        let size = k1.hypot(k2);
        tip.k_uncertainty = Some(bar);
        tip.j_uncertainty = tip.j_uncertainty.map(|b| b.max(j_bar(size, bar, model.material.effective_young())));
        k_error = k_error.map(|e| e.max(bar / size.max(SHADOW * largest)));
    }
    let (n_nodes, error_estimate) = (solved.discrete.n_nodes(), estimate.relative());
    Ok(RefinementRecord { n_nodes, error_estimate, energy_error, k_error, factors })
}

/// All tips that have factors.
fn tips(cracks: &mut [CrackRecord]) -> impl Iterator<Item = (&mut TipRecord, [f64; 2])> {
    cracks.iter_mut().flat_map(|c| &mut c.tips).filter_map(|tip| {
        let factors = [tip.k1?, tip.k2?];
        Some((tip, factors))
    })
}

fn is_met(accuracy: &AccuracySettings, record: &RefinementRecord) -> bool {
    // Where no tip is left, every K is accurate.
    let met = |percent: f64| record.factors.is_empty() || record.k_error.is_some_and(|e| 100.0 * e <= percent);
    let k = accuracy.k_percent.is_none_or(met);
    k && accuracy.energy_percent.is_none_or(|p| 100.0 * record.error_estimate <= p)
}

/// What is not met, in words.
fn shortfall(accuracy: &AccuracySettings, record: &RefinementRecord) -> String {
    let mut parts = vec![];
    if let Some(wanted) = accuracy.k_percent {
        match record.k_error {
            Some(error) if 100.0 * error <= wanted => {}
            Some(error) => parts.push(format!("K is good to {:.3} %, {wanted} % was asked for", 100.0 * error)),
            None if record.factors.is_empty() => {}
            None => parts.push(format!("how good K is cannot be told yet, {wanted} % was asked for")),
        }
    }
    if let Some(wanted) = accuracy.energy_percent.filter(|w| 100.0 * record.error_estimate > *w) {
        let estimate = 100.0 * record.error_estimate;
        parts.push(format!("the stress is good to {estimate:.3} % in the energy norm, {wanted} % was asked for"));
    }
    format!("the accuracy is not met: {}", parts.join(", and "))
}

/// The squares of the next solution, or why there is none.
fn next_tree(
    accuracy: &AccuracySettings,
    domain: &Domain,
    tree: &Quadtree,
    solved: &Solved,
    estimate: &ErrorEstimate,
    n_solutions: usize,
) -> std::result::Result<Quadtree, String> {
    if n_solutions > accuracy.refinements {
        return Err(format!("`accuracy.refinements` = {} are made", accuracy.refinements));
    }
    let points = &solved.discrete.cells.points;
    let halved = NEXT_TARGET * estimate.relative();
    let target = accuracy.energy_percent.filter(|_| accuracy.k_percent.is_none()).map_or(halved, |p| 0.01 * p);
    let mut marks = mark(tree, estimate, points, target);
    if marks.refine.is_empty() {
        // All squares are within twice the target, and yet their sum is not: aim below the mean.
        marks = mark(tree, estimate, points, halved);
    }
    let mut finer = tree.clone();
    if finer.refine(&marks.refine) == 0 {
        return Err("the squares cannot be split any more".into());
    }
    finer.coarsen(&marks.coarsen);
    let nodes_of = |tree: &Quadtree| estimated_nodes(domain, &spacing_of(tree, accuracy.growth));
    let n = solved.discrete.n_nodes() as f64 * nodes_of(&finer) / nodes_of(tree);
    if n > accuracy.nodes as f64 {
        return Err(format!("the next refinement needs about {n:.0} nodes, `accuracy.nodes` = {}", accuracy.nodes));
    }
    Ok(finer)
}
