//! Natural boundary conditions and forces.

use super::domain::PartId;
use super::field::{FieldPoint, ScalarField};
use crate::exact::ExactField;
use crate::material::Elasticity;
use crate::math::{Matrix2, Vector2};
use std::sync::Arc;

/// A traction on part of the boundary.
#[derive(Clone, Debug)]
pub struct BoundaryLoad {
    /// Where; `None` is every edge of the outline.
    pub part: Option<PartId>,
    /// How much.
    pub value: TractionValue,
}

/// Ways to say a traction.
#[derive(Clone, Debug)]
pub enum TractionValue {
    /// Force per area by component [stress].
    Components([ScalarField; 2]),
    /// Pressure [stress]: pushes against the body.
    Pressure(ScalarField),
    /// Traction of a uniform stress [stress]: `σ · n`.
    UniformStress(Matrix2),
    /// Traction of an exact field: `σ(x) · n`.
    Exact(Arc<dyn ExactField>),
}

impl TractionValue {
    /// Force per area at a boundary point [stress].
    pub fn traction(&self, material: &Elasticity, at: &FieldPoint) -> Vector2 {
        match self {
            Self::Components([x, y]) => Vector2::new(x.value(at), y.value(at)),
            Self::Pressure(p) => -at.normal * p.value(at),
            Self::UniformStress(s) => s * at.normal,
            Self::Exact(field) => field.stress(material, at.position) * at.normal,
        }
    }
}

/// A pressure on both faces of a crack, along its whole path however long it grows.
#[derive(Clone, Debug)]
pub struct CrackFaceLoad {
    /// Index of the crack in the model.
    pub crack: usize,
    /// Pressure [stress]: positive pushes the faces apart. It has no normal to depend on: that is zero.
    pub pressure: ScalarField,
}

/// Force per volume by component [stress/length].
#[derive(Clone, Debug)]
pub struct BodyForce(pub [ScalarField; 2]);

/// A force at a point of the body or its boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLoad {
    /// Where it acts.
    pub at: Vector2,
    /// Force over the whole thickness.
    pub force: Vector2,
}
