//! Sparse LU factorization of systems that are not symmetric.

use super::block_rows::BlockRows;
use crate::error::{Error, Result};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::lu::{LuRef, LuSymbolicParams, NumericLu, SymbolicLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use faer::{Conj, Mat, Par};

/// Rows of a square matrix, in compressed form.
#[derive(Debug)]
pub struct ScalarRows {
    /// Where each row starts, and the end of the last.
    pub starts: Vec<usize>,
    /// Columns, ascending in each row.
    pub columns: Vec<usize>,
    /// Entries.
    pub values: Vec<f64>,
}

impl Default for ScalarRows {
    fn default() -> Self {
        Self { starts: vec![0], columns: vec![], values: vec![] }
    }
}

impl ScalarRows {
    /// Expands blocks and borders the matrix with `border` to the right and its transpose below, see [`Self::border_below`].
    pub fn bordered<const D: usize>(matrix: &BlockRows<D>, border: &[Vec<f64>]) -> Self {
        let n = matrix.n_rows() * D;
        let mut rows = Self::default();
        for i in 0..n {
            let (columns, blocks) = matrix.row(i / D);
            for (&j, block) in columns.iter().zip(blocks) {
                for d in 0..D {
                    rows.columns.push(j as usize * D + d);
                    rows.values.push(block[i % D][d]);
                }
            }
            rows.columns.extend((0..border.len()).map(|k| n + k));
            rows.values.extend(border.iter().map(|b| b[i]));
            rows.end();
        }
        rows.border_below(border, n);
        rows
    }

    /// Adds the rows of a border below `n` columns, with minus the identity in the corner: to eliminate them adds the
    /// products of the border with itself to the matrix.
    pub fn border_below(&mut self, border: &[Vec<f64>], n: usize) {
        for (k, b) in border.iter().enumerate() {
            self.columns.extend((0..n).chain([n + k]));
            self.values.extend(b.iter().chain([&-1.0]));
            self.end();
        }
    }

    /// Ends a row.
    pub fn end(&mut self) {
        self.starts.push(self.columns.len());
    }
}

/// The factors.
pub struct SparseLu {
    symbolic: SymbolicLu<usize>,
    numeric: NumericLu<usize, f64>,
    n: usize,
}

impl SparseLu {
    /// Factors with columns ordered for little fill and rows by pivots.
    ///
    /// # Errors
    /// [`Error::Factorization`] if the matrix is singular to the solver.
    pub fn new(rows: ScalarRows) -> Result<Self> {
        let n = rows.starts.len() - 1;
        let fail = |reason: String| Error::Factorization { reason };
        // Rows are columns of the transposed matrix, and that is what is factored.
        let pattern = SymbolicSparseColMat::new_checked(n, n, rows.starts, None, rows.columns);
        let matrix = SparseColMat::new(pattern, rows.values);
        let symbolic = factorize_symbolic_lu(matrix.symbolic(), LuSymbolicParams::default())
            .map_err(|e| fail(format!("{e:?}")))?;
        let mut numeric = NumericLu::new();
        let mut memory = MemBuffer::new(symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, Default::default()));
        symbolic
            .factorize_numeric_lu(
                &mut numeric,
                matrix.as_ref(),
                Par::Seq,
                MemStack::new(&mut memory),
                Default::default(),
            )
            .map_err(|e| fail(format!("it is singular ({e:?})")))?;
        Ok(Self { symbolic, numeric, n })
    }

    /// Replaces `W` right-hand sides, whose entries stand side by side, by the solutions.
    pub fn solve_in_place<const W: usize>(&self, x: &mut [f64]) {
        let mut right = Mat::from_fn(self.n, W, |i, l| x[i * W + l]);
        let mut memory = MemBuffer::new(self.symbolic.solve_transpose_in_place_scratch::<f64>(W, Par::Seq));
        // The symbolic and numeric parts were made together.
        let factor = LuRef::new_unchecked(&self.symbolic, &self.numeric);
        factor.solve_transpose_in_place_with_conj(Conj::No, right.as_mut(), Par::Seq, MemStack::new(&mut memory));
        x.iter_mut().enumerate().for_each(|(i, v)| *v = right[(i / W, i % W)]);
    }
}

impl std::fmt::Debug for SparseLu {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "SparseLu({})", self.n)
    }
}
