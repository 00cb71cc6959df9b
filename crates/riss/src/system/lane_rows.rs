//! Rows of blocks times several vectors at once, in vector registers.

use crate::math::lanes::{GROUP, Lanes, Simd};

/// Blocks of a row, and [`GROUP`] vectors from the entry `first` on, which stand side by side.
pub(super) struct LaneRow<'a, T, const D: usize> {
    pub columns: &'a [u32],
    pub blocks: &'a [[[T; D]; D]],
    pub first: usize,
    pub values: &'a [f64],
}

impl<T: Copy + Into<f64>, const D: usize> LaneRow<'_, T, D> {
    /// Adds `factor` times the products to the `D` entries of each vector in `sum`; the factor is one or minus one.
    #[inline(always)]
    pub fn add_to<S: Simd>(&self, simd: S, factor: f64, sum: &mut [f64]) {
        let parts = GROUP / S::F64_LANES;
        let (values, sums) = (S::as_simd_f64s(self.values).0, S::as_mut_simd_f64s(sum).0);
        for part in 0..parts {
            let mut own: [Lanes<S>; D] = std::array::from_fn(|a| Lanes::new(simd, sums[a * parts + part]));
            for (&j, block) in self.columns.iter().zip(self.blocks) {
                let start = (j as usize - self.first) * D * parts;
                let x = &values[start..start + D * parts];
                for b in 0..D {
                    let x = Lanes::new(simd, x[b * parts + part]);
                    for a in 0..D {
                        let entry: f64 = block[a][b].into();
                        own[a] = Lanes::splat(simd, factor * entry).mul_add(x, own[a]);
                    }
                }
            }
            for a in 0..D {
                sums[a * parts + part] = own[a].get();
            }
        }
    }
}
