//! From the plan of a step to longer cracks: at once, or corrected until the new tips agree.

use super::advance::{Arrival, Increment, advance, arc_way};
use super::plan::{LEAST_SCALE, Pending, StepPlan};
use super::settings::{GrowthSettings, IncrementControl, IncrementForm};
use super::state::{GrowthState, TipMemory};
use super::walls::Ending;
use crate::analysis::linear_static::solve_step;
use crate::analysis::{Observer, Settings, Stage, StaticResult};
use crate::crack::{EndKind, TipId};
use crate::error::Result;
use crate::fracture::growth_criterion::{GrowthCriterion, TipDriving};
use crate::model::Model;

/// Corrections of an increment before it is taken as it is.
const MAX_CORRECTIONS: usize = 4;
/// A corrected increment is good if the criterion turns the new tip by less than this [rad].
const GOOD_TURN: f64 = 2e-3;

/// A curved increment that meets a wall is cut if it is longer than this part of a whole one: where it would have
/// turned to there is no tip that tells, and paths bend most close to holes.
const LONG_ARRIVAL: f64 = 0.25;

/// A step whose path error is this part of the tolerance may be followed by one twice as long.
const LONGER: f64 = 0.25;

/// The model after an increment.
pub(super) struct Grown {
    pub model: Model,
    /// What each tip of the plan ends at.
    pub endings: Vec<Ending>,
    /// Turn of each increment at the old tip [rad], and its length [length].
    pub made: Vec<(f64, f64)>,
    /// Memory of the tips.
    pub memory: Vec<TipMemory>,
    /// The solution after the increment, if corrections have found it already.
    pub result: Option<Result<StaticResult>>,
}

/// Direction and curvature of one increment while it is corrected.
#[derive(Clone, Copy)]
struct Shape {
    angle: f64,
    curvature: f64,
    last_curvature: f64,
    length: f64,
}

/// Makes the increments of a plan; returns them and the share of a whole increment to take next.
pub(super) fn grow(
    model: &Model,
    settings: &Settings,
    growth: &GrowthSettings,
    plan: &StepPlan,
    state: &GrowthState,
    observer: &mut dyn Observer,
) -> (Grown, f64) {
    let is_curved = growth.form == IncrementForm::Curved;
    let mut shapes: Vec<Shape> = plan
        .tips
        .iter()
        .map(|t| {
            let curvature = if is_curved { state.memory(t.tip).curvature } else { 0.0 };
            Shape { angle: t.angle, curvature, last_curvature: curvature, length: t.length }
        })
        .collect();
    let mut scale = state.scale;
    let mut grown = make(model, plan, &shapes, 1.0);
    let mut share = 1.0;
    while is_curved && arrives_far(plan, &grown) {
        shapes.iter_mut().for_each(|s| s.length *= 0.5);
        share *= 0.5;
        grown = make(model, plan, &shapes, share);
    }
    let corrects = is_curved || growth.criterion == GrowthCriterion::LocalSymmetry;
    let tolerance = match growth.control {
        IncrementControl::Converged { tolerance } => Some(tolerance),
        IncrementControl::Fixed | IncrementControl::HalvedOnTurns { .. } => None,
    };
    if !corrects && tolerance.is_none() {
        return (grown, scale);
    }
    let mut corrections = 0;
    loop {
        let result = solve_step(&grown.model, settings, state.step + 1, &mut Trial { observer });
        let Ok(found) = &result else {
            grown.result = Some(result);
            return (grown, scale);
        };
        let turns = turns_at_new_tips(&grown, growth, plan, found);
        let turn = turns.iter().flatten().fold(0.0, |m: f64, t| m.max(t.abs()));
        if corrects && turn > GOOD_TURN && corrections < MAX_CORRECTIONS {
            corrections += 1;
            for (shape, turn) in shapes.iter_mut().zip(&turns) {
                match (turn, is_curved) {
                    (Some(turn), true) => shape.curvature += turn / shape.length,
                    (Some(turn), false) => shape.angle += turn,
                    (None, _) => {}
                }
            }
        } else if tolerance.is_some_and(|t| path_error(&shapes, &turns, is_curved) > t) && scale > LEAST_SCALE {
            shapes.iter_mut().for_each(|s| s.length *= 0.5);
            scale *= 0.5;
            share *= 0.5;
            corrections = 0;
        } else {
            if tolerance.is_some_and(|t| path_error(&shapes, &turns, is_curved) < LONGER * t) {
                scale = (2.0 * scale).min(1.0);
            }
            grown.result = Some(result);
            return (grown, scale);
        }
        grown = make(model, plan, &shapes, share);
    }
}

/// Whether an increment meets a wall after a long way.
fn arrives_far(plan: &StepPlan, grown: &Grown) -> bool {
    let longest = plan.tips.iter().map(|t| t.length).fold(0.0, f64::max);
    let is_far = |(ending, (_, length)): (&Ending, &(f64, f64))| match ending {
        Ending::Free => false,
        Ending::Boundary(_) | Ending::Crack(_) => *length > LONG_ARRIVAL * longest,
    };
    grown.endings.iter().zip(&grown.made).any(is_far)
}

/// Distance between the ends of one increment and of two of half the length, over the length.
///
/// Two straight halves: the second turns by about half the turn at the end, over half the length. On an arc the
/// curvature is taken as constant; where it goes linearly from that of the last increment, by `c` in all, the true path
/// ends `c length² / 12` beside the arc. A turn that is left over at the end adds half of it.
fn path_error(shapes: &[Shape], turns: &[Option<f64>], is_curved: bool) -> f64 {
    let error = |(shape, turn): (&Shape, &Option<f64>)| {
        let turn = turn.unwrap_or(0.0).abs();
        let change = (shape.curvature - shape.last_curvature).abs();
        if is_curved { change * shape.length / 12.0 + 0.5 * turn } else { 0.25 * turn }
    };
    shapes.iter().zip(turns).map(error).fold(0.0, f64::max)
}

/// Makes increments of the given shapes, in a `share` of the step that was planned.
fn make(model: &Model, plan: &StepPlan, shapes: &[Shape], share: f64) -> Grown {
    let increments: Vec<Increment> = plan
        .tips
        .iter()
        .zip(shapes)
        .map(|(t, s)| {
            let frame = model.cracks[t.tip.crack].frame(t.tip.end);
            Increment { tip: t.tip, way: arc_way(frame.position, frame.angle + s.angle, s.curvature, s.length) }
        })
        .collect();
    let mut model = model.clone();
    let arrivals = advance(&mut model, &increments);
    let length = |(shape, arrival): (&Shape, &Arrival)| match arrival.ending {
        // The polygon around an arc is a little longer.
        Ending::Free => shape.length,
        Ending::Boundary(_) | Ending::Crack(_) => arrival.length,
    };
    let made = shapes.iter().zip(&arrivals).map(|pair| (pair.0.angle, length(pair))).collect();
    let mut memory: Vec<TipMemory> = plan
        .tips
        .iter()
        .zip(shapes)
        .map(|(t, s)| TipMemory { tip: t.tip, curvature: s.curvature, pending: 0.0 })
        .collect();
    let save_up = |p: &Pending| TipMemory { tip: p.tip, curvature: 0.0, pending: p.before + p.added * share };
    memory.extend(plan.pending.iter().map(save_up));
    memory.sort_by_key(|m| m.tip);
    let endings = arrivals.iter().map(|a| a.ending).collect();
    Grown { model, endings, made, memory, result: None }
}

/// Turn that the criterion asks for at each new tip that is still one [rad].
fn turns_at_new_tips(
    grown: &Grown,
    growth: &GrowthSettings,
    plan: &StepPlan,
    found: &StaticResult,
) -> Vec<Option<f64>> {
    let turn = |tip: TipId| {
        let record = found.step.cracks[tip.crack].tips.iter().find(|t| t.end == tip.end)?;
        let (k1, k2) = (record.k1?, record.k2?);
        let driving =
            TipDriving { k1, k2, t_stress: record.t_stress.unwrap_or(0.0), force: record.configurational_force };
        (k1 > 0.0).then(|| growth.criterion.kink_angle(&driving, &grown.model.material))
    };
    let is_tip = |tip: TipId| grown.model.cracks[tip.crack].end_kind(tip.end) == EndKind::Tip;
    plan.tips.iter().map(|t| if is_tip(t.tip) { turn(t.tip) } else { None }).collect()
}

/// Passes on stages; warnings of a solution that may be dropped are heard when it is taken.
struct Trial<'a> {
    observer: &'a mut dyn Observer,
}

impl Observer for Trial<'_> {
    fn stage(&mut self, stage: Stage) {
        self.observer.stage(stage);
    }

    fn wants_fields(&self, step: usize) -> bool {
        self.observer.wants_fields(step)
    }
}
