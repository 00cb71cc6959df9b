//! Where the path of a cohesive crack goes from a state.

use super::path::Path;

/// Rounds that settle which pairs unload.
const SETTLINGS: usize = 6;
/// The same one by one, over the number of pairs.
const SETTLINGS_ONE_BY_ONE: usize = 2;
/// Largest rate of other openings and of the load over that of a pair that has just come to its strength.
const MOST_RATIO: f64 = 1e6;

/// Rates of load factor and openings along the path.
#[derive(Clone)]
pub(in crate::analysis) struct Tangent {
    /// Of the load factor.
    pub load_factor: f64,
    /// Of the openings, by columns.
    pub openings: Vec<f64>,
    /// Whether each pair goes along its secant, not along the softening curve.
    pub unloads: Vec<bool>,
}

impl Path<'_> {
    /// Direction of the path, onwards.
    pub(super) fn find_tangent(&self) -> Option<Tangent> {
        let unknown = self.open_columns();
        let along_new = || {
            let is_new =
                |pair: usize, column: usize| self.opened.contains(&pair) && column == self.condensed.columns[pair];
            let new: Vec<f64> = unknown.iter().map(|(p, column)| f64::from(is_new(*p, *column))).chain([0.0]).collect();
            // Pairs that do not open although they may leave the path where it would have gone.
            self.settled(&unknown, &new).filter(|t| self.size(t) * self.law.opening_scale() < MOST_RATIO)
        };
        if self.opened.is_empty() { self.onwards(&unknown) } else { along_new().or_else(|| self.onwards(&unknown)) }
    }

    /// The tangent that goes on as the one before.
    fn onwards(&self, unknown: &[(usize, usize)]) -> Option<Tangent> {
        let before = self.tangent.as_ref()?;
        let (scale, first) = (self.law.opening_scale(), self.load_unit());
        let units = unknown.iter().map(|(_, column)| before.openings[*column] / (scale * scale));
        let last: Vec<f64> = units.chain([before.load_factor / (first * first)]).collect();
        self.settled(unknown, &last)
    }

    /// The tangent whose product with `last` is positive, with what loads and what unloads in it.
    ///
    /// Whoever is at the largest opening so far is taken to go on, until its rate says otherwise; in the end one pair at a
    /// time changes its mind, the last first, so that no two of them do so in turn forever [Murty1974].
    fn settled(&self, unknown: &[(usize, usize)], last: &[f64]) -> Option<Tangent> {
        let (n, n_pairs) = (unknown.len(), self.condensed.n_pairs());
        let largest = last.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let last: Vec<f64> = last.iter().map(|v| v / largest).collect();
        let may_load: Vec<bool> = (0..n_pairs).map(|k| self.is_at_largest(k)).collect();
        let mut unloads: Vec<bool> = may_load.iter().map(|may| !may).collect();
        for round in 0..SETTLINGS + SETTLINGS_ONE_BY_ONE * n_pairs {
            let mut right = vec![0.0; n + 1];
            right[n] = 1.0;
            self.factored(unknown, &self.state, &unloads, &last).solve_in_place(&mut right);
            if right.iter().any(|v| !v.is_finite()) {
                return None;
            }
            let mut openings = vec![0.0; self.state.openings.len()];
            unknown.iter().zip(&right).for_each(|((_, column), v)| openings[*column] = *v);
            let is_wrong = |k: &usize| {
                let growth = self.growth(*k, &openings);
                may_load[*k] && if unloads[*k] { growth > 0.0 } else { growth < 0.0 }
            };
            let mut wrong = (0..n_pairs).filter(is_wrong);
            let changed: Vec<usize> =
                if round < SETTLINGS { wrong.collect() } else { wrong.next_back().into_iter().collect() };
            if changed.is_empty() {
                return Some(Tangent { load_factor: right[n], openings, unloads });
            }
            changed.into_iter().for_each(|k| unloads[k] = !unloads[k]);
        }
        None
    }

    /// Whether a pair is open as far as it ever was.
    fn is_at_largest(&self, pair: usize) -> bool {
        self.state.is_open[pair] && self.effective(pair, &self.state.openings) >= self.state.history[pair]
    }

    /// Rate of the effective opening of a pair, in its own unit.
    pub(super) fn growth(&self, pair: usize, rates: &[f64]) -> f64 {
        let [n, s, t] = self.condensed.opening_of(pair, &self.state.openings);
        let [dn, ds, dt] = self.condensed.opening_of(pair, rates);
        n.max(0.0) * dn + self.law.shear_ratio.powi(2) * (s * ds + t * dt)
    }

    /// Largest rate of a tangent, in units of its step.
    pub(super) fn size(&self, tangent: &Tangent) -> f64 {
        let largest = tangent.openings.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        (largest / self.law.opening_scale()).max(tangent.load_factor.abs() / self.load_unit())
    }
}
