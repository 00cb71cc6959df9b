//! Known solutions of a solid.

use super::cracks::unit;
use super::schema::Triple;
use crate::case::build::report::Report;
use crate::exact::CrackFrontField;
use crate::math::Vector3;
use schemars::JsonSchema;
use serde::Deserialize;

/// A known solution, one of these.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(in crate::case) enum SolidExact {
    /// Field of a straight crack front with its half plane of crack.
    CrackFront(ExactFront),
}

/// Field of a straight crack front.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub(in crate::case) struct ExactFront {
    /// A point of the front [length].
    pub origin: Triple,
    /// Direction ahead of the crack; of any length.
    pub ahead: Triple,
    /// Normal of the crack; its part along `ahead` does not count.
    pub normal: Triple,
    /// Mode I stress intensity factor [stress·√length].
    #[serde(default)]
    pub K_I: f64,
    /// Mode II stress intensity factor [stress·√length].
    #[serde(default)]
    pub K_II: f64,
    /// Mode III stress intensity factor [stress·√length].
    #[serde(default)]
    pub K_III: f64,
    /// Stress along `ahead` that does not fade at the front [stress].
    #[serde(default)]
    pub T: f64,
}

pub(super) fn exact(exact: &SolidExact, report: &mut Report) -> Option<CrackFrontField> {
    let SolidExact::CrackFront(front) = exact;
    let ahead = unit(front.ahead, "exact.crack-front.ahead", report)?;
    let normal = Vector3::from(front.normal);
    let normal = unit((normal - ahead * normal.dot(&ahead)).into(), "exact.crack-front.normal", report)?;
    let factors = [front.K_I, front.K_II, front.K_III];
    Some(CrackFrontField { origin: Vector3::from(front.origin), ahead, normal, factors, t_stress: front.T })
}
