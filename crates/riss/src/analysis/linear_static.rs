//! One linear elastic solution and everything that is read from it.

use super::contact::{ContactSearch, solve_in_contact};
use super::energy::{reactions, strain_energy};
use super::error_bars::widen_error_bars;
use super::fields::sample_fields;
use super::growth_record::TipStatus;
use super::guard_rails::Rails;
use super::record::*;
use super::refinement::refine;
use super::settings::Settings;
use super::warnings::Warnings;
use crate::approximation::moving_least_squares::Derivatives;
use crate::approximation::{CrackSmoothing, ShapeFunctions, Surroundings};
use crate::crack::TipId;
use crate::error::{Error, Result};
use crate::fracture::{
    FacePressure, ForceAt, RememberedField, SolutionField, TipIntegrals, TipLoads, TipView, configurational_forces,
    tip_integrals,
};
use crate::geometry::predicates::distance_to_segment;
use crate::math::{Matrix2, Vector2};
use crate::model::{Model, RigidMotion};
use crate::nodes::spacing::SpacingField;
use crate::nodes::triangulation::SIGHT_SHIFT;
use crate::nodes::{generate, generate_at};
use crate::system::crack_faces::joining_pressure;
use crate::system::galerkin::displacement_gradients;
use crate::system::solve::UNBALANCED;
use crate::system::{ConstraintMethod, Discretization, Solution, assemble};

/// Stabilization of Nitsche's method grows by this factor when the matrix is not definite.
const STABILIZATION_GROWTH: f64 = 10.0;
/// How far behind a tip its opening is taken, over the length of the last segment: no node is so near.
const TIP_STEP: f64 = 1e-5;

/// Solves the linear elastic problem once and evaluates every tip.
///
/// # Errors
/// Every variant of [`Error`]; tips without room for a domain are reported, not refused.
pub fn linear_static(model: &Model, settings: &Settings, observer: &mut dyn Observer) -> Result<StaticResult> {
    let mut result = solve_step(model, settings, 0, observer)?;
    Rails { said: &mut vec![], observer }.inspect(model, &mut result);
    // There is nothing left to break off.
    let _ = observer.step(&result, None);
    Ok(result)
}

/// The static solution that is one step of an analysis.
///
/// # Errors
/// Those of [`linear_static`].
pub(super) fn solve_step(
    model: &Model,
    settings: &Settings,
    step: usize,
    observer: &mut dyn Observer,
) -> Result<StaticResult> {
    let mut warnings = Warnings::new(observer);
    let (solved, refinements) = match &settings.accuracy {
        Some(accuracy) => refine(model, settings, accuracy, &mut warnings)?,
        None => {
            let discrete = discretize(model, settings, warnings.observer)?;
            (solve_on(model, settings, discrete, &mut warnings)?, vec![])
        }
    };
    let before = warnings.list;
    let result = result_of(model, settings, &solved, (step, 1.0), observer)?;
    let warnings = before.into_iter().chain(result.warnings.iter().cloned()).collect();
    Ok(StaticResult { refinements, warnings, ..result })
}

/// What is read from a solution.
///
/// - `at`: number of the step, and the factor on the loads
///
/// # Errors
/// Those of the shape functions.
pub(super) fn result_of(
    model: &Model,
    settings: &Settings,
    solved: &Solved,
    at: (usize, f64),
    observer: &mut dyn Observer,
) -> Result<StaticResult> {
    let mut warnings = Warnings::new(observer);
    let (step, load_factor) = at;
    let Solved { discrete, solution, gradients, method, cracks } = solved;
    discrete.notes.iter().for_each(|n| warnings.add(n.clone()));
    if let CrackSmoothing::Transparency { .. } = settings.approximation.resolved_smoothing().cracks() {
        let n = nodes_too_near(model, discrete);
        if n > 0 {
            warnings.about("approximation.smoothing", format!(
                "{n} nodes near crack tips are closer to the crack than a quarter of the node spacing: where the crack is \
                 transparent their functions have a trough ahead of the tip; move them away or use diffraction"
            ));
        }
    }
    warnings.observer.stage(Stage::Fields);
    let energy = strain_energy(model, discrete, gradients);
    let fields = match warnings.observer.wants_fields(step) {
        true => sample_fields(model, discrete, solution)?,
        false => Fields::default(),
    };
    let reactions = reactions(model, discrete, solution, method, load_factor)?;
    let step = StepRecord {
        step,
        load_factor,
        cycles: None,
        cycles_range: None,
        stability: None,
        end: None,
        cracks: cracks.clone(),
        reactions,
    };
    let nodes = discrete.approximation.nodes();
    let node_records = (0..nodes.len()).map(|i| NodeRecord {
        position: nodes.positions[i],
        support_radius: nodes.support_radii[i].max(),
        parameters: solution.parameters[i],
    });
    Ok(StaticResult {
        step,
        n_nodes: nodes.len(),
        n_unknowns: solution.n_unknowns,
        n_integration_points: discrete.cells.points.len(),
        strain_energy: energy.strain_energy * model.thickness,
        energy_error: energy.relative_error,
        residual: solution.residual,
        refinements: vec![],
        fields,
        nodes: node_records.collect(),
        extra_parameters: solution.parameters[nodes.len()..].to_vec(),
        integration_points: discrete.cells.points.iter().map(|p| (p.position, p.weight)).collect(),
        warnings: warnings.list,
    })
}

/// Nodes that act on a tip and stand nearer to its crack than a quarter of the node spacing [EFG, section 4.3]; a node at
/// the tip itself looks past the crack.
fn nodes_too_near(model: &Model, discrete: &Discretization) -> usize {
    let nodes = discrete.approximation.nodes();
    let is_near = |copy: usize, node: usize| {
        let (p, radius) = (nodes.positions[node], nodes.support_radii[node].max());
        let spacing = discrete.triangulation.edge_length[discrete.triangulation.copies[copy].point as usize];
        model.tips().iter().any(|(tip, frame)| {
            let away = (p - frame.position).norm();
            let to_crack = || model.cracks[tip.crack].segments().map(|(a, b)| distance_to_segment(p, a, b));
            away > 0.0 && away < radius && to_crack().fold(away, f64::min) < (0.25 * spacing).min(0.999 * away)
        })
    };
    let standing = discrete.node_of_copy.iter().enumerate().filter_map(|(copy, node)| Some((copy, (*node)? as usize)));
    standing.filter(|(copy, node)| is_near(*copy, *node)).count()
}

/// A solution, and the cracks in it.
pub(super) struct Solved {
    pub discrete: Discretization,
    pub solution: Solution,
    /// Of the displacement at all integration points.
    pub gradients: Vec<Matrix2>,
    /// As it was used.
    pub method: ConstraintMethod,
    pub cracks: Vec<CrackRecord>,
}

/// Solves on given nodes and evaluates every tip.
pub(super) fn solve_on(
    model: &Model,
    settings: &Settings,
    discrete: Discretization,
    warnings: &mut Warnings,
) -> Result<Solved> {
    let (solution, method) = solve_once(model, settings, &discrete, warnings)?;
    if model.rigid_motion == RigidMotion::MeanIsZero && solution.imbalance > UNBALANCED {
        warnings.about(
            "rigid_motion",
            format!(
                "the loads are out of balance by {:.2} %; a body force like that of an acceleration balances them",
                100.0 * solution.imbalance
            ),
        );
    }
    warnings.observer.stage(Stage::Fracture);
    let mut cracks = evaluate_cracks(model, settings, &discrete, &solution, warnings)?;
    let gradients = displacement_gradients(&discrete, &solution.parameters)?;
    widen_error_bars(model, &discrete, &solution, &gradients, &mut cracks)?;
    Ok(Solved { discrete, solution, gradients, method, cracks })
}

/// Nodes, supports, cells and neighbor lists of a model.
///
/// # Errors
/// [`Error::NodeGeneration`] and [`Error::SingularMomentMatrix`].
pub fn discretize(model: &Model, settings: &Settings, observer: &mut dyn Observer) -> Result<Discretization> {
    observer.stage(Stage::Nodes);
    let layered = generate(model, &settings.nodes, settings.method.crack_form())?;
    observer.stage(Stage::Discretization);
    Discretization::new(model, layered, &settings.approximation, &settings.integration, &settings.constraints)
}

/// The same with irregular nodes at a given spacing.
///
/// # Errors
/// [`Error::NodeGeneration`] and [`Error::SingularMomentMatrix`].
pub fn discretize_at(
    model: &Model,
    settings: &Settings,
    spacing: &SpacingField,
    observer: &mut dyn Observer,
) -> Result<Discretization> {
    observer.stage(Stage::Nodes);
    let layered = generate_at(model, spacing, settings.nodes.star.as_ref(), settings.method.crack_form())?;
    observer.stage(Stage::Discretization);
    Discretization::new(model, layered, &settings.approximation, &settings.integration, &settings.constraints)
}

/// Assembles and solves; a matrix that Nitsche's terms made indefinite is tried again with a larger stabilization.
pub(super) fn solve_once(
    model: &Model,
    settings: &Settings,
    discrete: &Discretization,
    warnings: &mut Warnings,
) -> Result<(Solution, ConstraintMethod)> {
    let mut method = settings.constraints;
    for attempt in 0.. {
        warnings.observer.stage(Stage::Assembly);
        let system = assemble(model, discrete, &method)?;
        warnings.observer.stage(Stage::Solve);
        match (solve_in_contact(model, discrete, system, &method, settings.solver), method) {
            (Err(Error::Factorization { .. }), ConstraintMethod::Nitsche { factor }) if attempt < 3 => {
                let factor = factor * STABILIZATION_GROWTH;
                warnings.about(
                    "constraints",
                    format!("the stabilization of the supports was too small and is now {factor}"),
                );
                method = ConstraintMethod::Nitsche { factor };
            }
            (result, _) => {
                let (solution, search) = result?;
                if search.n_changed > 0 {
                    warnings.about("contact", unsettled(&search));
                }
                return Ok((solution, method));
            }
        }
    }
    unreachable!("the last attempt returns")
}

fn unsettled(search: &ContactSearch) -> String {
    format!(
        "the contact of crack faces did not settle in {} solutions: {} of their knots touch, {} changed in the last \
         one; a smaller penalty may help",
        search.n_solutions, search.n_closed, search.n_changed
    )
}

fn evaluate_cracks(
    model: &Model,
    settings: &Settings,
    discrete: &Discretization,
    solution: &Solution,
    warnings: &mut Warnings,
) -> Result<Vec<CrackRecord>> {
    let mut records = vec![];
    for (crack, path) in model.cracks.iter().enumerate() {
        let mut tips = vec![];
        for end in path.tip_ends() {
            tips.push(evaluate_tip(model, settings, discrete, solution, TipId { crack, end }, warnings)?);
        }
        let (name, ends) = (path.name.clone(), path.ends);
        records.push(CrackRecord { name, path: path.vertices.clone(), ends, tips });
    }
    Ok(records)
}

fn evaluate_tip(
    model: &Model,
    settings: &Settings,
    discrete: &Discretization,
    solution: &Solution,
    id: TipId,
    warnings: &mut Warnings,
) -> Result<TipRecord> {
    let view = TipView::new(model, id);
    let mut record = TipRecord::unknown(id.end, view.frame);
    if !solution.tip_factors.is_empty() {
        match direct_factors(model, discrete, solution, id) {
            Some(factors) => [record.k1_direct, record.k2_direct] = factors.map(Some),
            None => warnings.about_crack(id.crack, format!(
                "no K_I_direct and K_II_direct of the tip at ({:.6}, {:.6}): its functions fade inside the body, and where they \
                 do they take what the nodes leave of the field, not K; K_I and K_II are not touched by that",
                view.frame.position.x, view.frame.position.y
            )),
        }
    }
    let radii = match view.radii(settings.fracture.domain, settings.fracture.radii.as_deref()) {
        Ok((radii, note)) => {
            note.into_iter().for_each(|n| warnings.about_crack(id.crack, n));
            radii
        }
        Err(e) => {
            warnings.about_crack(id.crack, e.to_string());
            return Ok(record);
        }
    };
    let solved = SolutionField { discrete, solution };
    let field = RememberedField::new(&solved);
    let force = |p: Vector2| body_force_at(model, solution, p);
    let acts = model.body_force.is_some() || solution.imbalance > UNBALANCED;
    let contact = |p: Vector2| joining_pressure(discrete, &solution.contact_pressures, id.crack, p);
    let pressure = |p: Vector2| model.face_pressure(id.crack, p) + contact(p);
    let face_pressure = match model.loads_faces(id.crack) {
        true => Some(FacePressure { at: &pressure, tip_opening: tip_opening(discrete, solution, &view)? }),
        false => None,
    };
    let loads = TipLoads { body_force: acts.then_some(&force as ForceAt), face_pressure };
    let found = tip_integrals(&view, &radii, &settings.fracture, &model.material, &loads, &field)?;
    let mean = |get| mean_of(&found, get);
    let spread = |get| spread_of(&found, get);
    let (k1, k2) = (mean(|t| t.k1), mean(|t| t.k2));
    record.k1 = Some(k1);
    record.k2 = Some(k2);
    record.k_uncertainty = Some(spread(|t| t.k1).max(spread(|t| t.k2)));
    let clear = view.clear_of_kinks(&radii, discrete.triangulation.spacing_at(view.frame.position));
    // Faces that turn away hold energy that counts for J, and it is poor next to a kink.
    let found_clear = match clear == radii {
        true => found.clone(),
        false => tip_integrals(&view, &clear, &settings.fracture, &model.material, &loads, &field)?,
    };
    record.j = Some(mean_of(&found_clear, |t| t.j));
    record.j_uncertainty = Some(spread_of(&found_clear, |t| t.j));
    record.t_stress = Some(mean(|t| t.t_stress));
    record.t_uncertainty = Some(spread(|t| t.t_stress));
    let forces = configurational_forces(&view, &clear, &settings.fracture, &model.material, &loads, &field)?;
    let sum = forces.iter().map(|f| f.value(settings.fracture.crack_faces)).sum::<Vector2>();
    record.configurational_force = Some(sum / forces.len() as f64);
    record.status = status(k1, k2, contact(view.frame.position));
    record.radii = radii;
    Ok(record)
}

/// Stress intensity factors that were solved for; none where the functions of the tip fade: the energy is least with a
/// smaller multiple of them then, the smaller the finer the nodes at the tip are.
fn direct_factors(model: &Model, discrete: &Discretization, solution: &Solution, id: TipId) -> Option<[f64; 2]> {
    let place = model.tips().iter().position(|t| t.0 == id)?;
    let (tip, [inner, _]) = discrete.approximation.enrichment()?.regions().nth(place)?;
    let farthest = discrete.approximation.nodes().positions.iter().map(|p| (p - tip).norm()).fold(0.0, f64::max);
    (inner >= farthest).then(|| solution.tip_factors[place])
}

fn mean_of(found: &[TipIntegrals], get: fn(&TipIntegrals) -> f64) -> f64 {
    found.iter().map(get).sum::<f64>() / found.len() as f64
}

/// Largest value less smallest.
fn spread_of(found: &[TipIntegrals], get: fn(&TipIntegrals) -> f64) -> f64 {
    let values = || found.iter().map(get);
    values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
}

/// What a tip does, by its factors and the contact pressure on the faces there.
fn status(k1: f64, k2: f64, contact_pressure: f64) -> TipStatus {
    let opens = k1 > 0.0 || k1.abs() < 1e-6 * k2.abs();
    if opens && contact_pressure <= 0.0 { TipStatus::Stationary } else { TipStatus::Closed }
}

/// Opening of the faces right behind a tip [length].
fn tip_opening(discrete: &Discretization, solution: &Solution, view: &TipView) -> Result<f64> {
    let step = TIP_STEP * (view.path[1] - view.path[0]).norm();
    let at = view.frame.global(Vector2::new(-step, 0.0));
    let (mut around, mut shape) = <(Surroundings, ShapeFunctions<2>)>::default();
    let mut side = |shift: f64| {
        let sight = at + view.frame.x2() * (shift * SIGHT_SHIFT * step);
        discrete.approximation.evaluate(at, sight, Derivatives::First, &mut around, &mut shape)?;
        Ok(shape.value(&solution.parameters).dot(&view.frame.x2()))
    };
    Ok(side(1.0)? - side(-1.0)?)
}

/// All that acts inside the body: the model's body force, and what balances loads out of balance.
fn body_force_at(model: &Model, solution: &Solution, p: Vector2) -> Vector2 {
    model.body_force_at(p) + solution.balancing_force.at(p)
}
