//! Rates at which errors fall with the node spacing, against theory.

mod bar;
#[path = "../bodies/mod.rs"]
mod bodies;
mod cantilever;
mod plate_with_hole;
