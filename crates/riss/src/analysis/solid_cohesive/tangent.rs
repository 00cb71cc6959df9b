//! Where the path of a cohesive crack goes from a state.

use super::path::Path;

/// Rounds that settle which pairs unload.
const SETTLINGS: usize = 6;

/// Rates of load factor and openings along the path.
#[derive(Clone)]
pub(super) struct Tangent {
    /// Of the load factor.
    pub load_factor: f64,
    /// Of the openings, by columns.
    pub openings: Vec<f64>,
}

impl Path<'_> {
    /// Direction of the path, onwards.
    pub(super) fn find_tangent(&self) -> Option<Tangent> {
        let unknown = self.open_columns();
        let n = unknown.len();
        let c = self.condensed;
        let mut last = vec![0.0; n + 1];
        if let (true, Some(before)) = (self.opened.is_empty(), &self.tangent) {
            let (scale, first) = (self.law.opening_scale(), self.load_unit());
            let units = unknown.iter().map(|(_, column)| before.openings[*column] / (scale * scale));
            last.iter_mut().zip(units.chain([before.load_factor / (first * first)])).for_each(|(l, v)| *l = v);
        } else {
            let is_new = |pair: usize, column: usize| self.opened.contains(&pair) && column == c.columns[pair];
            unknown.iter().zip(&mut last).for_each(|((p, column), l)| *l = f64::from(is_new(*p, *column)));
        }
        let largest = last.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        last.iter_mut().for_each(|v| *v /= largest);
        // Whoever is at the largest opening so far is taken to go on, until its rate says otherwise.
        let mut history = self.state.history.clone();
        for _ in 0..SETTLINGS {
            let mut right = vec![0.0; n + 1];
            right[n] = 1.0;
            self.factored(&unknown, &self.state, &history, &last).solve_in_place(&mut right);
            if right.iter().any(|v| !v.is_finite()) {
                return None;
            }
            let mut openings = vec![0.0; self.state.openings.len()];
            unknown.iter().zip(&right).for_each(|((_, column), v)| openings[*column] = *v);
            let mut changed = false;
            for pair in (0..c.n_pairs()).filter(|k| self.state.is_open[*k]) {
                let (w, rate) = (c.opening_of(pair, &self.state.openings), c.opening_of(pair, &openings));
                let loads = self.law.effective(w) >= history[pair];
                let beta = self.law.shear_ratio.powi(2);
                let growth = w[0].max(0.0) * rate[0] + beta * (w[1] * rate[1] + w[2] * rate[2]);
                if loads && growth < 0.0 {
                    history[pair] *= 1.0 + 1e-6;
                    changed = true;
                }
            }
            if !changed {
                return Some(Tangent { load_factor: right[n], openings });
            }
        }
        None
    }

    /// Largest rate of a tangent, in units of its step.
    pub(super) fn size(&self, tangent: &Tangent) -> f64 {
        let largest = tangent.openings.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        (largest / self.law.opening_scale()).max(tangent.load_factor.abs() / self.load_unit())
    }

    /// The pair that reaches its strength first within a length, and where.
    pub(super) fn next_pair(&self, tangent: &Tangent, length: f64) -> Option<(usize, f64)> {
        let now = self.tractions();
        let rates = self.condensed.tractions(tangent.load_factor, &tangent.openings);
        let mut first: Option<(usize, f64)> = None;
        for pair in (0..self.condensed.n_pairs()).filter(|k| !self.state.is_open[*k]) {
            let own = self.condensed.of_pair(pair, &now);
            let gradient = self.law.exhaustion_gradient(own);
            let rate = self.condensed.of_pair(pair, &rates);
            let growth: f64 = gradient.iter().zip(rate).map(|(g, r)| g * r).sum();
            let reach = (1.0 - self.law.exhaustion(own)) / growth;
            if growth > 0.0 && reach < first.map_or(length, |f| f.1) {
                first = Some((pair, reach.max(0.0)));
            }
        }
        first
    }
}
