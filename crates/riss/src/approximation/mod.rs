//! Shape functions. Has never heard of materials or loads.
//!
//! [`ShapeFunctions`] is the value that goes on: a buffer, refilled point by point. [`MovingLeastSquares`] fills it,
//! from the [`weight_function`] of each visible neighbor and the fit in [`mls`] (far from
//! cracks for many points at once, in a [`point_batch`]), near tips with the functions of an
//! [`enrichment`]: in the basis, or as further unknowns (`partition_of_unity`, `global_functions`). For point collocation
//! [`ConstrainedMls`] does, by a fit in the [`taylor_basis`].

pub mod constrained_mls;
mod detour;
pub mod discontinuity;
mod enriched_fit;
pub mod enrichment;
mod extra;
mod fade;
pub mod finite_elements;
pub mod front_functions;
pub mod front_sheets;
mod global_functions;
mod lane_fit;
mod least_squares;
pub mod mls;
pub mod moving_least_squares;
mod orthogonal_columns;
mod partition_of_unity;
pub mod point_batch;
mod region_size;
pub mod settings;
mod sight;
pub mod taylor_basis;
pub mod tip_functions;
pub mod visible_nodes;
mod ways;
pub mod weight_function;

use crate::math::{Matrix, Vector};
pub use constrained_mls::{ConstrainedMls, FitBuffer};
pub use enrichment::Enrichment;
pub use finite_elements::FiniteElements;
pub use front_functions::{FrontEnds, FrontFrame, FrontLine};
pub use front_sheets::{CrackSides, EnrichedFront};
pub use moving_least_squares::{MovingLeastSquares, Surroundings};
pub use settings::{
    ApproximationSettings, Basis, CollocationWeight, ConstrainedMlsSettings, CrackSmoothing, EnrichmentKind,
    EnrichmentSettings, HoleSmoothing, Ramp, SmoothingSettings, SpacingFrom, SupportShape, WeightFunction,
};

/// Shape functions at one point. A buffer that is refilled, one per thread.
#[derive(Clone, Debug, Default)]
pub struct ShapeFunctions<const D: usize> {
    /// Nodes whose shape functions are not zero, ascending; then, from the number of nodes on, the additional functions of
    /// enriched nodes.
    pub neighbors: Vec<u32>,
    /// Values.
    pub values: Vec<f64>,
    /// Gradients [1/length].
    pub gradients: Vec<Vector<D>>,
    /// Second derivatives [1/length²]; empty unless they were asked for.
    pub second_derivatives: Vec<Matrix<D>>,
}

impl<const D: usize> ShapeFunctions<D> {
    /// Makes room for new neighbors.
    fn reset(&mut self, neighbors: &[u32]) {
        self.neighbors.clear();
        self.neighbors.extend_from_slice(neighbors);
        self.values.resize(neighbors.len(), 0.0);
        self.gradients.resize(neighbors.len(), Vector::zeros());
        self.second_derivatives.clear();
    }

    /// Field value of nodal parameters, `Σ φ_I u_I`.
    #[inline]
    pub fn value(&self, parameters: &[Vector<D>]) -> Vector<D> {
        let pairs = self.neighbors.iter().zip(&self.values);
        pairs.fold(Vector::zeros(), |u, (&i, &v)| u + parameters[i as usize] * v)
    }

    /// Gradient of a vector field of nodal parameters, `[(i, j)] = ∂u_i/∂x_j`.
    #[inline]
    pub fn gradient(&self, parameters: &[Vector<D>]) -> Matrix<D> {
        let pairs = self.neighbors.iter().zip(&self.gradients);
        pairs.fold(Matrix::zeros(), |g, (&i, d)| g + parameters[i as usize] * d.transpose())
    }
}
