//! Cases of solids: what they mean, and what is wrong with them.

use super::*;
use crate::crack::CrackFront;
use crate::math::Vector3;
use crate::model::{SolidDirection, SurfacePoint};
use std::f64::consts::PI;

const HEAD: &str = "method = 'collocation'\nmaterial = { young = 1000, poisson = 0.3 }\n";
const BOX: &str = "geometry.box = { lower = [-2, -2, -2], upper = [2, 2, 2] }\n";

fn parse(text: &str) -> SolidCase {
    match AnyCase::parse(text, "case.toml".as_ref(), &[]) {
        Ok(AnyCase::Solid(case)) => *case,
        Ok(AnyCase::Plane(_)) => panic!("a case in the plane"),
        Err(errors) => panic!("{errors}"),
    }
}

fn problems(text: &str) -> Vec<String> {
    let errors = AnyCase::parse(text, "case.toml".as_ref(), &[]).expect_err("a bad case");
    errors.problems.iter().map(|p| format!("{}: {}", p.key, p.message)).collect()
}

fn at(position: Vector3, normal: Vector3) -> SurfacePoint<3> {
    SurfacePoint { position, normal, sight: position }
}

#[test]
fn other_methods_are_left_to_the_plane() {
    let text = "rigid_motion = 'mean-is-zero'\nmaterial = { young = 1, poisson = 0.3, plane = 'strain' }\n\
        geometry.rectangle = { lower = [0, 0], upper = [1, 2] }\nremote_stress.yy = 1";
    assert!(matches!(AnyCase::parse(text, "case.toml".as_ref(), &[]), Ok(AnyCase::Plane(_))));
}

#[test]
fn conditions_belong_to_their_parts() {
    let case = parse(&format!(
        "{HEAD}{BOX}body_force.z = -3\n\
         load = [{{ on = 'z-max', traction = [1, '2*z', 0] }}, {{ on = ['x-min', 'z-max'], pressure = 'y' }}]\n\
         support = [{{ on = 'z-min', x = 0, z = 'x + nz' }}, {{ on = 'y-min', normal = 0 }}]"
    ));
    let part = |name: &str| case.model.body.parts().iter().position(|p| p.name == name).unwrap();
    let traction = |name: &str, at: &SurfacePoint<3>| case.model.solid.parts[part(name)].traction.value(at);
    let top = at(Vector3::new(1.0, 0.5, 2.0), Vector3::z());
    assert_eq!(traction("z-max", &top), Vector3::new(1.0, 4.0, -0.5));
    let side = at(Vector3::new(-2.0, 0.5, 0.0), -Vector3::x());
    assert_eq!(traction("x-min", &side), Vector3::new(0.5, 0.0, 0.0));
    assert_eq!(traction("x-max", &side), Vector3::zeros());
    let held = &case.model.solid.parts[part("z-min")].displacements;
    assert_eq!(held.len(), 2);
    assert_eq!(held[1].direction, SolidDirection::Fixed(Vector3::z()));
    assert_eq!(held[1].value.value(&at(Vector3::new(1.5, 0.0, -2.0), -Vector3::z())).z, 0.5);
    assert_eq!(case.model.solid.parts[part("y-min")].displacements[0].direction, SolidDirection::Normal);
    assert_eq!(case.model.solid.body_force.value(&top), Vector3::new(0.0, 0.0, -3.0));
}

#[test]
fn voids_are_free_of_the_remote_stress_and_have_one_name() {
    let case = parse(&format!(
        "{HEAD}{BOX}rigid_motion = 'mean-is-zero'\nremote_stress.xx = 2\n\
         void = [{{ ball = {{ center = [0, 0, 0], radius = 0.5 }} }},\n\
                 {{ name = 'bore', cylinder = {{ from = [1, 1, -1], to = [1, 1, 1], radius = 0.2 }} }}]"
    ));
    let names: Vec<&str> = case.model.body.parts().iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names[6..], ["void-1", "bore", "bore", "bore"]);
    let here = at(Vector3::zeros(), Vector3::x());
    for (k, part) in case.model.solid.parts.iter().enumerate() {
        assert_eq!(part.traction.value(&here).x, if k < 6 { 2.0 } else { 0.0 });
    }
    let volume = 64.0 - 4.0 / 3.0 * PI * 0.125 - PI * 0.04 * 2.0;
    assert!((case.model.body.volume() / volume - 1.0).abs() < 1e-3);
}

#[test]
fn cracks_have_names_and_fronts() {
    let case = parse(&format!(
        "{HEAD}{BOX}rigid_motion = 'mean-is-zero'\n\
         crack = [{{ ellipse = {{ center = [0, 0, 0], normal = [0, 0, 2], axis = [1, 0, 5], radii = [1, 0.5] }}, pressure = 3 }},\n\
                  {{ name = 'edge', polygon = [[-2, -2, 1], [-1, -2, 1], [-1, 2, 1], [-2, 2, 1]] }}]"
    ));
    assert_eq!(case.model.crack_names, ["crack-1", "edge"]);
    let length = |f: &CrackFront| f.length;
    assert!((length(&case.model.cracks[1].fronts[0]) - 4.0).abs() < 1e-4);
    // Ramanujan's circumference of an ellipse, good to eight digits here.
    let h: f64 = (0.5f64 / 1.5).powi(2);
    let around = PI * 1.5 * (1.0 + 3.0 * h / (10.0 + (4.0 - 3.0 * h).sqrt()));
    assert!((length(&case.model.cracks[0].fronts[0]) / around - 1.0).abs() < 1e-4);
    let face = at(Vector3::zeros(), -Vector3::z());
    assert_eq!(case.model.solid.faces[0].value(&face), Vector3::new(0.0, 0.0, 3.0));
}

#[test]
fn all_problems_come_together_with_their_lines() {
    let text = "method = 'collocation'\nmaterial = { young = -1, poisson = 0.5 }\n\
        geometry.box = { lower = [0, 0, 0], upper = [1, 1, 1] }\n\
        [[crack]]\ndisc = { center = [9, 9, 9], normal = [0, 0, 1], radius = 0.2 }\n\
        [[crack]]\npolygon = [[0, 0, 0.5], [1, 0, 0.5]]\n\
        [[load]]\non = 'left'\ntraction = [1, 0, 0]\n\
        [[load]]\non = 'x-max'\npressure = '2*q'\n\
        [nodes]\nspacing = -2\n";
    let errors = AnyCase::parse(text, "case.toml".as_ref(), &[]).expect_err("a bad case");
    let found: Vec<(usize, &str)> = errors.problems.iter().map(|p| (p.line, p.key.as_str())).collect();
    for expected in [
        (2, "material.young"),
        (2, "material.poisson"),
        (5, "crack[0].disc"),
        (7, "crack[1].polygon"),
        (9, "load[0].on"),
        (13, "load[1].pressure"),
        (15, "nodes.spacing"),
    ] {
        assert!(found.contains(&expected), "{expected:?} in {found:?}");
    }
}

#[test]
fn contradictions_are_named() {
    let check = |rest: &str, expected: &str| {
        let found = problems(&format!("{HEAD}{BOX}{rest}"));
        assert!(found.iter().any(|p| p.contains(expected)), "{rest}: {found:?}");
    };
    check("remote_stress.zz = 1", "nothing holds the body");
    check("rigid_motion = 'mean-is-zero'", "nothing loads the body");
    check("support = [{ on = 'z-min' }]", "no direction is given");
    check("support = [{ on = 'z-min', z = 1 }, { on = ['x-min', 'z-min'], x = 0 }]", "already has a support");
    check("support = [{ on = 'boundary', exact = true }]", "no sound [exact] section");
    check("void = [{ name = 'v' }]", "a void has one shape");
    check("part = [{ name = 'p', within = { lower = [5, 5, 5], upper = [6, 6, 6] } }]", "no triangle");
    check("nodes.spacing = 0.01\nremote_stress.zz = 1", "nodes");
    check("crack = [{ stl = 'missing.stl' }]", "no such file");
    let crossing = "crack = [{ disc = { center = [0, 0, 0], normal = [0, 0, 1], radius = 1 } },\n\
        { disc = { center = [0, 0, 0], normal = [1, 0, 1], radius = 0.5 } }]";
    check(crossing, "cracks must not meet");
}

/// Corners of a tetrahedron and its faces.
const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

#[test]
fn stl_files_give_one_part_for_each_smooth_piece() {
    let mut text = String::from("solid t\n");
    for face in FACES {
        text += "facet normal 0 0 0\nouter loop\n";
        for k in face {
            let [x, y, z] = CORNERS[k];
            text += &format!("vertex {x} {y} {z}\n");
        }
        text += "endloop\nendfacet\n";
    }
    text += "endsolid t\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("t.stl"), &text).unwrap();
    let path = folder.path().join("case.toml");
    let case = format!(
        "{HEAD}geometry.stl.file = 't.stl'\nrigid_motion = 'mean-is-zero'\nload = [{{ on = 'face-1', pressure = 1 }}]"
    );
    let Ok(AnyCase::Solid(case)) = AnyCase::parse(&case, &path, &[]) else { panic!() };
    let body = &case.model.body;
    assert!((body.volume() - 1.0 / 6.0).abs() < 1e-12);
    let names: Vec<&str> = body.parts().iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["face-1", "face-2", "face-3", "face-4"]);
    // The largest piece comes first.
    assert!((body.area(Some(0)) - 0.75f64.sqrt()).abs() < 1e-12);
    std::fs::write(folder.path().join("t.stl"), "solid nonsense").unwrap();
    assert!(AnyCase::parse(&format!("{HEAD}geometry.stl.file = 't.stl'"), &path, &[]).is_err());
}

#[test]
fn gmsh_models_give_one_part_for_each_physical_surface() {
    let mut text = String::from(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n2 7 \"slope\"\n$EndPhysicalNames\n$Nodes\n4\n",
    );
    for (k, [x, y, z]) in CORNERS.iter().enumerate() {
        text += &format!("{} {x} {y} {z}\n", k + 1);
    }
    text += "$EndNodes\n$Elements\n5\n";
    for (k, face) in FACES.iter().enumerate() {
        let group = if k == 3 { 7 } else { 4 };
        text += &format!("{} 2 2 {group} {} {} {} {}\n", k + 1, k + 1, face[0] + 1, face[1] + 1, face[2] + 1);
    }
    text += "5 4 2 1 1 1 2 3 4\n$EndElements\n";
    let mesh = crate::case::gmsh::read_gmsh_surface(text.as_bytes()).unwrap();
    let names: Vec<&str> = mesh.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["physical-4", "slope"]);
    let surface = crate::geometry::surface::Surface::closed(mesh, 0.5).unwrap();
    assert!((surface.volume() - 1.0 / 6.0).abs() < 1e-15 && surface.n_patches() == 4);
    // The reader of plane meshes refuses solids as before.
    assert!(crate::case::gmsh::read_gmsh(text.as_bytes()).unwrap_err().to_string().contains("is a solid"));
}

#[test]
fn cohesive_cracks_have_a_law_and_notches() {
    let crack = "crack = [{ cohesive = true, polygon = [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], \
        notch = [{ lower = [1, -2, -1], upper = [2, 2, 1] }] }]\n";
    let load = "rigid_motion = 'mean-is-zero'\nremote_stress.zz = 1\n";
    let law = "material.cohesive = { strength = 3, fracture_energy = 0.1, softening = 'linear' }\n";
    let case = parse(
        &format!("{HEAD}{law}{BOX}{load}{crack}")
            .replace("material = { young = 1000, poisson = 0.3 }", "material.young = 1000\nmaterial.poisson = 0.3"),
    );
    let cohesive = case.model.cohesive.as_ref().unwrap();
    assert_eq!(cohesive.law.strength, 3.0);
    let notched = case.model.cohesive_crack(0).unwrap();
    assert!(notched.is_notch(Vector3::new(1.5, 0.0, 0.0)) && !notched.is_notch(Vector3::zeros()));
    assert_eq!(case.loading, Some(crate::analysis::LoadingSettings::default()));

    let without = problems(&format!("{HEAD}{BOX}{load}{crack}"));
    assert_eq!(without, ["crack[0].cohesive: there is no law for it"]);
    let idle = problems(&format!("{HEAD}{BOX}{load}loading.steps = 3"));
    assert_eq!(idle, ["loading: no crack is cohesive"]);
    let disc = "crack = [{ disc = { center = [0, 0, 0], normal = [0, 0, 1], radius = 1 }, notch = [{ lower = [0, 0, 0], upper = [1, 1, 1] }] }]";
    assert_eq!(problems(&format!("{HEAD}{BOX}{load}{disc}")), ["crack[0].notch: only a cohesive crack has notches"]);
    let weak = format!("{HEAD}{BOX}{load}{crack}loading.largest_displacement = -1\n")
        .replace("poisson = 0.3", "poisson = 0.3, cohesive = { strength = 0, fracture_energy = -1 }");
    let found = problems(&weak);
    assert_eq!(found.len(), 3, "{found:?}");
    let growing = format!("{HEAD}{BOX}{load}{crack}growth = {{ steps = 1, increment = 1, criterion.stress-intensity-factors = {{ exponent = 2 }} }}")
        .replace("poisson = 0.3", "poisson = 0.3, cohesive = { strength = 3, fracture_energy = 1 }");
    assert!(problems(&growing).iter().any(|p| p.starts_with("growth.criterion: crack[0] is cohesive")));
}
