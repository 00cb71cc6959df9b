//! Solves for nodes and multipliers with several loads by one factorization.

use super::block_matrix::BlockMatrix;
use super::constraints::ConstraintRow;
use super::linear_solver::{Factor, MIXED_FROM, SaddleFactor};
use super::multifrontal::EliminationTree;
use super::settings::LinearSolver;
use crate::error::{Error, Result};
use nalgebra::{DMatrix, DVector, Dyn, LU};
use std::sync::Arc;

/// Unknowns of nodes, and multipliers of the constraint rows.
#[derive(Clone, Debug, Default)]
pub(super) struct Part {
    /// Dofs of nodes [length].
    pub u: Vec<f64>,
    /// Multipliers, row by row.
    pub multipliers: Vec<f64>,
}

/// A factored system.
pub(super) struct NodeSolver {
    kind: Kind,
    /// Products of rows in the matrix: `A + s Σ c cᵀ`.
    pub augmentation: f64,
}

enum Kind {
    /// Cholesky, the rows by their Schur complement.
    Definite { factor: Factor, columns: Vec<Vec<f64>>, schur: LU<f64, Dyn, Dyn> },
    /// With the multipliers, or an indefinite matrix.
    Indefinite(Box<SaddleFactor>),
}

fn apply(row: &ConstraintRow, x: &[f64]) -> f64 {
    row.entries.iter().map(|&(dof, c)| c * x[dof]).sum()
}

impl NodeSolver {
    /// Of a matrix that is positive definite but for motions that a few rows hold; their products are added to it.
    ///
    /// # Errors
    /// [`Error::Factorization`] if the matrix is not positive definite.
    pub fn definite(
        matrix: &mut BlockMatrix,
        tree: &Arc<EliminationTree>,
        rows: &[ConstraintRow],
        solver: LinearSolver,
    ) -> Result<Self> {
        // The matrix alone may be singular; c cᵀ of each row makes it definite and changes no solution.
        let augmentation = matrix.largest_diagonal();
        add_products(matrix, rows, augmentation);
        let single = match solver {
            LinearSolver::Automatic => 2 * matrix.n_nodes() >= MIXED_FROM,
            LinearSolver::Direct => false,
            LinearSolver::MixedPrecision => true,
        };
        let factor = match single.then(|| Factor::single(matrix, tree.clone())) {
            Some(Ok(factor)) => factor,
            // Too ill conditioned for single precision.
            Some(Err(_)) | None => Factor::double(matrix, tree.clone())?,
        };
        let column = |row: &ConstraintRow| {
            let mut c = vec![0.0; 2 * matrix.n_nodes()];
            row.entries.iter().for_each(|&(dof, v)| c[dof] = v);
            factor.solve(matrix, &c)
        };
        let columns: Vec<Vec<f64>> = rows.iter().map(column).collect::<Result<_>>()?;
        let schur = DMatrix::from_fn(rows.len(), rows.len(), |i, j| apply(&rows[i], &columns[j])).lu();
        Ok(Self { kind: Kind::Definite { factor, columns, schur }, augmentation })
    }

    /// Of any symmetric matrix with any number of rows.
    ///
    /// # Errors
    /// [`Error::Factorization`] if there is no factor.
    pub fn indefinite(matrix: &BlockMatrix, order: &[u32], rows: &[ConstraintRow]) -> Result<Self> {
        Ok(Self { kind: Kind::Indefinite(Box::new(SaddleFactor::new(matrix, order, rows)?)), augmentation: 0.0 })
    }

    /// Solves with a load and values of the rows; matrix and rows are those of the factorization.
    ///
    /// # Errors
    /// [`Error::Factorization`] or [`Error::Residual`].
    pub fn solve(&self, matrix: &BlockMatrix, rows: &[ConstraintRow], load: &[f64], values: &[f64]) -> Result<Part> {
        match &self.kind {
            Kind::Indefinite(factor) => {
                let (u, multipliers) = factor.solve(load, values)?;
                Ok(Part { u, multipliers })
            }
            Kind::Definite { factor, .. } if rows.is_empty() => {
                Ok(Part { u: factor.solve(matrix, load)?, multipliers: vec![] })
            }
            Kind::Definite { factor, columns, schur } => {
                let mut augmented = load.to_vec();
                for (row, value) in rows.iter().zip(values) {
                    row.entries.iter().for_each(|&(dof, c)| augmented[dof] += self.augmentation * c * value);
                }
                let mut u = factor.solve(matrix, &augmented)?;
                let gap = DVector::from_fn(rows.len(), |i, _| apply(&rows[i], &u) - values[i]);
                let contradict = || Error::Factorization { reason: "supports at points contradict one another".into() };
                let multipliers = schur.solve(&gap).ok_or_else(contradict)?;
                for (column, m) in columns.iter().zip(multipliers.iter()) {
                    u.iter_mut().zip(column).for_each(|(u, c)| *u -= m * c);
                }
                Ok(Part { u, multipliers: multipliers.iter().copied().collect() })
            }
        }
    }
}

fn add_products(matrix: &mut BlockMatrix, rows: &[ConstraintRow], factor: f64) {
    for row in rows {
        for &(p, cp) in &row.entries {
            for &(q, cq) in row.entries.iter().filter(|e| e.0 / 2 <= p / 2) {
                let range = matrix.row_starts[p / 2]..matrix.row_starts[p / 2 + 1];
                let column =
                    matrix.columns[range.clone()].binary_search(&((q / 2) as u32)).expect("rows are in the pattern");
                matrix.blocks[range.start + column][2 * (p % 2) + q % 2] += factor * cp * cq;
            }
        }
    }
}
