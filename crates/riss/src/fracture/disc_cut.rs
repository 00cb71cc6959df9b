//! Where a crack cuts the disc normal to its front.

use crate::approximation::{CrackSides, FrontFrame};
use crate::math::Vector;
use std::f64::consts::{FRAC_PI_2, PI};

/// Halvings of the half turn in which the crack is looked for.
const HALVINGS: usize = 40;
/// Step for the direction of a face, over the radius.
const STEP: f64 = 1e-3;

/// The disc normal to a front, cut along the crack behind it.
pub struct DiscCut<'a, const D: usize> {
    /// The front.
    pub frame: &'a FrontFrame<D>,
    /// The crack; none if it is plane.
    pub sides: Option<&'a dyn CrackSides<D>>,
}

impl<'a, const D: usize> DiscCut<'a, D> {
    /// The disc of a plane crack.
    pub fn plane(frame: &'a FrontFrame<D>) -> Self {
        Self { frame, sides: None }
    }

    /// The place at a distance and an angle.
    pub fn place(&self, r: f64, theta: f64) -> Vector<D> {
        self.frame.position + self.frame.ahead * (r * theta.cos()) + self.frame.normal * (r * theta.sin())
    }

    /// Angle of the positive face at a distance from the front [rad]; the negative one is a whole turn below.
    ///
    /// It is looked for from π/2 to 3π/2: a crack that turns back by more beside its front is not found.
    pub fn angle(&self, r: f64) -> f64 {
        let Some(sides) = self.sides else { return PI };
        let (mut above, mut below) = (FRAC_PI_2, 3.0 * FRAC_PI_2);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (above + below);
            if sides.nearest(self.place(r, middle)).1 { above = middle } else { below = middle }
        }
        0.5 * (above + below)
    }

    /// A place of the crack, and the normal on its positive side, as long as the line of the crack is for a unit of `r`.
    pub fn face(&self, r: f64) -> (Vector<D>, Vector<D>) {
        let theta = self.angle(r);
        let at = self.place(r, theta);
        if self.sides.is_none() {
            return (at, self.frame.normal);
        }
        let (near, far) = ((1.0 - STEP) * r, (1.0 + STEP) * r);
        let along = (self.place(far, self.angle(far)) - self.place(near, self.angle(near))) / (far - near);
        let (x, y) = (along.dot(&self.frame.ahead), along.dot(&self.frame.normal));
        (at, self.frame.ahead * y - self.frame.normal * x)
    }
}
