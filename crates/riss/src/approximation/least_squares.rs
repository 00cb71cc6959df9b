//! Weighted least squares by orthogonal columns, in memory that is reused.
//!
//! Modified Gram-Schmidt on the weighted columns loses digits with their condition, a factored moment matrix with its
//! square; the enriched basis needs the difference. Dependent columns are found and left out.

use super::orthogonal_columns::{Columns, NARROW, parts};
use super::settings::CollocationWeight;
use crate::math::lanes::{Arch, GROUP, Lanes, Simd, WithSimd};
use crate::math::{Matrix, Vector};

/// Room for the derivatives of a column: gradient, second derivatives and value, at most 10 of them.
pub(super) const LINES: usize = 2 * GROUP;
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

    /// Gradient, second derivatives `a ≤ b` rows first, value.
    fn lines(&self) -> [f64; LINES] {
        let mut lines = [0.0; LINES];
        lines[..D].copy_from_slice(self.gradient.as_slice());
        let mut d = D;
        for a in 0..D {
            for b in a..D {
                lines[d] = self.second_derivatives[(a, b)];
                d += 1;
            }
        }
        lines[d] = self.value;
        lines
    }
}

/// A fit: neighbors are rows, functions of the basis columns.
#[derive(Clone, Debug, Default)]
pub struct LeastSquares<const D: usize> {
    radius: f64,
    n_rows: usize,
    roots: Vec<f64>,
    /// Scaled offsets of the neighbors, axis by axis.
    offsets: Vec<f64>,
    /// Weighted values, made orthogonal from the left: [`GROUP`] rows of the first column, of the second, up to
    /// `pitch`; then the next rows. What is beyond the last column means nothing.
    values: Vec<f64>,
    pitch: usize,
    derivatives: Vec<[f64; LINES]>,
    /// Squared length of each column as it was given, and of what is left of it; that is zero if it is left out.
    lengths: Vec<f64>,
    sizes: Vec<f64>,
    /// Shares of the orthogonal columns in those after them, `pitch` for each; one on the diagonal.
    upper: Vec<f64>,
    n_orthogonal: usize,
    /// Coefficients of the derivatives in the orthogonal columns.
    coefficients: Vec<[f64; LINES]>,
    /// Derivatives by the values of the neighbors: one line each.
    lines: Vec<f64>,
    scratch: Vec<f64>,
}

impl<const D: usize> LeastSquares<D> {
    /// Begins a fit of no more than `n_columns`.
    ///
    /// - `relative`: squared distances of the neighbors over the squared support radius
    pub fn start(
        &mut self,
        radius: f64,
        weight: CollocationWeight,
        relative: impl Iterator<Item = f64>,
        n_columns: usize,
    ) {
        self.roots.clear();
        self.roots.extend(relative);
        weight.to_roots(&mut self.roots);
        self.radius = radius;
        self.n_rows = self.roots.len();
        // Rows without weight fill the last group.
        let stride = self.n_rows.next_multiple_of(GROUP);
        self.roots.resize(stride, 0.0);
        self.offsets.resize(D * stride, 0.0);
        self.pitch = n_columns + NARROW - 1;
        self.values.resize(self.pitch * stride, 0.0);
        self.upper.resize(self.pitch * n_columns, 0.0);
        self.derivatives.clear();
        self.lengths.clear();
        self.sizes.clear();
        self.n_orthogonal = 0;
    }

    /// Adds the function one.
    pub fn add_constant(&mut self) {
        let rows = self.values.chunks_exact_mut(GROUP * self.pitch);
        for (row, roots) in rows.zip(self.roots.chunks_exact(GROUP)) {
            row[..GROUP].copy_from_slice(roots);
        }
        self.added(&[Column { value: 1.0, ..Column::zero() }]);
    }

    /// Adds monomials of the offsets of the neighbors [support radii].
    ///
    /// - `factors`: each monomial as an earlier one (none for degree 1) times a coordinate
    pub fn add_monomials(
        &mut self,
        factors: &[(Option<usize>, usize)],
        columns: &[Column<D>],
        offsets: impl Iterator<Item = Vector<D>>,
    ) {
        let stride = self.roots.len();
        for (i, offset) in offsets.enumerate() {
            for d in 0..D {
                self.offsets[d * stride + i] = offset[d];
            }
        }
        Arch::new().dispatch(FillMonomials { fit: self, factors });
        self.added(columns);
    }

    /// Adds functions; `fill` writes their values at a neighbor.
    pub fn add_columns(
        &mut self,
        columns: &[Column<D>],
        neighbors: &[(f64, u32)],
        mut fill: impl FnMut(u32, &mut [f64]),
    ) {
        let first = self.derivatives.len();
        self.scratch.resize(columns.len(), 0.0);
        for i in 0..self.roots.len() {
            match neighbors.get(i) {
                Some(n) => fill(n.1, &mut self.scratch),
                None => self.scratch.fill(0.0),
            }
            let start = (i / GROUP * self.pitch + first) * GROUP + i % GROUP;
            for (v, value) in self.values[start..].iter_mut().step_by(GROUP).zip(&self.scratch) {
                *v = value * self.roots[i];
            }
        }
        self.added(columns);
    }

    /// Takes what is orthogonal already out of columns that were filled.
    fn added(&mut self, columns: &[Column<D>]) {
        let first = self.derivatives.len();
        self.derivatives.extend(columns.iter().map(Column::lines));
        let n = self.derivatives.len();
        debug_assert!(n + NARROW - 1 <= self.pitch);
        self.lengths.resize(n, 0.0);
        self.sizes.resize(n, 0.0);
        Arch::new().dispatch(CatchUp { fit: self, first });
    }

    /// Makes the next `count` columns orthogonal to those before; returns how many are independent.
    pub fn orthogonalize(&mut self, count: usize, tolerance: f64) -> usize {
        Arch::new().dispatch(Orthogonalize { fit: self, count, tolerance, is_twice: false })
    }

    /// The same with a second pass, for columns of which little is left.
    pub fn orthogonalize_twice(&mut self, count: usize, tolerance: f64) -> usize {
        Arch::new().dispatch(Orthogonalize { fit: self, count, tolerance, is_twice: true })
    }

    /// Derivatives of the fit by the values of the neighbors, and with `has_values` the values too.
    pub fn solve(&mut self, has_values: bool) {
        let n_lines = D + D * (D + 1) / 2;
        self.lines.resize((n_lines + 1) * self.roots.len(), 0.0);
        Arch::new().dispatch(WriteLines { fit: self, n_lines: n_lines + usize::from(has_values) });
    }

    /// Gradients, second derivatives `a ≤ b` rows first, and values by the values of the neighbors, one list for each, after
    /// [`Self::solve`].
    pub fn lines(&self) -> impl Iterator<Item = &[f64]> {
        self.lines.chunks_exact(self.roots.len().max(1)).map(|line| &line[..self.n_rows])
    }
}

struct FillMonomials<'a, const D: usize> {
    fit: &'a mut LeastSquares<D>,
    factors: &'a [(Option<usize>, usize)],
}

impl<const D: usize> WithSimd for FillMonomials<'_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { fit, factors } = self;
        let (first, parts) = (fit.derivatives.len(), parts::<S>());
        let roots = S::as_simd_f64s(&fit.roots).0;
        let offsets = S::as_simd_f64s(&fit.offsets).0;
        let rows = S::as_mut_simd_f64s(&mut fit.values).0.chunks_exact_mut(parts * fit.pitch);
        for (g, row) in rows.enumerate() {
            let row = &mut row[first * parts..];
            for (k, &(parent, axis)) in factors.iter().enumerate() {
                let x = &offsets[axis * roots.len() + g * parts..][..parts];
                let (before, own) = row.split_at_mut(k * parts);
                let parent = match parent {
                    None => &roots[g * parts..][..parts],
                    Some(p) => &before[p * parts..][..parts],
                };
                let own = &mut own[..parts];
                for u in 0..parts {
                    own[u] = (Lanes::new(simd, parent[u]) * Lanes::new(simd, x[u])).get();
                }
            }
        }
    }
}

struct CatchUp<'a, const D: usize> {
    fit: &'a mut LeastSquares<D>,
    first: usize,
}

impl<const D: usize> WithSimd for CatchUp<'_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { fit, first } = self;
        let n = fit.derivatives.len();
        let mut columns = Columns::new(simd, &mut fit.values, fit.pitch);
        for k in first..n {
            fit.lengths[k] = columns.squared_length(k);
        }
        for k in 0..fit.n_orthogonal {
            if fit.sizes[k] > 0.0 {
                columns.subtract(k, fit.sizes[k], &mut fit.upper[k * fit.pitch..][..fit.pitch], first..n);
            }
        }
    }
}

struct Orthogonalize<'a, const D: usize> {
    fit: &'a mut LeastSquares<D>,
    count: usize,
    tolerance: f64,
    is_twice: bool,
}

impl<const D: usize> WithSimd for Orthogonalize<'_, D> {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> usize {
        let Self { fit, count, tolerance, is_twice } = self;
        let (n, pitch) = (fit.derivatives.len(), fit.pitch);
        let mut columns = Columns::new(simd, &mut fit.values, pitch);
        let mut n_independent = 0;
        for k in fit.n_orthogonal..fit.n_orthogonal + count {
            if is_twice {
                columns.clean(k, &fit.sizes, &mut fit.upper);
            }
            let left = columns.squared_length(k);
            // Written so that NaN fails too.
            if left > tolerance * tolerance * fit.lengths[k] {
                fit.sizes[k] = left;
                n_independent += 1;
                columns.subtract(k, left, &mut fit.upper[k * pitch..][..pitch], k + 1..n);
            }
        }
        fit.n_orthogonal += count;
        n_independent
    }
}

/// Combines the orthogonal columns to the derivatives by the values of the neighbors.
struct WriteLines<'a, const D: usize> {
    fit: &'a mut LeastSquares<D>,
    n_lines: usize,
}

impl<const D: usize> WithSimd for WriteLines<'_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { fit, n_lines } = self;
        substitute(simd, fit, n_lines);
        let (roots, lines) = (S::as_simd_f64s(&fit.roots).0, S::as_mut_simd_f64s(&mut fit.lines).0);
        let columns = Columns::new(simd, &mut fit.values, fit.pitch);
        let mut first = 0;
        while first + 3 <= n_lines {
            columns.combine::<3>(&fit.coefficients, first, roots, lines);
            first += 3;
        }
        while first < n_lines {
            columns.combine::<1>(&fit.coefficients, first, roots, lines);
            first += 1;
        }
    }
}

/// Coefficients of the first `n_lines` derivatives: forward substitution with the transpose of `upper`, all at once.
#[inline(always)]
fn substitute<S: Simd, const D: usize>(simd: S, fit: &mut LeastSquares<D>, n_lines: usize) {
    let n = fit.n_orthogonal;
    fit.coefficients.clear();
    fit.coefficients.extend_from_slice(&fit.derivatives[..n]);
    let n_vectors = n_lines.div_ceil(S::F64_LANES);
    let inverse = 1.0 / fit.radius;
    for k in 0..n {
        let (done, rest) = fit.coefficients.split_at_mut(k + 1);
        let own = &mut done[k];
        if fit.sizes[k] > 0.0 {
            let shares = &fit.upper[k * fit.pitch..][k + 1..n];
            for (other, share) in rest.iter_mut().zip(shares) {
                let share = Lanes::splat(simd, -share);
                let (own, other) = (S::as_simd_f64s(own).0, S::as_mut_simd_f64s(other).0);
                for (o, v) in other[..n_vectors].iter_mut().zip(&own[..n_vectors]) {
                    *o = share.mul_add(Lanes::new(simd, *v), Lanes::new(simd, *o)).get();
                }
            }
            let factor = 1.0 / fit.sizes[k];
            let n_second = D * (D + 1) / 2;
            own[..D].iter_mut().for_each(|v| *v *= factor * inverse);
            own[D..D + n_second].iter_mut().for_each(|v| *v *= factor * inverse * inverse);
            own[D + n_second] *= factor;
        } else {
            own.fill(0.0);
        }
    }
}

#[cfg(test)]
mod tests;
