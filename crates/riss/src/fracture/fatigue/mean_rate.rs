//! Growth per load cycle, averaged over a spectrum.

use super::growth_law::{GrowthLaw, Rate};
use super::spectrum::LoadCycle;

/// Mean growth per cycle of a spectrum: Σ count · rate / Σ count, each cycle as if it were alone (no interaction).
///
/// - `cycles`: of one repetition, from [`LoadSpectrum::cycles`](super::LoadSpectrum::cycles)
/// - `reference`: stress intensity factor under the loads of the case, load factor 1 [stress·√length]
/// - returns `Unstable` if one cycle is, `Arrested` if no cycle makes the crack grow
pub fn mean_rate(law: &GrowthLaw, cycles: &[LoadCycle], reference: f64) -> Rate {
    let mut growth = 0.0;
    for cycle in cycles {
        match law.rate(cycle.minimum * reference, cycle.maximum * reference) {
            Rate::Arrested => {}
            Rate::Growing(rate) => growth += cycle.count * rate,
            Rate::Unstable => return Rate::Unstable,
        }
    }
    Rate::from_growth(growth / cycles_per_repetition(cycles))
}

/// Number of cycles in one repetition of a spectrum.
pub fn cycles_per_repetition(cycles: &[LoadCycle]) -> f64 {
    cycles.iter().map(|c| c.count).sum()
}
