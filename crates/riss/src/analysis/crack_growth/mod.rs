//! Cracks that grow: solve, let the criterion and the law say what each tip does, move the tips, again.
//!
//! Reading order: [`settings`], [`state`] (what goes from step to step), `plan` (what each tip does and why),
//! `increments` (how the new stretch is found), `advance` and `walls` (where it ends). Only here a crack moves.

mod advance;
mod increments;
mod plan;
mod seeding;
pub mod settings;
pub mod state;
mod walls;

use super::growth_record::{GrowthEnd, GrowthEndKind, TipStatus};
use super::guard_rails::Rails;
use super::linear_static::solve_step;
use super::record::*;
use super::settings::Settings;
use crate::error::{Error, Result};
use crate::model::Model;
use increments::{Grown, grow};
use plan::{StepPlan, leader, plan_step, record_mut};
use seeding::{seed, starts_again};
pub use settings::GrowthSettings;
pub use state::GrowthState;
use walls::Ending;

/// Grows all cracks of a model until something ends it; every step goes to the observer.
///
/// - `start`: where to go on; the first step if not given
///
/// Returns why it ended; `None` if the observer broke off.
///
/// # Errors
/// Those of the first step. If a later one fails, growth ends there, and the steps before stand.
pub fn crack_growth(
    model: &Model,
    settings: &Settings,
    growth: &GrowthSettings,
    start: Option<GrowthState>,
    observer: &mut dyn Observer,
) -> Result<Option<GrowthEnd>> {
    let mut model = model.clone();
    let mut state = match start {
        Some(state) => state,
        None => {
            if let Some(seeding) = &growth.seeding {
                seed(&mut model, settings, seeding, None, observer)?;
            }
            GrowthState::first(&model)
        }
    };
    model.cracks = state.cracks.clone();
    let increment = growth.increment.unwrap_or(state.automatic_increment);
    let mut result = solve_step(&model, settings, state.step, observer)?;
    loop {
        // The state as it was: what a resumed run starts from.
        let beginning = state.clone();
        let plan = plan_step(&model, growth, increment, &mut result.step, &mut state);
        let mut rails = Rails { said: &mut state.said, observer };
        rails.inspect(&model, &mut result);
        if beginning.step > 0 {
            plan.tips.iter().for_each(|t| rails.turn(t.tip, t.angle, t.length, &mut result));
        }
        if let Some(end) = result.step.end.clone() {
            let _ = observer.step(&result, Some(&beginning));
            return Ok(Some(end));
        }
        let (grown, scale) = grow(&model, settings, growth, &plan, &state, observer);
        note_endings(&model, &plan, &grown, &mut result.step);
        if observer.step(&result, Some(&beginning)).is_break() {
            return Ok(None);
        }
        state = GrowthState { scale, ..next_state(&model, &plan, &grown, &state, result.step.load_factor) };
        model = grown.model;
        let mut solved = grown.result;
        // The outline is no hole.
        let holes: Vec<usize> = state.reached_loops.iter().copied().filter(|l| *l > 0).collect();
        if let Some(seeding) = starts_again(growth.seeding.as_ref()).filter(|_| !holes.is_empty()) {
            // A body in pieces starts no cracks; the solution below says so.
            if let Ok(1..) = seed(&mut model, settings, seeding, Some(&holes), observer) {
                state.cracks = model.cracks.clone();
                solved = None;
            }
        }
        let found = match solved {
            Some(Ok(found)) => {
                found.warnings.iter().for_each(|w| observer.warning(w));
                Ok(found)
            }
            Some(Err(e)) => Err(e),
            None => solve_step(&model, settings, state.step, observer),
        };
        result = match found {
            Ok(found) => found,
            Err(error) => {
                let end = end_of(&error);
                let unsolved = unsolved(&model, &state, end.clone());
                let _ = observer.step(&unsolved, Some(&state));
                return Ok(Some(end));
            }
        };
    }
}

/// Writes what each increment really did into the record.
fn note_endings(model: &Model, plan: &StepPlan, grown: &Grown, step: &mut StepRecord) {
    for ((planned, ending), (angle, length)) in plan.tips.iter().zip(&grown.endings).zip(&grown.made) {
        let record = record_mut(step, planned.tip);
        record.kink_angle = Some(*angle);
        record.increment = Some(*length);
        let end = grown.model.cracks[planned.tip.crack].end_position(planned.tip.end);
        let at = format!("at ({:.6}, {:.6})", end.x, end.y);
        match ending {
            Ending::Free => {}
            Ending::Boundary(edge) => {
                let is_outline = model.domain.outline().contains(edge);
                let part = model.domain.parts.iter().find(|p| p.edges.contains(edge));
                let name = part.map_or(String::new(), |p| format!(" `{}`", p.name));
                record.status = if is_outline { TipStatus::ReachedBoundary } else { TipStatus::ReachedHole };
                record.reason = Some(format!("its increment meets{name} {at}"));
            }
            Ending::Crack(crack) => {
                record.status = TipStatus::ReachedCrack;
                record.reason = Some(format!("its increment meets `{}` {at}", model.cracks[*crack].name));
            }
        }
    }
}

fn next_state(model: &Model, plan: &StepPlan, grown: &Grown, state: &GrowthState, load_factor: f64) -> GrowthState {
    let mut next = GrowthState {
        step: state.step + 1,
        cracks: grown.model.cracks.clone(),
        cycles: state.cycles,
        cycles_range: state.cycles_range,
        leader: leader(plan, model),
        load_factor: Some(load_factor),
        hardest: state.hardest,
        automatic_increment: state.automatic_increment,
        scale: state.scale,
        tips: grown.memory.clone(),
        reached_loops: state.reached_loops.clone(),
        said: state.said.clone(),
    };
    if let Some(leader) = &mut next.leader {
        let made = plan.tips.iter().zip(&grown.made).find(|(t, _)| t.tip == leader.tip);
        leader.lengths[1] += made.map_or(0.0, |m| m.1.1);
    }
    for ending in &grown.endings {
        if let Ending::Boundary(edge) = ending
            && let Some(reached) = model.domain.loops.iter().position(|l| l.contains(edge))
            && !next.reached_loops.contains(&reached)
        {
            next.reached_loops.push(reached);
        }
    }
    next.reached_loops.sort_unstable();
    next
}

fn end_of(error: &Error) -> GrowthEnd {
    match error {
        Error::FreeRigidMotion { .. } => {
            GrowthEnd { kind: GrowthEndKind::Separated, reason: format!("the body has come apart: {error}") }
        }
        _ => GrowthEnd { kind: GrowthEndKind::Failed, reason: error.to_string() },
    }
}

/// The record of a step that could not be solved: where the cracks are.
fn unsolved(model: &Model, state: &GrowthState, end: GrowthEnd) -> StaticResult {
    let record = |path: &crate::crack::CrackPath| CrackRecord {
        name: path.name.clone(),
        path: path.vertices.clone(),
        ends: path.ends,
        tips: path.tip_ends().map(|e| TipRecord::unknown(e, path.frame(e))).collect(),
    };
    let step = StepRecord {
        step: state.step,
        load_factor: 1.0,
        cycles: None,
        cycles_range: None,
        stability: None,
        end: Some(end),
        cracks: model.cracks.iter().map(record).collect(),
        reactions: vec![],
    };
    StaticResult::unsolved(step)
}
