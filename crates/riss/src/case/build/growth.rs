//! Sense of the growth settings.

use super::report::Report;
use crate::analysis::GrowthSettings;
use crate::analysis::crack_growth::settings::{AdvanceLaw, IncrementControl, QuasiStatic, Seeding, SeedingTime};
use crate::fracture::fatigue::FieldProblem;
use crate::model::Model;

/// Reports what cannot be meant.
pub(super) fn check(growth: &GrowthSettings, model: &Model, report: &mut Report) {
    check_lengths(growth, model, report);
    if model.cracks.is_empty() && growth.seeding.is_none() {
        report.error("growth", "there is no crack to grow").suggest("add a [[crack]] or [growth.seeding]");
    }
    for (k, name) in growth.held.iter().enumerate() {
        if !model.cracks.iter().any(|c| c.name == *name) {
            let names = model.cracks.iter().map(|c| c.name.as_str());
            report.error(format!("growth.held[{k}]"), "unknown crack").one_of(name, names);
        }
    }
    match growth.control {
        IncrementControl::Fixed => {}
        IncrementControl::HalvedOnTurns { angle_deg, least } => {
            report.positive("growth.control.halved-on-turns.angle_deg", angle_deg);
            report.positive("growth.control.halved-on-turns.least", least);
        }
        IncrementControl::Converged { tolerance } => {
            report.positive("growth.control.converged.tolerance", tolerance);
        }
    }
    match &growth.law {
        AdvanceLaw::Equal => {}
        AdvanceLaw::QuasiStatic(law) => check_quasi_static(law, report),
        AdvanceLaw::Fatigue(law) => {
            add_problems(law.rate.problems(), "growth.law.fatigue.rate", report);
            add_problems(law.spectrum.problems(), "growth.law.fatigue.spectrum", report);
        }
    }
    if let Some(seeding) = &growth.seeding {
        check_seeding(seeding, model, report);
    }
    check_stops(growth, report);
}

fn check_lengths(growth: &GrowthSettings, model: &Model, report: &mut Report) {
    let size = model.domain.aabb().size().norm();
    let Some(increment) = growth.increment else { return };
    if report.positive("growth.increment", increment) && increment < 1e-6 * size {
        report
            .error("growth.increment", "too short for the size of the body")
            .allow(format!("at least {:.3e}", 1e-6 * size));
    }
    if increment >= size {
        report.error("growth.increment", "longer than the body").allow(format!("below {size:.4}"));
    }
}

fn check_quasi_static(law: &QuasiStatic, report: &mut Report) {
    let key = "growth.law.quasi-static";
    match (law.toughness, law.fracture_energy) {
        (Some(v), None) => report.positive(format!("{key}.toughness"), v),
        (None, Some(v)) => report.positive(format!("{key}.fracture_energy"), v),
        _ => {
            report.error(key, "the toughness is said once").allow("toughness or fracture_energy");
            false
        }
    };
    if !(0.0..1.0).contains(&law.tie) {
        report.error(format!("{key}.tie"), "out of range").allow("0 to below 1");
    }
}

fn add_problems(problems: Vec<FieldProblem>, key: &str, report: &mut Report) {
    for problem in problems {
        report.error(format!("{key}.{}", problem.field), problem.message).allow(problem.allowed);
    }
}

fn check_seeding(seeding: &Seeding, model: &Model, report: &mut Report) {
    let size = model.domain.aabb().size().norm();
    if report.positive("growth.seeding.length", seeding.length) && seeding.length >= size {
        report.error("growth.seeding.length", "longer than the body").allow(format!("below {size:.4}"));
    }
    for (name, value) in [("stress", seeding.stress), ("separation", seeding.separation)] {
        if let Some(value) = value {
            report.positive(format!("growth.seeding.{name}"), value);
        }
    }
    if seeding.number.is_none() && seeding.stress.is_none() {
        report.error("growth.seeding", "nothing says how many cracks start").allow("number, stress, or both");
    }
    if seeding.when == SeedingTime::AtReachedHoles && seeding.stress.is_none() {
        let message = "cracks start again only where the stress is beyond a limit";
        report.error("growth.seeding.when", message).suggest("give `stress`");
    }
    for (k, name) in seeding.on.iter().enumerate() {
        if !model.domain.parts.iter().any(|p| p.name == *name) {
            let names = model.domain.parts.iter().map(|p| p.name.as_str());
            report.error(format!("growth.seeding.on[{k}]"), "unknown part").one_of(name, names);
        }
    }
}

fn check_stops(growth: &GrowthSettings, report: &mut Report) {
    let stop = &growth.stop;
    for (name, value) in
        [("cycles", stop.cycles), ("crack_length", stop.crack_length), ("load_factor", stop.load_factor)]
    {
        if let Some(value) = value {
            report.positive(format!("growth.stop.{name}"), value);
        }
    }
    if stop.cycles.is_some() && !matches!(growth.law, AdvanceLaw::Fatigue(_)) {
        report.error("growth.stop.cycles", "only fatigue counts cycles").suggest("give [growth.law.fatigue]");
    }
    if stop.load_factor.is_some() && !matches!(growth.law, AdvanceLaw::QuasiStatic(_)) {
        report
            .error("growth.stop.load_factor", "only quasi-static growth changes the load")
            .suggest("give [growth.law.quasi-static]");
    }
}
