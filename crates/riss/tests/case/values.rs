//! Units, parameters and quantities.

use super::{bad, template};
use riss::case::{Case, CaseErrors};

fn read(head: &str, rest: &str) -> Result<Case, CaseErrors> {
    let text = format!(
        "{head}\nrigid_motion = 'mean-is-zero'\n[geometry.rectangle]\nlower = [0, 0]\nupper = ['40 mm', '80 mm']\n{rest}\n"
    );
    Case::parse(&text, "case.toml".as_ref(), &[])
}

const STEEL: &str = "[material]\nyoung = '210 GPa'\npoisson = 0.3\nplane = 'strain'\nthickness = '1 cm'\n";

#[test]
fn quantities_become_numbers_in_the_units_of_the_case() {
    let rest = format!(
        "{STEEL}[remote_stress]\nyy = '80 N/mm^2'\n[[load]]\non = 'top'\ntraction = ['-0.5 MPa', '2*y']\n\
         [[crack]]\npath = [[0, '0.04 m'], ['1 in', '4 cm']]\n[growth]\nincrement = '2 mm'\n\
         [growth.law.quasi-static]\ntoughness = '60 MPa√m'\n"
    );
    let case = read("units = 'mm, N, MPa'", &rest).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((case.model.material.young, case.model.thickness), (210e3, 10.0));
    assert_eq!(case.model.domain.area(), 3200.0);
    assert!((case.model.cracks[0].length() - 25.4).abs() < 1e-12);
    assert_eq!(case.units.expect("given").stress_intensity(), "MPa√mm");
    assert!(case.notes.is_empty(), "{:?}", case.notes);
    // The same body in inches.
    let case = read("units = 'in, kip, ksi'", &rest).unwrap_or_else(|e| panic!("{e}"));
    assert!((case.model.material.young - 210e9 / 6894757.293168361).abs() < 1e-6);
}

#[test]
fn wrong_units_are_explained() {
    let message = |head: &str, stress: &str| {
        let rest = format!("{STEEL}[remote_stress]\nyy = '{stress}'\n");
        let errors = read(head, &rest).expect_err("a bad case");
        errors.to_string()
    };
    let system = "units = 'mm, N, MPa'";
    let text = message(system, "80 mm");
    assert!(
        text.contains("remote_stress.yy = '80 mm': `mm` is the unit of a length") && text.contains("a stress"),
        "{text}"
    );
    assert!(message(system, "80 Mpa").contains("unknown unit `Mpa`"));
    assert!(message("units = 'mm, N, GPa'", "80 MPa").contains("write \"mm, N, MPa\""));
    assert_eq!(message("", "80 MPa").matches("the case does not say its units").count(), 5);
    let mut poisson = template();
    poisson.head = "units = 'mm, N'".into();
    poisson.rest += "[contact]\npenalty = '3 mm'\n";
    assert_eq!(bad(&poisson), "no unit is due here");
}

#[test]
fn strange_values_are_noted() {
    let notes = |young: &str, stress: &str| {
        let rest =
            format!("[material]\nyoung = {young}\npoisson = 0.3\nplane = 'strain'\n[remote_stress]\nyy = {stress}\n");
        let case = read("units = 'mm, N, MPa'", &rest).unwrap_or_else(|e| panic!("{e}"));
        case.notes.iter().map(|n| n.to_string()).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(notes("210e3", "80"), "");
    let note = notes("200", "80");
    assert!(note.contains("200 MPa are 0.2 GPa") && note.contains("more than a tenth"), "{note}");
    assert!(notes("210e9", "80e6").contains("material.young"));
    assert!(notes("'70 GPa'", "80e6").contains("remote_stress"));
}

#[test]
fn parameters_stand_for_numbers() {
    let mut case = template();
    case.head = "[parameters]\nw = 7\nhalf = 'w/2'\nload = '2*half'\nunused = 1\n".into();
    case.rest = "[remote_stress]\nyy = 'load'\n[[crack]]\npath = [[0, 8], ['half', 'w + 1']]\n\
                 [[load]]\non = 'top'\ntraction = [0, 'load*x']\n[nodes.layout.structured]\nnx = 'w'\nny = '2*w'\n"
        .into();
    let text = format!("rigid_motion = 'mean-is-zero'\n{}\n", case.head);
    let text = format!("{text}[material]\nyoung = 1\npoisson = 0.3\nplane = 'strain'\n{}{}", case.geometry, case.rest);
    let read = |overrides: &[&str]| {
        let overrides: Vec<String> = overrides.iter().map(|s| s.to_string()).collect();
        Case::parse(&text, "case.toml".as_ref(), &overrides).unwrap_or_else(|e| panic!("{e}"))
    };
    let plain = read(&[]);
    assert_eq!(plain.model.cracks[0].length(), 3.5);
    assert_eq!(plain.notes.iter().map(|n| n.key.as_str()).collect::<Vec<_>>(), ["parameters.unused"]);
    // By the name alone; what depends on it follows.
    assert_eq!(read(&["half=2"]).model.cracks[0].length(), 2.0);
    assert_eq!(read(&["parameters.half=3"]).model.cracks[0].length(), 3.0);
}

#[test]
fn wrong_parameters_are_explained() {
    let message = |parameters: &str, young: &str| {
        let text = format!(
            "rigid_motion = 'mean-is-zero'\nparameters = {parameters}\n[material]\nyoung = {young}\npoisson = 0.3\n\
             plane = 'strain'\n[geometry.disk]\ncenter = [0, 0]\nradius = 1\n[remote_stress]\nyy = 1\n"
        );
        Case::parse(&text, "case.toml".as_ref(), &[]).map(|_| ()).expect_err("a bad case").to_string()
    };
    let text = message("{ modulus = 5 }", "'2*modulos'");
    assert!(text.contains("case.toml:4:9") && text.contains("did you mean `modulus`?"), "{text}");
    assert!(message("{ a = 'b', b = 'a' }", "'a'").contains("refers to itself"));
    assert!(message("{ x = 1 }", "1").contains("has a meaning already"));
    assert!(message("{ a-b = 1 }", "1").contains("no name for a parameter"));
    assert!(message("{ a = true }", "1").contains("expected a number, found true or false"));
    assert!(message("{ a = 1 }", "'a/0'").contains("is not finite"));
    assert!(message("{ a = 1 }", "'a*x'").contains("cannot depend on x"));
    assert!(message("{ a = 1 }", "'a +'").contains("material.young"));
    let deep: String = (0..60).map(|k| format!("p{k} = 'p{}', ", k + 1)).collect();
    assert!(message(&format!("{{ {deep} p60 = 1 }}"), "'p0'").contains("refers to itself"));
}
