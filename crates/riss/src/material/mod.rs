//! Constitutive laws. Knows no geometry, nodes or cracks.

pub mod cohesive_law;
pub mod elasticity;

pub use cohesive_law::{Branch, Cohesion, CohesiveLaw, Softening};
pub use elasticity::{Elasticity, PlaneState};
