//! Eigenvalues of small symmetric matrices by Jacobi's rotations [Golub2013, section 8.5].

/// Sweeps after which rotations have long converged.
const SWEEPS: usize = 60;

/// Eigenvalues, and eigenvectors as rows, of a symmetric matrix; in no order.
pub fn symmetric_eigen(matrix: &[Vec<f64>]) -> (Vec<f64>, Vec<Vec<f64>>) {
    let n = matrix.len();
    let mut a = matrix.to_vec();
    let mut v: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| f64::from(u8::from(i == j))).collect()).collect();
    for _ in 0..SWEEPS {
        let off: f64 = (0..n).map(|i| (0..i).map(|j| a[i][j] * a[i][j]).sum::<f64>()).sum();
        let all: f64 = a.iter().flatten().map(|x| x * x).sum();
        if off <= 1e-32 * all {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                rotate(&mut a, &mut v, p, q);
            }
        }
    }
    ((0..n).map(|i| a[i][i]).collect(), v)
}

/// Makes entry (p, q) zero.
fn rotate(a: &mut [Vec<f64>], v: &mut [Vec<f64>], p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = tau.signum() / (tau.abs() + tau.hypot(1.0));
    let c = 1.0 / t.hypot(1.0);
    let s = t * c;
    for k in 0..a.len() {
        (a[k][p], a[k][q]) = (c * a[k][p] - s * a[k][q], s * a[k][p] + c * a[k][q]);
    }
    for k in 0..a.len() {
        (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
        (v[p][k], v[q][k]) = (c * v[p][k] - s * v[q][k], s * v[p][k] + c * v[q][k]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vectors_and_values_belong_together() {
        let matrix: Vec<Vec<f64>> =
            (0..6).map(|i| (0..6).map(|j| ((i * j) as f64 + (i + j) as f64 * 0.3).cos()).collect()).collect();
        let (values, vectors) = symmetric_eigen(&matrix);
        for (value, vector) in values.iter().zip(&vectors) {
            for i in 0..6 {
                let product: f64 = (0..6).map(|j| matrix[i][j] * vector[j]).sum();
                assert!((product - value * vector[i]).abs() < 1e-13);
            }
        }
        assert!((values.iter().sum::<f64>() - (0..6).map(|i| matrix[i][i]).sum::<f64>()).abs() < 1e-13);
    }
}
