//! Cohesive cracks of a plane body that grow ahead of what is broken.
//!
//! A tied face changes nothing in the body, so that a crack may end anywhere ahead of the places that have reached their
//! strength. It is loaded from rest until they come near its tip; then the tip advances across the largest principal stress,
//! and the longer crack is loaded from rest again.

use super::super::crack_growth::advance::{Increment, advance};
use super::super::crack_growth::walls::Ending;
use super::super::crack_growth::{GrowthSettings, GrowthState};
use super::super::settings::Settings;
use crate::crack::{CrackPath, TipFrame, TipId};
use crate::error::Result;
use crate::fracture::{GradientField, SolutionField};
use crate::geometry::predicates::segments_cross;
use crate::math::{Matrix2, Vector2, cross, principal_stresses, turn_left};
use crate::model::Model;
use crate::nodes::settings::Layout;
use crate::system::{Discretization, Solution};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A tip moves where the stress ahead is this share of the strength.
const NEAR: f64 = 0.8;
/// Increments of a tip in one go at most: the path turns with the stress of the longer crack.
const AT_ONCE: usize = 3;
/// Radii and angles of the places ahead of a tip, over the increment and in radians, whose mean stress counts.
const RADII: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
const ANGLES: [f64; 7] = [-1.2, -0.8, -0.4, 0.0, 0.4, 0.8, 1.2];
/// From this far ahead, over the increment, places are looked at.
const EYE: f64 = 0.02;
/// Turns smaller than this are noise of the nodes: plane cracks stay plane [rad].
const STEADY: f64 = 0.01;
/// Nodes along cracks that grow, over the increment.
const SPACING: f64 = 0.25;

/// Cracks at one time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GrownPath {
    /// Length of each crack, with what is still tied [length].
    pub lengths: Vec<f64>,
    /// Factor on the loads at which they grew, if they did.
    pub load_factor: Option<f64>,
    /// Increments since the first.
    pub increments: usize,
}

/// Where cohesive cracks stand before they are loaded from rest. The same state goes on in the same way, bit by bit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CohesivePaths {
    /// The cracks.
    cracks: Vec<CrackPath>,
    /// What they have been from first to last.
    history: Vec<GrownPath>,
    /// Why tips cannot grow any more.
    halt: Option<String>,
}

/// The largest principal stress ahead of a tip.
struct Ahead {
    tip: TipId,
    /// Positive in tension [stress].
    stress: f64,
    /// Unit vector along it, of either sign.
    along: Vector2,
}

/// Cracks with their problem.
pub(super) struct Growing<'a> {
    growth: &'a GrowthSettings,
    increment: f64,
    pub model: Model,
    pub paths: Vec<GrownPath>,
    /// Why tips cannot grow any more.
    pub halt: Option<String>,
}

impl<'a> Growing<'a> {
    /// The cracks of the case, or those that they had grown to.
    pub fn new(first: &Model, growth: &'a GrowthSettings, from: Option<CohesivePaths>) -> Self {
        let increment = growth.increment.unwrap_or_else(|| GrowthState::first(first).automatic_increment);
        let paths = vec![GrownPath { lengths: lengths(&first.cracks), load_factor: None, increments: 0 }];
        let mut growing = Self { growth, increment, model: first.clone(), paths, halt: None };
        if let Some(from) = from {
            (growing.model.cracks, growing.paths, growing.halt) = (from.cracks, from.history, from.halt);
        }
        growing
    }

    /// What it takes to go on from here.
    pub fn now(&self) -> CohesivePaths {
        CohesivePaths { cracks: self.model.cracks.clone(), history: self.paths.clone(), halt: self.halt.clone() }
    }

    /// Settings with nodes along cohesive cracks that do not change as these get longer.
    pub fn settings(&self, settings: &Settings) -> Settings {
        let mut settings = settings.clone();
        if let Layout::Graded(graded) = &mut settings.nodes.layout
            && graded.tip_spacing.is_none()
        {
            graded.tip_spacing = Some(SPACING * self.increment);
        }
        settings
    }

    /// Whether a place lies so near to a tip of its crack that this has to grow before it opens.
    pub fn is_near_tip(&self, crack: usize, place: Vector2) -> bool {
        let tips = self.tips();
        let mut own = tips.iter().filter(|(tip, _)| tip.crack == crack);
        self.halt.is_none() && own.any(|(_, frame)| (place - frame.position).norm() < self.increment)
    }

    /// Whether tips may still grow.
    pub fn may_grow(&self) -> bool {
        self.halt.is_none() && !self.tips().is_empty()
    }

    /// Number of increments, if there may be no more.
    pub fn done(&self) -> Option<usize> {
        let n = self.n_increments();
        (n >= self.growth.steps).then_some(n)
    }

    fn n_increments(&self) -> usize {
        self.paths.last().map_or(0, |p| p.increments)
    }

    /// Tips of cohesive cracks that are not held.
    fn tips(&self) -> Vec<(TipId, TipFrame)> {
        let grows = |crack: usize| {
            self.model.cohesive_crack(crack).is_some() && !self.growth.held.contains(&self.model.cracks[crack].name)
        };
        self.model.tips().into_iter().filter(|t| grows(t.0.crack)).collect()
    }

    /// Grows the cracks in a state whose openings came near a tip.
    ///
    /// - `place`: where; if there is none, nothing is tied yet, and the tip with the greatest stress grows
    ///
    /// # Errors
    /// Those of the shape functions.
    pub fn extend(
        &mut self,
        discrete: &Discretization,
        solution: &Solution,
        place: Option<(usize, Vector2)>,
        load_factor: f64,
    ) -> Result<()> {
        let Some(law) = self.model.cohesive.as_ref().map(|c| c.law) else { return Ok(()) };
        let before = self.n_increments();
        let (mut n, mut halt, mut place) = (0, String::from("no tip has room ahead"), place);
        let first = self.stresses(discrete, solution)?;
        let largest = first.iter().map(|s| s.stress).fold(0.0, f64::max);
        halt = if first.is_empty() {
            halt
        } else {
            format!("the largest principal stress ahead of them is {largest:.3e}")
        };
        let near = NEAR * if place.is_some() { law.strength } else { largest };
        while largest > 0.0 && n < AT_ONCE && before + n < self.growth.steps {
            let mut increments = vec![];
            for Ahead { tip, stress, along } in self.stresses(discrete, solution)? {
                let frame = self.model.cracks[tip.crack].frame(tip.end);
                let is_at =
                    |(crack, p): (usize, Vector2)| crack == tip.crack && (p - frame.position).norm() < self.increment;
                if stress >= near || place.is_some_and(is_at) {
                    let ahead = direction(&frame, along);
                    increments
                        .push(Increment { tip, way: vec![frame.position, frame.position + ahead * self.increment] });
                }
            }
            if increments.is_empty() {
                break;
            }
            let arrivals = advance(&mut self.model, &increments);
            n += 1;
            place = None;
            if arrivals.iter().all(|a| a.ending != Ending::Free) {
                break;
            }
        }
        self.halt = (n == 0).then_some(halt);
        if let Some(last) = self.paths.last_mut() {
            last.load_factor = Some(load_factor);
        }
        if n > 0 {
            let lengths = lengths(&self.model.cracks);
            self.paths.push(GrownPath { lengths, load_factor: None, increments: before + n });
        }
        Ok(())
    }

    /// The largest principal stress ahead of each tip; not of those without room.
    fn stresses(&self, discrete: &Discretization, solution: &Solution) -> Result<Vec<Ahead>> {
        let field = SolutionField { discrete, solution };
        let mut found = vec![];
        for (tip, frame) in self.tips() {
            if let Some(stress) = self.mean_ahead(&field, &frame)? {
                let (largest, _, along) = principal_stresses(&stress);
                found.push(Ahead { tip, stress: largest, along });
            }
        }
        Ok(found)
    }

    /// Mean stress over half a disc ahead of a tip, as far as it is in sight; none if nothing is.
    fn mean_ahead(&self, field: &SolutionField<'_>, frame: &TipFrame) -> Result<Option<Matrix2>> {
        let eye = frame.global(Vector2::new(EYE * self.increment, 0.0));
        let is_hidden = |at: Vector2| {
            !self.model.domain.contains(at)
                || self.model.cracks.iter().flat_map(CrackPath::segments).any(|(a, b)| segments_cross(eye, at, a, b))
        };
        let (mut sum, mut total) = (Matrix2::zeros(), 0.0);
        let mut buffer = Default::default();
        for r in RADII {
            for angle in ANGLES {
                let at = frame.global(crate::math::direction(angle) * (r * self.increment));
                if !is_hidden(at) {
                    sum += self.model.material.stress(&field.gradient(at, at, &mut buffer)?) * r;
                    total += r;
                }
            }
        }
        Ok((total > 0.0).then(|| sum / total))
    }
}

fn lengths(cracks: &[CrackPath]) -> Vec<f64> {
    cracks.iter().map(CrackPath::length).collect()
}

/// Across the largest principal stress, ahead; straight on if it is not clearly another way.
///
/// - `along`: unit vector of that stress, of either sign
fn direction(frame: &TipFrame, along: Vector2) -> Vector2 {
    let (ahead, across) = (frame.x1(), turn_left(along));
    let way = if across.dot(&ahead) < 0.0 { -across } else { across };
    if cross(ahead, way).abs() < STEADY { ahead } else { way }
}
