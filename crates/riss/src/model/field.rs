//! Prescribed values that may vary along the boundary.

use crate::math::Vector2;
use std::fmt;
use std::sync::Arc;

/// Where a field is asked for its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldPoint {
    /// Position.
    pub position: Vector2,
    /// Outward unit normal on the boundary, zero inside the body.
    pub normal: Vector2,
}

/// A number, or a function of position and normal.
#[derive(Clone)]
pub enum ScalarField {
    /// The same value everywhere.
    Constant(f64),
    /// A function, such as an expression of the case file.
    Function(Arc<dyn Fn(&FieldPoint) -> f64 + Send + Sync>),
}

impl ScalarField {
    /// The value at a point.
    #[inline]
    pub fn value(&self, at: &FieldPoint) -> f64 {
        match self {
            Self::Constant(v) => *v,
            Self::Function(f) => f(at),
        }
    }
}

impl fmt::Debug for ScalarField {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(v) => write!(f, "{v}"),
            Self::Function(_) => f.write_str("<function>"),
        }
    }
}

impl From<f64> for ScalarField {
    fn from(v: f64) -> Self {
        Self::Constant(v)
    }
}
