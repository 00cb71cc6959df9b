//! Cohesive cracks.

use crate::geometry::aabb::Aabb;
use crate::material::CohesiveLaw;
use crate::math::Vector;

/// What a crack is before the load.
#[derive(Clone, Debug)]
pub struct CohesiveCrack<const D: usize> {
    /// Where the crack is open and free from the beginning.
    pub notches: Vec<Aabb<D>>,
}

impl<const D: usize> CohesiveCrack<D> {
    /// Whether the crack is free at a point.
    pub fn is_notch(&self, p: Vector<D>) -> bool {
        self.notches.iter().any(|b| (0..D).all(|d| b.lower[d] <= p[d] && p[d] <= b.upper[d]))
    }
}

/// The law, and the cracks that obey it.
#[derive(Clone, Debug)]
pub struct CohesiveModel<const D: usize> {
    /// Strength and softening.
    pub law: CohesiveLaw,
    /// For each crack, if it is cohesive.
    pub cracks: Vec<Option<CohesiveCrack<D>>>,
}

impl<const D: usize> CohesiveModel<D> {
    /// What of a crack is cohesive, if anything is.
    pub fn crack(&self, crack: usize) -> Option<&CohesiveCrack<D>> {
        self.cracks.get(crack)?.as_ref()
    }
}
