//! Properties that hold for any input, on random input that repeats.

#[path = "../bodies/mod.rs"]
mod bodies;
mod enrichment;
mod finite_elements;
mod invariance;
mod point_batch;
mod shape_functions;
mod smoothing;
