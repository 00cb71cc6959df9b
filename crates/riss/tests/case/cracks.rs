//! Crack ends: tips, mouths and clipped overhang.

use super::{bad, good, template};
use riss::crack::CrackPath;
use riss::crack::EndKind::{Junction, Mouth, Tip};

fn crack(path: &str) -> CrackPath {
    with_geometry("", path).0
}

fn with_geometry(extra: &str, path: &str) -> (CrackPath, usize) {
    let mut template = template();
    template.geometry += &format!("{extra}[[crack]]\n{path}\n");
    let case = good(&template);
    (case.model.cracks[0].clone(), case.notes.len())
}

#[test]
fn ends_inside_are_tips_and_ends_on_the_boundary_mouths() {
    let inner = crack("path = [[1, 8], [3.5, 8]]");
    assert_eq!((inner.ends, inner.name.as_str()), ([Tip; 2], "crack-1"));
    let edge = crack("path = [[0, 8], [3.5, 8]]");
    assert_eq!(edge.ends, [Mouth, Tip]);
    let through = crack("path = [[0, 8], [3.5, 9], [7, 8]]");
    assert_eq!(through.ends, [Mouth; 2]);
}

#[test]
fn mouths_are_exactly_on_the_boundary() {
    for end in ["[7.000001, 5.3]", "[6.999999, 5.3]", "[7, 5.3]"] {
        let (path, notes) = with_geometry("", &format!("path = [[3.5, 8], {end}]"));
        assert_eq!((path.vertices[1].x, path.ends[1], notes), (7.0, Mouth, 0), "{end}");
    }
}

#[test]
fn a_small_overhang_is_clipped_with_a_note() {
    let (path, notes) = with_geometry("", "path = [[-0.5, 8], [3.5, 9]]");
    assert_eq!((path.vertices[0].x, path.ends[0], notes), (0.0, Mouth, 1));
    assert!((path.vertices[0].y - 8.125).abs() < 1e-12);
    let mut template = template();
    template.geometry += "[[crack]]\npath = [[-3, 8], [3.5, 9]]\n";
    assert!(bad(&template).contains("outside the body"));
}

#[test]
fn cracks_may_start_at_holes() {
    let hole = "[[hole]]\ncircle = { center = [3, 8], radius = 1 }\n";
    let (path, notes) = with_geometry(hole, "path = [[4, 8], [5, 8]]");
    assert_eq!((path.ends, notes), ([Mouth, Tip], 0));
    let (path, notes) = with_geometry(hole, "path = [[3.9, 8], [5, 8]]");
    assert!((path.vertices[0].x - 4.0).abs() < 1e-14 && path.ends[0] == Mouth && notes == 1);
}

#[test]
fn arcs_become_fine_polylines() {
    let arc = crack("arc = { start = [2, 8], through = [3, 9], end = [4, 8] }");
    // Tangents of 2 degrees each, so that the end segments point as the arc does.
    assert!((91..95).contains(&arc.vertices.len()), "{}", arc.vertices.len());
    let center = riss::math::Vector2::new(3.0, 8.0);
    assert!(arc.vertices.iter().all(|p| (0.0..2e-4).contains(&((p - center).norm() - 1.0 + 1e-14))));
    let first = (arc.vertices[1] - arc.vertices[0]).normalize();
    assert!(first.x.abs() < 1e-12 && first.y > 0.0, "{first:?}");
    let turn = |w: &[riss::math::Vector2]| {
        let (a, b) = (w[1] - w[0], w[2] - w[1]);
        riss::math::cross(a, b).atan2(a.dot(&b)).to_degrees().abs()
    };
    assert!(arc.vertices.windows(3).all(|w| turn(w) < 2.0 + 1e-9));
    let fine = crack("arc = { start = [2, 8], through = [3, 9], end = [4, 8], spacing = 0.01 }");
    assert!(fine.segments().all(|(a, b)| (b - a).norm() <= 0.01));
}

/// All cracks of a case, and the number of notes.
fn all_cracks(paths: &[&str]) -> (Vec<CrackPath>, usize) {
    let mut template = template();
    template.geometry += &paths.iter().map(|p| format!("[[crack]]\npath = {p}\n")).collect::<String>();
    let case = good(&template);
    (case.model.cracks.clone(), case.notes.len())
}

#[test]
fn cracks_that_meet_are_joined_with_a_note() {
    let (tee, notes) = all_cracks(&["[[0, 8], [4, 8]]", "[[2, 8], [2, 10]]"]);
    assert_eq!((tee[0].ends, tee[1].ends, tee[0].vertices.len(), notes), ([Mouth, Tip], [Junction, Tip], 3, 1));
    let (cross, notes) = all_cracks(&["[[1, 8], [4, 8]]", "[[2, 7], [3, 9]]"]);
    assert_eq!((cross[0].ends, cross[1].ends, notes), ([Tip; 2], [Tip; 2], 1));
    assert_eq!(cross[0].vertices[1], cross[1].vertices[1]);
    assert!((cross[0].vertices[1] - riss::math::Vector2::new(2.5, 8.0)).norm() < 1e-12);
    let (star, notes) = all_cracks(&["[[3, 8], [4, 8]]", "[[3, 8], [2, 9]]", "[[3, 8], [2, 7]]"]);
    assert!(star.iter().all(|c| c.ends == [Junction, Tip]) && notes == 1);
    // Two mouths in one place.
    let (vee, notes) = all_cracks(&["[[0, 8], [2, 9]]", "[[0, 8], [2, 7]]"]);
    assert!(vee.iter().all(|c| c.ends == [Mouth, Tip]) && notes == 1);
}

#[test]
fn cracks_that_run_along_each_other_are_refused() {
    let mut template = template();
    template.geometry += "[[crack]]\npath = [[0, 8], [4, 8]]\n[[crack]]\npath = [[3, 8], [5, 8]]\n";
    assert!(bad(&template).contains("runs along the crack `crack-1`"));
}

#[test]
fn a_crack_may_run_close_to_the_boundary_it_starts_from() {
    let shallow = crack("path = [[0, 8], [0.05, 12]]");
    assert_eq!(shallow.ends, [Mouth, Tip]);
}

const LAW: &str = "material.cohesive = { strength = 3, fracture_energy = 0.1 }\n";

/// Problems of a case with a crack, as `key: message`.
fn problems(head: &str, crack: &str) -> Vec<String> {
    let mut template = template();
    template.head = head.into();
    template.geometry += &format!("[[crack]]\n{crack}\n");
    let text = template.text().replace("[material]\n", "").replace("young", "material.young");
    let text = text.replace("poisson", "material.poisson").replace("plane", "material.plane");
    let read = riss::case::Case::parse(&text, "case.toml".as_ref(), &[]);
    let all = read.map(|_| ()).err().map_or(vec![], |errors| errors.problems);
    all.iter().map(|p| format!("{}: {}", p.key, p.message)).collect()
}

#[test]
fn cohesive_cracks_get_vertices_where_notches_end() {
    let mut template = template();
    template.head = "loading.stop_load = 0.1".into();
    template.geometry += "[[crack]]\ncohesive = true\npath = [[0, 8], [4, 8], [4, 9], [6, 9]]\n\
        notch = [{ lower = [-1, 7], upper = [1, 9] }, { lower = [3.5, 7.5], upper = [4.5, 8.25] }]\n";
    let text =
        template.text().replace("young = 1\n", "young = 1\ncohesive = { strength = 3, fracture_energy = 0.1 }\n");
    let case = riss::case::Case::parse(&text, "case.toml".as_ref(), &[]).unwrap();
    let found: Vec<(f64, f64)> = case.model.cracks[0].vertices.iter().map(|p| (p.x, p.y)).collect();
    assert_eq!(found, [(0.0, 8.0), (1.0, 8.0), (3.5, 8.0), (4.0, 8.0), (4.0, 8.25), (4.0, 9.0), (6.0, 9.0)]);
    assert_eq!(case.loading.unwrap().stop_load, 0.1);
    let crack = case.model.cohesive_crack(0).unwrap();
    let midpoints = case.model.cracks[0].segments().map(|(a, b)| (a + b) * 0.5);
    assert_eq!(midpoints.map(|p| crack.is_notch(p)).collect::<Vec<_>>(), [true, false, true, true, false, false]);
}

#[test]
fn what_does_not_go_with_cohesive_cracks_is_refused() {
    let crack = "path = [[0, 8], [3, 8]]\ncohesive = true";
    assert_eq!(problems("", crack), ["crack[0].cohesive: there is no law for it"]);
    assert_eq!(problems(LAW, "path = [[0, 8], [3, 8]]"), ["material.cohesive: no crack is cohesive"]);
    assert_eq!(problems("loading.steps = 5", "path = [[0, 8], [3, 8]]"), ["loading: no crack is cohesive"]);
    let notch = "path = [[0, 8], [3, 8]]\nnotch = [{ lower = [0, 7], upper = [1, 9] }]";
    assert_eq!(problems("", notch), ["crack[0].notch: only a cohesive crack has notches"]);
    let flat = format!("{crack}\nnotch = [{{ lower = [0, 9], upper = [1, 9] }}]");
    assert_eq!(
        problems(LAW, &flat),
        ["crack[0].notch[0].upper: every coordinate must be greater than that of `lower`"]
    );
    let all = format!(
        "{LAW}constraints = 'lagrange-multipliers'\ncontact = {{}}\naccuracy.K_percent = 1\n\
         approximation.enrichment.kind = 'extrinsic-mls'\ngrowth = {{ law = 'equal', stop.cycles = 3 }}"
    );
    let found = problems(&all, &format!("{crack}\npressure = 1"));
    for key in [
        "constraints",
        "contact",
        "accuracy",
        "approximation.enrichment.kind",
        "growth.law",
        "growth.stop",
        "crack[0].pressure",
    ] {
        assert!(found.iter().any(|p| p.starts_with(&format!("{key}: "))), "{key}: {found:#?}");
    }
    let started = problems(
        &format!("{LAW}growth.seeding = {{ length = 0.5, number = 1 }}\nconstraints = 'lagrange-multipliers'"),
        "path = [[0, 8], [3, 8]]",
    );
    assert_eq!(started, ["constraints: cracks that start are cohesive: faces are joined in a definite matrix"]);
    let particles = problems(&format!("{LAW}method = 'cracking-particles'"), crack);
    assert!(particles.iter().any(|p| p.starts_with("method: crack[0] is cohesive")), "{particles:?}");
    let weak =
        problems("material.cohesive = { strength = 0, fracture_energy = -1 }\nloading.largest_displacement = 0", crack);
    assert_eq!(weak.len(), 3, "{weak:?}");
}
