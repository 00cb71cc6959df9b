//! Cohesive cracks of a solid.

use crate::geometry::aabb::Aabb;
use crate::material::CohesiveLaw;
use crate::math::Vector3;

/// What a crack surface is before the load.
#[derive(Clone, Debug, Default)]
pub struct CohesiveCrack {
    /// Where the crack is open and free from the beginning.
    pub notches: Vec<Aabb<3>>,
}

impl CohesiveCrack {
    /// Whether the crack is free at a point.
    pub fn is_notch(&self, p: Vector3) -> bool {
        self.notches.iter().any(|b| (0..3).all(|d| b.lower[d] <= p[d] && p[d] <= b.upper[d]))
    }
}

/// The law, and the cracks that obey it.
#[derive(Clone, Debug)]
pub struct CohesiveModel {
    /// Strength and softening.
    pub law: CohesiveLaw,
    /// For each crack, if it is cohesive.
    pub cracks: Vec<Option<CohesiveCrack>>,
}
