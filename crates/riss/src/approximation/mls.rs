//! Moving least squares shape functions by the factored form A γ = p [EFG, section 2.1].
//!
//! The basis is shifted to the evaluation point and scaled by the weighted mean distance of the neighbors. With the
//! shift frozen, `p(x)` is a unit vector and the neighbors' basis values are constants, so that only weights are
//! differentiated: `A γ_i = p_i - A_i γ` and `A γ_ij = p_ij - A_i γ_j - A_j γ_i - A_ij γ`.

use super::ShapeFunctions;
use super::settings::Basis;
use crate::math::cholesky::Cholesky;
use crate::math::{Matrix, Vector};

/// Pivots of the moment matrix below this fraction of their diagonal count as singular.
///
/// The scaled diagonal is of order one; at 1e-8 half of the digits of the fit are gone.
pub const SINGULAR_PIVOT: f64 = 1e-8;

/// Neighbors of one point, as arrays: what the fit reads. A buffer, one per thread.
#[derive(Clone, Debug)]
pub struct Neighborhood<const D: usize> {
    /// Node indices.
    pub nodes: Vec<u32>,
    /// Node minus point, axis by axis.
    pub offsets: [Vec<f64>; D],
    /// Weights.
    pub weights: Vec<f64>,
    /// Gradients of the weights by the point, axis by axis.
    pub weight_gradients: [Vec<f64>; D],
    /// Second derivatives of the weights by the point; empty unless they are wanted.
    pub weight_second_derivatives: Vec<Matrix<D>>,
    /// Squared relative distances, while weights are computed.
    pub(super) relative: Vec<f64>,
    /// Inverse squared support radii, while weights are computed.
    pub(super) inverse: Vec<f64>,
    pub(super) basis: Vec<f64>,
}

impl<const D: usize> Default for Neighborhood<D> {
    fn default() -> Self {
        Self {
            nodes: vec![],
            offsets: std::array::from_fn(|_| vec![]),
            weights: vec![],
            weight_gradients: std::array::from_fn(|_| vec![]),
            weight_second_derivatives: vec![],
            relative: vec![],
            inverse: vec![],
            basis: vec![],
        }
    }
}

impl<const D: usize> Neighborhood<D> {
    /// Makes every array but the second derivatives `n` long.
    pub(super) fn resize(&mut self, n: usize) {
        self.nodes.resize(n, 0);
        self.offsets.iter_mut().for_each(|v| v.resize(n, 0.0));
        self.weights.resize(n, 0.0);
        self.weight_gradients.iter_mut().for_each(|v| v.resize(n, 0.0));
        self.relative.resize(n, 0.0);
        self.inverse.resize(n, 0.0);
        self.weight_second_derivatives.clear();
    }

    /// Node minus point.
    #[inline]
    pub fn offset(&self, k: usize) -> Vector<D> {
        Vector::<D>::from_fn(|d, _| self.offsets[d][k])
    }
}

/// Shape functions of a neighborhood; false if the moment matrix is singular.
///
/// Second derivatives are made if the neighborhood has those of the weights.
pub fn fit_into<const D: usize>(basis: Basis, near: &mut Neighborhood<D>, shape: &mut ShapeFunctions<D>) -> bool {
    match (basis, D) {
        (Basis::Linear, 2) => fit::<D, 3>(near, shape),
        (Basis::Quadratic, 2) => fit::<D, 6>(near, shape),
        (Basis::Linear, 3) => fit::<D, 4>(near, shape),
        (Basis::Quadratic, 3) => fit::<D, 10>(near, shape),
        (Basis::Linear, _) => fit::<D, 2>(near, shape),
        (Basis::Quadratic, _) => fit::<D, 3>(near, shape),
    }
}

/// Smallest pivot of the scaled moment matrix over its diagonal entry: 0 is singular, 1 is orthogonal.
pub fn quality<const D: usize>(basis: Basis, near: &mut Neighborhood<D>) -> f64 {
    let scale = scale(near);
    match (basis, D) {
        (Basis::Linear, 2) => Cholesky::least_pivot(&moment::<D, 3>(near, scale)),
        (Basis::Quadratic, 2) => Cholesky::least_pivot(&moment::<D, 6>(near, scale)),
        (Basis::Linear, 3) => Cholesky::least_pivot(&moment::<D, 4>(near, scale)),
        (Basis::Quadratic, 3) => Cholesky::least_pivot(&moment::<D, 10>(near, scale)),
        (Basis::Linear, _) => Cholesky::least_pivot(&moment::<D, 2>(near, scale)),
        (Basis::Quadratic, _) => Cholesky::least_pivot(&moment::<D, 3>(near, scale)),
    }
}

/// Basis values at a scaled offset: 1, then coordinates, then products.
#[inline]
pub(super) fn basis_at<const D: usize, const M: usize>(xi: [f64; D]) -> [f64; M] {
    let mut p = [0.0; M];
    p[0] = 1.0;
    p[1..=D].copy_from_slice(&xi);
    let mut k = 1 + D;
    for i in 0..D {
        for j in i..D {
            if k < M {
                p[k] = xi[i] * xi[j];
                k += 1;
            }
        }
    }
    p
}

/// Inverse of the weighted mean distance of the neighbors.
#[inline]
pub(super) fn scale<const D: usize>(near: &Neighborhood<D>) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for (k, w) in near.weights.iter().enumerate() {
        sum += w * near.offsets.iter().map(|o| o[k] * o[k]).sum::<f64>();
        total += w;
    }
    if sum > 0.0 { (total / sum).sqrt() } else { 1.0 }
}

/// Lower triangle of the moment matrix [EFG, Eq. 8a]; fills the basis values of the neighbors.
#[inline]
fn moment<const D: usize, const M: usize>(near: &mut Neighborhood<D>, scale: f64) -> [[f64; M]; M] {
    let mut a = [[0.0; M]; M];
    near.basis.resize(M * near.nodes.len(), 0.0);
    let (basis, _) = near.basis.as_chunks_mut::<M>();
    let offsets: [&[f64]; D] = std::array::from_fn(|d| &near.offsets[d][..basis.len()]);
    for (k, (w, p)) in near.weights.iter().zip(basis).enumerate() {
        *p = basis_at::<D, M>(std::array::from_fn(|d| offsets[d][k] * scale));
        for i in 0..M {
            let wp = w * p[i];
            for j in 0..=i {
                a[i][j] += wp * p[j];
            }
        }
    }
    a
}

fn fit<const D: usize, const M: usize>(near: &mut Neighborhood<D>, shape: &mut ShapeFunctions<D>) -> bool {
    let scale = scale(near);
    let a = moment::<D, M>(near, scale);
    let Some(factor) = Cholesky::new(&a, SINGULAR_PIVOT) else { return false };
    let n = near.nodes.len();
    let mut unit = [0.0; M];
    unit[0] = 1.0;
    let gamma = factor.solve(unit);
    let (basis, _) = near.basis.as_chunks::<M>();
    // A_i γ needs only the scalar p_I · γ of each neighbor.
    shape.reset(&near.nodes);
    let slopes: [&[f64]; D] = std::array::from_fn(|d| &near.weight_gradients[d][..n]);
    let mut products = [[0.0; M]; D];
    for (k, (p, value)) in basis.iter().zip(&mut shape.values).enumerate() {
        *value = dot(p, &gamma);
        for d in 0..D {
            let f = slopes[d][k] * *value;
            for i in 0..M {
                products[d][i] += f * p[i];
            }
        }
    }
    let gamma_by: [[f64; M]; D] = std::array::from_fn(|d| {
        let mut right = products[d].map(|v| -v);
        right[1 + d] += scale;
        factor.solve(right)
    });
    let wants_second = near.weight_second_derivatives.len() == n && n > 0;
    if wants_second {
        second_derivatives(near, shape, scale, &factor, &gamma, &gamma_by);
    }
    let targets = shape.values.iter_mut().zip(&mut shape.gradients);
    for (k, ((p, w), (value, gradient))) in basis.iter().zip(&near.weights).zip(targets).enumerate() {
        for d in 0..D {
            gradient[d] = w * dot(p, &gamma_by[d]) + slopes[d][k] * *value;
        }
        *value *= w;
    }
    true
}

#[inline]
pub(super) fn dot<const M: usize>(a: &[f64; M], b: &[f64; M]) -> f64 {
    let mut sum = 0.0;
    for i in 0..M {
        sum += a[i] * b[i];
    }
    sum
}

/// Fills the second derivatives; `shape.values` still holds `p_I · γ`.
#[cold]
fn second_derivatives<const D: usize, const M: usize>(
    near: &Neighborhood<D>,
    shape: &mut ShapeFunctions<D>,
    scale: f64,
    factor: &Cholesky<M>,
    gamma: &[f64; M],
    gamma_by: &[[f64; M]; D],
) {
    let (basis, _) = near.basis.as_chunks::<M>();
    let n = near.nodes.len();
    shape.second_derivatives.resize(n, Matrix::<D>::zeros());
    for i in 0..D {
        for j in i..D {
            let mut right = [0.0; M];
            let mut q = 1 + D;
            for a in 0..D {
                for b in a..D {
                    if q < M && (a, b) == (i, j) {
                        right[q] = scale * scale * if a == b { 2.0 } else { 1.0 };
                    }
                    q += 1;
                }
            }
            for k in 0..n {
                let f = near.weight_gradients[i][k] * dot(&basis[k], &gamma_by[j])
                    + near.weight_gradients[j][k] * dot(&basis[k], &gamma_by[i])
                    + near.weight_second_derivatives[k][(i, j)] * dot(&basis[k], gamma);
                for m in 0..M {
                    right[m] -= f * basis[k][m];
                }
            }
            let gamma_ij = factor.solve(right);
            for k in 0..n {
                let value = near.weights[k] * dot(&basis[k], &gamma_ij)
                    + near.weight_gradients[i][k] * dot(&basis[k], &gamma_by[j])
                    + near.weight_gradients[j][k] * dot(&basis[k], &gamma_by[i])
                    + near.weight_second_derivatives[k][(i, j)] * dot(&basis[k], gamma);
                shape.second_derivatives[k][(i, j)] = value;
                shape.second_derivatives[k][(j, i)] = value;
            }
        }
    }
}
