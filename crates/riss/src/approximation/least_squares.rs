//! Weighted least squares by orthogonal columns, in memory that is reused.
//!
//! Modified Gram-Schmidt on the weighted columns loses digits with their condition, a factored moment matrix with its
//! square; the enriched basis needs the difference. Dependent columns are found and left out.

use crate::math::lanes::{Arch, GROUP, Lanes, Simd, WithSimd};
use crate::math::{Matrix, Vector};

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
        self.stride = self.n_rows.next_multiple_of(GROUP);
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
        Arch::new().dispatch(Orthogonalize { fit: self, count, tolerance, passes })
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
        Arch::new().dispatch(WriteLines(self));
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

struct Orthogonalize<'a, const D: usize> {
    fit: &'a mut LeastSquares<D>,
    count: usize,
    tolerance: f64,
    passes: usize,
}

impl<const D: usize> WithSimd for Orthogonalize<'_, D> {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> usize {
        let Self { fit, count, tolerance, passes } = self;
        let stride = fit.stride;
        let mut n_independent = 0;
        for k in fit.n_orthogonal..fit.n_orthogonal + count {
            let (before, rest) = fit.values.split_at_mut(k * stride);
            let column = &mut rest[..stride];
            let length = dot(simd, column, column).sqrt();
            let start = fit.upper.len();
            fit.upper.resize(start + k + 1, 0.0);
            for _ in 0..passes {
                for (j, earlier) in before.chunks_exact(stride).enumerate() {
                    // Columns that are left out are zero.
                    let r = dot(simd, earlier, column);
                    fit.upper[start + j] += r;
                    add(simd, column, -r, earlier);
                }
            }
            let left = dot(simd, column, column).sqrt();
            // Written so that NaN fails too.
            if left > tolerance * length {
                fit.upper[start + k] = left;
                for v in column.iter_mut() {
                    *v /= left;
                }
                n_independent += 1;
            } else {
                column.fill(0.0);
            }
        }
        fit.n_orthogonal += count;
        n_independent
    }
}

/// Combines the orthonormal columns to the derivatives by the values of the neighbors.
struct WriteLines<'a, const D: usize>(&'a mut LeastSquares<D>);

impl<const D: usize> WithSimd for WriteLines<'_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self(fit) = self;
        let (n, m, stride) = (fit.n_orthogonal, 1 + D + D * D, fit.stride);
        fit.lines.clear();
        fit.lines.resize(m * stride, 0.0);
        for (d, line) in fit.lines.chunks_exact_mut(stride).enumerate() {
            // Second derivatives are symmetric: the lower ones are copied.
            if d > D && (d - 1 - D) / D > (d - 1 - D) % D {
                continue;
            }
            for (k, column) in fit.values.chunks_exact(stride).take(n).enumerate() {
                add(simd, line, fit.coefficients[k * m + d], column);
            }
            for (l, root) in line.iter_mut().zip(&fit.roots) {
                *l *= root;
            }
        }
    }
}

/// Scalar product of lists whose lengths are multiples of [`GROUP`].
#[inline(always)]
fn dot<S: Simd>(simd: S, a: &[f64], b: &[f64]) -> f64 {
    let (a, b) = (S::as_simd_f64s(a).0, S::as_simd_f64s(b).0);
    // Several sums, for an addition takes longer than the next one needs to start.
    let mut sums = [Lanes::splat(simd, 0.0); 4];
    let (a_parts, a_rest) = a.as_chunks::<4>();
    let (b_parts, b_rest) = b.as_chunks::<4>();
    for (a, b) in a_parts.iter().zip(b_parts) {
        for l in 0..4 {
            sums[l] = Lanes::new(simd, a[l]).mul_add(Lanes::new(simd, b[l]), sums[l]);
        }
    }
    for (a, b) in a_rest.iter().zip(b_rest) {
        sums[0] = Lanes::new(simd, *a).mul_add(Lanes::new(simd, *b), sums[0]);
    }
    ((sums[0] + sums[1]) + (sums[2] + sums[3])).sum()
}

/// Adds `factor x` to `y`.
#[inline(always)]
fn add<S: Simd>(simd: S, y: &mut [f64], factor: f64, x: &[f64]) {
    let factor = Lanes::splat(simd, factor);
    for (y, x) in S::as_mut_simd_f64s(y).0.iter_mut().zip(S::as_simd_f64s(x).0) {
        *y = Lanes::new(simd, *x).mul_add(factor, Lanes::new(simd, *y)).get();
    }
}
