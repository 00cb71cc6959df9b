//! Cohesive surfaces that grow ahead of what is broken [C3D, sections 2.4 and 2.5].
//!
//! A tied face changes nothing in the body, so that a surface may end anywhere ahead of the places that have reached their
//! strength. It is loaded from rest until they come near its front; then the front advances across the largest principal
//! stress as far as that stress is near the strength, and the longer surface is loaded from rest again. The last surface
//! thus has one path, without values carried over from other nodes.

use super::super::growth_record::{GrowthEnd, GrowthEndKind};
use super::super::solid_growth::drive::{Drive, by_strength, place_on};
use super::super::solid_growth::{SolidGrowthSettings, SolidGrowthState};
use super::super::solid_static::{SolidSettings, Solved};
use super::LoadingRecord;
use crate::analysis::cohesive::LoadPoint;
use crate::crack::{CrackDefect, EdgeLimits, FrontPoint, FrontStep};
use crate::error::Result;
use crate::material::CohesiveLaw;
use crate::math::Vector3;
use crate::model::SolidModel;
use crate::nodes::solid::{Region, SpacingPlan};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A front moves, and turns across the stress, where the stress ahead is this share of the strength. Where it is less, as at
/// the compressed side of a beam, its direction is noise of the nodes: a front that has to move goes straight on.
const NEAR: f64 = 0.8;
/// Fronts this near to the place that reached its strength move in any case, over the increment.
const AT_PLACE: f64 = 1.5;
/// Strips in one go at most.
const STRIPS: usize = 20;

/// Surfaces at one time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrownSurface {
    /// Area of each crack in the body, with what is still tied [area].
    pub areas: Vec<f64>,
    /// Factor on the loads at which it grew, if it did.
    pub load_factor: Option<f64>,
    /// Strips of triangles that it has got since the first.
    pub strips: usize,
}

/// Where cohesive surfaces stand before they are loaded from rest. The same state goes on in the same way, bit by bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CohesiveSurfaces {
    /// The surfaces.
    state: SolidGrowthState,
    /// What they have been from first to last.
    history: Vec<GrownSurface>,
}

/// Surfaces with their problem.
pub(super) struct Growing<'a> {
    first: &'a SolidModel,
    growth: &'a SolidGrowthSettings,
    state: SolidGrowthState,
    pub model: SolidModel,
    pub surfaces: Vec<GrownSurface>,
    /// Why fronts cannot grow any more.
    pub halt: Option<String>,
}

impl<'a> Growing<'a> {
    /// The surfaces of the case, or those that they had grown to.
    ///
    /// # Errors
    /// [`CrackDefect`] if a crack lies outside the body.
    pub fn new(
        first: &'a SolidModel,
        growth: &'a SolidGrowthSettings,
        from: Option<CohesiveSurfaces>,
    ) -> std::result::Result<Self, CrackDefect> {
        let (state, surfaces) = match from {
            Some(from) => (from.state, from.history),
            None => {
                let state = SolidGrowthState::first(first)?;
                let surfaces = vec![GrownSurface { areas: state.areas(), load_factor: None, strips: 0 }];
                (state, surfaces)
            }
        };
        let model = state.model(first)?;
        Ok(Self { first, growth, state, model, surfaces, halt: None })
    }

    /// What it takes to go on from here.
    pub fn now(&self) -> CohesiveSurfaces {
        CohesiveSurfaces { state: self.state.clone(), history: self.surfaces.clone() }
    }

    /// Settings with nodes as close along cohesive surfaces as at their fronts.
    pub fn settings(&self, settings: &SolidSettings) -> SolidSettings {
        let plan = &self.growth.spacing;
        let mut regions = plan.regions.clone();
        for (c, source) in self.state.sources.iter().enumerate() {
            let (surface, cohesive) = (&self.model.cracks[c].surface, self.model.cohesive_crack(c));
            let all = (0..surface.triangles().len() as u32).map(|t| surface.corners(t));
            let tied = all.filter(|p| cohesive.is_some_and(|c| !c.is_notch((p[0] + p[1] + p[2]) / 3.0)));
            regions.extend(tied.map(|corners| (Region::Triangle(corners), plan.at_fronts[*source])));
        }
        let plan = SpacingPlan { regions, ..plan.clone() };
        let spacing = plan.spacing(&self.model.cracks, &self.state.sources);
        SolidSettings { spacing, ..settings.clone() }
    }

    /// Whether a place lies so near to the front of its crack that the surface has to grow before it opens.
    pub fn is_near_front(&self, crack: usize, place: Vector3) -> bool {
        self.halt.is_none() && self.distance(crack, place) < self.growth.increment
    }

    fn distance(&self, crack: usize, place: Vector3) -> f64 {
        self.model.cracks[crack].fronts.iter().map(|f| place_on(f, place).0).fold(f64::INFINITY, f64::min)
    }

    /// Whether fronts may still grow.
    pub fn may_grow(&self) -> bool {
        let is_cohesive = |c: &usize| self.model.cohesive_crack(*c).is_some();
        self.halt.is_none()
            && (0..self.model.cracks.len()).filter(is_cohesive).any(|c| !self.model.cracks[c].fronts.is_empty())
    }

    /// Grows the surfaces in a state whose openings came near a front.
    ///
    /// - `place`: where; if there is none, nothing is tied yet
    ///
    /// # Errors
    /// Those of the shape functions.
    pub fn extend(
        &mut self,
        solved: &Solved,
        law: &CohesiveLaw,
        place: Option<Vector3>,
        load_factor: f64,
    ) -> Result<()> {
        let limits = EdgeLimits::of_increment(self.growth.increment);
        let strips = self.surfaces[self.surfaces.len() - 1].strips;
        let (mut n, mut most, mut halt) = (0, 0.0, String::new());
        while n < STRIPS && strips + n < self.growth.steps {
            let mut drive = by_strength(&self.model, solved, &self.state.cracks, self.growth.increment, law.strength)?;
            if n == 0 {
                most = drive.largest.unwrap_or(0.0);
                halt = format!("the largest principal stress ahead of them is {:.3e}", most * law.strength);
            }
            match place {
                Some(place) => self.choose(&mut drive, (n == 0).then_some(place)),
                None => drive.move_from(NEAR * most, self.growth.increment),
            }
            if drive.n_moving() == 0 {
                break;
            }
            let advanced = self.state.advanced(&drive.steps, &limits, &self.first.body);
            let (next, model) = match advanced.and_then(|next| Ok((next.clone(), next.model(self.first)?))) {
                Ok(grown) => grown,
                Err(defect) => {
                    halt = defect.to_string();
                    break;
                }
            };
            if next.areas().iter().sum::<f64>() <= self.state.areas().iter().sum::<f64>() {
                halt = "they have no room to advance".into();
                break;
            }
            (self.state, self.model) = (next, model);
            n += 1;
        }
        self.halt = (n == 0).then_some(halt);
        if let Some(last) = self.surfaces.last_mut() {
            last.load_factor = Some(load_factor);
        }
        if n > 0 {
            let areas = self.state.areas();
            self.surfaces.push(GrownSurface { areas, load_factor: None, strips: strips + n });
        }
        Ok(())
    }

    /// Moves the fronts where the stress is near the strength; around a place that reached it in any case, and along with
    /// that where there is about as much stress.
    fn choose(&self, drive: &mut Drive, place: Option<Vector3>) {
        let increment = self.growth.increment;
        let is_at = |p: &FrontPoint| place.is_some_and(|place| (place - p.position).norm() <= AT_PLACE * increment);
        let mut vertices = vec![];
        for (c, crack) in self.state.cracks.iter().enumerate().filter(|(c, _)| self.model.cohesive_crack(*c).is_some())
        {
            for (f, front) in crack.fronts().iter().enumerate() {
                vertices.extend(front.line.points.iter().enumerate().map(|(k, p)| ((c, f, k), p)));
            }
        }
        let around = vertices.iter().filter(|(_, p)| is_at(p)).map(|((c, f, k), _)| drive.ratios[*c][*f][*k]);
        let near = NEAR * around.reduce(f64::max).unwrap_or(1.0).min(1.0);
        for ((c, f, k), point) in vertices {
            let (ratio, step) = (drive.ratios[c][f][k], &mut drive.steps[c][f][k]);
            if ratio < NEAR {
                *step = FrontStep::ahead(point, 0.0);
            }
            step.length = if is_at(point) || (ratio > 0.0 && ratio >= near) { increment } else { 0.0 };
        }
    }

    /// Number of strips, if there may be no more.
    pub fn done(&self) -> Option<usize> {
        let strips = self.surfaces[self.surfaces.len() - 1].strips;
        (strips >= self.growth.steps).then_some(strips)
    }
}

/// The record of surfaces that are none.
pub(super) fn no_record(model: &SolidModel, defect: &CrackDefect) -> LoadingRecord {
    LoadingRecord {
        curve: vec![LoadPoint::default()],
        peak: 0,
        end: GrowthEnd { kind: GrowthEndKind::Failed, reason: defect.to_string() },
        surfaces: vec![],
        model: model.clone(),
    }
}
