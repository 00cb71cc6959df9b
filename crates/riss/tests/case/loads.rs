//! Loads, supports and known solutions.

use super::{Template, bad, good, template};
use riss::case::Case;
use riss::math::{Matrix2, Vector2};
use riss::model::{Contact, Direction, FieldPoint, TractionValue};

fn read(rest: &str) -> Case {
    let mut template = template();
    template.rest = rest.into();
    good(&template)
}

fn held(rest: &str) -> Case {
    let mut template = template();
    template.head = "# supported\n".into();
    template.rest = rest.into();
    let text = template.text().replace("'mean-is-zero'", "'supported'");
    Case::parse(&text, std::path::Path::new("case.toml"), &[]).unwrap_or_else(|e| panic!("{e}"))
}

fn traction(case: &Case, load: usize, x: f64, y: f64, normal: (f64, f64)) -> Vector2 {
    let at = FieldPoint { position: Vector2::new(x, y), normal: Vector2::new(normal.0, normal.1) };
    case.model.loads[load].value.traction(&case.model.material, &at)
}

#[test]
fn tractions_in_all_forms() {
    let case = read(
        "[remote_stress]\nyy = 3\nxy = 1\n[[load]]\non = 'right'\ntraction = [1.5, '0.5*y']\n\
         [[load]]\non = ['left', 'outline']\npressure = '2*y'\n[[load]]\non = 'top'\nstress = { xx = 1, yy = 2 }\n",
    );
    assert_eq!(traction(&case, 0, 7.0, 4.0, (1.0, 0.0)), Vector2::new(1.5, 2.0));
    assert_eq!(traction(&case, 1, 0.0, 4.0, (-1.0, 0.0)), Vector2::new(8.0, 0.0));
    assert_eq!(traction(&case, 3, 1.0, 16.0, (0.0, 1.0)), Vector2::new(0.0, 2.0));
    assert_eq!(traction(&case, 4, 1.0, 16.0, (0.0, 1.0)), Vector2::new(1.0, 3.0));
    assert!(case.model.loads[1].part.is_some() && case.model.loads[2].part.is_none());
}

#[test]
fn supports_by_part_and_point() {
    let case = held(
        "[remote_stress]\nyy = 1\n[[support]]\non = ['left', 'right']\nnormal = 0\n\
         [[support]]\nat = [3, 0]\ny = '0.1*x'\n[[spring]]\non = 'outline'\nx = 5\n",
    );
    let supports = &case.model.supports;
    assert_eq!(supports.iter().map(|s| s.direction).collect::<Vec<_>>(), [Direction::Normal; 2]);
    let [None, Some(u)] = case.model.point_supports[0].displacement else { panic!("y only") };
    assert!((u - 0.3).abs() < 1e-15);
    let outline = &case.model.domain.parts[case.model.springs[0].part];
    assert_eq!((outline.name.as_str(), outline.edges.len()), ("outline", 4));
}

#[test]
fn exact_fields_prescribe_and_load() {
    let case = held(
        "[exact.linear]\nconstant = [1, 0]\ngradient = [[0.1, 0.2], [0, 0.3]]\n\
         [[support]]\non = 'bottom'\nexact = true\n[[load]]\non = 'top'\nexact = true\n",
    );
    let material = case.model.material;
    let at = FieldPoint { position: Vector2::new(2.0, 0.0), normal: -Vector2::y() };
    let u = |k: usize| case.model.supports[k].value.value(&material, case.model.supports[k].direction, &at);
    assert_eq!((u(0), u(1)), (1.2, 0.0));
    let TractionValue::Exact(field) = &case.model.loads[0].value else { panic!("exact") };
    assert_eq!(field.gradient(&material, at.position), Matrix2::new(0.1, 0.2, 0.0, 0.3));
    assert!(case.model.exact.is_some());
}

#[test]
fn a_prescribed_displacement_is_a_load() {
    held("[[support]]\non = 'bottom'\nx = 0\ny = 0\n[[support]]\non = 'top'\ny = 0.01\n");
}

#[test]
fn listed_nodes_on_the_boundary_are_left_out_with_a_note() {
    let case = read("[remote_stress]\nyy = 1\n[nodes.layout.listed]\npositions = [[0, 0], [1, 1], [7, 3]]\n");
    let riss::nodes::settings::Layout::Listed(listed) = &case.settings.nodes.layout else { panic!("listed") };
    assert_eq!((listed.positions.as_slice(), case.notes.len()), ([[1.0, 1.0]].as_slice(), 1));
}

/// A case with nothing but a crack.
fn with_crack(lines: &str) -> Template {
    let geometry = format!("{}[[crack]]\npath = [[0, 8], [3.5, 8]]\n{lines}\n", template().geometry);
    Template { geometry, rest: String::new(), ..template() }
}

#[test]
fn pressure_in_a_crack_is_a_load_and_goes_with_its_crack() {
    let mut template = with_crack("pressure = '2*x + y + nx'");
    template.geometry += "[[crack]]\npath = [[1, 3], [2, 3]]\n[[crack]]\npath = [[1, 12], [2, 12]]\npressure = -3\n";
    let model = good(&template).model;
    let at = Vector2::new(1.0, 8.0);
    assert_eq!([0, 1, 2].map(|crack| model.face_pressure(crack, at)), [10.0, 0.0, -3.0]);
    assert_eq!([0, 1, 2].map(|crack| model.loads_faces(crack)), [true, false, true]);
}

#[test]
fn no_pressure_in_a_crack_is_no_load() {
    for pressure in ["0", "'0*x'"] {
        assert_eq!(bad(&with_crack(&format!("pressure = {pressure}"))), "nothing loads the body");
    }
}

#[test]
fn contact_has_a_default_penalty() {
    assert!(read("[remote_stress]\nyy = 1\n").model.contact.is_none());
    let penalty =
        |lines: &str| read(&format!("[remote_stress]\nyy = 1\n[contact]\n{lines}")).model.contact.unwrap().penalty;
    assert_eq!((penalty(""), penalty("penalty = 20")), (Contact::default().penalty, 20.0));
}
