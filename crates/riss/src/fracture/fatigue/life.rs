//! Load cycles that an increment of a crack takes.

use super::growth_law::{GrowthLaw, Rate};
use super::mean_rate::mean_rate;
use super::spectrum::LoadCycle;
use crate::math::gauss_legendre::gauss_legendre;

/// Relative error at which the integration is content.
const TOLERANCE: f64 = 1e-10;
/// Bound on the work.
const MAX_PIECES: usize = 500;
/// Places with jumps and kinks that begin pieces of their own; of more, which are smaller, only every nth does.
const MAX_BREAKS: usize = 200;
/// Points of the rule that counts and of the rule that it is compared with.
const N_POINTS: [usize; 2] = [16, 8];
/// Bisections that narrow a place down to neighboring numbers.
const MAX_BISECTIONS: usize = 100;

/// Growth of a crack by one increment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Increment {
    /// Crack length where it begins [length].
    pub a_start: f64,
    /// Crack length where it ends, not below `a_start` [length].
    pub a_end: f64,
    /// Equivalent stress intensity factor at `a_start` under load factor 1 [stress·√length].
    pub k_start: f64,
    /// The same at `a_end` [stress·√length].
    pub k_end: f64,
}

/// Life of a crack over an increment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LifeOverIncrement {
    /// Load cycles from the start to the ending; infinite if the crack only creeps towards its threshold.
    pub cycles: f64,
    /// Estimate of the numerical error of `cycles` [cycles]; it does not see the small jumps that are left out where more
    /// than 200 cycles of a spectrum pass their thresholds within one increment.
    pub error: f64,
    /// How it ends.
    pub ending: Ending,
}

/// How growth over an increment ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ending {
    /// The end of the increment is reached.
    Grown,
    /// No cycle of the spectrum makes the crack grow any more.
    Arrests {
        /// Crack length there [length].
        at: f64,
    },
    /// The largest load of the spectrum makes the crack run.
    Unstable {
        /// Crack length there [length].
        at: f64,
    },
}

/// Cycles over an increment: N = ∫ da / (da/dN), with the mean rate of the spectrum.
///
/// Between start and end ln K is linear in ln a, as for K ~ a^s; K is linear in a if a length or a stress intensity
/// factor is not positive. The integral takes Gauss points between the places where a cycle of
/// the spectrum passes its threshold, more of them where the rate varies quickly.
///
/// - `cycles`: of one repetition, from [`LoadSpectrum::cycles`](super::LoadSpectrum::cycles)
pub fn cycles_over(law: &GrowthLaw, cycles: &[LoadCycle], increment: Increment) -> LifeOverIncrement {
    let path = Path::through(increment);
    let at = increment.a_start;
    let immediately = |ending| LifeOverIncrement { cycles: 0.0, error: 0.0, ending };
    match mean_rate(law, cycles, increment.k_start) {
        Rate::Arrested => return immediately(Ending::Arrests { at }),
        Rate::Unstable => return immediately(Ending::Unstable { at }),
        Rate::Growing(_) => {}
    }
    if !(increment.a_end > increment.a_start) {
        return immediately(Ending::Grown);
    }
    let rate_at = |t| mean_rate(law, cycles, path.stress_intensity(t));
    let (t_end, ending) = last_growth(&path, rate_at);
    if matches!(ending, Ending::Arrests { .. }) && !law.reaches_threshold() {
        return LifeOverIncrement { cycles: f64::INFINITY, error: 0.0, ending };
    }
    let integrand = |t| match rate_at(t) {
        Rate::Growing(rate) => path.length_derivative(t) / rate,
        // Growth ends only once, as K is monotonic: such a point lies within rounding of the ending.
        Rate::Arrested | Rate::Unstable => 0.0,
    };
    let breaks = breaks(law, cycles, &path, t_end);
    let (value, error) = match ending {
        Ending::Grown | Ending::Unstable { .. } => integral(integrand, &[&[0.0], &breaks[..], &[t_end]].concat()),
        // The integrand may grow like (t_end − t)^(−p) with p < 1: t_end − t = t_end (1 − s)^4 takes the edge off.
        Ending::Arrests { .. } => {
            let breaks: Vec<f64> = breaks.iter().map(|t| 1.0 - (1.0 - t / t_end).powf(0.25)).collect();
            let substituted = |s: f64| {
                let rest = 1.0 - s;
                integrand(t_end * (1.0 - rest.powi(4))) * t_end * 4.0 * rest.powi(3)
            };
            integral(substituted, &[&[0.0], &breaks[..], &[1.0]].concat())
        }
    };
    LifeOverIncrement { cycles: value, error, ending }
}

/// Parameters below `t_end` where a cycle passes its threshold or a point of the table, ascending.
///
/// Quadrature alone does not see a jump between the end of a piece and its outermost point.
fn breaks(law: &GrowthLaw, cycles: &[LoadCycle], path: &Path, t_end: f64) -> Vec<f64> {
    let mut found = vec![];
    for cycle in cycles {
        let piece_at = |t: f64| {
            let reference = path.stress_intensity(t);
            law.piece(cycle.minimum * reference, cycle.maximum * reference)
        };
        let mut open = vec![(0.0, piece_at(0.0), t_end, piece_at(t_end))];
        while let Some((from, piece_from, to, piece_to)) = open.pop() {
            if piece_from == piece_to {
                continue;
            }
            let middle = 0.5 * (from + to);
            if to - from <= f64::EPSILON || middle <= from || middle >= to {
                found.push(middle);
                continue;
            }
            let piece_middle = piece_at(middle);
            open.push((from, piece_from, middle, piece_middle));
            open.push((middle, piece_middle, to, piece_to));
        }
    }
    found.retain(|t| *t > 0.0 && *t < t_end);
    found.sort_by(f64::total_cmp);
    found.dedup();
    let step = found.len().div_ceil(MAX_BREAKS).max(1);
    found.into_iter().step_by(step).collect()
}

/// The last parameter at which the crack grows, and what ends its growth; it grows at 0.
fn last_growth(path: &Path, rate_at: impl Fn(f64) -> Rate) -> (f64, Ending) {
    let (mut growing, mut ended) = (0.0, 1.0);
    let mut state = rate_at(1.0);
    if matches!(state, Rate::Growing(_)) {
        return (1.0, Ending::Grown);
    }
    for _ in 0..MAX_BISECTIONS {
        let middle = 0.5 * (growing + ended);
        if middle <= growing || middle >= ended {
            break;
        }
        match rate_at(middle) {
            Rate::Growing(_) => growing = middle,
            rate @ (Rate::Arrested | Rate::Unstable) => (ended, state) = (middle, rate),
        }
    }
    let at = path.length(ended);
    match state {
        Rate::Arrested => (growing, Ending::Arrests { at }),
        Rate::Unstable => (growing, Ending::Unstable { at }),
        Rate::Growing(_) => (1.0, Ending::Grown),
    }
}

/// Crack length and stress intensity factor over a parameter from 0 to 1.
struct Path {
    increment: Increment,
    /// Logarithms of the ratios of end to start, where both exist.
    logarithms: Option<(f64, f64)>,
}

impl Path {
    fn through(increment: Increment) -> Self {
        let Increment { a_start, a_end, k_start, k_end } = increment;
        let is_positive = a_start > 0.0 && a_end > 0.0 && k_start > 0.0 && k_end > 0.0;
        let log_ratio = |from: f64, to: f64| ((to - from) / from).ln_1p();
        let logarithms = is_positive.then(|| (log_ratio(a_start, a_end), log_ratio(k_start, k_end)));
        Self { increment, logarithms }
    }

    fn length(&self, t: f64) -> f64 {
        let Increment { a_start, a_end, .. } = self.increment;
        match self.logarithms {
            _ if t == 1.0 => a_end,
            Some((of_a, _)) => a_start * (of_a * t).exp(),
            None => a_start + (a_end - a_start) * t,
        }
    }

    /// Derivative of the length by the parameter [length].
    fn length_derivative(&self, t: f64) -> f64 {
        match self.logarithms {
            Some((of_a, _)) => of_a * self.length(t),
            None => self.increment.a_end - self.increment.a_start,
        }
    }

    fn stress_intensity(&self, t: f64) -> f64 {
        let Increment { k_start, k_end, .. } = self.increment;
        match self.logarithms {
            _ if t == 1.0 => k_end,
            Some((_, of_k)) => k_start * (of_k * t).exp(),
            None => k_start + (k_end - k_start) * t,
        }
    }
}

struct Piece {
    from: f64,
    to: f64,
    value: f64,
    error: f64,
}

/// Integral over pieces between `ends` and an estimate of its error: the worst is halved until the sum is good enough.
fn integral(f: impl Fn(f64) -> f64, ends: &[f64]) -> (f64, f64) {
    let rules = N_POINTS.map(gauss_legendre);
    let piece = |from: f64, to: f64| {
        let [value, other] =
            [0, 1].map(|i| rules[i].iter().map(|(x, w)| w * f(from + (to - from) * x)).sum::<f64>() * (to - from));
        let error = if value.is_finite() { (value - other).abs() } else { f64::INFINITY };
        Piece { from, to, value, error }
    };
    let mut pieces: Vec<Piece> = ends.windows(2).map(|pair| piece(pair[0], pair[1])).collect();
    loop {
        let value: f64 = pieces.iter().map(|p| p.value).sum();
        let error: f64 = pieces.iter().map(|p| p.error).sum();
        if !value.is_finite() || error <= TOLERANCE * value || pieces.len() >= MAX_PIECES {
            return (value, error);
        }
        let worst =
            (0..pieces.len()).max_by(|&i, &j| pieces[i].error.total_cmp(&pieces[j].error)).expect("never empty");
        let Piece { from, to, .. } = pieces[worst];
        let middle = 0.5 * (from + to);
        if middle <= from || middle >= to {
            return (value, error);
        }
        pieces[worst] = piece(from, middle);
        pieces.push(piece(middle, to));
    }
}

#[cfg(test)]
mod tests;
