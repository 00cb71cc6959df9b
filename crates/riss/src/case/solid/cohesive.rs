//! Cohesive cracks of a solid and how they are loaded.

use super::body::bounds;
use super::schema::{SolidBox, SolidCrack, SolidFile};
use crate::analysis::{FrontCriterion, LoadingSettings};
use crate::case::build::report::Report;
use crate::material::{CohesiveLaw, Softening};
use crate::model::{CohesiveCrack, CohesiveModel};
use schemars::JsonSchema;
use serde::Deserialize;

/// Softening of cohesive cracks.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct SolidCohesive {
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

/// What of a crack is cohesive, if anything is.
pub(super) fn crack(crack: &SolidCrack, key: &str, report: &mut Report) -> Option<CohesiveCrack> {
    if !crack.cohesive {
        if !crack.notch.is_empty() {
            report.error(format!("{key}.notch"), "only a cohesive crack has notches").suggest("cohesive = true");
        }
        return None;
    }
    if crack.pressure.is_some() {
        report.error(format!("{key}.pressure"), "a cohesive crack is under no pressure").suggest("take it out");
    }
    let notch = |(index, notch): (usize, &SolidBox)| bounds(notch, &format!("{key}.notch[{index}]"), report);
    Some(CohesiveCrack { notches: crack.notch.iter().enumerate().filter_map(notch).collect() })
}

/// The law with its cracks, and how far they are loaded.
pub(super) fn cohesive(
    file: &SolidFile,
    cracks: Vec<Option<CohesiveCrack>>,
    report: &mut Report,
) -> Option<(CohesiveModel, LoadingSettings)> {
    let found = file.crack.iter().position(|c| c.cohesive);
    let (Some(index), Some(c)) = (found, &file.material.cohesive) else {
        match (found, &file.material.cohesive) {
            (Some(index), None) => {
                let problem = report.error(format!("crack[{index}].cohesive"), "there is no law for it");
                problem.suggest("add [material.cohesive] with strength and fracture_energy");
            }
            (None, Some(_)) => {
                let problem = report.error("material.cohesive", "no crack is cohesive");
                problem.suggest("give a [[crack]] the key cohesive = true");
            }
            (_, _) if file.loading.is_some() => {
                report
                    .error("loading", "no crack is cohesive")
                    .suggest("take it out, or give a [[crack]] cohesive = true");
            }
            _ => {}
        }
        return None;
    };
    if let Some(growth) = &file.growth {
        let key = "growth.criterion";
        match growth.criterion {
            FrontCriterion::LargestPrincipalStress { tensile_strength } if tensile_strength == c.strength => {}
            FrontCriterion::LargestPrincipalStress { .. } => {
                let problem = report.error(key, "the strength of a cohesive crack stands in `material.cohesive`");
                problem.suggest(format!("largest-principal-stress = {{ tensile_strength = {} }}", c.strength));
            }
            FrontCriterion::StressIntensityFactors { .. } => {
                let message =
                    format!("crack[{index}] is cohesive: its stresses are finite, it has no intensity factors");
                report
                    .error(key, message)
                    .suggest(format!("largest-principal-stress = {{ tensile_strength = {} }}", c.strength));
            }
        }
    }
    let sound = [("strength", c.strength), ("fracture_energy", c.fracture_energy)]
        .map(|(key, value)| report.positive(format!("material.cohesive.{key}"), value));
    let loading = file.loading.unwrap_or_default();
    if let Some(u) = loading.largest_displacement {
        report.positive("loading.largest_displacement", u);
    }
    let (strength, fracture_energy) = (c.strength, c.fracture_energy);
    let law = CohesiveLaw { strength, fracture_energy, softening: c.softening, shear_ratio: c.shear_ratio };
    sound.iter().all(|s| *s).then_some((CohesiveModel { law, cracks }, loading))
}
