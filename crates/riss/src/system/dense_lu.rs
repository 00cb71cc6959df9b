//! LU factorization of dense matrices, in one thread: the same bits wherever it runs.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{Conj, Mat, Par};

/// The factors.
pub struct DenseLu {
    factors: Mat<f64>,
    forward: Vec<usize>,
    backward: Vec<usize>,
}

impl DenseLu {
    /// Factors the square matrix with the entries `entry(row, column)`.
    pub fn new(n: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        let mut factors = Mat::from_fn(n, n, entry);
        let (mut forward, mut backward) = (vec![0; n], vec![0; n]);
        let mut memory = MemBuffer::new(factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Default::default()));
        factor::lu_in_place(
            factors.as_mut(),
            &mut forward,
            &mut backward,
            Par::Seq,
            MemStack::new(&mut memory),
            Default::default(),
        );
        Self { factors, forward, backward }
    }

    /// Replaces the right-hand side by the solution; not finite if the matrix is singular.
    pub fn solve_in_place(&self, x: &mut [f64]) {
        let n = x.len();
        let mut right = Mat::from_fn(n, 1, |i, _| x[i]);
        let mut memory = MemBuffer::new(solve::solve_in_place_scratch::<usize, f64>(n, 1, Par::Seq));
        // The permutation and its inverse were made together.
        let permutation = PermRef::new_checked(&self.forward, &self.backward, n);
        solve::solve_in_place_with_conj(
            self.factors.as_ref(),
            self.factors.as_ref(),
            permutation,
            Conj::No,
            right.as_mut(),
            Par::Seq,
            MemStack::new(&mut memory),
        );
        x.iter_mut().enumerate().for_each(|(i, v)| *v = right[(i, 0)]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_system_that_needs_pivots() {
        let n = 30;
        let entry = |i: usize, j: usize| if i == j { 0.0 } else { ((i * 7 + j * 3) as f64).sin() };
        let x: Vec<f64> = (0..n).map(|i| (i as f64).cos()).collect();
        let mut right: Vec<f64> = (0..n).map(|i| (0..n).map(|j| entry(i, j) * x[j]).sum()).collect();
        DenseLu::new(n, entry).solve_in_place(&mut right);
        assert!(right.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-11));
    }
}
