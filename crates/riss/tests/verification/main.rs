//! Solutions against closed forms, each within a stated bound.

#[path = "../bodies/mod.rs"]
mod bodies;
mod constraint_methods;
mod free_motion;
mod loads;
mod nodal_integration;
mod patch;
mod plane_cohesive;
mod round_bodies;
mod supports;
