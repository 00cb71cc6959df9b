//! Cracks that grow: paths, lives, meetings, and random plates to the end.

#[path = "../bodies/mod.rs"]
mod bodies;
mod random_plates;
mod steps;
