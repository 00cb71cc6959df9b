//! Cohesive cracks of a plane body: tied until they reach their strength, then opening along the path of equilibrium.
//!
//! The same law and the same path as in solids ([`super::cohesive`]); [`body`] condenses the body of the weak form onto the
//! openings, and cracks that grow do so by [`growing`].

mod body;
mod growing;

use super::cohesive::{
    Bond, CohesiveState, Condensed, Followed, LoadPoint, LoadingSettings, follow, peak_of, pictures,
};
use super::crack_growth::GrowthSettings;
use super::linear_static::{Solved, discretize, result_of, solve_once};
use super::record::{CrackRecord, GrowthEnd, GrowthEndKind, Observer, Stage, StaticResult, TipRecord};
use super::settings::Settings;
use super::warnings::Warnings;
use crate::crack::CrackPath;
use crate::error::Result;
use crate::math::Vector2;
use crate::model::Model;
use crate::system::crack_faces::{Knot, joining_pressure, knots};
use crate::system::galerkin::displacement_gradients;
use crate::system::{Discretization, Solution};
use body::JoinedBody;
use growing::Growing;
pub use growing::{CohesivePaths, GrownPath};

/// The whole path.
#[derive(Clone, Debug)]
pub struct PlaneLoadingRecord {
    /// Load curve from rest.
    pub curve: Vec<LoadPoint>,
    /// Index of the greatest load.
    pub peak: usize,
    /// Why it ended.
    pub end: GrowthEnd,
    /// Its cracks from first to last, if they grow.
    pub paths: Vec<GrownPath>,
    /// The problem with the last of them.
    pub model: Model,
}

/// Loads a plane body with cohesive cracks; none if the observer ended it. States with fields reach the observer as steps, in
/// order, numbered by their point on the load curve.
///
/// - `growth`: how the cracks grow, if they do
/// - `from`: the cracks that an earlier run had grown to, if it goes on from there
///
/// # Errors
/// Those of nodes, shape functions and solver.
pub fn plane_loading(
    model: &Model,
    settings: &Settings,
    loading: &LoadingSettings,
    growth: Option<&GrowthSettings>,
    from: Option<CohesivePaths>,
    observer: &mut dyn Observer,
) -> Result<Option<PlaneLoadingRecord>> {
    let Some(growth) = growth else {
        let Traced::Done(record) = traced(model, settings, loading, None, observer)? else { return Ok(None) };
        return Ok(record.map(|r| *r));
    };
    let mut growing = Growing::new(model, growth, from);
    let settings = growing.settings(settings);
    loop {
        match traced(&growing.model, &settings, loading, Some(&growing), observer)? {
            Traced::Reached { state, place, load_factor } => {
                let (discrete, solution) = *state;
                growing.extend(&discrete, &solution, place, load_factor)?;
                if observer.paths_grown(&growing.now()).is_break() {
                    return Ok(None);
                }
            }
            Traced::Done(record) => {
                let Some(mut record) = record else { return Ok(None) };
                if let Some(halt) = growing.halt {
                    record.end.reason += &format!("; tips stopped before: {halt}");
                }
                return Ok(Some(PlaneLoadingRecord { paths: growing.paths, ..*record }));
            }
        }
    }
}

/// What becomes of cracks under load.
enum Traced {
    /// The whole path; none if the observer ended it.
    Done(Option<Box<PlaneLoadingRecord>>),
    /// A tip has to grow before the path goes on.
    Reached { state: Box<(Discretization, Solution)>, place: Option<(usize, Vector2)>, load_factor: f64 },
}

/// Loads the cracks as they are.
fn traced(
    model: &Model,
    settings: &Settings,
    loading: &LoadingSettings,
    growing: Option<&Growing<'_>>,
    observer: &mut dyn Observer,
) -> Result<Traced> {
    let Some(law) = model.cohesive.as_ref().map(|c| c.law) else { return Ok(Traced::Done(None)) };
    // Stresses at the tip of a cohesive crack are finite.
    let approximation = settings.approximation.without_automatic_enrichment();
    let settings = &Settings { approximation, ..settings.clone() };
    let discrete = discretize(model, settings, observer)?;
    observer.stage(Stage::Assembly);
    let Some(body) = JoinedBody::new(model, settings, &discrete)? else {
        return free(model, settings, growing, discrete, observer);
    };
    observer.stage(Stage::Solve);
    let condensed = body.condense()?;
    let knots = knots(&discrete);
    let bond = |(knot, area): (&Knot, f64)| Bond {
        area,
        is_near_front: growing.is_some_and(|g| g.is_near_tip(knot.crack, knot.position)),
    };
    let bonds: Vec<Bond> = knots.iter().zip(body.areas()).map(bond).collect();
    let followed = follow(&condensed, body.measure(), &law, loading, &bonds, observer);
    if followed.is_stopped {
        return Ok(Traced::Done(None));
    }
    let Followed { curve, states, mut end, reached, .. } = followed;
    let solution = |point: usize| {
        let state = &states[point];
        let tractions = condensed.tractions(state.load_factor, &state.openings);
        body.state(state.load_factor, &state.openings, &tractions)
    };
    if let (Some(n), Some(_)) = (growing.and_then(Growing::done), reached) {
        let reason = format!("the cracks have grown by {n} increments, and the next would be due");
        end = GrowthEnd { kind: GrowthEndKind::StepsDone, reason };
    } else if let Some(pair) = reached {
        let solution = solution(states.len() - 1)?;
        let Knot { crack, position } = knots[pair];
        let load_factor = states[states.len() - 1].load_factor;
        drop(body);
        let state = Box::new((discrete, solution));
        return Ok(Traced::Reached { state, place: Some((crack, position)), load_factor });
    }
    let peak = peak_of(&curve);
    let points = pictures(&curve, peak);
    let solutions = points.iter().map(|point| solution(*point)).collect::<Result<Vec<_>>>()?;
    let tractions: Vec<Vec<f64>> = points.iter().map(|point| normal_tractions(&condensed, &states[*point])).collect();
    drop(body);
    let record = PlaneLoadingRecord { curve, peak, end, paths: vec![], model: model.clone() };
    let (solution, cracks, method) = (Solution::default(), crack_records(model), settings.constraints);
    let mut solved = Solved { discrete, solution, gradients: vec![], method, cracks };
    for ((point, solution), tractions) in points.into_iter().zip(solutions).zip(tractions) {
        let gradients = displacement_gradients(&solved.discrete, &solution.parameters)?;
        solved = Solved { solution, gradients, ..solved };
        let mut result = result_of(model, settings, &solved, (point, record.curve[point].load_factor), observer)?;
        add_tractions(model, &solved.discrete, &tractions, &mut result);
        if observer.step(&result, None).is_break() {
            return Ok(Traced::Done(None));
        }
    }
    Ok(Traced::Done(Some(Box::new(record))))
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

/// Cracks of which nothing is tied: tips grow by the stress of the elastic body, if they may.
fn free(
    model: &Model,
    settings: &Settings,
    growing: Option<&Growing<'_>>,
    discrete: Discretization,
    observer: &mut dyn Observer,
) -> Result<Traced> {
    if growing.is_some_and(Growing::may_grow) {
        let (solution, _) = solve_once(model, settings, &discrete, &mut Warnings::new(observer))?;
        return Ok(Traced::Reached { state: Box::new((discrete, solution)), place: None, load_factor: 0.0 });
    }
    let end = GrowthEnd { kind: GrowthEndKind::NoTipGrows, reason: "nothing of the cohesive cracks is tied".into() };
    let curve = vec![LoadPoint::default()];
    Ok(Traced::Done(Some(Box::new(PlaneLoadingRecord { curve, peak: 0, end, paths: vec![], model: model.clone() }))))
}
