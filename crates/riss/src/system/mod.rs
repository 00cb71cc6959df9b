//! The linear system.

pub mod settings;

pub use settings::{ConstraintMethod, LinearSolver};
