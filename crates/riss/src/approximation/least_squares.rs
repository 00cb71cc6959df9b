//! Weighted least squares by orthogonal columns, in memory that is reused.
//!
//! Modified Gram-Schmidt on the weighted columns loses digits with their condition, a factored moment matrix with its
//! square; the enriched basis needs the difference. Dependent columns are found and left out.

use crate::math::{Matrix, Vector};

/// Numbers that the compiler keeps together in vector registers.
const LANES: usize = 8;

/// Value and derivatives of a function of the basis at the center, lengths counted in support radii.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Column<const D: usize> {
    /// Value.
    pub value: f64,
    /// Gradient.
    pub gradient: Vector<D>,
    /// Second derivatives.
    pub second_derivatives: Matrix<D>,
}

impl<const D: usize> Column<D> {
    /// A function of which nothing is known at the center.
    pub fn zero() -> Self {
        Self { value: 0.0, gradient: Vector::zeros(), second_derivatives: Matrix::zeros() }
    }
}

/// A fit: neighbors are rows, functions of the basis columns.
#[derive(Clone, Debug, Default)]
pub struct LeastSquares<const D: usize> {
    radius: f64,
    n_rows: usize,
    stride: usize,
    roots: Vec<f64>,
    /// Weighted values, made orthonormal from the left; column by column.
    values: Vec<f64>,
    derivatives: Vec<Column<D>>,
    /// Factor R by columns, its first k + 1 entries; zero on the diagonal for a column that is left out.
    upper: Vec<f64>,
    n_orthogonal: usize,
    /// Coefficients of the derivatives in the orthonormal columns.
    coefficients: Vec<f64>,
    /// Derivatives by the values of the neighbors: one line each.
    lines: Vec<f64>,
    scratch: Vec<f64>,
}

impl<const D: usize> LeastSquares<D> {
    /// Begins a fit with the square roots of the weights.
    pub fn start(&mut self, radius: f64, roots: impl Iterator<Item = f64>) {
        self.roots.clear();
        self.roots.extend(roots);
        self.radius = radius;
        self.n_rows = self.roots.len();
        self.stride = self.n_rows.next_multiple_of(LANES);
        self.roots.resize(self.stride, 0.0);
        self.values.clear();
        self.derivatives.clear();
        self.upper.clear();
        self.n_orthogonal = 0;
    }

    /// Adds the function one.
    pub fn add_constant(&mut self) {
        self.values.extend_from_slice(&self.roots);
        self.derivatives.push(Column { value: 1.0, gradient: Vector::zeros(), second_derivatives: Matrix::zeros() });
    }

    /// Adds functions; `fill` writes their values at a neighbor.
    pub fn add_columns(
        &mut self,
        columns: &[Column<D>],
        neighbors: &[(f64, u32)],
        mut fill: impl FnMut(u32, &mut [f64]),
    ) {
        let (start, stride) = (self.values.len(), self.stride);
        self.values.resize(start + columns.len() * stride, 0.0);
        self.scratch.resize(columns.len(), 0.0);
        for (i, n) in neighbors.iter().enumerate() {
            fill(n.1, &mut self.scratch);
            for (k, v) in self.scratch.iter().enumerate() {
                self.values[start + k * stride + i] = v * self.roots[i];
            }
        }
        self.derivatives.extend_from_slice(columns);
    }

    /// Makes the next `count` columns orthogonal to those before; returns how many are independent.
    pub fn orthogonalize(&mut self, count: usize, tolerance: f64) -> usize {
        self.run(count, tolerance, 1)
    }

    /// The same with a second pass, for columns of which little is left.
    pub fn orthogonalize_twice(&mut self, count: usize, tolerance: f64) -> usize {
        self.run(count, tolerance, 2)
    }

    fn run(&mut self, count: usize, tolerance: f64, passes: usize) -> usize {
        let stride = self.stride;
        let mut n_independent = 0;
        for k in self.n_orthogonal..self.n_orthogonal + count {
            let (before, rest) = self.values.split_at_mut(k * stride);
            let column = &mut rest[..stride];
            let length = dot(column, column).sqrt();
            let start = self.upper.len();
            self.upper.resize(start + k + 1, 0.0);
            for _ in 0..passes {
                for (j, earlier) in before.chunks_exact(stride).enumerate() {
                    // Columns that are left out are zero.
                    let r = dot(earlier, column);
                    self.upper[start + j] += r;
                    subtract(column, r, earlier);
                }
            }
            let left = dot(column, column).sqrt();
            // Written so that NaN fails too.
            if left > tolerance * length {
                self.upper[start + k] = left;
                column.iter_mut().for_each(|v| *v /= left);
                n_independent += 1;
            } else {
                column.fill(0.0);
            }
        }
        self.n_orthogonal += count;
        n_independent
    }

    /// Derivatives of the fit by the values of the neighbors.
    pub fn solve(&mut self) {
        let (n, m) = (self.n_orthogonal, 1 + D + D * D);
        self.coefficients.clear();
        self.coefficients.resize(n * m, 0.0);
        // Forward substitution with Rᵀ, all derivatives at once.
        let mut start = 0;
        for k in 0..n {
            let column = &self.derivatives[k];
            let (done, rest) = self.coefficients.split_at_mut(k * m);
            let own = &mut rest[..m];
            let pivot = self.upper[start + k];
            if pivot > 0.0 {
                own[0] = column.value;
                own[1..=D].copy_from_slice(column.gradient.as_slice());
                own[1 + D..].copy_from_slice(column.second_derivatives.as_slice());
                for (r, earlier) in self.upper[start..start + k].iter().zip(done.chunks_exact(m)) {
                    own.iter_mut().zip(earlier).for_each(|(o, e)| *o -= r * e);
                }
                own.iter_mut().for_each(|o| *o /= pivot);
            }
            start += k + 1;
        }
        let stride = self.stride;
        self.lines.clear();
        self.lines.resize(m * stride, 0.0);
        for (d, line) in self.lines.chunks_exact_mut(stride).enumerate() {
            // Second derivatives are symmetric: the lower ones are copied below.
            if d > D && (d - 1 - D) / D > (d - 1 - D) % D {
                continue;
            }
            for (k, column) in self.values.chunks_exact(stride).take(n).enumerate() {
                subtract(line, -self.coefficients[k * m + d], column);
            }
            line.iter_mut().zip(&self.roots).for_each(|(l, root)| *l *= root);
        }
    }

    /// Value and derivatives by the value of neighbor `i`, after [`Self::solve`].
    #[inline]
    pub fn row(&self, i: usize) -> Column<D> {
        let line = |d: usize| self.lines[d * self.stride + i];
        let inverse = 1.0 / self.radius;
        Column {
            value: line(0),
            gradient: Vector::from_fn(|a, _| line(1 + a) * inverse),
            second_derivatives: Matrix::from_fn(|a, b| line(1 + D + a.min(b) * D + a.max(b)) * inverse * inverse),
        }
    }
}

#[inline]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    for (a, b) in a.chunks_exact(LANES).zip(b.chunks_exact(LANES)) {
        for l in 0..LANES {
            sums[l] += a[l] * b[l];
        }
    }
    sums.iter().sum()
}

#[inline]
fn subtract(y: &mut [f64], factor: f64, x: &[f64]) {
    for (y, x) in y.chunks_exact_mut(LANES).zip(x.chunks_exact(LANES)) {
        for l in 0..LANES {
            y[l] -= factor * x[l];
        }
    }
}
