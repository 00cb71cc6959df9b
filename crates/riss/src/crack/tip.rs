//! Crack tips in the plane.

use super::path::End;
use crate::math::{Vector2, direction, turn_left};
use serde::{Deserialize, Serialize};

/// A tip by crack and end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TipId {
    /// Index of the crack in the model.
    pub crack: usize,
    /// Which end of the path.
    pub end: End,
}

/// Position and growth direction of a tip: `x1` ahead, `x2` to the left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipFrame {
    /// Crack tip.
    pub position: Vector2,
    /// Direction of `x1` from the x axis [rad].
    pub angle: f64,
}

impl TipFrame {
    /// Unit vector ahead.
    pub fn x1(&self) -> Vector2 {
        direction(self.angle)
    }

    /// Unit vector to the left of `x1`.
    pub fn x2(&self) -> Vector2 {
        turn_left(self.x1())
    }

    /// Coordinates of a point in this frame.
    pub fn local(&self, p: Vector2) -> Vector2 {
        let d = p - self.position;
        Vector2::new(d.dot(&self.x1()), d.dot(&self.x2()))
    }

    /// The point with coordinates `local` in this frame.
    pub fn global(&self, local: Vector2) -> Vector2 {
        self.position + self.x1() * local.x + self.x2() * local.y
    }
}
