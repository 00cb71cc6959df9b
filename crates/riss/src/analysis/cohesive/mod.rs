//! What cohesive cracks of a body do under load, in the plane and in space.
//!
//! The body is linear, so that it is condensed onto the openings of its pairs of faces ([`condensed`]; how depends on the
//! method); [`path`], with its [`tangent`] and the [`events`] on it, follows the softening of all pairs at once, and [`load_curve`] records it.

mod condensed;
mod events;
mod load_curve;
mod path;
mod settings;
mod tangent;

pub(in crate::analysis) use condensed::Condensed;
pub use load_curve::LoadPoint;
pub(in crate::analysis) use load_curve::{Bond, Followed, LoadMeasure, follow, peak_of, pictures, resultant};
pub use path::CohesiveState;
pub use settings::LoadingSettings;
