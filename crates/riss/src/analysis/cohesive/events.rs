//! What may happen to a pair along the path: it comes to the softening curve, for the first time or again.

use super::path::{CohesiveState, Path};
use super::tangent::Tangent;

/// How far beyond an event a pair may be in a converged step, over its strength or its largest opening.
const EXCESS: f64 = 1e-7;

/// Something that happens to a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Event {
    /// A tied pair reaches its strength.
    Reaches(usize),
    /// A pair that had unloaded is open again as far as it ever was.
    Returns(usize),
}

impl Path<'_> {
    /// The first event within a length, and where.
    pub(super) fn next_event(&self, tangent: &Tangent, length: f64) -> Option<(Event, f64)> {
        let now = self.tractions();
        let rates = self.condensed.tractions(tangent.load_factor, &tangent.openings);
        let mut first: Option<(Event, f64)> = None;
        for pair in 0..self.condensed.n_pairs() {
            let (event, left, rate) = if !self.state.is_open[pair] {
                let own = self.condensed.of_pair(pair, &now);
                let gradient = self.law.exhaustion_gradient(own);
                let rates = self.condensed.of_pair(pair, &rates);
                let growth: f64 = gradient.iter().zip(rates).map(|(g, r)| g * r).sum();
                (Event::Reaches(pair), 1.0 - self.law.exhaustion(own), growth)
            } else if tangent.unloads[pair] {
                let effective = self.effective(pair, &self.state.openings);
                let growth = self.growth(pair, &tangent.openings) / effective.max(f64::MIN_POSITIVE);
                (Event::Returns(pair), self.state.history[pair] - effective, growth)
            } else {
                continue;
            };
            let reach = left / rate;
            if rate > 0.0 && reach < first.map_or(length, |f| f.1) {
                first = Some((event, reach.max(0.0)));
            }
        }
        first
    }

    /// The event that a trial has gone farthest beyond.
    pub(super) fn missed_event(&self, trial: &CohesiveState, unloads: &[bool]) -> Option<Event> {
        let tractions = self.condensed.tractions(trial.load_factor, &trial.openings);
        let beyond = |pair: usize| {
            if !self.state.is_open[pair] {
                Some((Event::Reaches(pair), self.exhaustion(pair, &tractions) - 1.0))
            } else if unloads[pair] {
                let largest = self.state.history[pair];
                Some((Event::Returns(pair), self.effective(pair, &trial.openings) / largest - 1.0))
            } else {
                None
            }
        };
        let all = (0..self.condensed.n_pairs()).filter_map(beyond);
        let (event, most) = all.max_by(|a, b| a.1.total_cmp(&b.1))?;
        (most > EXCESS).then_some(event)
    }

    /// The equation of an event: its row in the Jacobian, and by how much it fails.
    pub(super) fn event_row(
        &self,
        event: Event,
        unknown: &[(usize, usize)],
        trial: &CohesiveState,
        tractions: &[f64],
    ) -> (Vec<f64>, f64) {
        let c = self.condensed;
        match event {
            Event::Reaches(pair) => {
                let own = c.of_pair(pair, tractions);
                let gradient = self.law.exhaustion_gradient(own);
                let rows = c.rows[pair]..c.rows[pair + 1];
                let along = |of_row: &dyn Fn(usize) -> f64| -> f64 {
                    rows.clone().enumerate().map(|(k, row)| gradient[k] * of_row(row)).sum()
                };
                let mut last: Vec<f64> =
                    unknown.iter().map(|(_, column)| along(&|row| c.by_opening(row, *column))).collect();
                last.push(along(&|row| c.by_load(row)));
                (last, self.law.exhaustion(own) - 1.0)
            }
            Event::Returns(pair) => {
                let largest = self.state.history[pair];
                let opening = c.opening_of(pair, &trial.openings);
                let gradient = self.law.effective_gradient(opening);
                let slope = |(of, column): &(usize, usize)| match *of == pair {
                    true => gradient[column - c.columns[pair]] / largest,
                    false => 0.0,
                };
                let last = unknown.iter().map(slope).chain([0.0]).collect();
                (last, self.law.effective(opening) / largest - 1.0)
            }
        }
    }
}
