//! Softening of cohesive cracks, in the plane and in space.

use super::report::Report;
use crate::analysis::LoadingSettings;
use crate::geometry::aabb::Aabb;
use crate::material::{CohesiveLaw, Softening};
use crate::model::CohesiveCrack;
use schemars::JsonSchema;
use serde::Deserialize;

/// Softening of cohesive cracks.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct Cohesive {
    /// Tensile strength, at which faces begin to part [stress].
    pub strength: f64,
    /// Fracture energy: area below the curve of traction over opening [stress·length].
    pub fracture_energy: f64,
    /// Shape of that curve.
    #[serde(default)]
    pub softening: Softening,
    /// Weight of sliding against opening; with 0 faces slide freely once they are open.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 10.0))]
    pub shear_ratio: f64,
}

/// What a crack says of its cohesion.
pub(in crate::case) struct Said<'a> {
    pub is_cohesive: bool,
    pub has_pressure: bool,
    /// Number of notches.
    pub n_notches: usize,
    /// Key of the crack.
    pub key: &'a str,
}

/// What of a crack is cohesive, if anything is.
///
/// - `notch`: the box of each notch; none if it has problems
pub(in crate::case) fn crack<const D: usize>(
    said: &Said<'_>,
    notch: impl Fn(usize, &str, &mut Report) -> Option<Aabb<D>>,
    report: &mut Report,
) -> Option<CohesiveCrack<D>> {
    let Said { is_cohesive, has_pressure, n_notches, key } = said;
    if !is_cohesive {
        if *n_notches > 0 {
            report.error(format!("{key}.notch"), "only a cohesive crack has notches").suggest("cohesive = true");
        }
        return None;
    }
    if *has_pressure {
        report.error(format!("{key}.pressure"), "a cohesive crack is under no pressure").suggest("take it out");
    }
    let notches = (0..*n_notches).filter_map(|k| notch(k, &format!("{key}.notch[{k}]"), report));
    Some(CohesiveCrack { notches: notches.collect() })
}

/// The law of a case whose first cohesive crack is `index`, with that number; none if there is none, or no crack for it.
pub(in crate::case) fn law_of(
    index: Option<usize>,
    law: Option<&Cohesive>,
    has_loading: bool,
    report: &mut Report,
) -> Option<(usize, Cohesive)> {
    match (index, law) {
        (Some(index), Some(law)) => return Some((index, *law)),
        (Some(index), None) => {
            let problem = report.error(format!("crack[{index}].cohesive"), "there is no law for it");
            problem.suggest("add [material.cohesive] with strength and fracture_energy");
        }
        (None, Some(_)) => {
            let problem = report.error("material.cohesive", "no crack is cohesive");
            problem.suggest("give a [[crack]] the key cohesive = true");
        }
        (None, None) if has_loading => {
            report.error("loading", "no crack is cohesive").suggest("take it out, or give a [[crack]] cohesive = true");
        }
        (None, None) => {}
    }
    None
}

/// Law and loading; none if they have problems.
pub(in crate::case) fn checked(
    law: &Cohesive,
    loading: Option<LoadingSettings>,
    report: &mut Report,
) -> Option<(CohesiveLaw, LoadingSettings)> {
    let sound = [("strength", law.strength), ("fracture_energy", law.fracture_energy)]
        .map(|(key, value)| report.positive(format!("material.cohesive.{key}"), value));
    let loading = loading.unwrap_or_default();
    if let Some(u) = loading.largest_displacement {
        report.positive("loading.largest_displacement", u);
    }
    let Cohesive { strength, fracture_energy, softening, shear_ratio } = *law;
    sound.iter().all(|s| *s).then_some((CohesiveLaw { strength, fracture_energy, softening, shear_ratio }, loading))
}
