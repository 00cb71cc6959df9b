//! A smoother stress from the stress at the nodes [CPM, Eq. A.2; Chung1998].

use crate::approximation::moving_least_squares::Derivatives;
use crate::approximation::{MovingLeastSquares, ShapeFunctions, Surroundings};
use crate::error::Result;
use crate::math::{Matrix2, Vector2};
use crate::model::Model;
use crate::system::{Discretization, Solution};
use rayon::prelude::*;

/// Supports of the recovery over those of the solution.
const SUPPORT_SHARE: f64 = 0.75;

/// Buffers of one thread.
pub type Buffer = (Surroundings, ShapeFunctions<2>);

/// The stress `Σ Ψ_k(x) σ(x_k)`: shape functions of smaller supports, the stress of the solution at the nodes.
#[derive(Clone, Debug)]
pub struct RecoveredStress<'a> {
    fine: MovingLeastSquares,
    wide: &'a MovingLeastSquares,
    nodal: Vec<Matrix2>,
}

impl<'a> RecoveredStress<'a> {
    /// Evaluates the stress of a solution at all nodes.
    ///
    /// # Errors
    /// Those of the shape functions.
    pub fn new(model: &Model, discrete: &'a Discretization, solution: &Solution) -> Result<Self> {
        Self::of_nodes(model, discrete, solution, |_| true)
    }

    /// The same for use at the points of disks, each with its radius.
    ///
    /// # Errors
    /// Those of the shape functions.
    pub fn within(
        model: &Model,
        discrete: &'a Discretization,
        solution: &Solution,
        disks: &[(Vector2, f64)],
    ) -> Result<Self> {
        let nodes = discrete.approximation.nodes();
        let reaches = |i: usize, disk: &(Vector2, f64)| {
            (nodes.positions[i] - disk.0).norm() < disk.1 + nodes.support_radii[i].norm()
        };
        Self::of_nodes(model, discrete, solution, |i| disks.iter().any(|d| reaches(i, d)))
    }

    fn of_nodes(
        model: &Model,
        discrete: &'a Discretization,
        solution: &Solution,
        is_used: impl Fn(usize) -> bool + Sync,
    ) -> Result<Self> {
        let wide = &discrete.approximation;
        let nodes = wide.nodes();
        let nodal = (0..nodes.len())
            .into_par_iter()
            .with_min_len(64)
            .map_init(Buffer::default, |(around, shape), i| {
                if !is_used(i) {
                    return Ok(Matrix2::zeros());
                }
                wide.evaluate(nodes.positions[i], nodes.sights[i], Derivatives::First, around, shape)?;
                Ok(model.material.stress(&shape.gradient(&solution.parameters)))
            })
            .collect::<Result<_>>()?;
        let mut smaller = nodes.clone();
        smaller.support_radii.iter_mut().for_each(|r| *r *= SUPPORT_SHARE);
        let fine = MovingLeastSquares::new(smaller, wide.obstacles().clone(), *wide.settings());
        Ok(Self { fine, wide, nodal })
    }

    /// The recovered stress at a point, seen from `sight` [stress].
    ///
    /// # Errors
    /// Those of the shape functions.
    pub fn at(&self, at: Vector2, sight: Vector2, (around, shape): &mut Buffer) -> Result<Matrix2> {
        // Where too few of the smaller supports reach, those of the solution do.
        if self.fine.evaluate(at, sight, Derivatives::First, around, shape).is_err() {
            self.wide.evaluate(at, sight, Derivatives::First, around, shape)?;
        }
        // The plain shape functions alone are a mean.
        let pairs = shape.neighbors.iter().zip(&shape.values).filter(|(n, _)| (**n as usize) < self.nodal.len());
        Ok(pairs.fold(Matrix2::zeros(), |sum, (&n, &v)| sum + self.nodal[n as usize] * v))
    }
}
