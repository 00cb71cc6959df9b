//! Essential boundary conditions, foundations, and what removes rigid motion.

use super::domain::PartId;
use super::field::{FieldPoint, ScalarField};
use crate::exact::ExactField;
use crate::material::Elasticity;
use crate::math::Vector2;
use std::sync::Arc;

/// Direction of a prescribed displacement or a spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along the outward normal of the boundary.
    Normal,
}

impl Direction {
    /// Unit vector at a boundary point.
    #[inline]
    pub fn vector(self, at: &FieldPoint) -> Vector2 {
        match self {
            Self::X => Vector2::x(),
            Self::Y => Vector2::y(),
            Self::Normal => at.normal,
        }
    }
}

/// Displacement prescribed in one direction on part of the boundary.
#[derive(Clone, Debug)]
pub struct BoundarySupport {
    /// Where.
    pub part: PartId,
    /// In which direction; others stay free.
    pub direction: Direction,
    /// How much.
    pub value: PrescribedValue,
}

/// Ways to say a displacement.
#[derive(Clone, Debug)]
pub enum PrescribedValue {
    /// A number or function [length].
    Field(ScalarField),
    /// The displacement of an exact field in the support's direction.
    Exact(Arc<dyn ExactField>),
}

impl PrescribedValue {
    /// Displacement in `direction` at a boundary point [length].
    pub fn value(&self, material: &Elasticity, direction: Direction, at: &FieldPoint) -> f64 {
        match self {
            Self::Field(f) => f.value(at),
            Self::Exact(field) => field.displacement(material, at.position).dot(&direction.vector(at)),
        }
    }
}

/// Displacement prescribed at a point of the body or its boundary, by component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointSupport {
    /// Where.
    pub at: Vector2,
    /// Displacement along x and y [length]; `None` leaves the component free.
    pub displacement: [Option<f64>; 2],
}

/// An elastic foundation of part of the boundary: traction `-stiffness · u` in one direction.
#[derive(Clone, Debug)]
pub struct Spring {
    /// Where.
    pub part: PartId,
    /// In which direction.
    pub direction: Direction,
    /// Traction per displacement [stress/length], not negative.
    pub stiffness: ScalarField,
}

/// What holds the body as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigidMotion {
    /// Only the supports.
    Supported,
    /// The mean displacement and the mean rotation of the body are zero [CPM, section 4.2].
    MeanIsZero,
}
