//! Cracks that are not plane: kinks, waves, caps and cones, against uniform stress and against finite elements.
//!
//! References "FE": an independent program with quadratic triangles and quarter-point elements, in plane strain with the
//! interaction integral (meshes of 0.02 and 0.01 at the tips agree within 0.02 %), with rotational symmetry from the opening
//! behind the front (0.01 and 0.005 agree within 0.3 %, a plane disc is 0.05 % below its closed form in a body of this size).

use proptest::prelude::*;
use riss::analysis::{Silent, SolidResult, solid_static};
use riss::case::AnyCase;
use riss::math::Vector3;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::path::Path;

type Triangles = Vec<[Vector3; 3]>;

const HEAD: &str =
    "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = { young = 1000, poisson = 0.3 }\n";

/// Solves a case whose crack is given by triangles.
fn solve(name: &str, triangles: &Triangles, body: &str) -> SolidResult {
    let mut stl = "solid crack\n".to_string();
    for corners in triangles {
        stl.push_str("facet normal 0 0 0\nouter loop\n");
        corners.iter().for_each(|p| writeln!(stl, "vertex {} {} {}", p.x, p.y, p.z).unwrap());
        stl.push_str("endloop\nendfacet\n");
    }
    stl.push_str("endsolid crack\n");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    std::fs::write(folder.join(format!("{name}.stl")), stl).unwrap();
    let text = format!("{HEAD}crack = [{{ name = 'c', stl = '{name}.stl' }}]\n{body}");
    let case = AnyCase::parse(&text, &folder.join("case.toml"), &[]).map_err(|e| e.to_string()).unwrap();
    let AnyCase::Solid(case) = case else { panic!() };
    solid_static(&case.model, &case.settings, &mut Silent).unwrap()
}

/// A profile in x and z, drawn out along y.
fn drawn_out(profile: &[[f64; 2]], y: [f64; 2]) -> Triangles {
    let at = |k: usize, j: usize| Vector3::new(profile[k][0], y[j], profile[k][1]);
    let quad = |k: usize| [[at(k, 0), at(k + 1, 0), at(k + 1, 1)], [at(k, 0), at(k + 1, 1), at(k, 1)]];
    (0..profile.len() - 1).flat_map(quad).collect()
}

/// Triangles of the unit disc, moved by a function of radius and angle.
fn disc(rings: usize, around: usize, place: impl Fn(f64, f64) -> Vector3) -> Triangles {
    let at = |i: usize, j: usize| place(i as f64 / rings as f64, TAU * (j % around) as f64 / around as f64);
    let mut triangles: Triangles = (0..around).map(|j| [at(0, 0), at(1, j), at(1, j + 1)]).collect();
    for (i, j) in (1..rings).flat_map(|i| (0..around).map(move |j| (i, j))) {
        triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
        triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    triangles
}

/// Length of a piece of a folded crack.
const PIECE: f64 = 0.3;

proptest! {
    #![proptest_config(ProptestConfig { cases: 4, ..ProptestConfig::default() })]
    /// Tension along the generators of a crack does not feel it, however that is folded.
    #[test]
    fn tension_along_folds_is_uniform(turns in proptest::collection::vec(-0.9..0.9f64, 2..5), seed in 0u32..1000) {
        let (mut profile, mut angle) = (vec![[-0.5, 0.1]], 0.0);
        for turn in &turns {
            angle += turn;
            let [x, z] = profile[profile.len() - 1];
            profile.push([x + PIECE * f64::cos(angle), z + PIECE * f64::sin(angle)]);
        }
        let body = "geometry.box = { lower = [-1.6, 0, -1.6], upper = [1.6, 0.4, 1.6] }\nremote_stress.yy = 1\n\
                    nodes = { spacing = 0.4, front_spacing = 0.1, growth = 0.3 }\nfracture.points = 3";
        let found = solve(&format!("folds-{seed}"), &drawn_out(&profile, [-0.1, 0.5]), body);
        for stress in &found.stresses {
            prop_assert!((stress[(1, 1)] - 1.0).abs() < 1e-5 && (stress.norm() - 1.0).abs() < 1e-5, "{stress}");
        }
        for p in found.fronts.iter().flat_map(|f| &f.points) {
            // Beyond the last fold the rule of a disc does not know where the integrand breaks.
            let allowed = if p.radius.is_some_and(|r| r < PIECE) { 1e-5 } else { 2e-3 };
            if let Some(f) = p.factors {
                prop_assert!(f.factors.iter().all(|k| k.abs() < allowed), "{f:?}");
            }
        }
    }
}

/// A crack from (-1, 0) to the origin with a kink of length 0.5, plane strain in a square of side 10 under tension, FE.
///
/// - `references`: K_I, K_II at the end of the kink, then at the straight end
fn check_kink(degrees: f64, references: [[f64; 2]; 2], tolerance: f64) {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let profile = [[-1.0, 0.0], [0.0, 0.0], [0.5 * cos, 0.5 * sin]];
    let body = "geometry.box = { lower = [-5, 0, -5], upper = [5, 0.4, 5] }\n\
                support = [{ on = ['y-min', 'y-max'], normal = 0 }]\n\
                load = [{ on = 'z-max', traction = [0, 0, 1] }, { on = 'z-min', traction = [0, 0, -1] }]\n\
                nodes = { spacing = 1.0, front_spacing = 0.05 }\nfracture.points = 3";
    let found = solve(&format!("kink-{degrees}"), &drawn_out(&profile, [-0.1, 0.5]), body);
    assert_eq!(found.fronts.len(), 2);
    for front in &found.fronts {
        let reference = references[usize::from(front.points[0].point.position.x < -0.9)];
        let size = reference[0].hypot(reference[1]);
        for p in &front.points {
            let k = p.factors.expect("a disc fits").factors;
            let far = (0..2).map(|m| (k[m] - reference[m]).abs() / size).fold(0.0, f64::max);
            assert!(far < tolerance, "{degrees}: {k:?} {reference:?}");
            assert!(k[2].abs() < tolerance * size, "{degrees}: {k:?}");
        }
    }
}

#[test]
fn a_crack_with_a_kink_of_5_degrees() {
    check_kink(5.0, [[1.57222, 0.14117], [1.58137, 0.01103]], 0.01);
}

#[test]
fn a_crack_with_a_kink_of_20_degrees() {
    check_kink(20.0, [[1.41690, 0.53325], [1.55850, 0.03971]], 0.015);
}

/// What is left comes from the hollow side of the kink, where stresses are infinite: 20 % without fitted nodes there.
#[test]
fn a_crack_with_a_kink_of_45_degrees() {
    check_kink(45.0, [[0.85199, 0.92969], [1.47642, 0.05312]], 0.04);
}

/// A crack with rotational symmetry in a block of half side 5 under tension along its axis.
fn check_round(name: &str, triangles: &Triangles, reference: [f64; 2], tolerance: f64) {
    let body = "geometry.box = { lower = [-5, -5, -5], upper = [5, 5, 5] }\nremote_stress.zz = 1\n\
                nodes = { spacing = 1.2, front_spacing = 0.09, growth = 0.14 }\nfracture.points = 8";
    let found = solve(name, triangles, body);
    let size = reference[0].hypot(reference[1]);
    for p in &found.fronts[0].points {
        let k = p.factors.expect("a disc fits").factors;
        let far = (0..2).map(|m| (k[m] - reference[m]).abs() / size).fold(k[2].abs() / size, f64::max);
        assert!(far < tolerance, "{name}: {k:?} {reference:?}");
    }
}

/// Waves of 0.02 rad leave K_I = 2 σ √(a/π) [Sneddon1946], and no more than their angle of the others.
#[test]
fn a_disc_with_waves() {
    let wave = |x: f64, y: f64| 0.02 / 8.0 * (8.0 * x).sin() * (8.0 * y).cos();
    let place = |r: f64, angle: f64| {
        let (sin, cos) = angle.sin_cos();
        Vector3::new(r * cos, r * sin, wave(r * cos, r * sin))
    };
    check_round("waves", &disc(16, 96, place), [2.0 / PI.sqrt(), 0.0], 0.025);
}

/// Caps of a sphere whose half angle is `degrees`, FE.
fn check_cap(degrees: f64, reference: [f64; 2], tolerance: f64) {
    let half = degrees.to_radians();
    let radius = 1.0 / half.sin();
    let place = |r: f64, angle: f64| {
        let (sin, cos) = (r * half).sin_cos();
        Vector3::new(radius * sin * angle.cos(), radius * sin * angle.sin(), radius * (cos - half.cos()))
    };
    check_round(&format!("cap-{degrees}"), &disc(24, 96, place), reference, tolerance);
}

#[test]
fn a_flat_cap() {
    check_cap(15.0, [1.0653, -0.2972], 0.025);
}

#[test]
fn a_cap_of_half_a_right_angle() {
    check_cap(30.0, [0.8739, -0.5459], 0.03);
}
