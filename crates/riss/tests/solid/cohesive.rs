//! Cohesive cracks against closed forms.

use riss::analysis::{CohesiveSurfaces, GrowthEndKind, LoadingRecord, LoadingStep, Observer, solid_loading};
use riss::case::AnyCase;
use riss::material::{CohesiveLaw, Softening};
use std::ops::ControlFlow;

#[derive(Default)]
struct Kept {
    steps: Vec<LoadingStep>,
    /// What a killed run would have left.
    surfaces: Vec<CohesiveSurfaces>,
}

impl Observer for Kept {
    fn loading_step(&mut self, step: &LoadingStep) -> ControlFlow<()> {
        self.steps.push(step.clone());
        ControlFlow::Continue(())
    }

    fn surfaces_grown(&mut self, surfaces: &CohesiveSurfaces) -> ControlFlow<()> {
        self.surfaces.push(surfaces.clone());
        ControlFlow::Continue(())
    }
}

fn load(text: &str) -> (LoadingRecord, Vec<LoadingStep>) {
    let (record, kept) = load_from(text, None);
    (record, kept.steps)
}

fn load_from(text: &str, from: Option<CohesiveSurfaces>) -> (LoadingRecord, Kept) {
    let case = AnyCase::parse(text, "case.toml".as_ref(), &[]).map_err(|e| e.to_string()).unwrap();
    let AnyCase::Solid(case) = case else { panic!("a solid") };
    let mut kept = Kept::default();
    let cohesive = case.model.cohesive.as_ref().unwrap();
    let record = solid_loading(
        &case.model,
        cohesive,
        &case.settings,
        &case.loading.unwrap(),
        case.growth.as_ref(),
        from,
        &mut kept,
    )
    .unwrap();
    (record.unwrap(), kept)
}

/// A bar that is pulled apart across one plane: everywhere the same opening.
///
/// With the stress σ = t(w), its elongation is L σ/E + w.
#[test]
fn a_bar_follows_the_law() {
    let (young, length, area, strength, energy) = (30000.0, 40.0, 100.0, 3.0, 0.1);
    for (softening, curve) in
        [("exponential", Softening::Exponential), ("linear", Softening::Linear), ("bilinear", Softening::Bilinear)]
    {
        for ends in [
            "support = [{ on = 'z-min', z = 0 }, { on = 'z-max', z = 0.01 }]",
            "load = [{ on = 'z-max', traction = [0, 0, 1] }, { on = 'z-min', traction = [0, 0, -1] }]",
        ] {
            let (record, steps) = load(&format!(
                "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = {{ young = {young}, poisson = 0.2, \
                 cohesive = {{ strength = {strength}, fracture_energy = {energy}, softening = '{softening}' }} }}\n\
                 geometry.box = {{ lower = [0, 0, 0], upper = [10, 10, {length}] }}\nnodes.spacing = 3\n{ends}\n\
                 crack = [{{ cohesive = true, polygon = [[0, 0, 18], [10, 0, 18], [10, 10, 18], [0, 10, 18]] }}]\n\
                 loading.stop_load = 0.001"
            ));
            let law = CohesiveLaw { strength, fracture_energy: energy, softening: curve, shear_ratio: 0.0 };
            let peak = record.curve[record.peak];
            assert!((peak.load / (strength * area) - 1.0).abs() < 1e-5, "{softening} {ends}: {peak:?}");
            assert_eq!(record.end.kind, GrowthEndKind::LimitReached, "{:?}", record.end);
            for point in &record.curve {
                let stress = point.load / area;
                let opening = point.displacement - length * stress / young;
                if point.crack_area > 0.0 {
                    let expected = law.softening(opening.max(0.0))[0];
                    assert!((stress - expected).abs() < 1e-4 * strength, "{softening}: {stress} {expected}");
                }
                let balance = point.external_work - point.elastic_energy - point.dissipated_energy;
                assert!(balance.abs() < 2e-3 * energy * area, "{softening}: {point:?}");
            }
            let end = record.curve[record.curve.len() - 1];
            let dissipated = law.dissipated(end.displacement - length * end.load / area / young) * area;
            assert!((end.dissipated_energy / dissipated - 1.0).abs() < 1e-4, "{end:?} {dissipated}");
            assert!(end.dissipated_energy > 0.98 * energy * area);
            assert!((end.crack_area / area - 1.0).abs() < 1e-6);
            assert!(steps.iter().any(|s| s.is_peak) && steps.last().unwrap().point == record.curve.len() - 1);
            for step in &steps {
                let stress = step.values.load / area;
                assert!(step.tractions[0].iter().all(|t| (t - stress).abs() < 1e-4 * strength));
            }
        }
    }
}

/// A plane that is not square to the bar slides as it opens: with `n·e_z = cos θ` the effective traction is `q σ`,
/// `q² = cos⁴θ + sin²θ cos²θ/β²`, and the elongation `L σ/E + δ q/cos θ`.
///
/// Virtual work is integrated node by node: tractions of a uniform stress that is not square to the plane vary by a tenth from
/// pair to pair, so that pairs open one after the other and the peak is 0.45 % low.
#[test]
fn an_inclined_plane_opens_and_slides() {
    let (young, length, area, strength, energy, beta) = (30000.0, 40.0, 100.0, 3.0, 0.1, 0.8);
    let (record, _) = load(&format!(
        "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = {{ young = {young}, poisson = 0.2, \
         cohesive = {{ strength = {strength}, fracture_energy = {energy}, shear_ratio = {beta} }} }}\n\
         geometry.box = {{ lower = [0, 0, 0], upper = [10, 10, {length}] }}\nnodes.spacing = 3\n\
         support = [{{ on = 'z-min', z = 0 }}, {{ on = 'z-max', z = 0.01 }}]\n\
         crack = [{{ cohesive = true, polygon = [[0, 0, 18], [10, 0, 20.5], [10, 10, 20.5], [0, 10, 18]] }}]"
    ));
    let law = CohesiveLaw { strength, fracture_energy: energy, softening: Softening::Exponential, shear_ratio: beta };
    let cos = 1.0 / (1.0 + 0.25f64 * 0.25).sqrt();
    let q = (cos.powi(4) + (1.0 - cos * cos) * cos * cos / (beta * beta)).sqrt();
    let peak = record.curve[record.peak].load / area;
    assert!((peak * q / strength - 1.0).abs() < 5e-3, "{peak} {}", strength / q);
    assert_eq!(record.end.kind, GrowthEndKind::LimitReached, "{:?}", record.end);
    let whole = area / cos * (1.0 - 1e-6);
    assert!(record.curve.iter().filter(|p| p.crack_area > whole).count() > 50);
    // In the first of them the last pair is about to open.
    for point in record.curve.iter().filter(|p| p.crack_area > whole).skip(1) {
        let stress = point.load / area;
        let effective = (point.displacement - length * stress / young) * cos / q;
        let expected = law.softening(effective.max(0.0))[0] / q;
        assert!((stress - expected).abs() < 1e-3 * strength, "{stress} {expected}");
    }
}

/// A surface that begins as a strip grows across a bar under uniform tension, which then follows the law as a whole:
/// peak `f_t A`, stress `t(w)`. The tied part ahead changes nothing.
#[test]
fn a_strip_grows_through_a_bar() {
    let (young, length, area, strength, energy) = (30000.0, 40.0, 100.0, 3.0, 0.1);
    let (record, steps) = load(&format!(
        "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = {{ young = {young}, poisson = 0.2, \
         cohesive = {{ strength = {strength}, fracture_energy = {energy} }} }}\n\
         geometry.box = {{ lower = [0, 0, 0], upper = [10, 10, {length}] }}\nnodes.spacing = 3\n\
         support = [{{ on = 'z-min', z = 0 }}, {{ on = 'z-max', z = 0.01 }}]\n\
         crack = [{{ cohesive = true, polygon = [[0, 0, 18], [3, 0, 18], [3, 10, 18], [0, 10, 18]] }}]\n\
         growth = {{ steps = 40, increment = 3, criterion.largest-principal-stress = {{ tensile_strength = {strength} }} }}"
    ));
    assert!((record.surfaces[0].areas[0] - 30.0).abs() < 1e-9);
    let last = record.surfaces.last().unwrap();
    assert!((last.areas[0] - area).abs() < 1e-6 * area && last.strips > 0, "{last:?}");
    assert!((record.curve[record.peak].load / (strength * area) - 1.0).abs() < 1e-5);
    let law = CohesiveLaw { strength, fracture_energy: energy, softening: Softening::Exponential, shear_ratio: 0.0 };
    for point in record.curve.iter().filter(|p| p.crack_area > 0.0) {
        let stress = point.load / area;
        let expected = law.softening((point.displacement - length * stress / young).max(0.0))[0];
        assert!((stress - expected).abs() < 1e-4 * strength, "{stress} {expected}");
    }
    assert!(steps.iter().all(|s| s.model.cracks[0].fronts.is_empty()));
}

/// A run that goes on from the surfaces that another left comes to the same path, bit by bit.
#[test]
fn growth_goes_on_from_the_surfaces_of_another_run() {
    let text = "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = { young = 30000, poisson = 0.2, \
         cohesive = { strength = 3, fracture_energy = 0.1 } }\n\
         geometry.box = { lower = [0, 0, 0], upper = [10, 10, 40] }\nnodes.spacing = 3\n\
         support = [{ on = 'z-min', z = 0 }, { on = 'z-max', z = 0.01 }]\n\
         crack = [{ cohesive = true, polygon = [[0, 0, 18], [3, 0, 18], [3, 10, 18], [0, 10, 18]] }]\n\
         growth = { steps = 40, increment = 3, criterion.largest-principal-stress = { tensile_strength = 3 } }";
    let (whole, kept) = load_from(text, None);
    assert!(whole.surfaces.len() > 1 && kept.surfaces.len() + 1 == whole.surfaces.len());
    for surfaces in kept.surfaces {
        let stored = serde_json::to_string(&surfaces).unwrap();
        let (rest, _) = load_from(text, Some(serde_json::from_str(&stored).unwrap()));
        assert_eq!(rest.curve, whole.curve);
        assert_eq!(rest.surfaces, whole.surfaces);
    }
}

/// With no steps left a path ends where the front would have to grow.
#[test]
fn growth_ends_with_its_steps() {
    let (record, _) = load(
        "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = { young = 30000, poisson = 0.2, \
         cohesive = { strength = 3, fracture_energy = 0.1 } }\n\
         geometry.box = { lower = [0, 0, 0], upper = [10, 10, 40] }\nnodes.spacing = 3\n\
         support = [{ on = 'z-min', z = 0 }, { on = 'z-max', z = 0.01 }]\n\
         crack = [{ cohesive = true, polygon = [[0, 0, 18], [3, 0, 18], [3, 10, 18], [0, 10, 18]] }]\n\
         growth = { steps = 1, increment = 3, criterion.largest-principal-stress = { tensile_strength = 3 } }",
    );
    assert_eq!((record.end.kind, record.surfaces.len()), (GrowthEndKind::StepsDone, 2), "{:?}", record.end);
}

/// A bar that is bent: ahead of the front the stress falls to nothing and into compression, where directions are noise. The
/// surface stays plane, and the load is that of the whole plane as far as its nodes are the same.
#[test]
fn a_strip_grows_straight_in_bending() {
    let text = |far: f64, growth: &str| {
        format!(
            "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = {{ young = 30000, poisson = 0.2, \
             cohesive = {{ strength = 3, fracture_energy = 0.1 }} }}\n\
             geometry.box = {{ lower = [0, 0, 0], upper = [12, 6, 30] }}\nnodes.spacing = 2\n\
             load = [{{ on = 'z-max', traction = [0, 0, '(6 - x)/6'] }}, {{ on = 'z-min', traction = [0, 0, '(x - 6)/6'] }}]\n\
             crack = [{{ cohesive = true, polygon = [[0, 0, 14], [{far}, 0, 14], [{far}, 6, 14], [0, 6, 14]] }}]\n\
             loading.stop_load = 0.5\n{growth}"
        )
    };
    let (whole, _) = load(&text(12.0, ""));
    let growth =
        "growth = { steps = 40, increment = 3, criterion.largest-principal-stress = { tensile_strength = 3 } }";
    let (record, steps) = load(&text(4.0, growth));
    assert!(record.surfaces.len() > 1, "{:?}", record.end);
    let surface = &steps[steps.len() - 1].model.cracks[0].surface;
    assert!(surface.vertices().iter().all(|p| (p.z - 14.0).abs() < 1e-6), "{:?}", record.surfaces);
    let [peak, expected] = [&record, &whole].map(|r| r.curve[r.peak].load);
    assert!((peak / expected - 1.0).abs() < 0.05, "{peak} {expected}");
}

/// Half of the end of a bar is moved, the other half pulled by the stress that goes with it: the stress is uniform, and the
/// force on the half that is moved is that stress over its area, though the support ends amid the surface.
#[test]
fn the_force_on_a_support_that_ends_amid_a_surface_is_that_of_a_uniform_stress() {
    let (young, length, displacement) = (30000.0, 40.0, 1e-3);
    // Corners of the lower end, then around the two halves of the upper one.
    let corners = [[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0]];
    let upper = [[0, 0, 40], [5, 0, 40], [10, 0, 40], [10, 10, 40], [5, 10, 40], [0, 10, 40]];
    let faces: [(&str, &[usize]); 7] = [
        ("bottom", &[0, 3, 2, 1]),
        ("moved", &[4, 5, 8, 9]),
        ("pulled", &[5, 6, 7, 8]),
        ("side", &[0, 1, 6, 5, 4]),
        ("side", &[1, 2, 7, 6]),
        ("side", &[2, 3, 9, 8, 7]),
        ("side", &[3, 0, 4, 9]),
    ];
    let names = ["bottom", "moved", "pulled", "side"];
    let tag = |name: &str| 1 + names.iter().position(|n| *n == name).unwrap();
    let mut mesh = String::from("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n");
    names.iter().for_each(|n| mesh += &format!("2 {} \"{n}\"\n", tag(n)));
    mesh += "$EndPhysicalNames\n$Nodes\n10\n";
    for (k, [x, y, z]) in corners.iter().chain(&upper).enumerate() {
        mesh += &format!("{} {x} {y} {z}\n", k + 1);
    }
    let fan = |c: &[usize]| -> Vec<[usize; 3]> { (1..c.len() - 1).map(|k| [c[0], c[k], c[k + 1]]).collect() };
    let triangles: Vec<_> = faces.iter().flat_map(|(n, c)| fan(c).into_iter().map(|t| (tag(n), t))).collect();
    mesh += &format!("$EndNodes\n$Elements\n{}\n", triangles.len());
    for (k, (tag, [a, b, c])) in triangles.iter().enumerate() {
        mesh += &format!("{} 2 2 {tag} {tag} {} {} {}\n", k + 1, a + 1, b + 1, c + 1);
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bar.msh");
    std::fs::write(&file, mesh + "$EndElements\n").unwrap();
    let (record, _) = load(&format!(
        "method = 'collocation'\nfiles = 'anywhere'\nrigid_motion = 'mean-is-zero'\nmaterial = {{ young = {young}, poisson = 0.2, \
         cohesive = {{ strength = 3, fracture_energy = 0.1 }} }}\ngeometry.gmsh = {{ file = '{}' }}\nnodes.spacing = 3\n\
         support = [{{ on = 'bottom', z = 0 }}, {{ on = 'moved', z = {displacement} }}]\n\
         load = [{{ on = 'pulled', traction = [0, 0, {}] }}]\n\
         crack = [{{ cohesive = true, polygon = [[0, 0, 18], [10, 0, 18], [10, 10, 18], [0, 10, 18]] }}]\n\
         loading.steps = 1",
        file.display(),
        young * displacement / length,
    ));
    let point = record.curve[1];
    let stiffness = point.load / point.displacement;
    // What is left, 1e-5, is the integration of the virtual field over the boundary.
    assert!((stiffness / (young * 50.0 / length) - 1.0).abs() < 1e-4, "{stiffness}");
}
