//! Incomplete LU factorization of block rows, ILUT [Saad1994], kept in single precision.

use super::block_rows::{Block, BlockRows};
use rayon::prelude::*;
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::ops::Range;

/// Blocks of the upper factor smaller than this share of the mean block of their row are dropped, and blocks of the lower
/// one, which are factors of rows, smaller than this.
const DROP: f64 = 0.01;
/// Most blocks kept in a row of either factor.
const MOST_BLOCKS: usize = 80;

/// Factors of the diagonal parts of a matrix.
#[derive(Debug)]
pub struct IncompleteFactor<const D: usize> {
    parts: Vec<PartFactor<D>>,
}

#[derive(Debug)]
struct PartFactor<const D: usize> {
    rows: Range<usize>,
    lower: Triangle<D>,
    upper: Triangle<D>,
    inverse_diagonal: Vec<Block<D>>,
}

/// Rows of a strict triangle; columns are counted from the first row of the part.
#[derive(Debug)]
struct Triangle<const D: usize> {
    starts: Vec<usize>,
    columns: Vec<u32>,
    blocks: Vec<[[f32; D]; D]>,
}

impl<const D: usize> Triangle<D> {
    fn new() -> Self {
        Self { starts: vec![0], columns: vec![], blocks: vec![] }
    }

    fn push(&mut self, row: &[(u32, Block<D>)]) {
        self.columns.extend(row.iter().map(|e| e.0));
        self.blocks.extend(row.iter().map(|e| e.1.map(|r| r.map(|v| v as f32))));
        self.starts.push(self.columns.len());
    }

    /// Subtracts row `i` times `x` from `sum`.
    #[inline]
    fn subtract<const W: usize>(&self, i: usize, x: &[f64], sum: &mut [[f64; W]; D]) {
        let range = self.starts[i]..self.starts[i + 1];
        for (&j, block) in self.columns[range.clone()].iter().zip(&self.blocks[range]) {
            let x = &x[j as usize * D * W..(j as usize + 1) * D * W];
            for a in 0..D {
                for b in 0..D {
                    let factor = f64::from(block[a][b]);
                    (0..W).for_each(|l| sum[a][l] -= factor * x[b * W + l]);
                }
            }
        }
    }
}

impl<const D: usize> IncompleteFactor<D> {
    /// Factors each range of rows by itself.
    pub fn new(matrix: &BlockRows<D>, parts: Vec<Range<usize>>) -> Self {
        Self { parts: parts.into_par_iter().map(|rows| PartFactor::new(matrix, rows)).collect() }
    }

    /// Number of blocks kept.
    pub fn n_blocks(&self) -> usize {
        self.parts.iter().map(|p| p.lower.columns.len() + p.upper.columns.len() + p.inverse_diagonal.len()).sum()
    }

    /// `z = M⁻¹ r` for `W` vectors at once, whose entries stand side by side.
    pub fn solve<const W: usize>(&self, r: &[f64], z: &mut [f64]) {
        let mut rest = z;
        let mut pieces = vec![];
        for part in &self.parts {
            let (own, after) = rest.split_at_mut(part.rows.len() * D * W);
            pieces.push((part, own));
            rest = after;
        }
        let of_part = |rows: &Range<usize>| &r[rows.start * D * W..rows.end * D * W];
        pieces.into_par_iter().for_each(|(part, z)| part.solve::<W>(of_part(&part.rows), z));
    }
}

impl<const D: usize> PartFactor<D> {
    fn new(matrix: &BlockRows<D>, rows: Range<usize>) -> Self {
        let n = rows.len();
        let mut this = Self {
            rows: rows.clone(),
            lower: Triangle::new(),
            upper: Triangle::new(),
            inverse_diagonal: Vec::with_capacity(n),
        };
        let mut row = WorkRow::new(n);
        for i in 0..n {
            let (columns, blocks) = matrix.row(rows.start + i);
            row.start(i);
            for (&j, block) in columns.iter().zip(blocks) {
                if rows.contains(&(j as usize)) {
                    *row.block((j as usize - rows.start) as u32) = *block;
                }
            }
            let mean = row.entries.iter().map(|e| size(&e.1)).sum::<f64>() / row.entries.len() as f64;
            this.eliminate(&mut row);
            this.keep(&mut row, DROP * mean);
        }
        this
    }

    /// Subtracts the rows above from a row, in the order of their columns.
    fn eliminate(&self, row: &mut WorkRow<D>) {
        while let Some(Reverse(k)) = row.open.pop() {
            let at = row.places[k as usize] as usize;
            let factor = product(&row.entries[at].1, &self.inverse_diagonal[k as usize]);
            if size(&factor) < DROP {
                row.entries[at].1 = [[0.0; D]; D];
                continue;
            }
            row.entries[at].1 = factor;
            let range = self.upper.starts[k as usize]..self.upper.starts[k as usize + 1];
            for (&j, block) in self.upper.columns[range.clone()].iter().zip(&self.upper.blocks[range]) {
                row.subtract_product(j, &factor, block);
            }
        }
    }

    /// Moves the largest blocks of a row to the factors.
    fn keep(&mut self, row: &mut WorkRow<D>, threshold: f64) {
        let (mut before, mut after, mut diagonal) = (vec![], vec![], [[0.0; D]; D]);
        for &(j, block) in &row.entries {
            row.places[j as usize] = u32::MAX;
            match (j as usize).cmp(&row.index) {
                std::cmp::Ordering::Equal => diagonal = block,
                std::cmp::Ordering::Less if size(&block) >= DROP => before.push((j, block)),
                std::cmp::Ordering::Greater if size(&block) >= threshold => after.push((j, block)),
                std::cmp::Ordering::Less | std::cmp::Ordering::Greater => {}
            }
        }
        for side in [&mut before, &mut after] {
            if side.len() > MOST_BLOCKS {
                let larger =
                    |a: &(u32, Block<D>), b: &(u32, Block<D>)| size(&b.1).total_cmp(&size(&a.1)).then(a.0.cmp(&b.0));
                side.select_nth_unstable_by(MOST_BLOCKS, larger);
                side.truncate(MOST_BLOCKS);
            }
            side.sort_unstable_by_key(|e| e.0);
        }
        self.lower.push(&before);
        self.upper.push(&after);
        self.inverse_diagonal.push(inverse(&diagonal));
    }

    fn solve<const W: usize>(&self, r: &[f64], z: &mut [f64]) {
        let n = self.inverse_diagonal.len();
        for i in 0..n {
            let mut sum: [[f64; W]; D] = std::array::from_fn(|a| std::array::from_fn(|l| r[(i * D + a) * W + l]));
            self.lower.subtract(i, z, &mut sum);
            z[i * D * W..(i + 1) * D * W].copy_from_slice(sum.as_flattened());
        }
        for i in (0..n).rev() {
            let mut sum: [[f64; W]; D] = std::array::from_fn(|a| std::array::from_fn(|l| z[(i * D + a) * W + l]));
            self.upper.subtract(i, z, &mut sum);
            for a in 0..D {
                for l in 0..W {
                    z[(i * D + a) * W + l] = (0..D).map(|b| self.inverse_diagonal[i][a][b] * sum[b][l]).sum();
                }
            }
        }
    }
}

/// A row while it is factored.
struct WorkRow<const D: usize> {
    index: usize,
    entries: Vec<(u32, Block<D>)>,
    /// Where each column stands in `entries`.
    places: Vec<u32>,
    /// Columns before the diagonal that are still to be eliminated.
    open: BinaryHeap<Reverse<u32>>,
}

impl<const D: usize> WorkRow<D> {
    fn new(n: usize) -> Self {
        Self { index: 0, entries: vec![], places: vec![u32::MAX; n], open: BinaryHeap::new() }
    }

    fn start(&mut self, index: usize) {
        self.index = index;
        self.entries.clear();
    }

    /// The block of a column, made if there is none yet.
    #[inline]
    fn block(&mut self, column: u32) -> &mut Block<D> {
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
    fn subtract_product(&mut self, column: u32, factor: &Block<D>, block: &[[f32; D]; D]) {
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
fn size<const D: usize>(block: &Block<D>) -> f64 {
    let mut sum = 0.0;
    for row in block {
        for v in row {
            sum += v * v;
        }
    }
    sum.sqrt()
}

#[inline]
fn product<const D: usize>(a: &Block<D>, b: &Block<D>) -> Block<D> {
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
fn inverse<const D: usize>(block: &Block<D>) -> Block<D> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::block_rows::RowChunk;

    /// Nothing is dropped in a matrix of few rows with large blocks: the factorization is complete.
    #[test]
    fn small_systems_are_solved_up_to_single_precision() {
        let n = 6u32;
        let mut chunk = RowChunk::<3>::default();
        for i in 0..n {
            let row: Vec<(u32, Block<3>)> = (0..n)
                .map(|j| {
                    let value = |a: usize, b: usize| {
                        let off = ((i * 7 + j * 3) as f64 + 1.7 * a as f64 - 0.9 * b as f64).sin();
                        if i == j && a == b { 12.0 } else { off }
                    };
                    (j, std::array::from_fn(|a| std::array::from_fn(|b| value(a, b))))
                })
                .collect();
            chunk.push(&row);
        }
        let matrix = BlockRows::new(vec![chunk]);
        let x: Vec<f64> = (0..18).map(|i| (i as f64).cos()).collect();
        let (mut right, mut found) = (vec![0.0; 18], vec![0.0; 18]);
        matrix.multiply(&x, &mut right);
        IncompleteFactor::new(&matrix, std::iter::once(0..6).collect()).solve::<1>(&right, &mut found);
        assert!(found.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-5), "{found:?}");
    }
}
