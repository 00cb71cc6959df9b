//! Columns of a least-squares fit in vector registers.
//!
//! A column that is done is taken out of all later ones at once, many in registers, and none is normalized: the order of
//! modified Gram-Schmidt with the columns outside.

use super::least_squares::LINES;
use crate::math::lanes::{GROUP, Lanes, Simd};
use std::ops::Range;

/// Columns that stand in registers at once.
const WIDE: usize = 12;
/// The least number of them: columns are read up to this far beyond the last one.
pub(super) const NARROW: usize = 4;

/// Number of vectors in a group.
pub(super) const fn parts<S: Simd>() -> usize {
    GROUP / S::F64_LANES
}

/// [`GROUP`] rows of the first column, of the second, up to `pitch`; then the next rows.
pub(super) struct Columns<'a, S: Simd> {
    simd: S,
    values: &'a mut [S::f64s],
    pitch: usize,
}

impl<'a, S: Simd> Columns<'a, S> {
    #[inline(always)]
    pub fn new(simd: S, values: &'a mut [f64], pitch: usize) -> Self {
        Self { simd, values: S::as_mut_simd_f64s(values).0, pitch }
    }

    /// Squared length of column `k`.
    #[inline(always)]
    pub fn squared_length(&self, k: usize) -> f64 {
        let parts = parts::<S>();
        let mut sums = [Lanes::splat(self.simd, 0.0); GROUP];
        for row in self.values.chunks_exact(parts * self.pitch) {
            let own = &row[k * parts..][..parts];
            for u in 0..parts {
                let v = Lanes::new(self.simd, own[u]);
                sums[u] = v.mul_add(v, sums[u]);
            }
        }
        for u in 1..parts {
            sums[0] += sums[u];
        }
        sums[0].sum()
    }

    /// Takes column `k`, of squared length `size`, out of later ones, and keeps its shares in them.
    #[inline(always)]
    pub fn subtract(&mut self, k: usize, size: f64, shares: &mut [f64], mut others: Range<usize>) {
        let inverse = 1.0 / size;
        while others.len() > 2 * NARROW {
            self.subtract_some::<WIDE>(k, inverse, shares, others.start);
            others.start += WIDE;
        }
        while !others.is_empty() {
            self.subtract_some::<NARROW>(k, inverse, shares, others.start);
            others.start += NARROW;
        }
    }

    /// The same for `W` columns.
    #[inline(always)]
    fn subtract_some<const W: usize>(&mut self, k: usize, inverse: f64, shares: &mut [f64], first: usize) {
        let (simd, parts) = (self.simd, parts::<S>());
        let mut sums = [Lanes::splat(simd, 0.0); W];
        for row in self.values.chunks_exact(parts * self.pitch) {
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
        for row in self.values.chunks_exact_mut(parts * self.pitch) {
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

    /// Takes all columns before column `k` out of it once more.
    ///
    /// - `sizes`: their squared lengths; `upper`: shares of each in all, `pitch` for each
    #[inline(always)]
    pub fn clean(&mut self, k: usize, sizes: &[f64], upper: &mut [f64]) {
        let (simd, parts, pitch) = (self.simd, parts::<S>(), self.pitch);
        for first in (0..k).step_by(NARROW) {
            let mut sums = [Lanes::splat(simd, 0.0); NARROW];
            for row in self.values.chunks_exact(parts * pitch) {
                let (own, others) = (&row[k * parts..][..parts], &row[first * parts..][..NARROW * parts]);
                for u in 0..parts {
                    let own = Lanes::new(simd, own[u]);
                    for w in 0..NARROW {
                        sums[w] = own.mul_add(Lanes::new(simd, others[w * parts + u]), sums[w]);
                    }
                }
            }
            let n = NARROW.min(k - first);
            let mut factors = [0.0; NARROW];
            for w in 0..n {
                if sizes[first + w] > 0.0 {
                    let share = sums[w].sum() / sizes[first + w];
                    upper[(first + w) * pitch + k] += share;
                    factors[w] = -share;
                }
            }
            for row in self.values.chunks_exact_mut(parts * pitch) {
                let (before, own) = row.split_at_mut(k * parts);
                let before = &before[first * parts..][..n * parts];
                for u in 0..parts {
                    let mut sum = Lanes::new(simd, own[u]);
                    for w in 0..n {
                        let factor = Lanes::splat(simd, factors[w]);
                        sum = Lanes::new(simd, before[w * parts + u]).mul_add(factor, sum);
                    }
                    own[u] = sum.get();
                }
            }
        }
    }

    /// Sums of the columns times coefficients, times the roots of the weights: `L` lines of results, from line `first` on.
    #[inline(always)]
    pub fn combine<const L: usize>(
        &self,
        coefficients: &[[f64; LINES]],
        first: usize,
        roots: &[S::f64s],
        lines: &mut [S::f64s],
    ) {
        let (simd, parts, n) = (self.simd, parts::<S>(), roots.len());
        // Two groups of rows at once; the last one is read twice if their number is odd.
        let size = parts * self.pitch;
        let n_groups = n / parts;
        for g in (0..n_groups).step_by(2) {
            let pair = [g, (g + 1).min(n_groups - 1)];
            let [one, two] = [&self.values[pair[0] * size..][..size], &self.values[pair[1] * size..][..size]];
            for u in 0..parts {
                let mut sums = [[Lanes::splat(simd, 0.0); 2]; L];
                for ((c, one), two) in coefficients.iter().zip(one.chunks_exact(parts)).zip(two.chunks_exact(parts)) {
                    let (one, two) = (Lanes::new(simd, one[u]), Lanes::new(simd, two[u]));
                    let c = &c[first..][..L];
                    for l in 0..L {
                        let factor = Lanes::splat(simd, c[l]);
                        sums[l][0] = one.mul_add(factor, sums[l][0]);
                        sums[l][1] = two.mul_add(factor, sums[l][1]);
                    }
                }
                for l in 0..L {
                    for h in 0..2 {
                        let at = pair[h] * parts + u;
                        lines[(first + l) * n + at] = (sums[l][h] * Lanes::new(simd, roots[at])).get();
                    }
                }
            }
        }
    }
}
