//! The stiffness of one cell from the gradients at its points.

use super::block_matrix::LocalMatrix;
use crate::integration::IntegrationPoint;
use crate::math::lanes::{GROUP, Lanes, Simd, WithSimd};

/// Rows that are computed together: each number that is loaded serves all of them.
const ROWS: usize = 2;

/// Adds the blocks `Σ w [λ g_a g_bᵀ + μ g_b g_aᵀ + μ (g_a·g_b) I]` from the sums `Σ w g_a g_bᵀ`, with columns in the
/// lanes of the vector registers.
pub(super) struct CellBlocks<'a> {
    /// Lamé parameter and shear modulus [stress].
    pub lame: [f64; 2],
    pub points: &'a [IntegrationPoint<2>],
    /// Gradients point by point, `stride` numbers each, a multiple of [`GROUP`]; zero beyond the nodes.
    pub gradients: [&'a [f64]; 2],
    pub stride: usize,
    /// Buffer of weighted gradients: x and y of the rows computed together, point by point.
    pub weighted: &'a mut Vec<[[f64; 2]; ROWS]>,
    /// Indices of the nodes in the matrix, ascending.
    pub places: &'a [u32],
    pub local: &'a mut LocalMatrix,
}

impl WithSimd for CellBlocks<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { lame: [lambda, mu], points, gradients: [gx, gy], stride, weighted, places, local } = self;
        let along = Lanes::splat(simd, lambda + 2.0 * mu);
        let (lambda, mu) = (Lanes::splat(simd, lambda), Lanes::splat(simd, mu));
        // Vectors from one point to the next.
        let step = stride / S::F64_LANES;
        let n = places.len();
        for first in (0..n).step_by(ROWS) {
            weighted.clear();
            for (q, point) in points.iter().enumerate() {
                let at = q * stride + first;
                weighted.push([0, 1].map(|r| [point.weight * gx[at + r], point.weight * gy[at + r]]));
            }
            let last = (first + ROWS).min(n);
            for chunk in 0..last.div_ceil(S::F64_LANES) {
                let mut sums = [[Lanes::splat(simd, 0.0); 4]; ROWS];
                for (q, of_rows) in weighted.iter().enumerate() {
                    let (x, y) = (Lanes::load(simd, gx, q * step + chunk), Lanes::load(simd, gy, q * step + chunk));
                    for r in 0..ROWS {
                        let (wx, wy) = (Lanes::splat(simd, of_rows[r][0]), Lanes::splat(simd, of_rows[r][1]));
                        sums[r][0] = wx.mul_add(x, sums[r][0]);
                        sums[r][1] = wx.mul_add(y, sums[r][1]);
                        sums[r][2] = wy.mul_add(x, sums[r][2]);
                        sums[r][3] = wy.mul_add(y, sums[r][3]);
                    }
                }
                let begin = chunk * S::F64_LANES;
                for a in first..last {
                    let [xx, xy, yx, yy] = sums[a - first];
                    let mut numbers = [[0.0; GROUP]; 4];
                    along.mul_add(xx, mu * yy).store(&mut numbers[0], 0);
                    lambda.mul_add(xy, mu * yx).store(&mut numbers[1], 0);
                    lambda.mul_add(yx, mu * xy).store(&mut numbers[2], 0);
                    along.mul_add(yy, mu * xx).store(&mut numbers[3], 0);
                    let place = places[a] as usize;
                    let row = &mut local.blocks[place * (place + 1) / 2..][..=place];
                    // Most chunks are full: no loop.
                    if begin + S::F64_LANES <= a + 1 {
                        let columns = &places[begin..begin + S::F64_LANES];
                        for k in 0..S::F64_LANES {
                            add(&mut row[columns[k] as usize], &numbers, k);
                        }
                    } else {
                        for b in begin..a + 1 {
                            add(&mut row[places[b] as usize], &numbers, b - begin);
                        }
                    }
                }
            }
        }
    }
}

#[inline(always)]
fn add(block: &mut [f64; 4], numbers: &[[f64; GROUP]; 4], k: usize) {
    for i in 0..4 {
        block[i] += numbers[i][k];
    }
}
