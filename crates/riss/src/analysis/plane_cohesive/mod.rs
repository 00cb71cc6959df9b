//! Cohesive cracks of a plane body: tied until they reach their strength, then opening along the path of equilibrium.
//!
//! The same law and the same path as in solids ([`super::cohesive`]); [`body`] condenses the body of the weak form onto the
//! openings. Where cracks grow, their ways come first, from the elastic body with open cracks, and then the load, on the
//! whole ways [CendonEtAl2000]: a face that is tied changes nothing in the body, so that a crack may lie ahead of what is broken.

mod body;

use super::cohesive::{
    Bond, CohesiveState, Condensed, Followed, LoadPoint, LoadingSettings, follow, peak_of, pictures,
};
use super::crack_growth::{GrowthSettings, GrowthState, crack_growth};
use super::growth_record::{GrowthEnd, GrowthEndKind};
use super::linear_static::{Solved, discretize, result_of};
use super::record::{CrackRecord, Observer, Stage, StaticResult, TipRecord};
use super::settings::Settings;
use super::warnings::Warning;
use crate::crack::CrackPath;
use crate::error::Result;
use crate::math::Vector2;
use crate::model::{CohesiveCrack, Model};
use crate::system::crack_faces::joining_pressure;
use crate::system::galerkin::displacement_gradients;
use crate::system::{Discretization, Solution};
use body::JoinedBody;
use std::ops::ControlFlow;

/// The whole path.
#[derive(Clone, Debug)]
pub struct PlaneLoadingRecord {
    /// Load curve from rest.
    pub curve: Vec<LoadPoint>,
    /// Index of the greatest load.
    pub peak: usize,
    /// Why it ended.
    pub end: GrowthEnd,
    /// Why the cracks grew no further, if they grow.
    pub growth_end: Option<GrowthEnd>,
    /// The problem with its cracks as they were loaded.
    pub model: Model,
}

/// Loads a plane body with cohesive cracks; none if the observer ended it. States with fields reach the observer as steps, in
/// order, numbered by their point on the load curve; steps of growth before reach it with their states.
///
/// - `settings`: supports by Nitsche's method or a penalty
/// - `growth`: how the cracks grow, if they do
/// - `from`: where growth goes on that an earlier run began
///
/// # Errors
/// Those of nodes, shape functions and solver.
pub fn plane_loading(
    model: &Model,
    settings: &Settings,
    loading: &LoadingSettings,
    growth: Option<&GrowthSettings>,
    from: Option<GrowthState>,
    observer: &mut dyn Observer,
) -> Result<Option<PlaneLoadingRecord>> {
    let Some(growth) = growth else { return traced(model, settings, loading, observer) };
    let elastic = Model { cohesive: None, ..model.clone() };
    let mut ways = Ways { observer, cracks: vec![] };
    let Some(end) = crack_growth(&elastic, settings, growth, from, &mut ways)? else { return Ok(None) };
    let cracks: Vec<CrackPath> =
        ways.cracks.into_iter().map(|c| CrackPath { name: c.name, vertices: c.path, ends: c.ends }).collect();
    let mut cohesive = model.cohesive.clone();
    if let Some(cohesive) = &mut cohesive {
        // Cracks that have started are cohesive all along.
        cohesive.cracks.resize(cracks.len(), Some(CohesiveCrack { notches: vec![] }));
    }
    let record = traced(&Model { cracks, cohesive, ..model.clone() }, settings, loading, observer)?;
    Ok(record.map(|r| PlaneLoadingRecord { growth_end: Some(end), ..r }))
}

/// Keeps where cracks have come to, for an observer that hears of growth only what it takes to go on.
struct Ways<'a> {
    observer: &'a mut dyn Observer,
    cracks: Vec<CrackRecord>,
}

impl Observer for Ways<'_> {
    fn stage(&mut self, stage: Stage) {
        self.observer.stage(stage);
    }

    fn warning(&mut self, warning: &Warning) {
        self.observer.warning(warning);
    }

    fn wants_fields(&self, _step: usize) -> bool {
        false
    }

    fn step(&mut self, result: &StaticResult, state: Option<&GrowthState>) -> ControlFlow<()> {
        self.cracks.clone_from(&result.step.cracks);
        state.map_or(ControlFlow::Continue(()), |state| self.observer.ways_grown(state))
    }
}

/// Loads the cracks as they are.
fn traced(
    model: &Model,
    settings: &Settings,
    loading: &LoadingSettings,
    observer: &mut dyn Observer,
) -> Result<Option<PlaneLoadingRecord>> {
    let Some(law) = model.cohesive.as_ref().map(|c| c.law) else { return Ok(None) };
    // Stresses at the tip of a cohesive crack are finite.
    let approximation = settings.approximation.without_automatic_enrichment();
    let settings = &Settings { approximation, ..settings.clone() };
    let discrete = discretize(model, settings, observer)?;
    observer.stage(Stage::Assembly);
    let Some(body) = JoinedBody::new(model, settings, &discrete)? else {
        let reason = "nothing of the cohesive cracks is tied".into();
        let end = GrowthEnd { kind: GrowthEndKind::NoTipGrows, reason };
        let (curve, model) = (vec![LoadPoint::default()], model.clone());
        return Ok(Some(PlaneLoadingRecord { curve, peak: 0, end, growth_end: None, model }));
    };
    observer.stage(Stage::Solve);
    let condensed = body.condense()?;
    let bonds: Vec<Bond> = body.areas().into_iter().map(|area| Bond { area, is_near_front: false }).collect();
    let Followed { curve, states, end, is_stopped, .. } =
        follow(&condensed, body.measure(), &law, loading, &bonds, observer);
    if is_stopped {
        return Ok(None);
    }
    let peak = peak_of(&curve);
    let points = pictures(&curve, peak);
    let solution = |point: &usize| {
        let state = &states[*point];
        let tractions = condensed.tractions(state.load_factor, &state.openings);
        body.state(state.load_factor, &state.openings, &tractions)
    };
    let solutions = points.iter().map(solution).collect::<Result<Vec<_>>>()?;
    drop(body);
    let (solution, cracks, method) = (Solution::default(), crack_records(model), settings.constraints);
    let mut solved = Solved { discrete, solution, gradients: vec![], method, cracks };
    for (point, solution) in points.into_iter().zip(solutions) {
        let gradients = displacement_gradients(&solved.discrete, &solution.parameters)?;
        solved = Solved { solution, gradients, ..solved };
        let state = &states[point];
        let mut result = result_of(model, settings, &solved, (point, state.load_factor), observer)?;
        add_tractions(model, &solved.discrete, &normal_tractions(&condensed, state), &mut result);
        // Said once.
        solved.discrete.notes.clear();
        if observer.step(&result, None).is_break() {
            return Ok(None);
        }
    }
    Ok(Some(PlaneLoadingRecord { curve, peak, end, growth_end: None, model: model.clone() }))
}

/// Cracks with their tips; factors of a cohesive tip are none.
fn crack_records(model: &Model) -> Vec<CrackRecord> {
    let of_crack = |path: &CrackPath| CrackRecord {
        name: path.name.clone(),
        path: path.vertices.clone(),
        ends: path.ends,
        tips: path.tip_ends().map(|end| TipRecord::unknown(end, path.frame(end))).collect(),
    };
    model.cracks.iter().map(of_crack).collect()
}

/// Tractions along the normal, by knots: positive pulls the faces together.
fn normal_tractions(condensed: &Condensed, state: &CohesiveState) -> Vec<f64> {
    let all = condensed.tractions(state.load_factor, &state.openings);
    (0..condensed.n_pairs()).map(|k| condensed.of_pair(k, &all)[0]).collect()
}

/// Puts tractions beside the displacements of crack faces.
fn add_tractions(model: &Model, discrete: &Discretization, tractions: &[f64], result: &mut StaticResult) {
    for (crack, faces) in result.fields.crack_faces.iter_mut().enumerate() {
        let Some(cohesive) = model.cohesive_crack(crack) else { continue };
        let at = |p: &Vector2| match cohesive.is_notch(*p) {
            true => 0.0,
            false => joining_pressure(discrete, tractions, crack, *p),
        };
        faces.traction = faces.positions.iter().map(at).collect();
    }
}
