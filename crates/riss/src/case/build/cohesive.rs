//! Cohesive cracks in the plane: which they are, what they obey, and what does not go with them.

use super::boxes::bounds;
use super::report::Report;
use super::softening::{Said, checked, crack as cohesion, law_of};
use crate::analysis::{LoadingSettings, Method};
use crate::approximation::EnrichmentKind;
use crate::case::schema::{self, CaseFile};
use crate::geometry::aabb::Aabb;
use crate::math::Vector2;
use crate::model::{CohesiveCrack, CohesiveModel};
use crate::system::ConstraintMethod;

/// Keys of `[growth]` that say nothing to cohesive cracks, whose way alone is sought.
const OTHER_GROWTH: [&str; 2] = ["law", "stop"];

/// What of a crack is cohesive, if anything is.
pub(super) fn crack(crack: &schema::Crack, key: &str, report: &mut Report) -> Option<CohesiveCrack<2>> {
    let (is_cohesive, has_pressure, n_notches) = (crack.cohesive, crack.pressure.is_some(), crack.notch.len());
    let said = Said { is_cohesive, has_pressure, n_notches, key };
    cohesion(&said, |k, key, report| bounds(crack.notch[k].lower, crack.notch[k].upper, key, report), report)
}

/// Vertices with further ones where the path enters or leaves a notch.
pub(super) fn cut_at_notches(vertices: &[Vector2], notches: &[Aabb<2>], tolerance: f64) -> Vec<Vector2> {
    let mut result = vec![vertices[0]];
    for w in vertices.windows(2) {
        let (a, e) = (w[0], w[1] - w[0]);
        let mut cuts: Vec<f64> = vec![];
        for notch in notches {
            for (d, bound) in (0..2).flat_map(|d| [(d, notch.lower[d]), (d, notch.upper[d])]) {
                let t = (bound - a[d]) / e[d];
                let other = a[1 - d] + e[1 - d] * t;
                let is_inner = t * e.norm() > tolerance && (1.0 - t) * e.norm() > tolerance;
                if is_inner && (notch.lower[1 - d]..=notch.upper[1 - d]).contains(&other) {
                    cuts.push(t);
                }
            }
        }
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|b, a| (*b - *a) * e.norm() <= tolerance);
        result.extend(cuts.into_iter().map(|t| a + e * t));
        result.push(w[1]);
    }
    result
}

/// The law with its cracks, and how far they are loaded.
pub(super) fn cohesive(
    file: &CaseFile,
    cracks: Vec<Option<CohesiveCrack<2>>>,
    report: &mut Report,
) -> Option<(CohesiveModel<2>, LoadingSettings)> {
    let found = file.crack.iter().position(|c| c.cohesive);
    let law = match (&file.material.cohesive, found) {
        (Some(law), None) if file.growth.as_ref().is_some_and(|g| g.seeding.is_some()) => {
            refuse(file, "cracks that start are cohesive", report);
            *law
        }
        (law, found) => {
            let (index, law) = law_of(found, law.as_ref(), file.loading.is_some(), report)?;
            refuse(file, &format!("crack[{index}] is cohesive"), report);
            law
        }
    };
    let (law, loading) = checked(&law, file.loading, report)?;
    Some((CohesiveModel { law, cracks }, loading))
}

/// Reports what a case with cohesive cracks cannot have.
///
/// - `because`: which crack is cohesive
fn refuse(file: &CaseFile, because: &str, report: &mut Report) {
    if file.method != Method::ElementFreeGalerkin {
        let message = format!("{because}, which cracking particles cannot be");
        report.error("method", message).allow("element-free-galerkin, or collocation in space");
    }
    match file.constraints {
        ConstraintMethod::Nitsche { .. } | ConstraintMethod::Penalty { .. } => {}
        ConstraintMethod::LagrangeMultipliers
        | ConstraintMethod::ModifiedVariational
        | ConstraintMethod::FiniteElementCoupled => {
            let message = format!("{because}: faces are joined in a definite matrix");
            report.error("constraints", message).allow("nitsche, penalty");
        }
    }
    if !matches!(file.approximation.enrichment.kind, EnrichmentKind::Automatic | EnrichmentKind::None) {
        let message = format!("{because}: stresses at tips are finite");
        report.error("approximation.enrichment.kind", message).allow("none");
    }
    for (key, is_there) in [("accuracy", file.accuracy.is_some()), ("contact", file.contact.is_some())] {
        if is_there {
            let message = match key {
                "contact" => format!("{because}: faces that touch are kept apart by the law"),
                _ => format!("{because}: there are no stress intensity factors to be accurate"),
            };
            report.error(key, message).suggest("take it out");
        }
    }
    for (k, _) in file.crack.iter().enumerate().filter(|(_, c)| c.pressure.is_some() && !c.cohesive) {
        let message = format!("{because}: no crack beside it can be under pressure");
        report.error(format!("crack[{k}].pressure"), message).suggest("take it out");
    }
    for key in OTHER_GROWTH.map(|key| format!("growth.{key}")) {
        if report.document.says(&key) {
            let message = format!("{because}: [growth] finds the way, and the law says how far it breaks");
            report.error(key, message).suggest("leave it out");
        }
    }
}
