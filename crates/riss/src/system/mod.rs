//! The linear system: discretization, assembly, constraints, solution. Has never heard of crack growth.

pub mod aggregates;
pub mod block_matrix;
pub mod block_rows;
mod cell_blocks;
pub mod coarse_level;
pub mod collocation;
pub mod collocation_settings;
mod collocation_solve;
pub mod constraints;
pub mod crack_faces;
pub mod dense_lu;
pub mod discretization;
pub mod galerkin;
mod held_nodes;
pub mod incomplete_factor;
pub mod krylov;
pub mod linear_solver;
mod node_conditions;
mod node_solver;
pub mod ordering;
mod patches;
pub mod rigid_motion;
mod safeguard;
pub mod settings;
pub mod solve;
pub mod sparse_lu;
pub mod tied_faces;
pub mod tip_factors;

pub use collocation::{Collocation, CollocationSystem};
pub use collocation_settings::{CollocationSettings, CollocationSolver, ConcaveCorners, FrontNodes};
pub use collocation_solve::{CollocationSolution, PreparedSolver, SolverEffort};
pub use discretization::Discretization;
pub use galerkin::{LinearSystem, assemble};
pub use settings::{ConstraintMethod, LinearSolver};
pub use solve::{Solution, solve};
pub use tied_faces::{TiedFaces, TiedPair};
