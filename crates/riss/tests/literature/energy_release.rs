//! Rice (1968): the energy release rate J of a crack is the change of the strain energy with its length at fixed loads.
//!
//! Goal: J, K and the strain energy, which come from different integrals, belong together.
//!
//! ```text
//!      ^ ^ ^ ^ ^   1
//!      +-------+
//!      |       |
//!      |===o   |   width 1, height 2, crack a at mid-height, E = 1, nu = 0.3, plane strain
//!      |       |   dU/da from a - 1 % and a + 1 %
//!      +-------+
//!      v v v v v
//! ```
//!
//! Tolerance: 1 % of a difference of 0.2 to 1 % of the strain energy. The nodes of both lengths differ, so the energies must be
//! good to some millionths of themselves: nodes are finer than by default.

use super::bodies::{edge_crack, pulled, rectangle, solve, tips};
use riss::analysis::{Settings, StaticResult};
use riss::nodes::settings::{Graded, Layout};

fn with_crack(length: f64) -> StaticResult {
    let model = pulled(rectangle([0.0, -1.0], [1.0, 1.0], &[]), vec![edge_crack(&[[0.0, 0.0], [length, 0.0]])], 1.0);
    let mut settings = Settings::default();
    settings.nodes.layout = Layout::Graded(Graded { spacing: Some(0.04), tip_spacing: Some(0.001), growth: Some(0.1) });
    solve(&model, &settings)
}

fn check_release(length: f64) {
    let [shorter, middle, longer] = [0.99, 1.0, 1.01].map(|factor| with_crack(factor * length));
    let slope = (longer.strain_energy - shorter.strain_energy) / (0.02 * length);
    let tip = tips(&middle)[0];
    let j = tip.j.unwrap();
    assert!((slope / j - 1.0).abs() < 0.01, "a = {length}: dU/da = {slope}, J = {j}");
    let from_k = (1.0 - 0.3 * 0.3) * (tip.k1.unwrap().powi(2) + tip.k2.unwrap().powi(2));
    assert!((from_k / j - 1.0).abs() < 0.005, "a = {length}: K gives {from_k}, J = {j}");
}

#[test]
fn rice_1968_energy_release_of_short_crack() {
    check_release(0.3);
}

#[test]
fn rice_1968_energy_release_of_long_crack() {
    check_release(0.6);
}
