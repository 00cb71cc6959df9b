//! Tests of units.

use super::*;

fn check_conversion(units: &str, value: f64, unit: &str, expected: f64) {
    let system = UnitSystem::parse(units).unwrap();
    let converted = system.convert(value, Unit::parse(unit).unwrap());
    assert!((converted / expected - 1.0).abs() < 1e-14, "{value} {unit} is {converted}, expected {expected}");
}

#[test]
fn powers_of_ten_are_exact() {
    let system = UnitSystem::parse("mm, N, MPa").unwrap();
    let convert = |value: f64, unit: &str| system.convert(value, Unit::parse(unit).unwrap());
    assert_eq!(convert(200.0, "GPa"), 200e3);
    assert_eq!(convert(0.3, "m"), 300.0);
    assert_eq!(convert(5.0, "kN/m"), 5.0);
    assert_eq!(convert(7.3, "bar"), 0.73);
    assert_eq!(convert(0.1, "mm"), 0.1);
}

#[test]
fn conversions_by_hand() {
    // 1 MPa√m = √1000 MPa√mm.
    check_conversion("mm, N", 50.0, "MPa√m", 50.0 * 1000f64.sqrt());
    check_conversion("mm, N", 50.0, "MPa*sqrt(m)", 50.0 * 1000f64.sqrt());
    check_conversion("mm, N", 50.0, "MPa m^0.5", 50.0 * 1000f64.sqrt());
    // NIST SP 811, appendix B.8: 1 psi = 6.894757 kPa, 1 ksi√in = 1.098843 MPa√m.
    let system = UnitSystem::parse("m, N, Pa").unwrap();
    assert!((system.convert(1.0, Unit::parse("psi").unwrap()) / 6894.757 - 1.0).abs() < 1e-7);
    assert!((system.convert(1.0, Unit::parse("ksi√in").unwrap()) / 1.098843e6 - 1.0).abs() < 1e-6);
    check_conversion("in, lbf, psi", 30e3, "ksi", 30e6);
    check_conversion("in, lbf", 1.0, "ft", 12.0);
    // A rate in m and MPa√m with m = 3: 1e-11 m = 1e-8 mm over (√1000)^3.
    check_conversion("mm, N", 1e-11, "m/cycle/(MPa√m)^3", 1e-8 / 1000f64.powf(1.5));
    check_conversion("mm, N", 1e-11, "m/cycle/MPa√m", 1e-8 / 1000f64.sqrt());
}

#[test]
fn systems_are_completed_and_must_be_consistent() {
    let names = |text: &str| {
        let names = UnitSystem::parse(text).map(|s| s.names).map_err(|e| e.0);
        names.map(|n| format!("{} {} {}", n.length, n.force, n.stress))
    };
    assert_eq!(names("mm, N"), Ok("mm N MPa".into()));
    assert_eq!(names("GPa, mm"), Ok("mm kN GPa".into()));
    assert_eq!(names("m, N, Pa"), Ok("m N Pa".into()));
    assert_eq!(names("in, lbf"), Ok("in lbf psi".into()));
    assert_eq!(names("in, kip, ksi"), Ok("in kip ksi".into()));
    assert_eq!(names("cm, N"), Ok("cm N N/cm²".into()));
    assert_eq!(names("mm, N, N/mm^2"), Ok("mm N N/mm^2".into()));
    assert_eq!(names("m, N, MPa"), Err("m and N do not go with MPa".into()));
    for bad in ["", "mm", "mm, cm, N", "mm, s", "mm, N, kg", "N, MPa", "mm, N·m, MPa"] {
        assert!(names(bad).is_err(), "{bad}");
    }
}

#[test]
fn slips_are_refused() {
    for bad in ["Gpa", "mmm", "m^", "m^x", "(m", "m)", "/m", "m//N", "m^99", "MPa√m^3", "√", "((((((((((m))))))))))"]
    {
        assert!(Unit::parse(bad).is_err(), "{bad}");
    }
}
