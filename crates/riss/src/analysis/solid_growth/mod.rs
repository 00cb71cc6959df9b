//! Cracks of an elastic solid that grow by their fronts, step by step: solve, ask the criterion, advance, place nodes anew.
//!
//! Reading order: [`settings`], [`SolidGrowthState`], [`solid_growth`], [`drive`] (how each vertex moves).

pub(super) mod drive;
pub mod settings;

use super::growth_record::{GrowthEnd, GrowthEndKind};
use super::record::Observer;
use super::solid_record::SolidResult;
use super::solid_static::{SolidSettings, Solved};
use crate::crack::{CrackDefect, CrackSurface, EdgeLimits, FrontStep, GrowingCrack};
use crate::error::Result;
use crate::geometry::surface::Surface;
use crate::model::SolidModel;
use drive::Drive;
use serde::{Deserialize, Serialize};
pub use settings::{FrontCriterion, SolidGrowthSettings};

/// Where growth stands at the beginning of a step. The same state gives the same steps, bit by bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SolidGrowthState {
    /// Number of the step.
    pub step: usize,
    /// Cracks in this step.
    pub cracks: Vec<GrowingCrack>,
    /// Which crack of the model each one goes on from; the first of those that joined.
    pub sources: Vec<usize>,
}

/// One step of growth.
#[derive(Clone, Debug)]
pub struct SolidStep {
    /// Number of the step, from 0.
    pub step: usize,
    /// The problem with the cracks of this step.
    pub model: SolidModel,
    /// The solution.
    pub result: SolidResult,
    /// Area of each crack in the body [area].
    pub areas: Vec<f64>,
    /// The same after the fronts moved [area]; fewer where cracks joined.
    pub areas_after: Vec<f64>,
    /// Factor on the loads at which the strength is reached somewhere; for the factors none.
    pub load_factor: Option<f64>,
    /// Number of vertices of fronts, and of those that move.
    pub n_vertices: usize,
    /// Number of those that move.
    pub n_moving: usize,
    /// Why growth ends with this step, if it does.
    pub end: Option<GrowthEnd>,
}

impl SolidGrowthState {
    /// The state of the first step.
    ///
    /// # Errors
    /// [`CrackDefect`] if a crack lies outside the body.
    pub fn first(model: &SolidModel) -> std::result::Result<Self, CrackDefect> {
        let begin =
            |c: &CrackSurface| GrowingCrack::new(&crate::crack::CrackShape::Triangles(c.surface.mesh()), &model.body);
        let cracks = model.cracks.iter().map(begin).collect::<std::result::Result<Vec<_>, _>>()?;
        Ok(Self { step: 0, sources: (0..cracks.len()).collect(), cracks })
    }

    /// The problem with the cracks as they are now.
    pub(in crate::analysis) fn model(&self, model: &SolidModel) -> std::result::Result<SolidModel, CrackDefect> {
        let surfaces = self.cracks.iter().map(|c| CrackSurface::new(&c.shape(), &model.body));
        let mut current = model.clone();
        current.cracks = surfaces.collect::<std::result::Result<Vec<_>, _>>()?;
        current.crack_names = self.sources.iter().map(|s| model.crack_names[*s].clone()).collect();
        current.solid.faces = self.sources.iter().map(|s| model.solid.faces[*s].clone()).collect();
        if let (Some(now), Some(before)) = (&mut current.cohesive, &model.cohesive) {
            now.cracks = self.sources.iter().map(|s| before.cracks[*s].clone()).collect();
        }
        Ok(current)
    }

    /// The state after the fronts moved.
    pub(in crate::analysis) fn advanced(
        &self,
        steps: &[Vec<Vec<FrontStep>>],
        limits: &EdgeLimits,
        body: &Surface,
    ) -> std::result::Result<Self, CrackDefect> {
        let (mut cracks, mut sources, mut steps) = (self.cracks.clone(), self.sources.clone(), steps.to_vec());
        let mut a = 0;
        while a < cracks.len() {
            let join = |b: usize| {
                GrowingCrack::joined([&cracks[a], &cracks[b]], [&steps[a], &steps[b]], limits, body).map(|j| (b, j))
            };
            if let Some((b, (crack, its_steps))) = (a + 1..cracks.len()).find_map(join) {
                (cracks[a], steps[a]) = (crack, its_steps);
                cracks.remove(b);
                sources.remove(b);
                steps.remove(b);
            } else {
                a += 1;
            }
        }
        let open = |c: &GrowingCrack| Surface::open(c.mesh(), 0.5);
        let mut surfaces = cracks.iter().map(open).collect::<std::result::Result<Vec<_>, _>>()?;
        for c in 0..cracks.len() {
            let others: Vec<&Surface> = surfaces.iter().enumerate().filter(|(o, _)| *o != c).map(|(_, s)| s).collect();
            cracks[c] = cracks[c].advanced(&steps[c], limits, body, &others)?;
            surfaces[c] = open(&cracks[c])?;
        }
        Ok(Self { step: self.step + 1, cracks, sources })
    }

    /// Area of each crack in the body [area].
    pub(in crate::analysis) fn areas(&self) -> Vec<f64> {
        self.cracks.iter().map(GrowingCrack::area).collect()
    }
}

/// Grows the cracks of a solid; from `state` on if there is one. None if the observer ended it.
///
/// # Errors
/// Those of nodes, shape functions and solver. What the geometry of grown cracks does not allow ends growth instead.
pub fn solid_growth(
    model: &SolidModel,
    settings: &SolidSettings,
    growth: &SolidGrowthSettings,
    state: Option<SolidGrowthState>,
    observer: &mut dyn Observer,
) -> Result<Option<GrowthEnd>> {
    let failed = |defect: CrackDefect| GrowthEnd { kind: GrowthEndKind::Failed, reason: defect.to_string() };
    let mut state = match state.map_or_else(|| SolidGrowthState::first(model), Ok) {
        Ok(state) => state,
        Err(defect) => return Ok(Some(failed(defect))),
    };
    let limits = EdgeLimits::of_increment(growth.increment);
    loop {
        let current = match state.model(model) {
            Ok(current) => current,
            Err(defect) => return Ok(Some(failed(defect))),
        };
        let spacing = growth.spacing.spacing(&current.cracks, &state.sources);
        let settings = SolidSettings { spacing, ..settings.clone() };
        let solved = Solved::of(&current, &settings, observer)?;
        let (mut drive, mut load_factor) = (Drive::default(), None);
        if let FrontCriterion::LargestPrincipalStress { tensile_strength } = growth.criterion {
            drive = drive::by_strength(&current, &solved, &state.cracks, growth.increment, tensile_strength)?;
            load_factor = drive.largest.filter(|l| *l > 0.0).map(f64::recip);
        }
        let result = solved.result(&current, &settings, observer)?;
        if let FrontCriterion::StressIntensityFactors { exponent, direction } = &growth.criterion {
            drive = drive::by_factors(&current, &result, &state.cracks, growth.increment, *exponent, direction);
        }
        let (next, end) = match state.advanced(&drive.steps, &limits, &model.body) {
            Ok(next) => {
                let end = end_of(growth, &state, &next, &drive);
                (next, end)
            }
            Err(defect) => (state.clone(), Some(failed(defect))),
        };
        let step = SolidStep {
            step: state.step,
            areas: state.areas(),
            areas_after: next.areas(),
            load_factor,
            n_vertices: drive.steps.iter().flatten().map(Vec::len).sum(),
            n_moving: drive.n_moving(),
            model: current,
            result,
            end,
        };
        let flow = observer.solid_step(&step, &state);
        if step.end.is_some() {
            return Ok(step.end);
        }
        if flow.is_break() {
            return Ok(None);
        }
        state = next;
    }
}

/// Why growth ends with a step, if it does.
fn end_of(
    growth: &SolidGrowthSettings,
    state: &SolidGrowthState,
    next: &SolidGrowthState,
    drive: &Drive,
) -> Option<GrowthEnd> {
    let end = |kind, reason: String| Some(GrowthEnd { kind, reason });
    if state.step >= growth.steps {
        return end(GrowthEndKind::StepsDone, format!("{} steps are done", growth.steps));
    }
    if drive.n_moving() == 0 {
        let reason = match (drive.largest, growth.criterion) {
            (None, _) => "the criterion cannot be evaluated at any front".into(),
            (Some(ratio), FrontCriterion::LargestPrincipalStress { .. }) => {
                format!("the largest principal stress ahead of the fronts is {ratio:.4} of the strength")
            }
            (Some(k), FrontCriterion::StressIntensityFactors { .. }) => {
                format!("the largest equivalent factor is {k:.4e}: nothing opens a front")
            }
        };
        return end(GrowthEndKind::NoTipGrows, reason);
    }
    if next.cracks.iter().all(|c| c.fronts().is_empty()) {
        return end(GrowthEndKind::Separated, "the cracks have no front left after this step".into());
    }
    if next.areas().iter().sum::<f64>() <= state.areas().iter().sum::<f64>() {
        return end(GrowthEndKind::NoTipGrows, "the fronts have no room to advance".into());
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{AnyCase, SolidCase};
    use std::f64::consts::PI;
    use std::ops::ControlFlow;

    /// Keeps every step.
    #[derive(Default)]
    struct Kept {
        steps: Vec<SolidStep>,
        states: Vec<SolidGrowthState>,
        last: usize,
    }

    impl Observer for Kept {
        fn solid_step(&mut self, step: &SolidStep, state: &SolidGrowthState) -> ControlFlow<()> {
            self.steps.push(step.clone());
            self.states.push(state.clone());
            if self.steps.len() == self.last { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        }
    }

    fn parse(text: &str) -> Box<SolidCase> {
        let AnyCase::Solid(case) = AnyCase::parse(text, "case.toml".as_ref(), &[]).map_err(|e| e.to_string()).unwrap()
        else {
            panic!()
        };
        case
    }

    fn grow(case: &SolidCase) -> (Kept, GrowthEnd) {
        let mut kept = Kept::default();
        let growth = case.growth.as_ref().unwrap();
        let end = solid_growth(&case.model, &case.settings, growth, None, &mut kept).unwrap().unwrap();
        (kept, end)
    }

    const PENNY: &str = "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = { young = 1000, poisson = 0.3 }\n\
        geometry.box = { lower = [-5, -5, -5], upper = [5, 5, 5] }\n\
        nodes = { spacing = 2, front_spacing = 0.11, growth = 0.25 }\nfracture.points = 6\n";

    /// A circle stays one, with `K_I = 2 σ √(a/π)` at each radius [Sneddon1946].
    #[test]
    fn a_penny_in_tension_grows_as_a_circle() {
        let case = parse(&format!(
            "{PENNY}remote_stress.zz = 1\ncrack = [{{ disc = {{ center = [0, 0, 0], normal = [0, 0, 1], radius = 1 }} }}]\n\
             growth = {{ steps = 1, increment = 0.25, criterion.stress-intensity-factors = {{ exponent = 3 }} }}"
        ));
        let (kept, end) = grow(&case);
        assert_eq!((end.kind, kept.steps.len()), (GrowthEndKind::StepsDone, 2));
        for (n, (step, state)) in kept.steps.iter().zip(&kept.states).enumerate() {
            let radius = 1.0 + 0.25 * n as f64;
            for p in &state.cracks[0].fronts()[0].line.points {
                assert!((p.position.norm() / radius - 1.0).abs() < 0.01, "{n}: {}", p.position);
            }
            let exact = 2.0 * (radius / PI).sqrt();
            for p in &step.result.fronts[0].points {
                let [k1, k2, k3] = p.factors.unwrap().factors;
                assert!(
                    (k1 / exact - 1.0).abs() < 0.02 && k2.abs() < 0.02 * exact && k3.abs() < 0.02 * exact,
                    "{n} {k1} {k2} {k3} {exact}"
                );
            }
            assert!((step.areas[0] / (PI * radius * radius) - 1.0).abs() < 0.02);
        }
    }

    /// Going on from a state gives the same bits as going through.
    #[test]
    fn growth_goes_on_from_any_step() {
        let case = parse(
            "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = { young = 1000, poisson = 0.2 }\n\
             geometry.box = { lower = [0, 0, -2], upper = [4, 1, 2] }\nnodes = { spacing = 0.5, front_spacing = 0.25 }\n\
             fracture.points = 3\nremote_stress.zz = 1\ncrack = [{ polygon = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]] }]\n\
             growth = { steps = 2, increment = 0.4, criterion.largest-principal-stress = { tensile_strength = 0.5 } }",
        );
        let (through, _) = grow(&case);
        let mut first = Kept { last: 2, ..Kept::default() };
        let growth = case.growth.as_ref().unwrap();
        assert!(solid_growth(&case.model, &case.settings, growth, None, &mut first).unwrap().is_none());
        let text = serde_json::to_string(&through.states[1]).unwrap();
        let mut second = Kept::default();
        let state = serde_json::from_str(&text).unwrap();
        solid_growth(&case.model, &case.settings, growth, Some(state), &mut second).unwrap();
        assert_eq!(second.states, through.states[1..]);
        for (a, b) in second.steps.iter().zip(&through.steps[1..]) {
            assert_eq!((&a.result.displacements, &a.areas), (&b.result.displacements, &b.areas));
        }
        assert!(through.steps.windows(2).all(|w| w[1].areas[0] > w[0].areas[0] && w[1].areas == w[0].areas_after));
    }

    /// The mean stress ahead of a penny in tension is the same all around, and sends the front straight on.
    #[test]
    fn the_strength_is_reached_all_around_a_penny() {
        let case = parse(&format!(
            "{PENNY}remote_stress.zz = 1\ncrack = [{{ disc = {{ center = [0, 0, 0], normal = [0, 0, 1], radius = 1 }} }}]\n\
             growth = {{ steps = 1, increment = 0.25, criterion.largest-principal-stress = {{ tensile_strength = 1 }} }}"
        ));
        let solved = Solved::of(&case.model, &case.settings, &mut super::super::record::Silent).unwrap();
        let cracks = SolidGrowthState::first(&case.model).unwrap().cracks;
        let of = |strength: f64| drive::by_strength(&case.model, &solved, &cracks, 0.25, strength).unwrap();
        let most = of(1.0).largest.unwrap();
        // Of the front field alone, the mean of K_I/√(2πr) over the places straight ahead would be 1.8.
        assert!(most > 1.2 && most < 2.4, "{most}");
        let (all, none) = (of(0.95 * most), of(1.001 * most));
        assert_eq!((all.n_moving(), none.n_moving()), (cracks[0].fronts()[0].vertices.len(), 0));
        for (step, p) in all.steps[0][0].iter().zip(&cracks[0].fronts()[0].line.points) {
            assert_eq!((step.direction, step.length), (p.ahead, 0.25));
        }
    }

    /// Below the strength nothing moves.
    #[test]
    fn a_strong_solid_holds() {
        let case = parse(
            "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = { young = 1000, poisson = 0.2 }\n\
             geometry.box = { lower = [0, 0, -2], upper = [4, 1, 2] }\nnodes = { spacing = 0.5, front_spacing = 0.25 }\n\
             fracture.points = 3\nremote_stress.zz = 1\ncrack = [{ polygon = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]] }]\n\
             growth = { steps = 3, increment = 0.4, criterion.largest-principal-stress = { tensile_strength = 50 } }",
        );
        let (kept, end) = grow(&case);
        assert_eq!((end.kind, kept.steps.len(), kept.steps[0].n_moving), (GrowthEndKind::NoTipGrows, 1, 0));
        assert!(kept.steps[0].load_factor.unwrap() > 1.0);
    }
}
