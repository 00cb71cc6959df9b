//! The path of equilibrium of a cohesive crack, through snap-backs.
//!
//! From pair to pair: for each set of opened pairs the load is found at which the next one just reaches its strength; the
//! load factor is one more unknown, and that condition one more equation. Where the next pair is far, steps along the
//! tangent of the path take its place [Riks1979].

use super::condensed::Condensed;
use super::events::Event;
use super::tangent::Tangent;
use crate::material::{Branch, Cohesion, CohesiveLaw};
use crate::system::dense_lu::DenseLu;
use serde::{Deserialize, Serialize};

/// Pairs this near to their strength open together.
const TOGETHER: f64 = 1e-6;
/// Largest residual of tractions over the strength.
const RESIDUAL: f64 = 1e-9;
/// How far from its length a step along the tangent may end, over that length.
const OFF_LENGTH: f64 = 1e-6;
/// Stiffness of faces that slide freely, over `f_t²/G_f`.
const HOLD: f64 = 1e-6;
/// How far from its branch a pair may be in a converged step, over `G_f/f_t`.
const OFF_BRANCH: f64 = 1e-6;
/// Longest step: largest change of an opening over `G_f/f_t`, and of the load factor over itself.
const LONGEST: f64 = 0.05;
/// A step shorter than this is given up.
const SHORTEST: f64 = 1e-9;
/// Newton's iterations, and pairs that are tried as the next, in one step.
const ITERATIONS: usize = 14;
const TRIALS: usize = 8;
/// A step may come out this many times as long as planned.
const OVERSHOOT: f64 = 5.0;

/// Where a cohesive crack stands. The same state goes on in the same way, bit by bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CohesiveState {
    /// Factor on all loads.
    pub load_factor: f64,
    /// Openings: components of each pair [length].
    pub openings: Vec<f64>,
    /// Largest effective opening of each pair so far [length].
    pub history: Vec<f64>,
    /// Whether each pair has reached its strength.
    pub is_open: Vec<bool>,
    /// Shear that each pair bore when it opened [stress]; where faces slide freely it fades as the pair softens.
    pub shear: Vec<[f64; 2]>,
}

/// What makes a step a step.
enum Target<'a> {
    /// Something happens to a pair.
    Event(Event),
    /// The state lies in the plane across a tangent, at the predicted place.
    Across { tangent: &'a Tangent, from: &'a CohesiveState, length: f64 },
}

/// Follows the path.
pub(in crate::analysis) struct Path<'a> {
    pub(super) condensed: &'a Condensed,
    pub(super) law: &'a CohesiveLaw,
    pub state: CohesiveState,
    pub(super) tangent: Option<Tangent>,
    /// Pairs that came to the softening curve in the last step: for the first time, or back on their secants.
    pub(super) opened: Vec<usize>,
    /// First critical load factor.
    first: f64,
    longest: f64,
}

impl<'a> Path<'a> {
    /// At rest.
    pub fn new(condensed: &'a Condensed, law: &'a CohesiveLaw) -> Self {
        let n = condensed.n_pairs();
        let n_columns = condensed.columns[n];
        let state = CohesiveState {
            load_factor: 0.0,
            openings: vec![0.0; n_columns],
            history: vec![0.0; n],
            is_open: vec![false; n],
            shear: vec![[0.0; 2]; n],
        };
        Self { condensed, law, state, tangent: None, opened: vec![], first: 0.0, longest: LONGEST }
    }

    /// Tractions of all pairs [stress].
    pub fn tractions(&self) -> Vec<f64> {
        self.condensed.tractions(self.state.load_factor, &self.state.openings)
    }

    /// Loads up to the first pair that reaches its strength; none does if the answer is no.
    pub fn begin(&mut self) -> bool {
        let tractions = self.condensed.tractions(1.0, &self.state.openings);
        let most = (0..self.condensed.n_pairs()).map(|k| self.exhaustion(k, &tractions)).fold(0.0, f64::max);
        if !(most > 0.0 && most.is_finite()) {
            return false;
        }
        (self.first, self.state.load_factor) = (1.0 / most, 1.0 / most);
        self.open_exhausted();
        true
    }

    /// Goes one step on; no if none converges.
    pub fn advance(&mut self) -> bool {
        let Some(tangent) = self.find_tangent() else { return false };
        let size = self.size(&tangent);
        let mut length = self.longest / size;
        loop {
            let (mut candidate, mut shortened) = (self.next_event(&tangent, length), false);
            for _ in 0..TRIALS {
                let reach = candidate.map_or(length, |c: (Event, f64)| c.1);
                let mut trial = self.predicted(&tangent, reach);
                let target = match candidate {
                    Some((event, _)) => Target::Event(event),
                    None => Target::Across { tangent: &tangent, from: &self.state, length: reach },
                };
                if !self.converge(&mut trial, &tangent.unloads, &target)
                    || !self.is_ahead(&tangent, &trial, length.max(reach))
                    || !self.keeps_branches(&trial, &tangent.unloads)
                {
                    break;
                }
                match self.missed_event(&trial, &tangent.unloads) {
                    Some(event) if candidate.is_some_and(|c| c.0 == event) => break,
                    Some(event) => {
                        candidate = Some((event, reach));
                        shortened = true;
                    }
                    None => {
                        self.accept(trial, tangent, candidate.map(|c| c.0));
                        self.longest = if shortened { self.longest } else { (1.5 * self.longest).min(LONGEST) };
                        return true;
                    }
                }
            }
            length *= 0.5;
            self.longest = (0.5 * self.longest).max(SHORTEST);
            if length * size < SHORTEST {
                return false;
            }
        }
    }

    /// Effective opening of a pair.
    pub(super) fn effective(&self, pair: usize, openings: &[f64]) -> f64 {
        self.law.effective(self.condensed.opening_of(pair, openings))
    }

    /// What changes of the load factor are measured by.
    pub(super) fn load_unit(&self) -> f64 {
        self.state.load_factor.abs().max(self.first)
    }

    /// How far a pair is exhausted.
    pub(super) fn exhaustion(&self, pair: usize, tractions: &[f64]) -> f64 {
        self.law.exhaustion(self.condensed.of_pair(pair, tractions))
    }

    /// Traction of an opened pair and its derivative.
    fn cohesion(&self, pair: usize, state: &CohesiveState, unloads: bool) -> Cohesion {
        let opening = self.condensed.opening_of(pair, &state.openings);
        let largest = state.history[pair].max(self.law.first_opening());
        let branch = if unloads { Branch::Secant(largest) } else { Branch::Softening };
        let mut found = self.law.cohesion_on(opening, branch);
        let at = if unloads { largest } else { self.law.effective(opening) };
        let [t, slope, _] = self.law.softening(at);
        for (k, shear) in state.shear[pair].into_iter().enumerate() {
            found.traction[k + 1] += shear * t / self.law.strength;
            if self.law.shear_ratio == 0.0 {
                // Two parts that nothing else holds beside each other stay where they are.
                let hold = HOLD * self.law.strength / self.law.opening_scale();
                found.traction[k + 1] += hold * opening[k + 1];
                found.tangent[k + 1][k + 1] += hold;
            }
            if !unloads {
                found.tangent[k + 1][0] += shear * slope / self.law.strength;
            }
        }
        found
    }

    /// Unknown columns.
    pub(super) fn open_columns(&self) -> Vec<(usize, usize)> {
        let columns = &self.condensed.columns;
        let open = (0..self.condensed.n_pairs()).filter(|k| self.state.is_open[*k]);
        open.flat_map(|k| (columns[k]..columns[k + 1]).map(move |c| (k, c))).collect()
    }

    /// Residuals of the opened pairs in their columns' order, and the tractions of all.
    fn residuals(&self, unknown: &[(usize, usize)], trial: &CohesiveState, unloads: &[bool]) -> (Vec<f64>, Vec<f64>) {
        let c = self.condensed;
        let tractions = c.tractions(trial.load_factor, &trial.openings);
        let own = |(pair, column): &(usize, usize)| {
            let k = column - c.columns[*pair];
            let cohesion = self.cohesion(*pair, trial, unloads[*pair]);
            tractions[c.rows[*pair] + k] - cohesion.traction[k]
        };
        (unknown.iter().map(own).collect(), tractions)
    }

    /// The Jacobian of the residuals, with a last row.
    ///
    /// - `unloads`: whether each pair follows its secant
    /// - `last`: coefficients of the openings, then that of the load factor
    pub(super) fn factored(
        &self,
        unknown: &[(usize, usize)],
        trial: &CohesiveState,
        unloads: &[bool],
        last: &[f64],
    ) -> DenseLu {
        let c = self.condensed;
        let n = unknown.len();
        let cohesion: Vec<_> =
            unknown.iter().map(|(pair, _)| self.cohesion(*pair, trial, unloads[*pair]).tangent).collect();
        DenseLu::new(n + 1, |i, j| {
            if i == n {
                return last[j];
            }
            let (pair, column) = unknown[i];
            let k = column - c.columns[pair];
            let row = c.rows[pair] + k;
            if j == n {
                return c.by_load(row);
            }
            let (other, opening) = unknown[j];
            let own = if other == pair { cohesion[i][k][opening - c.columns[pair]] } else { 0.0 };
            c.by_opening(row, opening) - own
        })
    }

    /// Newton's method on given branches, so that it meets no kinks; the trial is a solution if the answer is yes.
    fn converge(&self, trial: &mut CohesiveState, unloads: &[bool], target: &Target<'_>) -> bool {
        let unknown = self.open_columns();
        let allowed = match target {
            Target::Event(_) => RESIDUAL,
            Target::Across { .. } => OFF_LENGTH,
        };
        for _ in 0..ITERATIONS {
            let (mut right, tractions) = self.residuals(&unknown, trial, unloads);
            let (last, excess) = self.target_row(&unknown, trial, &tractions, target);
            let largest = right.iter().fold(0.0, |m: f64, r| m.max(r.abs())) / self.law.strength;
            if !largest.is_finite() {
                return false;
            }
            if largest <= RESIDUAL && excess.abs() <= allowed {
                return true;
            }
            right.push(excess);
            self.factored(&unknown, trial, unloads, &last).solve_in_place(&mut right);
            if right.iter().any(|v| !v.is_finite()) {
                return false;
            }
            for ((_, column), change) in unknown.iter().zip(&right) {
                trial.openings[*column] -= change;
            }
            trial.load_factor -= right[unknown.len()];
        }
        false
    }

    /// The last equation: its row, and by how much it fails.
    fn target_row(
        &self,
        unknown: &[(usize, usize)],
        trial: &CohesiveState,
        tractions: &[f64],
        target: &Target<'_>,
    ) -> (Vec<f64>, f64) {
        match target {
            Target::Event(event) => self.event_row(*event, unknown, trial, tractions),
            Target::Across { tangent, from, length } => {
                let (scale, first) = (self.law.opening_scale(), self.load_unit());
                let square = |v: f64, unit: f64| (v / unit) * (v / unit);
                let norm = unknown.iter().map(|(_, c)| square(tangent.openings[*c], scale)).sum::<f64>()
                    + square(tangent.load_factor, first);
                let (to_openings, to_load) =
                    (1.0 / (scale * scale * norm * length), 1.0 / (first * first * norm * length));
                let mut last: Vec<f64> = unknown.iter().map(|(_, c)| tangent.openings[*c] * to_openings).collect();
                last.push(tangent.load_factor * to_load);
                let done: f64 = unknown
                    .iter()
                    .zip(&last)
                    .map(|((_, c), l)| l * (trial.openings[*c] - from.openings[*c]))
                    .sum::<f64>()
                    + last[unknown.len()] * (trial.load_factor - from.load_factor);
                (last, done - 1.0)
            }
        }
    }

    fn predicted(&self, tangent: &Tangent, length: f64) -> CohesiveState {
        let mut trial = self.state.clone();
        trial.load_factor += length * tangent.load_factor;
        trial.openings.iter_mut().zip(&tangent.openings).for_each(|(w, rate)| *w += length * rate);
        trial
    }

    /// Whether a solution lies onwards and near.
    fn is_ahead(&self, tangent: &Tangent, trial: &CohesiveState, length: f64) -> bool {
        let (scale, first) = (self.law.opening_scale(), self.load_unit());
        let load = (trial.load_factor - self.state.load_factor) / first;
        let changes = trial.openings.iter().zip(&self.state.openings).map(|(a, b)| (a - b) / scale);
        let (mut along, mut largest) = (load * tangent.load_factor / first, load.abs());
        for (change, rate) in changes.zip(&tangent.openings) {
            along += change * rate / scale;
            largest = largest.max(change.abs());
        }
        along >= 0.0 && largest <= OVERSHOOT * length * self.size(tangent)
    }

    /// Whether pairs that soften have opened.
    fn keeps_branches(&self, trial: &CohesiveState, unloads: &[bool]) -> bool {
        let allowed = OFF_BRANCH * self.law.opening_scale();
        let softens = |k: &usize| self.state.is_open[*k] && !unloads[*k];
        (0..self.condensed.n_pairs())
            .filter(softens)
            .all(|k| self.effective(k, &trial.openings) >= self.state.history[k] - allowed)
    }

    fn accept(&mut self, trial: CohesiveState, tangent: Tangent, event: Option<Event>) {
        self.state = trial;
        for pair in (0..self.condensed.n_pairs()).filter(|k| self.state.is_open[*k]) {
            // Those that soften stay on the curve, where a step has closed one by next to nothing.
            let returns = event == Some(Event::Returns(pair));
            let before = if tangent.unloads[pair] && !returns { self.state.history[pair] } else { 0.0 };
            self.state.history[pair] = self.effective(pair, &self.state.openings).max(before);
        }
        self.tangent = Some(tangent);
        self.open_exhausted();
        if let Some(Event::Returns(pair)) = event {
            self.opened.push(pair);
        }
    }

    /// Opens the pairs at their strength.
    fn open_exhausted(&mut self) {
        let tractions = self.tractions();
        self.opened = (0..self.condensed.n_pairs())
            .filter(|k| !self.state.is_open[*k] && self.exhaustion(*k, &tractions) >= 1.0 - TOGETHER)
            .collect();
        for pair in self.opened.clone() {
            let (first, strength) = (self.law.first_opening(), self.law.strength);
            let [n, s, t] = self.condensed.of_pair(pair, &tractions);
            self.state.is_open[pair] = true;
            // Whatever the pair bears when it opens, it bears still.
            let opening = if self.law.shear_ratio == 0.0 {
                self.state.shear[pair] = [s, t];
                [first, 0.0, 0.0]
            } else {
                let across = strength * self.law.shear_ratio.powi(2);
                [first * n.max(0.0) / strength, first * s / across, first * t / across]
            };
            let columns = self.condensed.columns[pair]..self.condensed.columns[pair + 1];
            columns.zip(opening).for_each(|(column, w)| self.state.openings[column] = w);
            // Round-off must not take it for a pair that has closed a little.
            self.state.history[pair] = self.effective(pair, &self.state.openings);
        }
    }
}
