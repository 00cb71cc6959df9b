//! Cracks that grow: paths, lives, meetings, and random plates to the end.

#[path = "../bodies/mod.rs"]
mod bodies;
mod configurational_force;
mod laws;
mod paths;
mod pieces;
mod random_plates;
mod repetition;
mod steps;
