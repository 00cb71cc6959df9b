//! A block row while it is factored, and the arithmetic of its blocks.

use crate::system::block_rows::Block;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A row while it is factored.
pub(super) struct WorkRow<const D: usize> {
    pub index: usize,
    pub entries: Vec<(u32, Block<D>)>,
    /// Where each column stands in `entries`.
    pub places: Vec<u32>,
    /// Columns before the diagonal that are still to be eliminated.
    pub open: BinaryHeap<Reverse<u32>>,
}

impl<const D: usize> WorkRow<D> {
    pub fn new(n: usize) -> Self {
        Self { index: 0, entries: vec![], places: vec![u32::MAX; n], open: BinaryHeap::new() }
    }

    pub fn start(&mut self, index: usize) {
        self.index = index;
        self.entries.clear();
    }

    /// The block of a column, made if there is none yet.
    #[inline]
    pub fn block(&mut self, column: u32) -> &mut Block<D> {
        let place = &mut self.places[column as usize];
        if *place == u32::MAX {
            *place = self.entries.len() as u32;
            self.entries.push((column, [[0.0; D]; D]));
            if (column as usize) < self.index {
                self.open.push(Reverse(column));
            }
        }
        &mut self.entries[*place as usize].1
    }

    #[inline]
    pub fn subtract_product(&mut self, column: u32, factor: &Block<D>, block: &[[f32; D]; D]) {
        let own = self.block(column);
        for a in 0..D {
            for k in 0..D {
                for b in 0..D {
                    own[a][b] -= factor[a][k] * f64::from(block[k][b]);
                }
            }
        }
    }
}

#[inline]
pub(super) fn size<const D: usize>(block: &Block<D>) -> f64 {
    let mut sum = 0.0;
    for row in block {
        for v in row {
            sum += v * v;
        }
    }
    sum.sqrt()
}

#[inline]
pub(super) fn product<const D: usize>(a: &Block<D>, b: &Block<D>) -> Block<D> {
    let mut c = [[0.0; D]; D];
    for i in 0..D {
        for k in 0..D {
            for j in 0..D {
                c[i][j] += a[i][k] * b[k][j];
            }
        }
    }
    c
}

/// Inverse by elimination with pivots; of a singular block that of what is regular.
pub(super) fn inverse<const D: usize>(block: &Block<D>) -> Block<D> {
    let (mut a, mut b) = (*block, [[0.0; D]; D]);
    (0..D).for_each(|i| b[i][i] = 1.0);
    let least = 1e-12 * size(block);
    for k in 0..D {
        let pivot = (k..D).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).unwrap_or(k);
        a.swap(k, pivot);
        b.swap(k, pivot);
        if a[k][k].abs() <= least {
            continue;
        }
        let scale = 1.0 / a[k][k];
        (0..D).for_each(|j| {
            a[k][j] *= scale;
            b[k][j] *= scale;
        });
        for i in (0..D).filter(|&i| i != k) {
            let factor = a[i][k];
            for j in 0..D {
                a[i][j] -= factor * a[k][j];
                b[i][j] -= factor * b[k][j];
            }
        }
    }
    b
}
