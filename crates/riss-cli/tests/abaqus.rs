//! Input files of Abaqus and CalculiX as their users have them: what is read, what is ignored, what is refused.

use riss::case::{Case, CaseErrors};
use riss::geometry::curve::Curve;
use riss::math::Vector2;
use riss::model::TractionValue;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Four quadrilaterals over [0, 4] x [0, 2] as Abaqus/CAE writes them, with parts and an assembly.
const CAE: &str = "*Heading
** Job name: strip Model name: Model-1
*Preprint, echo=NO, model=NO, history=NO, contact=NO
**
*Part, name=Strip
*Node
      1,           0.,           0.
      2,           2.,           0.
      3,           4.,           0.
      4,           0.,           1.
      5,           2.,           1.
      6,           4.,           1.
      7,           0.,           2.
      8,           2.,           2.
      9,           4.,           2.
*Element, type=CPE4R
1, 1, 2, 5, 4
2, 2, 3, 6, 5
3, 4, 5, 8, 7
4, 5, 6,
 9, 8
*Nset, nset=Set-1, generate
 1,  9,  1
*Elset, elset=Set-1, generate
 1,  4,  1
** Section: Section-1
*Solid Section, elset=Set-1, material=Steel
2.5,
*End Part
*Assembly, name=Assembly
*Instance, name=Strip-1, part=Strip
*End Instance
*Nset, nset=Left, instance=Strip-1
 1, 4, 7
*Nset, nset=Corner, instance=Strip-1
 3,
*Elset, elset=_Right_S2, internal, instance=Strip-1
 2, 4
*Surface, type=ELEMENT, name=Right
_Right_S2, S2
*End Assembly
*Material, name=Steel
*Elastic
210000., 0.3
*Boundary
Left, XSYMM
Corner, 2, 2
** ----
*Step, name=Step-1, nlgeom=NO
*Static
1., 1., 1e-05, 1.
*Boundary
Assembly.Left, 2, 2, 0.25
*Cload
Strip-1.Corner, 1, 30.
*Dsload
Right, P, -8.
*Dload
Set-1, BY, -0.5
*Output, history, variable=PRESELECT
*End Step
";

/// A fresh folder for one test.
fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("abaqus").join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("made");
    folder
}

/// The case around an input file.
fn read(name: &str, input: &str, rest: &str) -> Result<Case, CaseErrors> {
    let folder = scratch(name);
    std::fs::write(folder.join("body.inp"), input).expect("written");
    let text = format!("{rest}\n[geometry.abaqus]\nfile = 'body.inp'\n");
    Case::parse(&text, &folder.join("case.toml"), &[])
}

fn good(name: &str, input: &str, rest: &str) -> Case {
    read(name, input, rest).unwrap_or_else(|errors| panic!("{name}: {errors}"))
}

fn notes(case: &Case) -> String {
    case.notes.iter().map(|n| format!("{n}\n")).collect()
}

#[test]
fn a_file_of_abaqus_cae_becomes_a_case() {
    let case = good("cae", CAE, "");
    let model = &case.model;
    assert_eq!((model.material.young, model.material.poisson, model.thickness), (210e3, 0.3, 2.5));
    assert_eq!(model.material.plane, riss::material::PlaneState::Strain);
    // Straight sides are one edge each, whatever elements there are.
    assert_eq!((model.domain.area(), model.domain.edges.len()), (8.0, 4));
    let part = |name: &str| model.domain.parts.iter().position(|p| p.name == name).expect(name);
    let edge = |name: &str| model.domain.edges[model.domain.parts[part(name)].edges[0]];
    assert_eq!(edge("Left"), Curve::Line { start: Vector2::new(0.0, 2.0), end: Vector2::new(0.0, 0.0) });
    // XSYMM and, in the step, a displacement along y, on the same set.
    let held: Vec<_> = model.supports.iter().map(|s| (s.part, s.direction)).collect();
    assert_eq!(held.len(), 2);
    assert!(held.iter().all(|h| h.0 == part("Left")));
    assert_eq!(model.point_supports.len(), 1);
    assert_eq!(
        (model.point_supports[0].at, model.point_supports[0].displacement),
        (Vector2::new(4.0, 0.0), [None, Some(0.0)])
    );
    assert_eq!(
        (model.point_loads[0].at, model.point_loads[0].force),
        (Vector2::new(4.0, 0.0), Vector2::new(30.0, 0.0))
    );
    assert_eq!((model.loads.len(), model.loads[0].part), (1, Some(part("Right"))));
    assert!(
        matches!(&model.loads[0].value, TractionValue::Pressure(riss::model::ScalarField::Constant(p)) if *p == -8.0)
    );
    assert!(model.body_force.is_some());
    assert_eq!(case.notes, vec![], "nothing is lost");
}

#[test]
fn what_the_case_names_itself_wins() {
    let rest = "rigid_motion = 'mean-is-zero'\nremote_stress.xx = 1\n[material]\nplane = 'stress'\nyoung = 70e3\n";
    let case = good("own", CAE, rest);
    assert_eq!((case.model.material.young, case.model.material.poisson), (70e3, 0.3));
    assert_eq!(case.model.material.plane, riss::material::PlaneState::Stress);
    assert!(case.model.supports.is_empty() && case.model.point_loads.is_empty() && case.model.body_force.is_none());
    let notes = notes(&case);
    assert!(notes.contains("the supports of the file are not taken, because the case has `rigid_motion`"), "{notes}");
    assert!(notes.contains("the loads of the file are not taken, because the case has `remote_stress`"), "{notes}");
}

/// A quarter of a ring between radii 1 and 2 from one element of eight nodes; CalculiX style.
fn quarter_ring() -> String {
    let at = |r: f64, degrees: f64| {
        format!("{:.9}, {:.9}, 0.", r * degrees.to_radians().cos(), r * degrees.to_radians().sin())
    };
    let points = [(1.0, 0.0), (2.0, 0.0), (2.0, 90.0), (1.0, 90.0), (1.5, 0.0), (2.0, 45.0), (1.5, 90.0), (1.0, 45.0)];
    let nodes: String = points.iter().enumerate().map(|(k, (r, a))| format!("{}, {}\n", k + 1, at(*r, *a))).collect();
    format!(
        "*NODE, NSET=NALL\n{nodes}*ELEMENT, TYPE=CPS8, ELSET=EALL\n1, 1,2,3,4,5,6,7,8\n\
         *MATERIAL, NAME=AL\n*ELASTIC\n70.D3, .33, 20.\n60.D3, .33, 300.\n*SOLID SECTION, ELSET=EALL, MATERIAL=AL\n\
         *BOUNDARY\n1, 2\n2, 2\n5, 2\n3, 1\n4, 1\n7, 1\n*STEP\n*STATIC\n*DLOAD\nEALL, P4, 5.\n*EQUATION\n2\n1,1,1.,2,1,-1.\n\
         *NODE FILE\nU\n*END STEP\n"
    )
}

#[test]
fn edges_of_quadratic_elements_are_arcs() {
    let case = good("ring", &quarter_ring(), "");
    let domain = &case.model.domain;
    let exact = 0.25 * std::f64::consts::PI * (4.0 - 1.0);
    // Coordinates have nine digits.
    assert!((domain.area() / exact - 1.0).abs() < 1e-8, "{}", domain.area());
    let arcs: Vec<f64> = domain
        .edges
        .iter()
        .filter_map(|c| match c {
            Curve::Arc { radius, .. } => Some(*radius),
            Curve::Line { .. } => None,
        })
        .collect();
    assert_eq!((domain.edges.len(), arcs.len()), (4, 2));
    // The face P4 is the inner arc.
    let part = case.model.domain.parts.iter().find(|p| p.name == "EALL-P4").expect("the loaded face");
    assert!(matches!(domain.edges[part.edges[0]], Curve::Arc { radius, .. } if (radius - 1.0).abs() < 1e-8));
    assert_eq!(case.model.material.young, 70e3);
    assert_eq!(case.model.point_supports.len(), 6);
    let notes = notes(&case);
    assert!(notes.contains("further rows of *ELASTIC (line 13)") && notes.contains("*EQUATION (line 28)"), "{notes}");
}

#[test]
fn triangles_and_lines_as_gmsh_writes_them() {
    // Two triangles, and a line in a set of its own.
    let input = "*Heading\n square.inp\n*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n\
        ******* E L E M E N T S *************\n*ELEMENT, type=T3D2, ELSET=Line1\n1, 1, 2\n\
        *ELEMENT, type=CPS3, ELSET=Surface1\n2, 1, 2, 3\n3, 1, 3, 4\n*ELSET,ELSET=ground\n1\n";
    let rest = "support = [{ on = 'ground', x = 0, y = 0 }]\nload = [{ on = 'outline', pressure = 1 }]\n\
        material = { young = 1, poisson = 0.3 }\n";
    let case = good("gmsh", input, rest);
    let ground = case.model.domain.parts.iter().find(|p| p.name == "ground").expect("the set of lines");
    assert_eq!((ground.edges.len(), case.model.domain.area()), (1, 1.0));
    assert_eq!(case.model.title, "square.inp");
}

/// The message for a file that cannot be used.
fn check_refused(name: &str, input: &str, expected: &str) {
    let errors = read(name, input, "").map(|_| ()).expect_err("a bad file");
    let text = errors.to_string();
    assert!(text.contains("geometry.abaqus.file") && text.contains(expected), "{name}: {text}");
}

#[test]
fn bad_files_are_explained_with_their_line() {
    let with = |from: &str, to: &str| {
        assert!(CAE.contains(from), "{from}");
        CAE.replacen(from, to, 1)
    };
    check_refused("text", "hello\n", "line 1: the file does not begin with a keyword");
    check_refused("empty", "", "there are no plane elements");
    check_refused("solid", &with("CPE4R", "C3D8R"), "line 16, *ELEMENT: element type C3D8R is a solid");
    check_refused("round", &with("CPE4R", "CAX4"), "element type CAX4 is axisymmetric");
    check_refused("warm", &with("CPE4R", "CPE4T"), "element type CPE4T is not known");
    check_refused("number", &with("2.,           1.", "2.,          1.x"), "line 11, *NODE: `1.x` is not a coordinate");
    check_refused("infinite", &with("2.,           1.", "2.,        1e999"), "`1e999` is not a coordinate");
    check_refused(
        "flat",
        &with("      5,           2.,           1.", "5, 2."),
        "node 5 has fewer than two coordinates",
    );
    check_refused("twice", &with("      9,  ", "      8,  "), "line 15, *NODE: node 8 is there twice");
    check_refused("missing", &with("1, 1, 2, 5, 4", "1, 1, 2, 5, 44"), "node 44 is missing");
    check_refused("short", &with("4, 5, 6,\n 9, 8\n", "4, 5, 6, 9\n"), "element 4 has fewer than 4 nodes");
    check_refused("long", &with("1, 1, 2, 5, 4", "1, 1, 2, 5, 4, 7"), "element 1 has more than 4 nodes");
    check_refused("folded", &with("1, 1, 2, 5, 4", "1, 1, 2, 3, 4"), "line");
    check_refused("set", &with("Left, XSYMM", "Lift, XSYMM"), "line 46, *BOUNDARY: there are no nodes `Lift`");
    check_refused("kind", &with("Left, XSYMM", "Left, HINGED"), "neither a direction nor a known type");
    check_refused("face", &with("_Right_S2, S2", "_Right_S2, S7"), "line 40, *SURFACE: `S7` is not a face S1 to S4");
    check_refused("inside", &with("_Right_S2, S2", "_Right_S2, S4"), "no face of `Right` lies on the boundary");
    check_refused(
        "rotation",
        &with("Strip-1.Corner, 1, 30.", "Strip-1.Corner, 6, 30."),
        "`6` is no direction of the plane",
    );
    check_refused("huge", &with(" 1,  9,  1", " 1,  99999999999,  1"), "is no range of members");
    check_refused("moved", &with("part=Strip\n*End", "part=Strip\n5., 0., 0.\n*End"), "the instance is moved");
    check_refused("include", &with("*Assembly", "*Include, input=mesh.inp\n*Assembly"), "other files are not read");
    check_refused(
        "mixed",
        &with("3, 4, 5, 8, 7", "*Element, type=CPS4\n3, 4, 5, 8, 7"),
        "of plane stress and of plane strain",
    );
    check_refused("pieces", &with("2, 2, 3, 6, 5\n3, 4, 5, 8, 7\n", ""), "touches itself at (2, 1)");
}

#[test]
fn what_is_ignored_is_named() {
    let input = CAE.replace("*Dsload\n", "*Temperature\nLeft, 20.\n*Dsload, amplitude=Ramp\n");
    let input = input
        .replace("*End Step\n", "*End Step\n*Step\n*Static\n*Cload\n1, 1, 5.\n*End Step\n*Element, type=MASS\n20, 1\n");
    let case = good("ignored", &input, "");
    let notes = notes(&case);
    for text in [
        "*TEMPERATURE (line 56)",
        "AMPLITUDE of *DSLOAD (line 58)",
        "*CLOAD (line 66)",
        "*ELEMENT of type MASS (line 69)",
    ] {
        assert!(notes.contains(text), "{text}: {notes}");
    }
}

#[test]
fn no_bytes_make_it_panic() {
    let ring = quarter_ring();
    let folder = scratch("bytes");
    let case = "[geometry.abaqus]\nfile = 'body.inp'\n";
    let mut state = 12345u64;
    let mut random = |n: usize| {
        // The generator of Knuth's MMIX.
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize % n
    };
    for round in 0..600 {
        let mut bytes = if round % 2 == 0 { CAE.as_bytes().to_vec() } else { ring.as_bytes().to_vec() };
        match round % 3 {
            0 => bytes.truncate(random(bytes.len())),
            1 => (0..3).for_each(|_| {
                let at = random(bytes.len());
                bytes[at] = b"*,-0.9e\n\xff"[random(9)];
            }),
            _ => {
                let (a, b) = (random(bytes.len()), random(bytes.len()));
                bytes.drain(a.min(b)..a.max(b));
            }
        }
        std::fs::write(folder.join("body.inp"), &bytes).expect("written");
        let _ = Case::parse(case, &folder.join("case.toml"), &[]);
    }
}

#[test]
fn an_imported_case_runs_once_it_has_a_crack() {
    let folder = scratch("import");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let file = root.join("cases/abaqus-hole-crack/plate.inp").canonicalize().expect("there");
    let run = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_riss")).args(arguments).current_dir(&folder).output().expect("riss runs")
    };
    let output = run(&["import", file.to_str().expect("plain")]);
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(output.status.success() && text.contains("young = 72000.0"), "{text}");
    let text = text.replace("# [[crack]]\n# path = [[0, 0], [1, 0]]", "[[crack]]\npath = [[5, 0], [9, 0]]");
    std::fs::write(folder.join("case.toml"), text).expect("written");
    let checked = run(&["check", "case.toml"]);
    assert!(checked.status.success(), "{}", String::from_utf8_lossy(&checked.stderr));
    assert_eq!(run(&["import", "missing.inp"]).status.code(), Some(2));
}
