//! Cohesive cracks in the plane against closed forms.

use riss::analysis::{
    GrowthEndKind, GrowthState, LoadPoint, Observer, PlaneLoadingRecord, StaticResult, plane_loading,
};
use riss::case::Case;
use riss::material::{CohesiveLaw, Softening};
use std::ops::ControlFlow;

#[derive(Default)]
struct Kept {
    steps: Vec<StaticResult>,
    /// What a killed run would have left.
    ways: Vec<GrowthState>,
    /// Break off after this many states of growth, or points of the curve.
    most: Option<usize>,
}

impl Observer for Kept {
    fn step(&mut self, result: &StaticResult, _state: Option<&GrowthState>) -> ControlFlow<()> {
        self.steps.push(result.clone());
        ControlFlow::Continue(())
    }

    fn ways_grown(&mut self, state: &GrowthState) -> ControlFlow<()> {
        self.ways.push(state.clone());
        self.goes_on(self.ways.len())
    }

    fn load_curve(&mut self, curve: &[LoadPoint]) -> ControlFlow<()> {
        self.goes_on(curve.len())
    }
}

impl Kept {
    fn goes_on(&self, n: usize) -> ControlFlow<()> {
        if self.most.is_some_and(|most| n >= most) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

fn load_from(text: &str, from: Option<GrowthState>, mut kept: Kept) -> (Option<PlaneLoadingRecord>, Kept) {
    let case = Case::parse(text, "case.toml".as_ref(), &[]).map_err(|e| e.to_string()).unwrap();
    let loading = case.loading.unwrap();
    let record = plane_loading(&case.model, &case.settings, &loading, case.growth.as_ref(), from, &mut kept);
    (record.unwrap(), kept)
}

fn load(text: &str) -> (PlaneLoadingRecord, Kept) {
    let (record, kept) = load_from(text, None, Kept::default());
    (record.unwrap(), kept)
}

/// A bar that is pulled apart across one section: everywhere the same opening.
///
/// With the stress σ = t(w), its elongation is L σ/E + w.
#[test]
fn a_bar_follows_the_law() {
    let (young, length, area, strength, energy) = (30000.0, 40.0, 20.0, 3.0, 0.1);
    for (name, softening) in
        [("exponential", Softening::Exponential), ("linear", Softening::Linear), ("bilinear", Softening::Bilinear)]
    {
        for ends in [
            "support = [{ on = 'bottom', y = 0 }, { on = 'top', y = 0.01 }, { at = [5, 0], x = 0 }]",
            "support = [{ at = [0, 0], x = 0, y = 0 }, { at = [10, 0], y = 0 }]\nconstraints.penalty.factor = 1e5\n\
             load = [{ on = 'top', traction = [0, 1] }, { on = 'bottom', traction = [0, -1] }]",
            "rigid_motion = 'mean-is-zero'\nload = [{ on = 'top', traction = [0, 1] }, { on = 'bottom', traction = [0, -1] }]",
        ] {
            let (record, kept) = load(&format!(
                "{ends}\ngeometry.rectangle = {{ lower = [0, 0], upper = [10, {length}] }}\n\
                 crack = [{{ cohesive = true, path = [[0, 18], [10, 18]] }}]\nloading.stop_load = 0.001\n\
                 [material]\nyoung = {young}\npoisson = 0.2\nplane = 'stress'\nthickness = 2\n\
                 cohesive = {{ strength = {strength}, fracture_energy = {energy}, softening = '{name}' }}"
            ));
            let law = CohesiveLaw { strength, fracture_energy: energy, softening, shear_ratio: 0.0 };
            let peak = record.curve[record.peak];
            assert!((peak.load / (strength * area) - 1.0).abs() < 1e-5, "{name} {ends}: {peak:?}");
            assert_eq!(record.end.kind, GrowthEndKind::LimitReached, "{:?}", record.end);
            for point in &record.curve {
                let stress = point.load / area;
                let opening = point.displacement - length * stress / young;
                if point.crack_area > 0.0 {
                    let expected = law.softening(opening.max(0.0))[0];
                    assert!((stress - expected).abs() < 1e-4 * strength, "{name}: {stress} {expected}");
                }
                let balance = point.external_work - point.elastic_energy - point.dissipated_energy;
                assert!(balance.abs() < 2e-3 * energy * area, "{name}: {point:?}");
            }
            let end = record.curve[record.curve.len() - 1];
            let dissipated = law.dissipated(end.displacement - length * end.load / area / young) * area;
            assert!((end.dissipated_energy / dissipated - 1.0).abs() < 1e-4, "{end:?} {dissipated}");
            assert!(end.dissipated_energy > 0.98 * energy * area && (end.crack_area / area - 1.0).abs() < 1e-9);
            assert!(kept.steps.iter().any(|s| s.step.step == record.peak));
            assert_eq!(kept.steps.last().unwrap().step.step, record.curve.len() - 1);
            for step in &kept.steps {
                let point = record.curve[step.step.step];
                let stress = point.load / area;
                let elastic = 0.5 * stress * stress / young * area * length;
                let greatest = 0.5 * strength * strength / young * area * length;
                assert!((step.strain_energy - elastic).abs() < 1e-6 * greatest, "{} {elastic}", step.strain_energy);
                let faces = &step.fields.crack_faces[0];
                let opening = point.displacement - length * stress / young;
                for k in 0..faces.positions.len() {
                    assert!((faces.traction[k] - stress).abs() < 1e-5 * strength);
                    assert!(((faces.left[k] - faces.right[k]).y - opening).abs() < 1e-5 * law.opening_scale());
                }
                for (_, force) in step.step.reactions.iter().filter(|r| r.0 == "top") {
                    assert!((force.y - point.load).abs() < 1e-6 * peak.load, "{force:?} {point:?}");
                }
            }
        }
    }
}

/// A section that is not square to the bar slides as it opens: with `n·e_y = cos θ` the effective traction is `q σ`,
/// `q² = cos⁴θ + sin²θ cos²θ/β²`, and the elongation `L σ/E + δ q/cos θ`.
#[test]
fn an_inclined_section_opens_and_slides() {
    let (young, length, area, strength, energy, beta) = (30000.0, 40.0, 10.0, 3.0, 0.1, 0.8);
    let (record, _) = load(&format!(
        "support = [{{ on = 'bottom', y = 0 }}, {{ on = 'top', y = 0.01 }}, {{ at = [5, 0], x = 0 }}]\n\
         geometry.rectangle = {{ lower = [0, 0], upper = [10, {length}] }}\n\
         crack = [{{ cohesive = true, path = [[0, 18], [10, 20.5]] }}]\n\
         [material]\nyoung = {young}\npoisson = 0.2\nplane = 'stress'\n\
         cohesive = {{ strength = {strength}, fracture_energy = {energy}, shear_ratio = {beta} }}"
    ));
    let law = CohesiveLaw { strength, fracture_energy: energy, softening: Softening::Exponential, shear_ratio: beta };
    let cos = 1.0 / (1.0 + 0.25f64 * 0.25).sqrt();
    let q = (cos.powi(4) + (1.0 - cos * cos) * cos * cos / (beta * beta)).sqrt();
    assert!(
        (record.curve[record.peak].load / area * q / strength - 1.0).abs() < 1e-3,
        "{:?}",
        record.curve[record.peak]
    );
    let whole = area / cos * (1.0 - 1e-6);
    let mut n = 0;
    for point in record.curve.iter().filter(|p| p.crack_area > whole) {
        let stress = point.load / area;
        let effective = (point.displacement - length * stress / young) * cos / q;
        let expected = law.softening(effective.max(0.0))[0] / q;
        assert!((stress - expected).abs() < 1e-3 * strength, "{stress} {expected}");
        n += 1;
    }
    assert!(n > 50);
}

/// Both halves of a symmetric specimen are as good as each other: past the peak only one of its cracks opens on, through the
/// point where the path forks and through pairs that unload and load again.
#[test]
fn a_symmetric_specimen_breaks_all_through() {
    let specimen = |geometry: &str| {
        format!(
            "{geometry}\nloading.stop_load = 0.01\nnodes.layout.graded.tip_spacing = 1.3\n\
             [material]\nyoung = 36000\npoisson = 0.1\nplane = 'stress'\n\
             cohesive = {{ strength = 3, fracture_energy = 0.011 }}"
        )
    };
    let (whole, kept) = load(&specimen(
        "geometry.rectangle = { lower = [0, -62.5], upper = [60, 62.5] }\n\
         support = [{ on = 'bottom', y = 0 }, { on = 'top', y = 0.01 }, { at = [30, -62.5], x = 0 }]\n\
         crack = [{ cohesive = true, path = [[0, 0], [60, 0]], \
         notch = [{ lower = [0, -1], upper = [5, 1] }, { lower = [55, -1], upper = [60, 1] }] }]",
    ));
    let (half, _) = load(&specimen(
        "geometry.rectangle = { lower = [0, -62.5], upper = [30, 62.5] }\n\
         support = [{ on = 'bottom', y = 0 }, { on = 'top', y = 0.01 }, { on = 'right', x = 0 }]\n\
         crack = [{ cohesive = true, path = [[0, 0], [30, 0]], notch = [{ lower = [0, -1], upper = [5, 1] }] }]",
    ));
    let [a, b] = [&whole, &half].map(|r| r.curve[r.peak]);
    assert!((a.load / (2.0 * b.load) - 1.0).abs() < 2e-3, "{a:?} {b:?}");
    for record in [&whole, &half] {
        assert_eq!(record.end.kind, GrowthEndKind::LimitReached, "{:?}", record.end);
        let mut work = 0.0f64;
        for point in &record.curve {
            let balance = point.external_work - point.elastic_energy - point.dissipated_energy;
            work = work.max(point.external_work);
            assert!(balance.abs() <= 3e-3 * work, "{point:?}");
        }
    }
    // It leans: somewhere past the peak one notch is open more than twice as far as the other.
    let ratio = |step: &StaticResult| {
        let faces = &step.fields.crack_faces[0];
        let opening = |x: f64| {
            let k = (0..faces.positions.len())
                .min_by(|i, j| (faces.positions[*i].x - x).abs().total_cmp(&(faces.positions[*j].x - x).abs()));
            k.map_or(0.0, |k| (faces.left[k] - faces.right[k]).y)
        };
        let [left, right] = [6.0, 54.0].map(opening);
        (left / right).max(right / left)
    };
    let before = kept.steps.iter().filter(|s| s.step.step <= whole.peak).map(ratio).fold(0.0, f64::max);
    let after = kept.steps.iter().filter(|s| s.step.step > whole.peak).map(ratio).fold(0.0, f64::max);
    assert!(before < 1.1 && after > 2.0, "{before} {after}");
}

const BEAM: &str = "rigid_motion = 'mean-is-zero'\ngeometry.rectangle = { lower = [-170, 0], upper = [170, 75] }\n\
    crack = [{ cohesive = true, path = [[-60, 0], [-60, 37.5]], notch = [{ lower = [-61, -1], upper = [-59, 30] }] }]\n\
    load = [{ on = 'top', traction = [0, '-max(0, 1 - (x/10)^2)'] }, { on = 'bottom', traction = \
    [0, '0.5*max(0, 1 - ((x - 150)/10)^2) + 0.5*max(0, 1 - ((x + 150)/10)^2)'] }]\n\
    growth.increment = 6\ngrowth.steps = 4\nloading.largest_displacement = 0.05\n\
    [material]\nyoung = 38000\npoisson = 0.2\nplane = 'stress'\ncohesive = { strength = 3, fracture_energy = 0.069 }";

#[test]
fn growth_goes_on_bit_by_bit_where_a_run_was_killed() {
    let (whole, kept) = load(BEAM);
    let path = &whole.model.cracks[0].vertices;
    // The notch of the case ends below the drawn crack, which gets a vertex there.
    assert!(path[1].y == 30.0 && path[2].y == 37.5 && path.len() == 7, "{path:?}");
    assert!(whole.growth_end.as_ref().is_some_and(|e| e.kind == GrowthEndKind::StepsDone), "{:?}", whole.growth_end);
    assert!(kept.steps.iter().all(|s| s.step.cracks[0].path == *path));
    let (none, killed) = load_from(BEAM, None, Kept { most: Some(3), ..Kept::default() });
    assert!(none.is_none() && killed.ways.len() == 3 && killed.steps.is_empty());
    let (again, _) = load_from(BEAM, killed.ways.last().cloned(), Kept::default());
    let again = again.unwrap();
    assert_eq!(again.curve, whole.curve);
    assert_eq!(again.model.cracks, whole.model.cracks);
    // Where growth is over, the observer ends the curve.
    let (none, stopped) = load_from(BEAM, kept.ways.last().cloned(), Kept { most: Some(9), ..Kept::default() });
    assert!(none.is_none() && stopped.steps.is_empty());
}
