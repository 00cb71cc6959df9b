//! What each tip does next, and why: written into the step's record.

use super::settings::{AdvanceLaw, GrowthSettings, IncrementControl, QuasiStatic};
use super::state::{GrowthState, Leader};
use crate::analysis::{GrowthEnd, GrowthEndKind, Stability, StepRecord, TipRecord, TipStatus};
use crate::crack::TipId;
use crate::fracture::fatigue::{self, LoadCycle, Rate};
use crate::fracture::growth_criterion::TipDriving;
use crate::model::Model;

/// A crack is closed if K_I is below minus this part of K_II: in pure shear noise must not decide.
const CLOSURE: f64 = 0.01;
/// Tips driven less than this part of the hardest driven one are in its shadow: their factors are noise.
const SHADOW: f64 = 0.01;
/// Tips driven less than this part of the hardest driven one of all steps are in pieces that carry nothing any more: what is
/// left of their factors is rounding.
const ROUNDING: f64 = 1e-7;
/// Growth shorter than this part of the step's increment is saved up.
const LEAST_SHARE: f64 = 0.05;
/// An increment that converges is never halved below this share.
pub(super) const LEAST_SCALE: f64 = 1.0 / 16.0;

/// A tip that grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TipPlan {
    pub tip: TipId,
    /// Turn against the direction ahead [rad].
    pub angle: f64,
    /// Length of its increment [length].
    pub length: f64,
    /// Equivalent factor [stress·√length].
    pub k_equivalent: f64,
    /// Error bar of the factors [stress·√length].
    pub k_uncertainty: f64,
}

/// Growth that is saved up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pending {
    pub tip: TipId,
    /// From earlier steps [length].
    pub before: f64,
    /// In this step, if it is taken whole [length].
    pub added: f64,
}

/// All tips that grow, and what is saved up for others.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct StepPlan {
    pub tips: Vec<TipPlan>,
    pub pending: Vec<Pending>,
}

/// Fills what growth adds to the record of a step, and says which tips grow.
///
/// - `increment`: length of a whole increment [length]
/// - `state`: of this step; gets the share of the increment that the control has left
pub(super) fn plan_step(
    model: &Model,
    growth: &GrowthSettings,
    increment: f64,
    step: &mut StepRecord,
    state: &mut GrowthState,
) -> StepPlan {
    for (crack, record) in step.cracks.iter_mut().enumerate() {
        let held = growth.held.contains(&record.name);
        record.tips.iter_mut().for_each(|tip| judge(model, growth, tip, held));
        debug_assert_eq!(model.cracks[crack].name, record.name);
    }
    set_unloaded_aside(step, state);
    control(growth.control, step, state);
    let length = increment * state.scale;
    let plan = match &growth.law {
        AdvanceLaw::Equal => equal(step, length),
        AdvanceLaw::QuasiStatic(law) => quasi_static(model, law, step, state, length),
        AdvanceLaw::Fatigue(law) => {
            let cycles = law.spectrum.cycles();
            step.end = count_cycles(&law.rate, &cycles, step, state);
            by_rate(&law.rate, &cycles, step, state, length)
        }
    };
    step.end = step.end.take().or_else(|| reached_limit(model, growth, step)).or_else(|| nothing_grows(step, &plan));
    match step.end {
        Some(_) => StepPlan::default(),
        None => plan,
    }
}

/// Criterion and closure of one tip.
fn judge(model: &Model, growth: &GrowthSettings, tip: &mut TipRecord, held: bool) {
    let (Some(k1), Some(k2)) = (tip.k1, tip.k2) else {
        tip.reason = Some("no integration domain fits around the tip".into());
        return;
    };
    let driving = TipDriving { k1, k2, t_stress: tip.t_stress.unwrap_or(0.0), force: tip.configurational_force };
    tip.kink_angle = Some(growth.criterion.kink_angle(&driving, &model.material));
    tip.k_equivalent = Some(growth.equivalent.value(k1, k2));
    tip.increment = Some(0.0);
    if held {
        tip.status = TipStatus::Held;
        tip.reason = Some("the case holds this crack".into());
    } else if model.contact.is_some() && tip.status == TipStatus::Closed {
        tip.reason = Some("the faces touch at the tip".into());
    } else if k1 < -CLOSURE * k2.abs() || (k1 <= 0.0 && k2 == 0.0) {
        tip.status = TipStatus::Closed;
        tip.reason = Some(format!("K_I = {k1:.4e} presses the faces together"));
    } else {
        tip.status = TipStatus::Waiting;
    }
}

/// Tips in pieces that have come off and carry nothing do not grow, whatever their factors are.
fn set_unloaded_aside(step: &mut StepRecord, state: &mut GrowthState) {
    state.hardest = hardest(step).map_or(state.hardest, |(_, k)| k.max(state.hardest));
    let tips = step.cracks.iter_mut().flat_map(|c| &mut c.tips);
    for tip in tips.filter(|t| t.status == TipStatus::Waiting) {
        let k = tip.k_equivalent.unwrap_or(0.0);
        if k < ROUNDING * state.hardest {
            tip.status = TipStatus::Unloaded;
            tip.reason = Some(format!("K_equivalent = {k:.2e} is rounding beside {:.3e} of before", state.hardest));
        }
    }
}

/// Share of the increment after the turns of this step.
fn control(control: IncrementControl, step: &StepRecord, state: &mut GrowthState) {
    let IncrementControl::HalvedOnTurns { angle_deg, least } = control else { return };
    let turns = open_tips(step).filter_map(|(_, t)| t.kink_angle);
    let turn = turns.fold(0.0, |m: f64, t| m.max(t.abs())).to_degrees();
    if turn > angle_deg {
        state.scale = (0.5 * state.scale).max(least.min(state.scale));
    } else if turn < 0.5 * angle_deg {
        state.scale = (2.0 * state.scale).min(1.0);
    }
}

/// Tips that may grow, with their ids.
fn open_tips(step: &StepRecord) -> impl Iterator<Item = (TipId, &TipRecord)> {
    all_tips(step).filter(|(_, t)| t.status == TipStatus::Waiting)
}

fn all_tips(step: &StepRecord) -> impl Iterator<Item = (TipId, &TipRecord)> {
    let cracks = step.cracks.iter().enumerate();
    cracks.flat_map(|(crack, record)| record.tips.iter().map(move |t| (TipId { crack, end: t.end }, t)))
}

/// The record of a tip.
pub(super) fn record_mut(step: &mut StepRecord, tip: TipId) -> &mut TipRecord {
    let tips = &mut step.cracks[tip.crack].tips;
    tips.iter_mut().find(|t| t.end == tip.end).expect("plans are made from the records")
}

/// The tip that is driven hardest, and how hard.
fn hardest(step: &StepRecord) -> Option<(TipId, f64)> {
    let driven = open_tips(step).filter_map(|(id, t)| Some((id, t.k_equivalent?)));
    driven.filter(|(_, k)| *k > 0.0).max_by(|a, b| a.1.total_cmp(&b.1))
}

fn tip_name(step: &StepRecord, tip: TipId) -> String {
    let end = if tip.end.index() == 0 { "start" } else { "end" };
    format!("{}, {end}", step.cracks[tip.crack].name)
}

/// Lets a tip grow.
fn grow(step: &mut StepRecord, tip: TipId, length: f64, reason: String, plan: &mut StepPlan) {
    let record = record_mut(step, tip);
    record.status = TipStatus::Growing;
    record.increment = Some(length);
    record.reason = Some(reason);
    let (angle, k_equivalent) = (record.kink_angle.unwrap_or(0.0), record.k_equivalent.unwrap_or(0.0));
    let k_uncertainty = record.k_uncertainty.unwrap_or(0.0);
    plan.tips.push(TipPlan { tip, angle, length, k_equivalent, k_uncertainty });
}

/// Every open tip that is not in the shadow of another.
fn equal(step: &mut StepRecord, length: f64) -> StepPlan {
    let mut plan = StepPlan::default();
    let Some((leader, most)) = hardest(step) else { return plan };
    let open: Vec<(TipId, f64)> = open_tips(step).map(|(id, t)| (id, t.k_equivalent.unwrap_or(0.0))).collect();
    for (tip, k) in open {
        if k > SHADOW * most {
            grow(step, tip, length, format!("K_equivalent = {k:.5e}"), &mut plan);
        } else {
            let reason = format!("K_equivalent = {k:.2e} is noise beside {most:.3e} at {}", tip_name(step, leader));
            record_mut(step, tip).reason = Some(reason);
        }
    }
    plan
}

/// The tips that the toughness is reached at first.
fn quasi_static(model: &Model, law: &QuasiStatic, step: &mut StepRecord, state: &GrowthState, length: f64) -> StepPlan {
    let mut plan = StepPlan::default();
    let Some((leader, most)) = hardest(step) else { return plan };
    let toughness = law.toughness(&model.material);
    step.load_factor = toughness / most;
    step.stability = state.load_factor.map(|before| match step.load_factor >= before {
        true => Stability::Stable,
        false => Stability::Unstable,
    });
    let open: Vec<(TipId, f64)> = open_tips(step).map(|(id, t)| (id, t.k_equivalent.unwrap_or(0.0))).collect();
    for (tip, k) in open {
        if k >= (1.0 - law.tie) * most {
            let factor = step.load_factor;
            grow(step, tip, length, format!("reaches the toughness at a load factor of {factor:.5e}"), &mut plan);
        } else {
            let reason =
                format!("K_equivalent = {k:.5e} is below {most:.5e} at {}, which grows", tip_name(step, leader));
            record_mut(step, tip).reason = Some(reason);
        }
    }
    plan
}

/// Adds the cycles of the last increment, now that the factor after it is known. An increment that no number of cycles
/// makes is the end.
fn count_cycles(
    law: &fatigue::GrowthLaw,
    cycles: &[LoadCycle],
    step: &mut StepRecord,
    state: &mut GrowthState,
) -> Option<GrowthEnd> {
    let mut end = None;
    if let Some(leader) = state.leader.take() {
        let [a_start, a_end] = leader.lengths;
        let tip = all_tips(step).find(|(id, _)| *id == leader.tip).map(|(_, t)| t);
        let now = tip.and_then(|t| t.k_equivalent);
        // A tip that has arrived somewhere has no factor any more; that of a crack in a wide body stands in.
        let k_end = now.filter(|k| *k > 0.0).unwrap_or(leader.k_equivalent * (a_end / a_start).sqrt());
        let way = fatigue::Increment { a_start, a_end, k_start: leader.k_equivalent, k_end };
        let life = fatigue::cycles_over(law, cycles, way).cycles;
        if life.is_finite() {
            state.cycles += life;
            let bars = [leader.k_uncertainty, tip.and_then(|t| t.k_uncertainty).unwrap_or(leader.k_uncertainty)];
            for (bound, sign) in state.cycles_range.iter_mut().zip([1.0, -1.0]) {
                let [k_start, k_end] = [way.k_start + sign * bars[0], way.k_end + sign * bars[1]].map(|k| k.max(0.0));
                let life = fatigue::cycles_over(law, cycles, fatigue::Increment { k_start, k_end, ..way }).cycles;
                // A state is written as JSON, which knows no infinity.
                *bound = (*bound + life).min(f64::MAX);
            }
        } else {
            let reason = format!(
                "{} creeps towards its threshold: K_equivalent falls from {:.5e} to {k_end:.5e} over the last increment",
                tip_name(step, leader.tip),
                leader.k_equivalent
            );
            end = Some(GrowthEnd { kind: GrowthEndKind::NoTipGrows, reason });
        }
    }
    step.cycles = Some(state.cycles);
    step.cycles_range = Some(state.cycles_range.map(|c| if c < f64::MAX { c } else { f64::INFINITY }));
    end
}

/// Every tip by its growth per cycle.
fn by_rate(
    law: &fatigue::GrowthLaw,
    cycles: &[LoadCycle],
    step: &mut StepRecord,
    state: &GrowthState,
    length: f64,
) -> StepPlan {
    let mut plan = StepPlan::default();
    let mut rates: Vec<(TipId, f64)> = vec![];
    let open: Vec<(TipId, f64)> = open_tips(step).map(|(id, t)| (id, t.k_equivalent.unwrap_or(0.0))).collect();
    for (tip, k) in open {
        let record = record_mut(step, tip);
        match fatigue::mean_rate(law, cycles, k.max(0.0)) {
            Rate::Growing(rate) => {
                record.growth_rate = Some(rate);
                rates.push((tip, rate));
            }
            Rate::Arrested => {
                record.growth_rate = Some(0.0);
                record.status = TipStatus::Arrested;
                record.reason = Some(format!("K_equivalent = {k:.5e} is below the threshold in every cycle"));
            }
            Rate::Unstable => {
                record.status = TipStatus::Unstable;
                let toughness = law.toughness().unwrap_or(f64::NAN);
                let at_most = k * cycles.iter().map(|c| c.maximum).fold(0.0, f64::max);
                record.reason =
                    Some(format!("K = {at_most:.5e} at the greatest load reaches the toughness {toughness:.5e}"));
            }
        }
    }
    let fastest = rates.iter().map(|r| r.1).fold(0.0, f64::max);
    for (tip, rate) in rates {
        let share = rate / fastest;
        let (before, added) = (state.memory(tip).pending, share * length);
        let wanted = before + added;
        if wanted >= LEAST_SHARE * length {
            grow(step, tip, wanted, format!("grows by {rate:.4e} a cycle"), &mut plan);
        } else {
            plan.pending.push(Pending { tip, before, added });
            let reason = format!("grows by {rate:.4e} a cycle, {share:.1e} of the fastest; {wanted:.3e} is saved up");
            record_mut(step, tip).reason = Some(reason);
        }
    }
    plan
}

/// The tip that sets the pace: it is driven hardest, the first of equals.
pub(super) fn leader(plan: &StepPlan, model: &Model) -> Option<Leader> {
    let hardest = plan.tips.iter().map(|t| t.k_equivalent).fold(0.0, f64::max);
    let tip = plan.tips.iter().find(|t| t.k_equivalent == hardest)?;
    let length = model.cracks[tip.tip.crack].handbook_length();
    let k_uncertainty = tip.k_uncertainty;
    Some(Leader { tip: tip.tip, lengths: [length; 2], k_equivalent: tip.k_equivalent, k_uncertainty })
}

fn reached_limit(model: &Model, growth: &GrowthSettings, step: &StepRecord) -> Option<GrowthEnd> {
    let unstable = all_tips(step).find(|(_, t)| t.status == TipStatus::Unstable);
    if let Some((tip, record)) = unstable {
        let reason = format!("{}: {}", tip_name(step, tip), record.reason.clone().unwrap_or_default());
        return Some(GrowthEnd { kind: GrowthEndKind::ToughnessReached, reason });
    }
    let limit = |reason: String| Some(GrowthEnd { kind: GrowthEndKind::LimitReached, reason });
    let stop = &growth.stop;
    if let (Some(most), Some(cycles)) = (stop.cycles, step.cycles)
        && cycles >= most
    {
        return limit(format!("{cycles:.6e} load cycles, {most:.6e} were asked for"));
    }
    if let Some(most) = stop.crack_length
        && let Some(crack) = model.cracks.iter().find(|c| c.handbook_length() >= most)
    {
        return limit(format!("{} is {:.6} long, {most:.6} is the limit", crack.name, crack.handbook_length()));
    }
    if let Some(most) = stop.load_factor
        && step.load_factor > most
    {
        return limit(format!("growth needs a load factor of {:.6e}, {most:.6e} is the limit", step.load_factor));
    }
    if step.step >= growth.steps {
        return Some(GrowthEnd { kind: GrowthEndKind::StepsDone, reason: format!("{} steps are done", growth.steps) });
    }
    None
}

fn nothing_grows(step: &StepRecord, plan: &StepPlan) -> Option<GrowthEnd> {
    if !plan.tips.is_empty() {
        return None;
    }
    let mut reasons: Vec<String> = vec![];
    for (tip, record) in all_tips(step) {
        let reason = record.reason.clone().unwrap_or("it is not driven".into());
        reasons.push(format!("{}: {reason}", tip_name(step, tip)));
    }
    let reason = if reasons.is_empty() { "no crack tip is left".into() } else { reasons.join("; ") };
    Some(GrowthEnd { kind: GrowthEndKind::NoTipGrows, reason })
}
