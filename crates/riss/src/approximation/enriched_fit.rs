//! Moving least squares whose basis holds the field of a crack tip [EFG, section 5.3].
//!
//! The basis of [`mls`](super::mls), shifted to the evaluation point, and tip functions less their value there. Away from
//! the tip these are nearly polynomials; where the moment matrix tells them apart no longer, the basis is made orthogonal
//! for the weights at the point first [EFG, section 5.3.1]. Scale, shift and orthogonalization are frozen: only weights
//! and the values at the point itself are differentiated.

use super::ShapeFunctions;
use super::enrichment::TipPoint;
use super::mls::{Neighborhood, SINGULAR_PIVOT, basis_at, dot, scale};
use super::settings::Basis;
use super::tip_functions::TipFunctions;
use crate::math::Matrix;
use crate::math::cholesky::Cholesky;

/// Least part of a tip function, squared, that is no combination of the functions before it.
///
/// At a hundred support radii from the tip it is about 1e-10, and rounding makes 1e-26 of what is nothing.
const SINGULAR_PART: f64 = 1e-18;

/// Shape functions of a neighborhood; false if the basis is not independent there.
pub(super) fn fit_enriched_into(
    basis: Basis,
    functions: TipFunctions,
    near: &mut Neighborhood<2>,
    tip: &TipPoint,
    shape: &mut ShapeFunctions<2>,
) -> bool {
    match (basis, functions) {
        (Basis::Linear, TipFunctions::Full) => fit::<3, 7>(near, tip, shape),
        (Basis::Linear, TipFunctions::Radial) => fit::<3, 4>(near, tip, shape),
        (Basis::Quadratic, TipFunctions::Full) => fit::<6, 10>(near, tip, shape),
        (Basis::Quadratic, TipFunctions::Radial) => fit::<6, 7>(near, tip, shape),
    }
}

/// The basis at the point: its values and its derivatives there.
struct AtPoint<const M: usize> {
    value: [f64; M],
    first: [[f64; M]; 2],
    second: [[f64; M]; 3],
}

/// Pairs of axes of the second derivatives.
const PAIRS: [(usize, usize); 3] = [(0, 0), (0, 1), (1, 1)];

fn fit<const P: usize, const M: usize>(
    near: &mut Neighborhood<2>,
    tip: &TipPoint,
    shape: &mut ShapeFunctions<2>,
) -> bool {
    let scale = scale(near);
    let mut at = at_point::<P, M>(tip, scale);
    let moment = moment::<P, M>(near, tip, scale);
    match Cholesky::new(&moment, SINGULAR_PIVOT) {
        Some(factor) => finish(near, shape, &at, |right| factor.solve(right)),
        None => {
            let sizes = std::array::from_fn(|k| moment[k][k]);
            if !orthogonalize::<P, M>(near, &mut at, &sizes) {
                return false;
            }
            // The moment matrix is now the identity.
            finish(near, shape, &at, |right| right);
        }
    }
    true
}

fn at_point<const P: usize, const M: usize>(tip: &TipPoint, scale: f64) -> AtPoint<M> {
    let mut at = AtPoint { value: [0.0; M], first: [[0.0; M]; 2], second: [[0.0; M]; 3] };
    at.value[0] = 1.0;
    for (d, first) in at.first.iter_mut().enumerate() {
        first[1 + d] = scale;
        (P..M).for_each(|j| first[j] = tip.gradients[j - P][d]);
    }
    for (q, ((a, b), second)) in PAIRS.into_iter().zip(&mut at.second).enumerate() {
        if P > 3 {
            second[3 + q] = scale * scale * if a == b { 2.0 } else { 1.0 };
        }
        (P..M).for_each(|j| second[j] = tip.second_derivatives[j - P][(a, b)]);
    }
    at
}

/// Lower triangle of the moment matrix; fills the basis values of the neighbors.
fn moment<const P: usize, const M: usize>(near: &mut Neighborhood<2>, tip: &TipPoint, scale: f64) -> [[f64; M]; M] {
    let mut a = [[0.0; M]; M];
    near.basis.resize(M * near.nodes.len(), 0.0);
    let (basis, _) = near.basis.as_chunks_mut::<M>();
    for (k, (p, w)) in basis.iter_mut().zip(&near.weights).enumerate() {
        let polynomials = basis_at::<2, P>([near.offsets[0][k] * scale, near.offsets[1][k] * scale]);
        p[..P].copy_from_slice(&polynomials);
        p[P..].copy_from_slice(&tip.differences[k][..M - P]);
        for i in 0..M {
            let wp = w * p[i];
            for j in 0..=i {
                a[i][j] += wp * p[j];
            }
        }
    }
    a
}

/// Shape functions from the basis; `solve` inverts the moment matrix.
fn finish<const M: usize>(
    near: &Neighborhood<2>,
    shape: &mut ShapeFunctions<2>,
    at: &AtPoint<M>,
    solve: impl Fn([f64; M]) -> [f64; M],
) {
    let n = near.nodes.len();
    shape.reset(&near.nodes);
    let (basis, _) = near.basis.as_chunks::<M>();
    let slopes: [&[f64]; 2] = std::array::from_fn(|d| &near.weight_gradients[d][..n]);
    let gamma = solve(at.value);
    let mut by = at.first;
    for (k, (p, value)) in basis.iter().zip(&mut shape.values).enumerate() {
        *value = dot(p, &gamma);
        for (d, by) in by.iter_mut().enumerate() {
            let f = slopes[d][k] * *value;
            (0..M).for_each(|i| by[i] -= f * p[i]);
        }
    }
    let by = by.map(&solve);
    if near.weight_second_derivatives.len() == n && n > 0 {
        second_derivatives(near, shape, at, &by, &gamma, &solve);
    }
    let targets = shape.values.iter_mut().zip(&mut shape.gradients);
    for (k, ((p, w), (value, gradient))) in basis.iter().zip(&near.weights).zip(targets).enumerate() {
        for d in 0..2 {
            gradient[d] = w * dot(p, &by[d]) + slopes[d][k] * *value;
        }
        *value *= w;
    }
}

/// Makes the basis orthonormal for the weights (modified Gram-Schmidt [Bjorck1967]), at the neighbors and at the point.
///
/// - `sizes`: squared norms of the functions
fn orthogonalize<const P: usize, const M: usize>(
    near: &mut Neighborhood<2>,
    at: &mut AtPoint<M>,
    sizes: &[f64; M],
) -> bool {
    let (basis, _) = near.basis.as_chunks_mut::<M>();
    for k in 0..M {
        let mut products = [0.0; M];
        for (p, w) in basis.iter().zip(&near.weights) {
            let wp = w * p[k];
            (0..M).for_each(|j| products[j] += wp * p[j]);
        }
        let least = if k < P { SINGULAR_PIVOT } else { SINGULAR_PART };
        // Written so that NaN fails too.
        if !(products[k] > least * sizes[k]) {
            return false;
        }
        let inverse = products[k].sqrt().recip();
        let shares: [f64; M] = std::array::from_fn(|j| if j > k { products[j] * inverse } else { 0.0 });
        let reduce = |p: &mut [f64; M]| {
            p[k] *= inverse;
            let own = p[k];
            (0..M).for_each(|j| p[j] -= own * shares[j]);
        };
        basis.iter_mut().for_each(reduce);
        reduce(&mut at.value);
        at.first.iter_mut().for_each(reduce);
        at.second.iter_mut().for_each(reduce);
    }
    true
}

/// Fills the second derivatives; `shape.values` still holds `p_I · γ`.
#[cold]
fn second_derivatives<const M: usize>(
    near: &Neighborhood<2>,
    shape: &mut ShapeFunctions<2>,
    at: &AtPoint<M>,
    by: &[[f64; M]; 2],
    gamma: &[f64; M],
    solve: &impl Fn([f64; M]) -> [f64; M],
) {
    let (basis, _) = near.basis.as_chunks::<M>();
    shape.second_derivatives.resize(near.nodes.len(), Matrix::<2>::zeros());
    for (q, (i, j)) in PAIRS.into_iter().enumerate() {
        let by_weights = |k: usize, p: &[f64; M]| {
            near.weight_gradients[i][k] * dot(p, &by[j])
                + near.weight_gradients[j][k] * dot(p, &by[i])
                + near.weight_second_derivatives[k][(i, j)] * dot(p, gamma)
        };
        let mut right = at.second[q];
        for (k, p) in basis.iter().enumerate() {
            let f = by_weights(k, p);
            (0..M).for_each(|m| right[m] -= f * p[m]);
        }
        let gamma_ij = solve(right);
        for (k, p) in basis.iter().enumerate() {
            let value = near.weights[k] * dot(p, &gamma_ij) + by_weights(k, p);
            shape.second_derivatives[k][(i, j)] = value;
            shape.second_derivatives[k][(j, i)] = value;
        }
    }
}
