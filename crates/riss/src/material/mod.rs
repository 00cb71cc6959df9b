//! Constitutive laws. Knows no geometry, nodes or cracks.

pub mod elasticity;

pub use elasticity::{Elasticity, PlaneState};
