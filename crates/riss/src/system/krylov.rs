//! Krylov methods for systems that are not symmetric, preconditioned from the right.
//!
//! Sums are taken over fixed pieces, so that any number of threads gives the same bits.

use crate::math::Vector;
use rayon::prelude::*;

/// A linear map, `apply(x, y)` sets `y`.
pub trait LinearMap: Sync {
    /// `y = A x`.
    fn apply(&self, x: &[f64], y: &mut [f64]);
}

impl<F: Fn(&[f64], &mut [f64]) + Sync> LinearMap for F {
    fn apply(&self, x: &[f64], y: &mut [f64]) {
        self(x, y);
    }
}

/// What an iteration came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Multiplications by the matrix.
    pub iterations: usize,
    /// Relative residual by recurrence.
    pub residual: f64,
}

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Relative residual.
    pub target: f64,
    /// Multiplications by the matrix.
    pub iterations: usize,
}

const PIECE: usize = 8192;

/// One number for each of `W` vectors that are treated at once. Their entries stand side by side: entry `i` of vector `l` at
/// `i W + l`.
pub type Lanes<const W: usize> = Vector<W>;

/// `a · b`.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    dots::<1>(a, b)[0]
}

/// `a · b` of each vector.
fn dots<const W: usize>(a: &[f64], b: &[f64]) -> Lanes<W> {
    let piece = |(a, b): (&[f64], &[f64])| {
        let mut sums = [Lanes::<W>::zeros(); 8];
        let (x, y) = (a.chunks_exact(8 * W), b.chunks_exact(8 * W));
        let (mut rest, ends) = (Lanes::<W>::zeros(), (x.remainder(), y.remainder()));
        for (x, y) in ends.0.chunks_exact(W).zip(ends.1.chunks_exact(W)) {
            (0..W).for_each(|l| rest[l] += x[l] * y[l]);
        }
        for (x, y) in x.zip(y) {
            for k in 0..8 {
                (0..W).for_each(|l| sums[k][l] += x[k * W + l] * y[k * W + l]);
            }
        }
        sums.iter().fold(Lanes::zeros(), |sum, s| sum + s) + rest
    };
    let pieces: Vec<Lanes<W>> = a.par_chunks(PIECE * W).zip(b.par_chunks(PIECE * W)).map(piece).collect();
    pieces.iter().fold(Lanes::zeros(), |sum, s| sum + s)
}

/// Length of a vector.
pub fn norm(a: &[f64]) -> f64 {
    norms::<1>(a)[0]
}

/// Length of each vector.
pub fn norms<const W: usize>(a: &[f64]) -> Lanes<W> {
    dots::<W>(a, a).map(f64::sqrt)
}

/// `y += factor x`.
pub fn add(y: &mut [f64], factor: f64, x: &[f64]) {
    adds::<1>(y, Lanes::repeat(factor), x);
}

/// `y += factor x` for each vector.
fn adds<const W: usize>(y: &mut [f64], factor: Lanes<W>, x: &[f64]) {
    y.par_chunks_mut(PIECE * W).zip(x.par_chunks(PIECE * W)).for_each(|(y, x)| {
        for (y, x) in y.chunks_exact_mut(W).zip(x.chunks_exact(W)) {
            (0..W).for_each(|l| y[l] += factor[l] * x[l]);
        }
    });
}

/// `r = b - A x`.
pub fn residual(matrix: &dyn LinearMap, right: &[f64], x: &[f64], r: &mut [f64]) {
    matrix.apply(x, r);
    r.par_iter_mut().zip(right).for_each(|(r, b)| *r = b - *r);
}

/// `a / b`, zero where `b` is: a vector that is solved stays as it is while others go on.
fn quotient<const W: usize>(a: Lanes<W>, b: Lanes<W>) -> Lanes<W> {
    a.zip_map(&b, |a, b| if b == 0.0 { 0.0 } else { a / b })
}

/// Number of shadow vectors of [`idr`].
const SHADOWS: usize = 4;

/// IDR(4) with biorthogonal vectors [VanGijzen2011, Fig. 2], from the `x` given, for `W` systems with one matrix at once.
///
/// The residual told is that of the worst of them.
pub fn idr<const W: usize>(
    matrix: &dyn LinearMap,
    preconditioner: &dyn LinearMap,
    right: &[f64],
    x: &mut [f64],
    limits: Limits,
) -> Progress {
    const S: usize = SHADOWS;
    let (n, size) = (right.len(), norms::<W>(right).map(|s| s.max(f64::MIN_POSITIVE)));
    let shadow = shadow_space::<W>(n / W);
    let (mut g, mut u) = (vec![vec![0.0; n]; S], vec![vec![0.0; n]; S]);
    let mut m = [[Lanes::<W>::zeros(); S]; S];
    (0..S).for_each(|i| m[i][i] = Lanes::repeat(1.0));
    let (mut r, mut v, mut t) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    residual(matrix, right, x, &mut r);
    // NaN in any of them must show.
    let worst = |r: &[f64]| {
        let all = norms::<W>(r).component_div(&size);
        all.iter().fold(0.0, |worst: f64, own| if *own <= worst { worst } else { *own })
    };
    let mut progress = Progress { iterations: 0, residual: worst(&r) };
    let is_over =
        |p: &Progress| p.residual < limits.target || p.iterations >= limits.iterations || !p.residual.is_finite();
    let mut omega = Lanes::<W>::repeat(1.0);
    while !is_over(&progress) {
        let mut f: [Lanes<W>; S] = std::array::from_fn(|i| dots(&shadow[i], &r));
        for k in 0..S {
            let mut c = [Lanes::<W>::zeros(); S];
            v.copy_from_slice(&r);
            for i in k..S {
                let known = (k..i).fold(Lanes::zeros(), |sum, j| sum + m[i][j].component_mul(&c[j]));
                c[i] = quotient(f[i] - known, m[i][i]);
                adds(&mut v, -c[i], &g[i]);
            }
            preconditioner.apply(&v, &mut t);
            t.par_chunks_exact_mut(W).for_each(|t| (0..W).for_each(|l| t[l] *= omega[l]));
            for i in k..S {
                adds(&mut t, c[i], &u[i]);
            }
            matrix.apply(&t, &mut v);
            for i in 0..k {
                let alpha = quotient(dots(&shadow[i], &v), m[i][i]);
                adds(&mut v, -alpha, &g[i]);
                adds(&mut t, -alpha, &u[i]);
            }
            for i in k..S {
                m[i][k] = dots(&shadow[i], &v);
            }
            let beta = quotient(f[k], m[k][k]);
            std::mem::swap(&mut u[k], &mut t);
            std::mem::swap(&mut g[k], &mut v);
            adds(&mut r, -beta, &g[k]);
            adds(x, beta, &u[k]);
            progress = Progress { iterations: progress.iterations + 1, residual: worst(&r) };
            if is_over(&progress) {
                return progress;
            }
            (k + 1..S).for_each(|i| f[i] -= beta.component_mul(&m[i][k]));
        }
        preconditioner.apply(&r, &mut v);
        matrix.apply(&v, &mut t);
        omega = minimal_step(&t, &r);
        adds(x, omega, &v);
        adds(&mut r, -omega, &t);
        progress = Progress { iterations: progress.iterations + 1, residual: worst(&r) };
    }
    progress
}

/// Steps that make `r - ω t` least, lengthened where `t` is nearly orthogonal to `r` [VanGijzen2011, section 4.2].
fn minimal_step<const W: usize>(t: &[f64], r: &[f64]) -> Lanes<W> {
    const LEAST_COSINE: f64 = 0.7;
    let (tt, tr) = (norms::<W>(t), dots::<W>(t, r));
    let cosine = quotient(tr, tt.component_mul(&norms(r))).abs();
    let longer = quotient(Lanes::repeat(LEAST_COSINE), cosine).map(|f| f.max(1.0));
    quotient(tr, tt.component_mul(&tt)).component_mul(&longer)
}

/// Orthonormal vectors from a fixed random sequence, the same in all lanes.
fn shadow_space<const W: usize>(n: usize) -> Vec<Vec<f64>> {
    let mut state = 0x2545_F491_4F6C_DD1Du64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let mut space: Vec<Vec<f64>> = vec![];
    for _ in 0..SHADOWS {
        let mut p: Vec<f64> = (0..n).map(|_| random()).collect();
        for q in &space {
            let along = dot(q, &p);
            add(&mut p, -along, q);
        }
        let length = norm(&p);
        p.iter_mut().for_each(|v| *v /= length);
        space.push(p);
    }
    space.into_iter().map(|p| p.into_iter().flat_map(|v| [v; W]).collect()).collect()
}

/// Restarted GMRES [SaadSchultz1986] from the `x` given.
pub fn gmres(
    matrix: &dyn LinearMap,
    preconditioner: &dyn LinearMap,
    right: &[f64],
    x: &mut [f64],
    restart: usize,
    limits: Limits,
) -> Progress {
    let (n, size) = (right.len(), norm(right).max(f64::MIN_POSITIVE));
    let (mut r, mut z) = (vec![0.0; n], vec![0.0; n]);
    let mut progress = Progress { iterations: 0, residual: f64::INFINITY };
    loop {
        residual(matrix, right, x, &mut r);
        let length = norm(&r);
        progress.residual = length / size;
        if progress.residual < limits.target || progress.iterations >= limits.iterations || !length.is_finite() {
            return progress;
        }
        r.iter_mut().for_each(|v| *v /= length);
        let mut basis = vec![std::mem::replace(&mut r, vec![0.0; n])];
        let mut hessenberg = Rotated::new(length);
        while basis.len() <= restart && progress.iterations < limits.iterations {
            preconditioner.apply(&basis[basis.len() - 1], &mut z);
            let mut w = vec![0.0; n];
            matrix.apply(&z, &mut w);
            progress.iterations += 1;
            let mut column = vec![];
            for v in &basis {
                let along = dot(v, &w);
                add(&mut w, -along, v);
                column.push(along);
            }
            let rest = norm(&w);
            let estimate = hessenberg.push(column, rest);
            if estimate < 0.5 * limits.target * size || rest == 0.0 {
                break;
            }
            w.iter_mut().for_each(|v| *v /= rest);
            basis.push(w);
        }
        for (v, y) in basis.iter().zip(hessenberg.solve()) {
            add(&mut r, y, v);
        }
        preconditioner.apply(&r, &mut z);
        add(x, 1.0, &z);
    }
}

/// A Hessenberg matrix made triangular by rotations as it grows.
struct Rotated {
    columns: Vec<Vec<f64>>,
    rotations: Vec<[f64; 2]>,
    right: Vec<f64>,
}

impl Rotated {
    fn new(length: f64) -> Self {
        Self { columns: vec![], rotations: vec![], right: vec![length] }
    }

    /// Adds a column and what is below it; returns the length of the residual.
    fn push(&mut self, mut column: Vec<f64>, below: f64) -> f64 {
        let k = self.columns.len();
        column.push(below);
        for (j, [c, s]) in self.rotations.iter().enumerate() {
            (column[j], column[j + 1]) = (c * column[j] + s * column[j + 1], c * column[j + 1] - s * column[j]);
        }
        let length = column[k].hypot(column[k + 1]);
        let [c, s] = [column[k] / length, column[k + 1] / length];
        column[k] = length;
        let last = self.right[k];
        self.right[k] = c * last;
        self.right.push(-s * last);
        self.rotations.push([c, s]);
        self.columns.push(column);
        self.right[k + 1].abs()
    }

    fn solve(&self) -> Vec<f64> {
        let n = self.columns.len();
        let mut y = vec![0.0; n];
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|j| self.columns[j][i] * y[j]).sum();
            y[i] = (self.right[i] - known) / self.columns[i][i];
        }
        y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Convection and diffusion in one dimension, not symmetric.
    fn matrix(x: &[f64], y: &mut [f64]) {
        for i in 0..x.len() {
            let before = if i > 0 { x[i - 1] } else { 0.0 };
            let after = if i + 1 < x.len() { x[i + 1] } else { 0.0 };
            y[i] = 2.5 * x[i] - 1.4 * before - 0.6 * after;
        }
    }

    fn jacobi(x: &[f64], y: &mut [f64]) {
        y.iter_mut().zip(x).for_each(|(y, x)| *y = x / 2.5);
    }

    fn check(solve: impl Fn(&[f64], &mut [f64]) -> Progress) {
        let exact: Vec<f64> = (0..300).map(|i| (i as f64 * 0.37).sin()).collect();
        let (mut right, mut x) = (vec![0.0; 300], vec![0.0; 300]);
        matrix(&exact, &mut right);
        let progress = solve(&right, &mut x);
        assert!(progress.residual < 1e-10, "{progress:?}");
        let error = x.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e-8, "{error} {progress:?}");
    }

    #[test]
    fn methods_solve_a_system_that_is_not_symmetric() {
        let limits = Limits { target: 1e-10, iterations: 1000 };
        check(|b, x| idr::<1>(&matrix, &jacobi, b, x, limits));
        check(|b, x| gmres(&matrix, &jacobi, b, x, 40, limits));
    }

    /// Systems that are solved at once come out as they do one by one, one of them with nothing to solve.
    #[test]
    fn several_systems_are_solved_at_once() {
        const W: usize = 3;
        let n = 300;
        let lanes = |map: fn(&[f64], &mut [f64])| {
            move |x: &[f64], y: &mut [f64]| {
                for l in 0..W {
                    let own: Vec<f64> = (0..x.len() / W).map(|i| x[i * W + l]).collect();
                    let mut image = vec![0.0; own.len()];
                    map(&own, &mut image);
                    image.iter().enumerate().for_each(|(i, v)| y[i * W + l] = *v);
                }
            }
        };
        let exact: Vec<f64> = (0..n * W).map(|i| if i % W == 1 { 0.0 } else { (i as f64 * 0.37).sin() }).collect();
        let (mut right, mut x) = (vec![0.0; n * W], vec![0.0; n * W]);
        lanes(matrix)(&exact, &mut right);
        let limits = Limits { target: 1e-10, iterations: 1000 };
        let progress = idr::<W>(&lanes(matrix), &lanes(jacobi), &right, &mut x, limits);
        assert!(progress.residual < 1e-10, "{progress:?}");
        let error = x.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e-8, "{error} {progress:?}");
    }
}
