//! Numbers that are possible but strange in the units of the case: mostly a slip of units.

use super::report::Report;
use crate::analysis::crack_growth::settings::AdvanceLaw;
use crate::case::schema::{CaseFile, Scalar, Stress};
use crate::case::units::{Dimension, UnitSystem};

/// Young's modulus of solids that crack, from polymers to diamond [Pa] [Ashby2011, chapter 4].
const YOUNG: [f64; 2] = [1e9, 1.3e12];
/// Fracture toughness from ice and glass to the toughest steels, with a margin of ten [Pa·√m] [Ashby2011, chapter 4].
const TOUGHNESS: [f64; 2] = [1e4, 5e9];
/// Stress over Young's modulus beyond which displacements are no longer small.
const MOST_STRAIN: f64 = 0.1;

/// Notes what does not look like the units that the case says.
pub(super) fn check(file: &CaseFile, units: &UnitSystem, report: &mut Report) {
    let names = &units.names;
    let young = file.material.young;
    check_young(young, units, report);
    for (index, load) in file.load.iter().enumerate() {
        let traction = load.traction.as_ref().map_or(0.0, |[x, y]| number(x).abs().max(number(y).abs()));
        let pressure = load.pressure.as_ref().map_or(0.0, |p| number(p).abs());
        let stress = load.stress.as_ref().map_or(0.0, largest);
        let most = traction.max(pressure).max(stress);
        check_load(&format!("load[{index}]"), most, young, &names.stress, report);
    }
    check_load("remote_stress", file.remote_stress.as_ref().map_or(0.0, largest), young, &names.stress, report);
    if let Some(AdvanceLaw::QuasiStatic(law)) = file.growth.as_ref().map(|g| &g.law)
        && let Some(toughness) = law.toughness
    {
        let in_si = units.in_si(toughness, dimension("stress·√length"));
        if !(TOUGHNESS[0]..=TOUGHNESS[1]).contains(&in_si) {
            let unit = names.stress_intensity();
            let message = format!("{toughness} {unit} are {} MPa√m; are the units right?", in_si / 1e6);
            report.note("growth.law.quasi-static.toughness", message);
        }
    }
}

/// Notes an unlikely modulus.
pub(in crate::case) fn check_young(young: f64, units: &UnitSystem, report: &mut Report) {
    let in_gpa = units.in_si(young, dimension("stress")) / 1e9;
    if !(YOUNG[0]..=YOUNG[1]).contains(&(1e9 * in_gpa)) {
        let unit = &units.names.stress;
        let message =
            format!("{young} {unit} are {in_gpa} GPa, but solids that crack have 1 to 1300 GPa; are the units right?");
        report.note("material.young", message);
    }
}

fn dimension(name: &str) -> Dimension {
    Dimension::named(name).expect("a known name")
}

/// Notes a load that no solid of this modulus bears.
pub(in crate::case) fn check_load(key: &str, most: f64, young: f64, unit: &str, report: &mut Report) {
    if most > MOST_STRAIN * young {
        let message =
            format!("{most} {unit} are more than a tenth of Young's modulus, {young} {unit}; are the units right?");
        report.note(key, message);
    }
}

/// Expressions are not judged.
fn number(scalar: &Scalar) -> f64 {
    scalar.number().unwrap_or(0.0)
}

fn largest(stress: &Stress) -> f64 {
    stress.xx.abs().max(stress.yy.abs()).max(stress.xy.abs())
}
