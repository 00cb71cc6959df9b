//! Symmetric systems, definite or not, solved to full precision.

use super::block_matrix::BlockMatrix;
use super::constraints::ConstraintRow;
use super::multifrontal::{Cholesky, EliminationTree};
use crate::error::{Error, Result};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, IntranodeLbltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use faer::{Conj, Mat, Par, Side};
use std::sync::Arc;

/// From this many dofs a factor in single precision with conjugate gradients is faster and half the size.
pub const MIXED_FROM: usize = 120_000;
/// Conjugate gradients stop at this relative residual.
const ITERATION_TARGET: f64 = 1e-12;
/// Iterations after which the single precision factor counts as too poor.
const MAX_ITERATIONS: usize = 60;

/// A factored symmetric matrix.
pub enum Factor {
    /// Cholesky in double precision.
    Double(Cholesky<f64>),
    /// Cholesky in single precision, of the matrix scaled to unit diagonal.
    Single {
        /// The factor.
        factor: Cholesky<f32>,
        /// Inverse square roots of the diagonal.
        scale: Vec<f64>,
    },
}

impl Factor {
    /// Factors in double precision.
    ///
    /// # Errors
    /// [`Error::Factorization`] if the matrix is not positive definite.
    pub fn double(matrix: &BlockMatrix, tree: Arc<EliminationTree>) -> Result<Self> {
        Ok(Self::Double(Cholesky::new(tree, matrix, |v, _, _| v)?))
    }

    /// Factors in single precision.
    ///
    /// # Errors
    /// [`Error::Factorization`] if the matrix is not positive definite in this precision.
    pub fn single(matrix: &BlockMatrix, tree: Arc<EliminationTree>) -> Result<Self> {
        let scale: Vec<f64> = (0..2 * matrix.n_nodes())
            .map(|dof| matrix.blocks[matrix.row_starts[dof / 2 + 1] - 1][3 * (dof % 2)].sqrt().recip())
            .collect();
        let factor = Cholesky::new(tree, matrix, |v, i, j| (v * scale[i] * scale[j]) as f32)?;
        Ok(Self::Single { factor, scale })
    }

    /// Solves `A x = b` to full precision.
    pub fn solve(&self, matrix: &BlockMatrix, right: &[f64]) -> Result<Vec<f64>> {
        match self {
            Self::Double(factor) => {
                let mut x = right.to_vec();
                factor.solve_in_place(&mut x);
                // One step of refinement costs a multiplication and keeps all digits.
                let mut r = vec![0.0; x.len()];
                matrix.multiply(&x, &mut r);
                r.iter_mut().zip(right).for_each(|(r, b)| *r = b - *r);
                factor.solve_in_place(&mut r);
                x.iter_mut().zip(&r).for_each(|(x, d)| *x += d);
                Ok(x)
            }
            Self::Single { factor, scale } => conjugate_gradients(matrix, right, |r| {
                let largest = r.iter().fold(0.0f64, |m, v| m.max(v.abs())).max(f64::MIN_POSITIVE);
                let mut z: Vec<f32> = r.iter().zip(scale).map(|(v, s)| (v * s / largest) as f32).collect();
                factor.solve_in_place(&mut z);
                z.iter().zip(scale).map(|(v, s)| *v as f64 * s * largest).collect()
            }),
        }
    }
}

/// Expands blocks to scalars: row `i` of the lower triangle is column `i` of the upper one.
fn upper_columns(matrix: &BlockMatrix) -> (Vec<usize>, Vec<usize>, Vec<f64>) {
    let n = matrix.n_nodes();
    let n_values = 4 * matrix.columns.len() - n;
    let (mut starts, mut rows, mut values) =
        (Vec::with_capacity(2 * n + 1), Vec::with_capacity(n_values), Vec::with_capacity(n_values));
    starts.push(0);
    for i in 0..n {
        for c in 0..2 {
            for k in matrix.row_starts[i]..matrix.row_starts[i + 1] {
                let j = matrix.columns[k] as usize;
                for d in 0..if i == j { c + 1 } else { 2 } {
                    rows.push(2 * j + d);
                    values.push(matrix.blocks[k][2 * c + d]);
                }
            }
            starts.push(rows.len());
        }
    }
    (starts, rows, values)
}

fn symbolic_factor(
    matrix: &SparseColMat<usize, f64>,
    order: &[usize],
    inverse: &[usize],
) -> Result<SymbolicCholesky<usize>> {
    let n = order.len();
    let parameters = CholeskySymbolicParams {
        supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
        ..Default::default()
    };
    let ordering = SymmetricOrdering::Custom(PermRef::new_checked(order, inverse, n));
    factorize_symbolic_cholesky(matrix.symbolic(), Side::Upper, ordering, parameters)
        .map_err(|e| Error::Factorization { reason: format!("{e:?}") })
}

fn invert(order: &[usize]) -> Vec<usize> {
    let mut inverse = vec![0; order.len()];
    for (position, &dof) in order.iter().enumerate() {
        inverse[dof] = position;
    }
    inverse
}

fn conjugate_gradients(
    matrix: &BlockMatrix,
    right: &[f64],
    precondition: impl Fn(&[f64]) -> Vec<f64>,
) -> Result<Vec<f64>> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let size = dot(right, right).sqrt();
    let mut x = vec![0.0; right.len()];
    if size == 0.0 {
        return Ok(x);
    }
    let mut r = right.to_vec();
    let mut z = precondition(&r);
    let mut p = z.clone();
    let mut q = vec![0.0; right.len()];
    let mut rz = dot(&r, &z);
    for _ in 0..MAX_ITERATIONS {
        matrix.multiply(&p, &mut q);
        let alpha = rz / dot(&p, &q);
        for i in 0..x.len() {
            x[i] += alpha * p[i];
            r[i] -= alpha * q[i];
        }
        let residual = dot(&r, &r).sqrt() / size;
        if residual <= ITERATION_TARGET {
            return Ok(x);
        }
        if !residual.is_finite() {
            break;
        }
        z = precondition(&r);
        let next = dot(&r, &z);
        for i in 0..p.len() {
            p[i] = z[i] + next / rz * p[i];
        }
        rz = next;
    }
    Err(Error::Residual { residual: dot(&r, &r).sqrt() / size, allowed: ITERATION_TARGET })
}

/// A factored saddle point problem of a matrix with constraint rows, which may be indefinite: LBLᵀ with pivoting inside
/// supernodes.
pub struct SaddleFactor {
    sparse: SparseColMat<usize, f64>,
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    subdiagonal: Vec<f64>,
    pivots: [Vec<usize>; 2],
    /// Number of dofs.
    n: usize,
    /// Factor of each constraint row.
    scales: Vec<f64>,
}

impl SaddleFactor {
    /// Factors; each multiplier is eliminated right after the last of its nodes, so that its pivot is filled by then.
    ///
    /// # Errors
    /// [`Error::Factorization`] if there is no memory for the factor.
    pub fn new(matrix: &BlockMatrix, order: &[u32], rows: &[ConstraintRow]) -> Result<Self> {
        let (n, m) = (2 * matrix.n_nodes(), rows.len());
        // The multipliers are scaled to the stiffness, so that pivots compare.
        let stiffness = matrix.largest_diagonal();
        let largest = |row: &ConstraintRow| row.entries.iter().fold(0.0f64, |a, e| a.max(e.1.abs()));
        let scales: Vec<f64> = rows.iter().map(|row| stiffness / largest(row)).collect();
        let (mut starts, mut indices, mut values) = upper_columns(matrix);
        for (k, row) in rows.iter().enumerate() {
            for &(dof, v) in &row.entries {
                indices.push(dof);
                values.push(v * scales[k]);
            }
            indices.push(n + k);
            values.push(0.0);
            starts.push(indices.len());
        }
        let size = n + m;
        let sparse = SparseColMat::new(SymbolicSparseColMat::new_checked(size, size, starts, None, indices), values);
        let mut position = vec![0; matrix.n_nodes()];
        order.iter().enumerate().for_each(|(p, &i)| position[i as usize] = p);
        let mut after: Vec<Vec<usize>> = vec![vec![]; matrix.n_nodes()];
        for (k, row) in rows.iter().enumerate() {
            let last = row.entries.iter().map(|e| position[e.0 / 2]).max().unwrap_or(0);
            after[last].push(n + k);
        }
        let mut full = Vec::with_capacity(size);
        for (p, &i) in order.iter().enumerate() {
            full.extend([2 * i as usize, 2 * i as usize + 1]);
            full.extend(&after[p]);
        }
        let symbolic = symbolic_factor(&sparse, &full, &invert(&full))?;
        let (mut values, mut subdiagonal) = (vec![0.0; symbolic.len_val()], vec![0.0; size]);
        let (mut forward, mut backward) = (vec![0; size], vec![0; size]);
        let mut memory =
            MemBuffer::new(symbolic.factorize_numeric_intranode_lblt_scratch::<f64>(Par::Seq, Default::default()));
        symbolic.factorize_numeric_intranode_lblt(
            &mut values,
            &mut subdiagonal,
            &mut forward,
            &mut backward,
            sparse.as_ref(),
            Side::Upper,
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        Ok(Self { sparse, symbolic, values, subdiagonal, pivots: [forward, backward], n, scales })
    }

    /// Dofs and multipliers under a load, with given values of the constraint rows.
    ///
    /// # Errors
    /// [`Error::Factorization`] if rows are redundant or contradict one another.
    pub fn solve(&self, load: &[f64], values: &[f64]) -> Result<(Vec<f64>, Vec<f64>)> {
        let size = self.n + self.scales.len();
        let [forward, backward] = &self.pivots;
        let pivots = PermRef::new_checked(forward, backward, size);
        let factor = IntranodeLbltRef::new(&self.symbolic, &self.values, &self.subdiagonal, pivots);
        let scaled = values.iter().zip(&self.scales).map(|(v, s)| v * s);
        let right: Vec<f64> = load.iter().copied().chain(scaled).collect();
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let mut x = vec![0.0; size];
        // Refinement: pivoting inside supernodes may cost some digits.
        for _ in 0..3 {
            let product = multiply_upper(&self.sparse, &x);
            let mut step = Mat::from_fn(size, 1, |i, _| right[i] - product[i]);
            factor.solve_in_place_with_conj(Conj::No, step.as_mut(), Par::Seq, MemStack::new(&mut memory));
            (0..size).for_each(|i| x[i] += step[(i, 0)]);
        }
        if x.iter().any(|v| !v.is_finite()) {
            return Err(Error::Factorization { reason: "a constraint is redundant or contradicts another".into() });
        }
        let multipliers = self.scales.iter().zip(&x[self.n..]).map(|(s, v)| v * s).collect();
        x.truncate(self.n);
        Ok((x, multipliers))
    }
}

fn multiply_upper(matrix: &SparseColMat<usize, f64>, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; x.len()];
    let (starts, rows, values) = (matrix.symbolic().col_ptr(), matrix.symbolic().row_idx(), matrix.val());
    for j in 0..x.len() {
        for k in starts[j]..starts[j + 1] {
            let i = rows[k];
            y[i] += values[k] * x[j];
            if i != j {
                y[j] += values[k] * x[i];
            }
        }
    }
    y
}
