//! How the cracks of a solid grow.

use super::schema::SolidFile;
use crate::analysis::{FrontCriterion, SolidGrowthSettings};
use crate::case::build::report::Report;
use crate::geometry::surface::Surface;
use crate::nodes::solid::SpacingPlan;
use schemars::JsonSchema;
use serde::Deserialize;

/// Least increment over the spacing of nodes at a front: new faces need nodes.
const LEAST: f64 = 1.0;

/// How cracks grow, step by step.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(in crate::case) struct SolidGrowth {
    /// Number of steps at most.
    #[schemars(range(min = 1, max = 10000))]
    pub steps: usize,
    /// Longest step of a front [length]; edges of new fronts are half to one and a half as long.
    pub increment: f64,
    /// Where fronts grow, and which way.
    pub criterion: FrontCriterion,
}

pub(super) fn growth(
    file: &SolidFile,
    body: &Surface,
    spacing: SpacingPlan,
    report: &mut Report,
) -> Option<SolidGrowthSettings> {
    let growth = file.growth.as_ref()?;
    if file.crack.is_empty() {
        report.error("growth", "there is no crack that could grow");
    }
    let smallest = spacing.at_fronts.iter().copied().fold(spacing.largest, f64::min);
    let size = body.bounds().size().norm();
    if !(growth.increment >= LEAST * smallest && growth.increment < size) {
        let allowed =
            format!("from {smallest:.4}, the spacing of nodes at fronts, and below {size:.4}, the size of the body");
        let problem = report.error("growth.increment", format!("{} is no increment here", growth.increment));
        problem.allow(allowed);
    }
    match growth.criterion {
        FrontCriterion::LargestPrincipalStress { tensile_strength } => {
            report.positive("growth.criterion.largest-principal-stress.tensile_strength", tensile_strength);
        }
        FrontCriterion::StressIntensityFactors { exponent, .. } => {
            if !(0.0..=20.0).contains(&exponent) {
                let key = "growth.criterion.stress-intensity-factors.exponent";
                report.error(key, "out of range").allow("from 0 to 20");
            }
        }
    }
    Some(SolidGrowthSettings { steps: growth.steps, increment: growth.increment, criterion: growth.criterion, spacing })
}
