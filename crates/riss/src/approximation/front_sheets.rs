//! On which sheet of the functions of a front a place is, where the crack behind the front is not plane.
//!
//! The functions hold `√r` and the angle at the front, and jump where the angle passes ±π. That is the crack only if it
//! is plane. Behind a kink or in a curved crack, places between the plane and the crack would be counted to the wrong
//! side, and the basis would jump inside the material. So the angle is carried on beyond ±π up to the crack itself: the
//! functions stay what they are, with the same derivatives, and jump only where the material does.

use super::front_functions::{FrontFrame, FrontLine};
use crate::geometry::aabb::Aabb;
use crate::geometry::surface::Surface;
use crate::math::Vector;
use crate::nodes::cloud::Cloud;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Reach of the functions of a front over the spacing of nodes there: from here on the error of the polynomials
/// outside no longer counts. At 4 the factors are off by 2 %, at 6 by 0.1 to 0.8 %, at 8 by 0.02 to 0.1 %, at 12 by 0.002
/// to 0.05 %.
pub const REACH: f64 = 12.0;
/// Supports are smaller than this, over the spacing of their node.
const SUPPORT: f64 = 8.0;
/// Where the crack nearest to a place is this near to the front, over the distance of the place, no sheet is in question.
const AT_FRONT: f64 = 0.1;

/// What the functions of a front ask about their crack.
pub trait CrackSides<const D: usize>: Send + Sync {
    /// The place of the crack that is nearest to a point which is not on it, and whether the point is on its positive side.
    fn nearest(&self, p: Vector<D>) -> (Vector<D>, bool);
}

impl CrackSides<3> for Surface {
    fn nearest(&self, p: Vector<3>) -> (Vector<3>, bool) {
        let foot = self.closest(p);
        (foot.position, !self.is_behind(p, &foot))
    }
}

/// A front with the distance from it up to which the basis is enriched.
#[derive(Clone)]
pub struct EnrichedFront<const D: usize> {
    /// The front.
    pub line: FrontLine<D>,
    /// Nodes and points nearer to it than this have the functions of the front in their basis [length].
    pub reach: f64,
    /// Its crack; none if that is plane.
    pub crack: Option<Arc<dyn CrackSides<D>>>,
}

impl<const D: usize> EnrichedFront<D> {
    /// The front of a plane crack with the reach that measurements favor, for nodes at the given spacing [length].
    pub fn new(line: FrontLine<D>, spacing: f64) -> Self {
        Self { line, reach: REACH * spacing, crack: None }
    }

    /// The frame nearest to a point within reach, with its distance [length].
    pub fn within_reach(&self, at: Vector<D>, reach: f64) -> Option<(f64, FrontFrame<D>)> {
        let around = Aabb { lower: at.add_scalar(-reach), upper: at.add_scalar(reach) };
        if !around.intersects(self.line.bounds()) {
            return None;
        }
        let frame = self.line.nearest(at)?;
        let distance = (at - frame.position).norm();
        (distance < reach).then_some((distance, frame))
    }

    /// Angle at the front of a place that is seen from `sight`, up to the crack and so perhaps beyond ±π [rad].
    pub fn angle(&self, frame: &FrontFrame<D>, sight: Vector<D>) -> f64 {
        let [x, y] = frame.plane(sight);
        let theta = y.atan2(x);
        let Some(crack) = &self.crack else { return theta };
        let (foot, is_positive) = crack.nearest(sight);
        let [fx, fy] = frame.plane(foot);
        if fx > -AT_FRONT * x.hypot(y) {
            return theta;
        }
        // Along the crack from its front, the angle of a face starts at ±π; nothing is between the foot and the place.
        let at_foot = fy.atan2(fx);
        let face = match (is_positive, at_foot > 0.0) {
            (true, false) => at_foot + TAU,
            (false, true) => at_foot - TAU,
            (true, true) | (false, false) => at_foot,
        };
        let turn = theta - at_foot;
        face + turn - TAU * (turn / TAU).round()
    }

    /// Angles of all nodes that functions of the front are evaluated at; zero elsewhere [rad].
    pub fn angles(&self, cloud: &Cloud<D>) -> Vec<f64> {
        let one = |i: usize| {
            let reach = self.reach + SUPPORT * cloud.spacings[i];
            let near = self.within_reach(cloud.positions[i], reach);
            near.map_or(0.0, |(_, frame)| self.angle(&frame, cloud.sights[i]))
        };
        (0..cloud.len()).into_par_iter().map(one).collect()
    }
}

/// The angle of a point from -π to π, on the sheet that is nearest to a known angle.
#[inline]
pub(super) fn on_sheet(theta: f64, near: f64) -> f64 {
    // Most places are on the first sheet.
    if (near - theta).abs() <= PI { theta } else { theta + TAU * ((near - theta) / TAU).round() }
}
