//! Monomials of a Taylor polynomial without its constant [C3D, Eq. 2].

use crate::math::{Matrix, Vector};

/// Monomials of the degrees 1 to `order` in `D` variables.
///
/// The first `D` are the coordinates, the next `D (D + 1) / 2` their products `x_i x_j` with `i ≤ j`, rows first.
#[derive(Clone, Debug)]
pub struct TaylorBasis<const D: usize> {
    order: usize,
    /// Each monomial as an earlier one (none for degree 1) times a coordinate.
    factors: Vec<(Option<usize>, usize)>,
}

/// Number of first and second derivatives in `D` dimensions.
pub const fn n_derivatives<const D: usize>() -> usize {
    D + D * (D + 1) / 2
}

impl<const D: usize> TaylorBasis<D> {
    /// The monomials up to a degree.
    pub fn new(order: usize) -> Self {
        let mut factors: Vec<(Option<usize>, usize)> = (0..D).map(|axis| (None, axis)).collect();
        let mut degree = 0..D;
        for _ in 1..order {
            let next = factors.len();
            for parent in degree.clone() {
                // Coordinates in falling order, so that each product comes once.
                let last = factors[parent].1;
                factors.extend((last..D).map(|axis| (Some(parent), axis)));
            }
            degree = next..factors.len();
        }
        Self { order, factors }
    }

    /// Highest degree (m).
    pub fn order(&self) -> usize {
        self.order
    }

    /// Number of monomials (L).
    pub fn len(&self) -> usize {
        self.factors.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.factors.is_empty()
    }

    /// Each monomial as an earlier one (none for degree 1) times a coordinate.
    pub fn factors(&self) -> &[(Option<usize>, usize)] {
        &self.factors
    }

    /// Derivatives of monomial `k` at the origin: gradient and second derivatives.
    pub fn derivatives_at_origin(&self, k: usize) -> (Vector<D>, Matrix<D>) {
        let (mut gradient, mut second) = (Vector::zeros(), Matrix::zeros());
        let (parent, axis) = self.factors[k];
        match parent {
            None => gradient[axis] = 1.0,
            Some(p) if p < D => {
                second[(p, axis)] += 1.0;
                second[(axis, p)] += 1.0;
            }
            Some(_) => {}
        }
        (gradient, second)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_size<const D: usize>(order: usize, expected: usize) {
        assert_eq!(TaylorBasis::<D>::new(order).len(), expected);
    }

    /// L = (n + m)! / (n! m!) - 1 [C3D, after Eq. 2].
    #[test]
    fn sizes_are_binomial() {
        for (order, expected) in [(1, 2), (2, 5), (3, 9), (4, 14)] {
            check_size::<2>(order, expected);
        }
        for (order, expected) in [(1, 3), (2, 9), (3, 19), (4, 34)] {
            check_size::<3>(order, expected);
        }
    }

    #[test]
    fn monomials_are_distinct_and_complete() {
        let basis = TaylorBasis::<3>::new(3);
        let x = Vector::<3>::new(2.0, 3.0, 5.0);
        let mut values: Vec<f64> = vec![];
        for &(parent, axis) in basis.factors() {
            values.push(parent.map_or(1.0, |p| values[p]) * x[axis]);
        }
        let mut expected = vec![];
        for (i, j, k) in (0..64).map(|n| (n / 16, n / 4 % 4, n % 4)).filter(|t| (1..=3).contains(&(t.0 + t.1 + t.2))) {
            expected.push(2f64.powi(i) * 3f64.powi(j) * 5f64.powi(k));
        }
        values.sort_by(f64::total_cmp);
        expected.sort_by(f64::total_cmp);
        assert_eq!(values, expected);
    }
}
