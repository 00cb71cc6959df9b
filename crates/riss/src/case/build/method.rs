//! What the method says where the case says nothing, and what it cannot do.

use super::report::Report;
use crate::analysis::Method;
use crate::approximation::{Basis, CrackSmoothing, EnrichmentKind};
use crate::case::schema::CaseFile;

/// Fills in what the source of the method takes, and reports options that do not apply to it.
pub(super) fn complete(file: &mut CaseFile, report: &mut Report) {
    match file.method {
        Method::ElementFreeGalerkin => {}
        Method::CrackingParticles => {
            check_particles(file, report);
            add_defaults(file, report);
        }
    }
}

fn add_defaults(file: &mut CaseFile, report: &Report) {
    let is_open = |key: &str| !report.document.says(key);
    let (settings, growth) = (file.method.settings(), file.method.growth());
    // Wider bases need more neighbors.
    if is_open("approximation.dilation") && file.approximation.basis == Basis::Linear {
        file.approximation.dilation = settings.approximation.dilation;
    }
    if is_open("fracture.domain") {
        file.fracture.domain = settings.fracture.domain;
    }
    if let Some(given) = &mut file.growth {
        if is_open("growth.criterion") {
            given.criterion = growth.criterion;
        }
        if is_open("growth.control") {
            given.control = growth.control;
        }
    }
}

/// Cracking particles know nothing but visibility and polynomials.
fn check_particles(file: &mut CaseFile, report: &mut Report) {
    const ADVICE: &str = "leave it out, or use `method = \"element-free-galerkin\"`";
    if file.approximation.smoothing.cracks.is_some_and(|c| c != CrackSmoothing::Visibility) {
        let message = "cracking particles divide supports by visibility";
        report.error("approximation.smoothing.cracks", message).allow("visibility").suggest(ADVICE);
    }
    let kind = &mut file.approximation.enrichment.kind;
    if *kind == EnrichmentKind::Automatic {
        *kind = EnrichmentKind::None;
    }
    if *kind != EnrichmentKind::None {
        let message = "cracking particles have no functions of the tip in their basis";
        report.error("approximation.enrichment.kind", message).allow("none").suggest(ADVICE);
    }
}
