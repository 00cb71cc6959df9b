//! A linear elastic solid in the plane or in space, as point collocation sees it.
//!
//! Conditions belong to named parts of the boundary and to crack faces, by index; the geometry itself comes with the
//! nodes.

use super::support::RigidMotion;
use crate::material::Elasticity;
use crate::math::{Vector, axis};
use std::fmt;
use std::sync::Arc;

/// Where a field is asked for its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint<const D: usize> {
    /// Position.
    pub position: Vector<D>,
    /// Unit normal out of the material; zero inside the body.
    pub normal: Vector<D>,
    /// A place nearby inside the material: it tells the two faces of a crack apart.
    pub sight: Vector<D>,
}

impl<const D: usize> SurfacePoint<D> {
    /// A point inside the body.
    pub fn inside(position: Vector<D>) -> Self {
        Self { position, normal: Vector::zeros(), sight: position }
    }
}

/// A vector, or a function of position and normal.
#[derive(Clone)]
pub enum VectorField<const D: usize> {
    /// The same everywhere.
    Constant(Vector<D>),
    /// A function.
    Function(Arc<VectorFunction<D>>),
}

/// What a [`VectorField`] calls.
pub type VectorFunction<const D: usize> = dyn Fn(&SurfacePoint<D>) -> Vector<D> + Send + Sync;

impl<const D: usize> VectorField<D> {
    /// The field that is zero.
    pub fn zero() -> Self {
        Self::Constant(Vector::zeros())
    }

    /// A function of the position.
    pub fn of_position(function: impl Fn(Vector<D>) -> Vector<D> + Send + Sync + 'static) -> Self {
        Self::Function(Arc::new(move |at| function(at.position)))
    }

    /// A pressure: `-p n`.
    pub fn pressure(pressure: f64) -> Self {
        Self::Function(Arc::new(move |at| at.normal * -pressure))
    }

    /// The value at a point.
    #[inline]
    pub fn value(&self, at: &SurfacePoint<D>) -> Vector<D> {
        match self {
            Self::Constant(v) => *v,
            Self::Function(f) => f(at),
        }
    }
}

impl<const D: usize> fmt::Debug for VectorField<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Constant(v) => write!(f, "{v:?}"),
            Self::Function(_) => f.write_str("<function>"),
        }
    }
}

/// Direction of a prescribed displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SolidDirection<const D: usize> {
    /// A unit vector.
    Fixed(Vector<D>),
    /// The normal of the surface.
    Normal,
}

/// A displacement prescribed in one direction: the component of a field.
#[derive(Clone, Debug)]
pub struct DirectedDisplacement<const D: usize> {
    /// In which direction; across it the surface stays free.
    pub direction: SolidDirection<D>,
    /// Its component in the direction is prescribed [length].
    pub value: VectorField<D>,
}

/// Prescribed directions that differ by less than this sine count as one.
pub const SAME_DIRECTION: f64 = 0.05;

impl<const D: usize> DirectedDisplacement<D> {
    /// Its direction where the surface has this normal.
    pub fn unit(&self, normal: Vector<D>) -> Vector<D> {
        match self.direction {
            SolidDirection::Fixed(d) => d,
            SolidDirection::Normal => normal,
        }
    }
}

/// What holds on a part of the boundary: displacement in some directions, traction in the others.
#[derive(Clone, Debug)]
pub struct SurfaceConditions<const D: usize> {
    /// Essential conditions.
    pub displacements: Vec<DirectedDisplacement<D>>,
    /// Traction in the directions without displacement [stress].
    pub traction: VectorField<D>,
}

impl<const D: usize> SurfaceConditions<D> {
    /// Neither load nor support.
    pub fn free() -> Self {
        Self::traction(VectorField::zero())
    }

    /// A traction [stress].
    pub fn traction(traction: VectorField<D>) -> Self {
        Self { displacements: vec![], traction }
    }

    /// All components of the displacement [length].
    pub fn displacement(value: VectorField<D>) -> Self {
        let along = |d| DirectedDisplacement { direction: SolidDirection::Fixed(axis(d)), value: value.clone() };
        Self { displacements: (0..D).map(along).collect(), traction: VectorField::zero() }
    }

    /// Whether displacements in a direction are not prescribed where the surface has this normal.
    pub fn is_free(&self, direction: Vector<D>, normal: Vector<D>) -> bool {
        let across = |held: Vector<D>| (direction - held * held.dot(&direction)).norm();
        self.displacements.iter().all(|d| across(d.unit(normal)) > SAME_DIRECTION)
    }

    /// A plane of symmetry: no displacement across it, no traction along it.
    pub fn symmetry() -> Self {
        let normal = DirectedDisplacement { direction: SolidDirection::Normal, value: VectorField::zero() };
        Self { displacements: vec![normal], traction: VectorField::zero() }
    }
}

/// An elastic solid with what acts on it.
#[derive(Clone, Debug)]
pub struct Solid<const D: usize> {
    /// Elastic constants; the plane state means nothing in space and must be that of plane strain there.
    pub material: Elasticity,
    /// Conditions on the parts of the boundary, by their index.
    pub parts: Vec<SurfaceConditions<D>>,
    /// Tractions on the faces of each crack, asked for on both faces with the normal out of each [stress].
    pub faces: Vec<VectorField<D>>,
    /// Force per volume [stress/length].
    pub body_force: VectorField<D>,
    /// What holds the body as a whole.
    pub rigid_motion: RigidMotion,
}
