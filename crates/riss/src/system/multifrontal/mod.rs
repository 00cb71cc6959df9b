//! Cholesky factorization of symmetric positive definite matrices: multifrontal, with dense kernels on the fronts of a
//! nested dissection, in which branches are factored side by side.
//!
//! Reading order: [`tree`] (what is eliminated together, and after what), [`front`] (one front: what children hand on, its
//! elimination), [`factor`] (all of them, and solutions).

pub mod factor;
mod front;
pub mod tree;

pub use factor::{Cholesky, Scalar};
pub use tree::EliminationTree;
