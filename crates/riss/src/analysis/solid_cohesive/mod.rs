//! Cohesive cracks on given surfaces: tied until they reach their strength, then opening along the path of equilibrium.
//!
//! The body is linear, so that it is condensed onto the openings of its pairs of nodes: [`condensed`], with [`energy`] between their
//! displacement fields, what loads do in [`work`] and supports in [`reactions`], and areas of faces in [`areas`] and
//! [`free_faces`]; what then happens along the path of equilibrium is that of [`super::cohesive`]. Surfaces that grow do so by [`growing`].

mod areas;
mod condensed;
mod energy;
mod free_faces;
mod growing;
mod reactions;
mod work;

use super::cohesive::{
    Bond, CohesiveState, Condensed, Followed, LoadMeasure, LoadPoint, LoadingSettings, follow, peak_of, pictures,
};
use super::growth_record::{GrowthEnd, GrowthEndKind};
use super::record::{Observer, Stage};
use super::solid_growth::SolidGrowthSettings;
use super::solid_record::SolidResult;
use super::solid_static::{Placed, SolidSettings, Solved};
use crate::error::Result;
use crate::integration::NodeCells;
use crate::math::{Vector, Vector3};
use crate::model::{CohesiveModel, SolidModel};
use crate::system::{CollocationSolution, CollocationSystem, TiedFaces, TiedPair};
use areas::{FaceArea, face_areas};
use condensed::{Parting, TiedBody, UnitFields, condense};
use free_faces::FreeFaces;
use growing::Growing;
pub use growing::{CohesiveSurfaces, GrownSurface};
use work::Work;

/// Pairs with less than this share of cohesive area are free.
const LEAST_SHARE: f64 = 0.1;
/// Faces that pass on more shear than this, over the strength, must be let slide.
const STICKS: f64 = 0.05;

/// A state of the path with its fields.
#[derive(Clone, Debug)]
pub struct LoadingStep {
    /// Index of its point on the load curve.
    pub point: usize,
    /// The point.
    pub values: LoadPoint,
    /// The problem with its surfaces.
    pub model: SolidModel,
    /// The solution.
    pub result: SolidResult,
    /// Traction that pulls the faces together along the normal, for each crack at the places of its opening [stress].
    pub tractions: Vec<Vec<f64>>,
    /// Whether it is the one with the greatest load.
    pub is_peak: bool,
}

/// The whole path.
#[derive(Clone, Debug)]
pub struct LoadingRecord {
    /// Load curve from rest.
    pub curve: Vec<LoadPoint>,
    /// Index of the greatest load.
    pub peak: usize,
    /// Why it ended.
    pub end: GrowthEnd,
    /// Its surfaces from first to last, if they grow.
    pub surfaces: Vec<GrownSurface>,
    /// The problem with the last of them.
    pub model: SolidModel,
}

/// A pair with its area.
struct TiedBond {
    /// Index among the pairs of the cloud.
    pair: usize,
    area: FaceArea,
    /// Its place, if the surface has to grow before it opens.
    near_front: Option<Vector3>,
}

/// Loads a solid with cohesive cracks; none if the observer ended it. Steps with fields reach the observer in order.
///
/// - `growth`: how the surfaces grow, if they do
/// - `from`: the surfaces that an earlier run had grown to, if it goes on from there
///
/// # Errors
/// Those of nodes, shape functions and solver.
pub fn solid_loading(
    model: &SolidModel,
    cohesive: &CohesiveModel<3>,
    settings: &SolidSettings,
    loading: &LoadingSettings,
    growth: Option<&SolidGrowthSettings>,
    from: Option<CohesiveSurfaces>,
    observer: &mut dyn Observer,
) -> Result<Option<LoadingRecord>> {
    let Some(growth) = growth else {
        let Traced::Done(record) = traced(model, cohesive, settings, loading, None, observer)? else { return Ok(None) };
        return Ok(record.map(|r| *r));
    };
    let mut growing = match Growing::new(model, growth, from) {
        Ok(growing) => growing,
        Err(defect) => return Ok(Some(growing::no_record(model, &defect))),
    };
    loop {
        let settings = growing.settings(settings);
        match traced(&growing.model, cohesive, &settings, loading, Some(&growing), observer)? {
            Traced::Reached { solved, place, load_factor } => {
                growing.extend(&solved, &cohesive.law, place, load_factor)?;
                if growing.halt.is_none() && observer.surfaces_grown(&growing.now()).is_break() {
                    return Ok(None);
                }
            }
            Traced::Done(record) => {
                let Some(mut record) = record else { return Ok(None) };
                if let Some(halt) = growing.halt {
                    record.end.reason += &format!("; fronts stopped before: {halt}");
                }
                return Ok(Some(LoadingRecord { surfaces: growing.surfaces, ..*record }));
            }
        }
    }
}

/// What becomes of surfaces under load.
enum Traced {
    /// The whole path; none if the observer ended it.
    Done(Option<Box<LoadingRecord>>),
    /// A front has to grow before the path goes on.
    Reached { solved: Box<Solved>, place: Option<Vector3>, load_factor: f64 },
}

/// Loads the surfaces as they are.
fn traced(
    model: &SolidModel,
    cohesive: &CohesiveModel<3>,
    settings: &SolidSettings,
    loading: &LoadingSettings,
    growing: Option<&Growing<'_>>,
    observer: &mut dyn Observer,
) -> Result<Traced> {
    let mut placed = Placed::of(model, settings, observer)?;
    observer.stage(Stage::Assembly);
    let system = placed.collocation.assemble()?;
    let (pairs, bonds, free) = bonds(model, &placed, &system, settings, growing);
    if bonds.is_empty() && growing.is_some_and(Growing::may_grow) {
        // All of the surfaces are open: their fronts are those of an elastic solid.
        let elastic = SolidModel { cohesive: None, ..model.clone() };
        let solved = Box::new(Solved::of(&elastic, settings, observer)?);
        return Ok(Traced::Reached { solved, place: None, load_factor: 0.0 });
    }
    let tied = TiedFaces::new(&placed.collocation, &system, pairs)?;
    let work = Work::new(model, &placed.collocation, &settings.spacing)?;
    let cells = NodeCells::new(&model.body, &placed.collocation.approximation, &settings.spacing);
    observer.stage(Stage::Solve);
    let body = TiedBody::new(&placed.collocation, &system, &tied, work, cells)?;
    let solved = |u: Vec<f64>, effort| {
        let displacements = u.chunks_exact(3).map(Vector::from_column_slice).collect();
        CollocationSolution { displacements, effort }
    };
    let areas: Vec<FaceArea> = bonds.iter().map(|b| b.area).collect();
    let slides = cohesive.law.shear_ratio > 0.0;
    let mut fields = UnitFields::default();
    let mut condense = |parting| condense(&body, &placed.collocation, parting, &areas, &free, &mut fields);
    let mut condensed = condense(if slides { Parting::Full } else { Parting::Normal })?;
    let measure = LoadMeasure { resultant: body.work.resultant, prescribed: body.work.prescribed };
    let of_curve = |b: &TiedBond| Bond { area: b.area.cohesive, is_near_front: b.near_front.is_some() };
    let of_curve: Vec<Bond> = bonds.iter().map(of_curve).collect();
    let mut followed = follow(&condensed, measure, &cohesive.law, loading, &of_curve, observer);
    if !slides && followed.most_shear > STICKS * cohesive.law.strength {
        condensed = condense(Parting::Full)?;
        followed = follow(&condensed, measure, &cohesive.law, loading, &of_curve, observer);
    }
    if followed.is_stopped {
        return Ok(Traced::Done(None));
    }
    let Followed { curve, states, mut end, reached, .. } = followed;
    let reached = reached.and_then(|pair| bonds[pair].near_front);
    if let (Some(strips), Some(_)) = (growing.and_then(Growing::done), reached) {
        let reason = format!("the surfaces have grown by {strips} strips, and the next would be due");
        end = GrowthEnd { kind: GrowthEndKind::StepsDone, reason };
    } else if let (Some(place), Some(state)) = (reached, states.last()) {
        let (u, effort) = body.solve(state.load_factor, &openings(&condensed, &tied, state))?;
        let (load_factor, solution) = (state.load_factor, solved(u, effort));
        let solved = Box::new(Solved::new(placed, solution));
        return Ok(Traced::Reached { solved, place: Some(place), load_factor });
    }
    let peak = peak_of(&curve);
    for point in pictures(&curve, peak) {
        observer.stage(Stage::Solve);
        let state = &states[point];
        let (u, effort) = body.solve(state.load_factor, &openings(&condensed, &tied, state))?;
        let tractions = tractions(model, &placed, &condensed, &bonds, state);
        let (result, again) = Solved::new(placed, solved(u, effort)).result_and_place(model, settings, observer)?;
        placed = again;
        let step = LoadingStep {
            point,
            values: curve[point],
            model: model.clone(),
            result,
            tractions,
            is_peak: point == peak,
        };
        if observer.loading_step(&step).is_break() {
            return Ok(Traced::Done(None));
        }
    }
    let record = LoadingRecord { curve, peak, end, surfaces: vec![], model: model.clone() };
    Ok(Traced::Done(Some(Box::new(record))))
}

/// The pairs that are tied, and what is free.
fn bonds(
    model: &SolidModel,
    placed: &Placed,
    system: &CollocationSystem<3>,
    settings: &SolidSettings,
    growing: Option<&Growing<'_>>,
) -> (Vec<TiedPair<3>>, Vec<TiedBond>, FreeFaces) {
    let (mut pairs, mut bonds, mut free) = (vec![], vec![], FreeFaces::default());
    let positions = &placed.collocation.cloud().positions;
    for crack in 0..model.cracks.len() {
        let cohesive = model.cohesive_crack(crack);
        let own: Vec<usize> = (0..placed.pairs.len()).filter(|p| placed.pairs[*p].crack as usize == crack).collect();
        let places: Vec<Vector3> = own.iter().map(|p| positions[placed.pairs[*p].nodes[0] as usize]).collect();
        let areas = face_areas(model, crack, cohesive, &places, &settings.spacing);
        let surface = &model.cracks[crack].surface;
        for ((pair, place), area) in own.into_iter().zip(places).zip(areas) {
            let foot = surface.closest(place);
            let normal = surface.normal_at(foot.triangle, foot.position);
            let nodes = placed.pairs[pair].nodes.map(|i| i as usize);
            if area.share() >= LEAST_SHARE
                && let Some(tied) = TiedPair::new(nodes, normal, system)
            {
                pairs.push(tied);
                let near_front = growing.filter(|g| g.is_near_front(crack, place)).map(|_| place);
                bonds.push(TiedBond { pair, area, near_front });
            } else {
                free.push(model, crack, nodes, place, normal, area.total);
            }
        }
    }
    (pairs, bonds, free)
}

fn openings(condensed: &Condensed, tied: &TiedFaces<3>, state: &CohesiveState) -> Vec<(usize, Vector3)> {
    let opening = |k: usize| {
        let w = condensed.opening_of(k, &state.openings);
        tied.pairs[k].directions.iter().zip(w).map(|(e, w)| e * w).sum::<Vector3>()
    };
    (0..tied.pairs.len()).map(|k| (k, opening(k))).filter(|(_, w)| *w != Vector3::zeros()).collect()
}

/// Normal tractions in the order of [`super::OpenedCrack::positions`].
fn tractions(
    model: &SolidModel,
    placed: &Placed,
    condensed: &Condensed,
    bonds: &[TiedBond],
    state: &CohesiveState,
) -> Vec<Vec<f64>> {
    let all = condensed.tractions(state.load_factor, &state.openings);
    let mut of_pair = vec![0.0; placed.pairs.len()];
    bonds.iter().enumerate().for_each(|(k, b)| of_pair[b.pair] = condensed.of_pair(k, &all)[0]);
    let of_crack = |crack: usize| {
        let pairs = placed.pairs.iter().zip(&of_pair).filter(|(p, _)| p.crack as usize == crack);
        let on_fronts = model.cracks[crack].fronts.iter().map(|f| f.points.len()).sum();
        pairs.map(|(_, t)| *t).chain(std::iter::repeat_n(0.0, on_fronts)).collect()
    };
    (0..model.cracks.len()).map(of_crack).collect()
}
