//! Error estimates and refinement against exact fields.

mod accuracy;
#[path = "../bodies/mod.rs"]
mod bodies;
mod effectivity;
mod half_central_crack;
mod problems;
