//! Sparse rows of small dense blocks, for systems that are not symmetric.

use super::lane_rows::LaneRow;
use crate::math::lanes::{Arch, GROUP, Simd, WithSimd};
use rayon::prelude::*;

/// Rows that are made, kept and multiplied together.
pub const CHUNK: usize = 256;

/// A block that joins two nodes: `block[row][column]`.
pub type Block<const D: usize> = [[f64; D]; D];

/// A square matrix of `D`×`D` blocks, stored in chunks of rows.
#[derive(Clone, Debug, Default)]
pub struct BlockRows<const D: usize> {
    chunks: Vec<RowChunk<D>>,
    n_rows: usize,
}

/// Some rows; columns ascend in each.
#[derive(Clone, Debug)]
pub struct RowChunk<const D: usize> {
    starts: Vec<u32>,
    columns: Vec<u32>,
    blocks: Vec<Block<D>>,
}

impl<const D: usize> Default for RowChunk<D> {
    fn default() -> Self {
        Self { starts: vec![0], columns: vec![], blocks: vec![] }
    }
}

impl<const D: usize> RowChunk<D> {
    /// Room for `n` blocks.
    pub fn with_capacity(n: usize) -> Self {
        Self { starts: vec![0], columns: Vec::with_capacity(n), blocks: Vec::with_capacity(n) }
    }

    /// Adds a row; entries with equal columns, which must be neighbors, are added up.
    pub fn push(&mut self, entries: &[(u32, Block<D>)]) {
        let start = self.columns.len();
        for (column, block) in entries {
            if self.columns.len() > start && self.columns.last() == Some(column) {
                let last = self.blocks.len() - 1;
                (0..D).for_each(|a| (0..D).for_each(|b| self.blocks[last][a][b] += block[a][b]));
            } else {
                self.columns.push(*column);
                self.blocks.push(*block);
            }
        }
        self.starts.push(self.columns.len() as u32);
    }

    fn n_rows(&self) -> usize {
        self.starts.len() - 1
    }

    fn row(&self, i: usize) -> (&[u32], &[Block<D>]) {
        let range = self.starts[i] as usize..self.starts[i + 1] as usize;
        (&self.columns[range.clone()], &self.blocks[range])
    }

    fn multiply<const W: usize>(&self, x: &[f64], y: &mut [f64]) {
        for (i, y) in y.chunks_exact_mut(D * W).enumerate() {
            let (columns, blocks) = self.row(i);
            let mut sum = [[0.0; W]; D];
            for (&j, block) in columns.iter().zip(blocks) {
                let x = &x[j as usize * D * W..(j as usize + 1) * D * W];
                for a in 0..D {
                    for b in 0..D {
                        (0..W).for_each(|l| sum[a][l] += block[a][b] * x[b * W + l]);
                    }
                }
            }
            y.copy_from_slice(sum.as_flattened());
        }
    }
}

impl<const D: usize> BlockRows<D> {
    /// Joins chunks; all but the last hold [`CHUNK`] rows.
    pub fn new(chunks: Vec<RowChunk<D>>) -> Self {
        let n_rows = chunks.iter().map(RowChunk::n_rows).sum();
        debug_assert!(chunks.iter().rev().skip(1).all(|c| c.n_rows() == CHUNK));
        Self { chunks, n_rows }
    }

    /// Number of block rows.
    pub fn n_rows(&self) -> usize {
        self.n_rows
    }

    /// Number of blocks.
    pub fn n_blocks(&self) -> usize {
        self.chunks.iter().map(|c| c.columns.len()).sum()
    }

    /// Columns and blocks of a row.
    #[inline]
    pub fn row(&self, i: usize) -> (&[u32], &[Block<D>]) {
        self.chunks[i / CHUNK].row(i % CHUNK)
    }

    /// `y = A x`.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        self.multiply_lanes::<1>(x, y);
    }

    /// `y = A x` for `W` vectors at once, whose entries stand side by side.
    pub fn multiply_lanes<const W: usize>(&self, x: &[f64], y: &mut [f64]) {
        let arch = Arch::new();
        y.par_chunks_mut(CHUNK * D * W).zip(&self.chunks).for_each(|(y, chunk)| {
            if W == GROUP {
                arch.dispatch(Product { chunk, x, y });
            } else {
                chunk.multiply::<W>(x, y);
            }
        });
    }
}

/// The rows of a chunk times [`GROUP`] vectors in registers.
struct Product<'a, const D: usize> {
    chunk: &'a RowChunk<D>,
    x: &'a [f64],
    y: &'a mut [f64],
}

impl<const D: usize> WithSimd for Product<'_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for (i, y) in self.y.chunks_exact_mut(D * GROUP).enumerate() {
            let (columns, blocks) = self.chunk.row(i);
            y.fill(0.0);
            LaneRow { columns, blocks, first: 0, values: self.x }.add_to(simd, 1.0, y);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn product_and_doubled_entries() {
        let mut chunk = RowChunk::<2>::default();
        let block = [[1.0, 2.0], [3.0, 4.0]];
        chunk.push(&[(0, block), (1, block), (1, block)]);
        chunk.push(&[(1, block)]);
        let matrix = BlockRows::new(vec![chunk]);
        let mut y = [0.0; 4];
        matrix.multiply(&[1.0, 0.0, 0.0, 1.0], &mut y);
        assert_eq!(y, [5.0, 11.0, 2.0, 4.0]);
        assert_eq!(matrix.n_blocks(), 3);
    }
}
