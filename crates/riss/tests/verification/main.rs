//! Solutions against closed forms, each within a stated bound.

#[path = "../bodies/mod.rs"]
mod bodies;
mod patch;
