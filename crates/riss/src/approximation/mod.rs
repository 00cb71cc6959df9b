//! Shape functions. Has never heard of materials or loads.

pub mod settings;

pub use settings::{ApproximationSettings, Basis, SpacingFrom, SupportShape, WeightFunction};
