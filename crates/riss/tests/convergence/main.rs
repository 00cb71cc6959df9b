//! Rates at which errors fall with the node spacing, against theory.

mod bar;
#[path = "../bodies/mod.rs"]
mod bodies;
mod cantilever;
mod nodal_integration;
mod plate_with_hole;
