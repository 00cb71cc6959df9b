//! Cohesive cracks of a solid and how they are loaded.

use super::schema::{SolidCrack, SolidFile};
use crate::analysis::{FrontCriterion, LoadingSettings};
use crate::case::build::boxes::bounds;
use crate::case::build::report::Report;
use crate::case::build::softening::{Said, checked, crack as cohesion, law_of};
use crate::model::{CohesiveCrack, CohesiveModel};

/// What of a crack is cohesive, if anything is.
pub(super) fn crack(crack: &SolidCrack, key: &str, report: &mut Report) -> Option<CohesiveCrack<3>> {
    let (is_cohesive, has_pressure, n_notches) = (crack.cohesive, crack.pressure.is_some(), crack.notch.len());
    let said = Said { is_cohesive, has_pressure, n_notches, key };
    cohesion(&said, |k, key, report| bounds(crack.notch[k].lower, crack.notch[k].upper, key, report), report)
}

/// The law with its cracks, and how far they are loaded.
pub(super) fn cohesive(
    file: &SolidFile,
    cracks: Vec<Option<CohesiveCrack<3>>>,
    report: &mut Report,
) -> Option<(CohesiveModel<3>, LoadingSettings)> {
    let found = file.crack.iter().position(|c| c.cohesive);
    let (index, c) = law_of(found, file.material.cohesive.as_ref(), file.loading.is_some(), report)?;
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
    let (law, loading) = checked(&c, file.loading, report)?;
    Some((CohesiveModel { law, cracks }, loading))
}
