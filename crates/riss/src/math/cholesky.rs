//! Cholesky factorization of small symmetric matrices on the stack.

/// Lower Cholesky factor of an `M`×`M` matrix.
#[derive(Clone, Copy, Debug)]
pub struct Cholesky<const M: usize> {
    lower: [[f64; M]; M],
    inverse_diagonal: [f64; M],
}

impl<const M: usize> Cholesky<M> {
    /// Factors `a`, of which only the lower triangle is read.
    ///
    /// Returns `None` if a pivot falls below `tolerance` times its diagonal entry: the matrix is then
    /// indefinite, or so ill conditioned that the solution would carry no digits.
    #[inline]
    pub fn new(a: &[[f64; M]; M], tolerance: f64) -> Option<Self> {
        let mut l = *a;
        let mut inverse_diagonal = [0.0; M];
        for j in 0..M {
            let mut pivot = a[j][j];
            for k in 0..j {
                pivot -= l[j][k] * l[j][k];
            }
            // Written so that NaN fails too.
            if !(pivot > tolerance * a[j][j]) || a[j][j] <= 0.0 {
                return None;
            }
            let d = 1.0 / pivot.sqrt();
            inverse_diagonal[j] = d;
            l[j][j] = pivot * d;
            for i in j + 1..M {
                let mut s = l[i][j];
                for k in 0..j {
                    s -= l[i][k] * l[j][k];
                }
                l[i][j] = s * d;
            }
        }
        Some(Self { lower: l, inverse_diagonal })
    }

    /// Least pivot of `a` over its diagonal entry: 1 for a diagonal matrix, 0 for a singular or indefinite one.
    pub fn least_pivot(a: &[[f64; M]; M]) -> f64 {
        let Some(factor) = Self::new(a, 1e-14) else { return 0.0 };
        (0..M).map(|j| factor.lower[j][j] * factor.lower[j][j] / a[j][j]).fold(1.0, f64::min)
    }

    /// Solves `A x = b`.
    #[inline]
    pub fn solve(&self, b: [f64; M]) -> [f64; M] {
        let mut x = b;
        for i in 0..M {
            for k in 0..i {
                x[i] -= self.lower[i][k] * x[k];
            }
            x[i] *= self.inverse_diagonal[i];
        }
        for i in (0..M).rev() {
            for k in i + 1..M {
                x[i] -= self.lower[k][i] * x[k];
            }
            x[i] *= self.inverse_diagonal[i];
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_hilbert_system() {
        let a: [[f64; 4]; 4] = std::array::from_fn(|i| std::array::from_fn(|j| 1.0 / (i + j + 1) as f64));
        let x = [1.0, -2.0, 3.0, -4.0];
        let b = std::array::from_fn(|i| (0..4).map(|j| a[i][j] * x[j]).sum());
        let y = Cholesky::new(&a, 1e-14).unwrap().solve(b);
        for i in 0..4 {
            assert!((x[i] - y[i]).abs() < 1e-9);
        }
    }

    #[test]
    fn refuses_singular_indefinite_and_nan() {
        assert!(Cholesky::new(&[[1.0, 0.0], [1.0, 1.0]], 1e-12).is_none());
        assert!(Cholesky::new(&[[1.0, 0.0], [2.0, 1.0]], 1e-12).is_none());
        assert!(Cholesky::new(&[[f64::NAN]], 1e-12).is_none());
    }
}
