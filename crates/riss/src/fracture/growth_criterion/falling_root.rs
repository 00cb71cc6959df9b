//! Places where a function falls through zero: maxima of a function with known derivative.

/// Enough halvings to reach the last bit of any positive `f64` from zero; other searches end long before.
const MOST_HALVINGS: usize = 1200;

/// Root in `[low, high]` of `f`, positive at `low` and not positive at `high`, to the last bit by bisection.
///
/// Bisection because the intervals are narrow to begin with and relative accuracy is wanted at tiny angles.
pub(super) fn falling_root(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..MOST_HALVINGS {
        let middle = low + 0.5 * (high - low);
        if middle <= low || middle >= high {
            break;
        }
        if f(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// All places in `(low, high]` where `f` falls through zero and that are at least an interval of `n_intervals` apart.
pub(super) fn falling_roots(f: impl Fn(f64) -> f64, low: f64, high: f64, n_intervals: usize) -> Vec<f64> {
    let at = |i: usize| low + (high - low) * (i as f64 / n_intervals as f64);
    let mut roots = Vec::new();
    let mut was_positive = f(low) > 0.0;
    for i in 1..=n_intervals {
        let is_positive = f(at(i)) > 0.0;
        if was_positive && !is_positive {
            roots.push(falling_root(&f, at(i - 1), at(i)));
        }
        was_positive = is_positive;
    }
    roots
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn maxima_of_a_wave_are_found_and_minima_are_not() {
        let roots = falling_roots(f64::cos, 0.0, 10.0, 40);
        assert_eq!(roots.len(), 2);
        assert!((roots[0] - 0.5 * PI).abs() < 1e-15 && (roots[1] - 2.5 * PI).abs() < 2e-15);
    }

    #[test]
    fn tiny_roots_keep_their_relative_accuracy() {
        assert!((falling_root(|x| 3e-300 - x, 0.0, 1.0) / 3e-300 - 1.0).abs() < 1e-15);
    }
}
