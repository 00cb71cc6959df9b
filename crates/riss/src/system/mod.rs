//! The linear system: discretization, assembly, constraints, solution. Has never heard of crack growth.

pub mod block_matrix;
pub mod constraints;
pub mod crack_faces;
pub mod discretization;
pub mod galerkin;
pub mod linear_solver;
mod node_solver;
pub mod ordering;
pub mod rigid_motion;
mod safeguard;
pub mod settings;
pub mod solve;
mod tip_factors;

pub use discretization::Discretization;
pub use galerkin::{LinearSystem, assemble};
pub use settings::{ConstraintMethod, LinearSolver};
pub use solve::{Solution, solve};
