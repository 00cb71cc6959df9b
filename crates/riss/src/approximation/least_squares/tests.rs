//! Tests of weighted least squares.

use super::super::settings::WeightFunction;
use super::super::taylor_basis::TaylorBasis;
use super::*;
use nalgebra::DMatrix;

/// Functions besides the monomials.
fn further(x: &Vector<3>, k: usize) -> f64 {
    ((3.0 + 0.8 * k as f64) * x[k % 3] + 0.7 * x[(k + 1) % 3]).sin()
}

fn column(basis: &TaylorBasis<3>, k: usize) -> Column<3> {
    let (gradient, second_derivatives) = basis.derivatives_at_origin(k);
    Column { value: 0.0, gradient, second_derivatives }
}

/// Against a QR factorization by Householder's reflections of the whole weighted matrix.
fn check(n: usize, has_constant: bool, n_further: usize, weight: CollocationWeight) {
    let (basis, radius) = (TaylorBasis::<3>::new(3), 1.7);
    let turn = |i: usize, f: f64| (i as f64 * f).sin();
    let offsets: Vec<Vector<3>> =
        (0..n).map(|i| Vector::<3>::new(turn(i + 1, 12.9), turn(i + 1, 78.2), turn(i + 1, 37.7)) * 0.57).collect();
    let neighbors: Vec<(f64, u32)> = offsets.iter().zip(0..).map(|(x, i)| (x.norm_squared(), i)).collect();
    let monomials: Vec<Column<3>> = (0..basis.len()).map(|k| column(&basis, k)).collect();
    let others: Vec<Column<3>> =
        (0..n_further).map(|k| Column { value: 0.2, ..column(&basis, (5 * k + 1) % 9) }).collect();

    let mut fit = LeastSquares::<3>::default();
    // What an earlier, larger fit leaves behind must not matter.
    for further_columns in [8, n_further] {
        let all = basis.len() + usize::from(has_constant) + further_columns;
        fit.start(radius, weight, neighbors.iter().map(|n| n.0), all);
        if has_constant {
            fit.add_constant();
            assert_eq!(fit.orthogonalize(1, 1e-3), 1);
        }
        fit.add_monomials(basis.factors(), &monomials, offsets.iter().copied());
        assert_eq!(fit.orthogonalize(9, 1e-3) + fit.orthogonalize(10, 1e-3), 19);
    }
    fit.add_columns(&others, &neighbors, |j, values| {
        values.iter_mut().enumerate().for_each(|(k, v)| *v = further(&offsets[j as usize], k));
    });
    assert_eq!(fit.orthogonalize_twice(n_further, 1e-6), n_further);
    fit.solve(true);

    let mut roots: Vec<f64> = offsets.iter().map(|x| x.norm_squared()).collect();
    weight.to_roots(&mut roots);
    let (mut columns, mut lines) = (vec![], vec![]);
    if has_constant {
        columns.push(roots.clone());
        lines.push(Column::<3> { value: 1.0, ..Column::zero() }.lines());
    }
    for (k, monomial) in monomials.iter().enumerate() {
        let value = |x: &Vector<3>| {
            let (mut v, mut factor) = (1.0, Some(k));
            while let Some(f) = factor {
                v *= x[basis.factors()[f].1];
                factor = basis.factors()[f].0;
            }
            v
        };
        columns.push(offsets.iter().zip(&roots).map(|(x, r)| r * value(x)).collect());
        lines.push(monomial.lines());
    }
    for (k, other) in others.iter().enumerate() {
        columns.push(offsets.iter().zip(&roots).map(|(x, r)| r * further(x, k)).collect());
        lines.push(other.lines());
    }
    let matrix = DMatrix::from_fn(n, columns.len(), |i, k| columns[k][i]);
    let (q, r) = matrix.qr().unpack();
    for (d, found) in fit.lines().enumerate() {
        let scale = radius.powi([-1, -2, 0][usize::from(d >= 3) + usize::from(d >= 9)]);
        let right = DMatrix::from_fn(columns.len(), 1, |k, _| lines[k][d] * scale);
        let expected = &q * r.transpose().solve_lower_triangular(&right).unwrap();
        let size = expected.iter().zip(&roots).map(|(e, root)| (e * root).abs()).fold(0.0, f64::max);
        assert_eq!(found.len(), n);
        for i in 0..n {
            let difference = found[i] - expected[i] * roots[i];
            assert!(difference.abs() <= 1e-10 * size, "{d} {i}: {difference:e} of {size:e}");
        }
    }
}

#[test]
fn fits_are_those_of_a_dense_factorization() {
    for n in [60, 61, 79, 149] {
        for n_further in [0, 3, 8] {
            check(n, false, n_further, CollocationWeight::NonSmooth);
            check(n, true, n_further, CollocationWeight::Smooth(WeightFunction::QuarticSpline));
        }
    }
}

#[test]
fn dependent_columns_are_left_out() {
    let offsets: Vec<Vector<3>> =
        (0..40).map(|i| Vector::<3>::new((i % 7) as f64, (i / 7) as f64, 0.0) * 0.1).collect();
    let basis = TaylorBasis::<3>::new(1);
    let columns: Vec<Column<3>> = (0..3).map(|k| column(&basis, k)).collect();
    let mut fit = LeastSquares::<3>::default();
    fit.start(1.0, CollocationWeight::NonSmooth, offsets.iter().map(|x| x.norm_squared()), 3);
    fit.add_monomials(basis.factors(), &columns, offsets.iter().copied());
    assert_eq!(fit.orthogonalize(3, 1e-3), 2);
    fit.solve(false);
    // The gradient of x + 2 y, and nothing across the plane.
    for (line, expected) in fit.lines().zip([1.0, 2.0, 0.0]) {
        let slope: f64 = line.iter().zip(&offsets).map(|(v, x)| v * (x[0] + 2.0 * x[1])).sum();
        assert!((slope - expected).abs() < 1e-12, "{slope} {expected}");
    }
}
