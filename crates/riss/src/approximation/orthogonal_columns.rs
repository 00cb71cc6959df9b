//! Columns of a fit in vector registers: lengths, shares and sums of many columns at once.
//!
//! A group of rows holds [`GROUP`] values of the first column, of the second, up to `pitch`; then come the next rows. Columns
//! are read up to [`NARROW`] - 1 beyond the last one.

use crate::math::lanes::{GROUP, Lanes, Simd};

/// Columns that stand in registers at once, and the least number of them.
const WIDE: usize = 12;
pub(super) const NARROW: usize = 4;
/// Room for the derivatives of a column: gradient, second derivatives and value, at most 10 of them.
pub(super) const LINES: usize = 2 * GROUP;

/// Number of vectors in a group.
pub(super) const fn parts<S: Simd>() -> usize {
    GROUP / S::F64_LANES
}

/// Squared length of column `k`.
#[inline(always)]
pub(super) fn squared_length<S: Simd>(simd: S, values: &[S::f64s], pitch: usize, k: usize) -> f64 {
    let parts = parts::<S>();
    // Several sums, for an addition takes longer than the next one needs to start.
    let mut sums = [Lanes::splat(simd, 0.0); NARROW];
    for (g, row) in values.chunks_exact(parts * pitch).enumerate() {
        for (u, v) in row[k * parts..][..parts].iter().enumerate() {
            let (v, s) = (Lanes::new(simd, *v), (g * parts + u) % NARROW);
            sums[s] = v.mul_add(v, sums[s]);
        }
    }
    ((sums[0] + sums[1]) + (sums[2] + sums[3])).sum()
}

/// Takes column `k` out of the columns from `first` to `end`; keeps its shares.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "parts of a fit that are borrowed apart")]
pub(super) fn subtract<S: Simd>(
    simd: S,
    values: &mut [S::f64s],
    pitch: usize,
    k: usize,
    size: f64,
    shares: &mut [f64],
    mut first: usize,
    end: usize,
) {
    let inverse = 1.0 / size;
    while first + 8 < end {
        subtract_some::<S, WIDE>(simd, values, pitch, k, inverse, shares, first);
        first += WIDE;
    }
    while first < end {
        subtract_some::<S, NARROW>(simd, values, pitch, k, inverse, shares, first);
        first += NARROW;
    }
}

/// The same for `W` columns.
#[inline(always)]
fn subtract_some<S: Simd, const W: usize>(
    simd: S,
    values: &mut [S::f64s],
    pitch: usize,
    k: usize,
    inverse: f64,
    shares: &mut [f64],
    first: usize,
) {
    let parts = parts::<S>();
    let mut sums = [Lanes::splat(simd, 0.0); W];
    for row in values.chunks_exact(parts * pitch) {
        let (own, others) = (&row[k * parts..][..parts], &row[first * parts..][..W * parts]);
        for u in 0..parts {
            let own = Lanes::new(simd, own[u]);
            for w in 0..W {
                sums[w] = own.mul_add(Lanes::new(simd, others[w * parts + u]), sums[w]);
            }
        }
    }
    let mut factors = [Lanes::splat(simd, 0.0); W];
    for w in 0..W {
        let share = sums[w].sum() * inverse;
        shares[first + w] = share;
        factors[w] = Lanes::splat(simd, -share);
    }
    for row in values.chunks_exact_mut(parts * pitch) {
        let (before, others) = row.split_at_mut(first * parts);
        let (own, others) = (&before[k * parts..][..parts], &mut others[..W * parts]);
        for u in 0..parts {
            let own = Lanes::new(simd, own[u]);
            for w in 0..W {
                let v = Lanes::new(simd, others[w * parts + u]);
                others[w * parts + u] = own.mul_add(factors[w], v).get();
            }
        }
    }
}

/// Takes the [`NARROW`] columns from `first`, as far as they are before column `k`, out of it once more.
#[inline(always)]
pub(super) fn clean<S: Simd>(
    simd: S,
    values: &mut [S::f64s],
    pitch: usize,
    k: usize,
    first: usize,
    sizes: &[f64],
    upper: &mut [f64],
) {
    let parts = parts::<S>();
    let mut sums = [Lanes::splat(simd, 0.0); NARROW];
    for row in values.chunks_exact(parts * pitch) {
        let (own, others) = (&row[k * parts..][..parts], &row[first * parts..][..NARROW * parts]);
        for u in 0..parts {
            for w in 0..NARROW {
                sums[w] = Lanes::new(simd, own[u]).mul_add(Lanes::new(simd, others[w * parts + u]), sums[w]);
            }
        }
    }
    let n = NARROW.min(k - first);
    let mut factors = [Lanes::splat(simd, 0.0); NARROW];
    for w in 0..n {
        if sizes[first + w] > 0.0 {
            let share = sums[w].sum() / sizes[first + w];
            upper[(first + w) * pitch + k] += share;
            factors[w] = Lanes::splat(simd, -share);
        }
    }
    for row in values.chunks_exact_mut(parts * pitch) {
        for u in 0..parts {
            let mut own = Lanes::new(simd, row[k * parts + u]);
            for w in 0..n {
                own = Lanes::new(simd, row[(first + w) * parts + u]).mul_add(factors[w], own);
            }
            row[k * parts + u] = own.get();
        }
    }
}

/// `L` lines at once.
#[inline(always)]
pub(super) fn write_some<S: Simd, const L: usize>(
    simd: S,
    coefficients: &[[f64; LINES]],
    values: &[S::f64s],
    pitch: usize,
    roots: &[S::f64s],
    lines: &mut [S::f64s],
    first: usize,
) {
    let parts = parts::<S>();
    let n_vectors = roots.len();
    let rows = values.chunks_exact(2 * parts * pitch);
    let last = rows.remainder();
    // Two groups of rows at once, and the last one twice if their number is odd.
    for (g, row) in rows.enumerate() {
        let (one, two) = row.split_at(parts * pitch);
        for u in 0..parts {
            let sums = combine::<S, L>(simd, coefficients, [one, two], u, first);
            for l in 0..L {
                for (h, sum) in sums[l].iter().enumerate() {
                    let at = (2 * g + h) * parts + u;
                    lines[(first + l) * n_vectors + at] = (*sum * Lanes::new(simd, roots[at])).get();
                }
            }
        }
    }
    if !last.is_empty() {
        for u in 0..parts {
            let sums = combine::<S, L>(simd, coefficients, [last, last], u, first);
            for l in 0..L {
                let at = n_vectors - parts + u;
                lines[(first + l) * n_vectors + at] = (sums[l][0] * Lanes::new(simd, roots[at])).get();
            }
        }
    }
}

/// Sums of the columns in two groups of rows times coefficients.
#[inline(always)]
fn combine<S: Simd, const L: usize>(
    simd: S,
    coefficients: &[[f64; LINES]],
    rows: [&[S::f64s]; 2],
    u: usize,
    first: usize,
) -> [[Lanes<S>; 2]; L] {
    let parts = parts::<S>();
    let mut sums = [[Lanes::splat(simd, 0.0); 2]; L];
    let columns = rows[0].chunks_exact(parts).zip(rows[1].chunks_exact(parts));
    for (c, (one, two)) in coefficients.iter().zip(columns) {
        let (one, two) = (Lanes::new(simd, one[u]), Lanes::new(simd, two[u]));
        for l in 0..L {
            let factor = Lanes::splat(simd, c[first + l]);
            sums[l][0] = one.mul_add(factor, sums[l][0]);
            sums[l][1] = two.mul_add(factor, sums[l][1]);
        }
    }
    sums
}
