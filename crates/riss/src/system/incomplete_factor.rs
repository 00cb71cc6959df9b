//! Incomplete LU factorization of block rows, ILUT [Saad1994], kept in single precision.
//!
//! Parts of the matrix that do not meet are factored and solved side by side.

mod work_row;

use super::block_rows::{Block, BlockRows};
use super::dissection::Dissection;
use super::lane_rows::LaneRow;
use crate::math::lanes::{Arch, GROUP, Simd, WithSimd};
use rayon::prelude::*;
use std::cmp::Reverse;
use std::ops::Range;
use work_row::{WorkRow, inverse, product, size};

/// Blocks of the upper factor smaller than this share of the mean block of their row are dropped, and blocks of the lower
/// one, which are factors of rows, smaller than this.
const DROP: f64 = 0.01;
/// Most blocks kept in a row of either factor.
const MOST_BLOCKS: usize = 80;
/// The same for rows that are kept fuller.
const FULLER_DROP: f64 = 0.001;
const FULLER_MOST_BLOCKS: usize = 300;

/// Factors of a matrix.
#[derive(Debug)]
pub struct IncompleteFactor<const D: usize> {
    dissection: Dissection,
    stages: Vec<Vec<PartFactor<D>>>,
}

#[derive(Debug)]
struct PartFactor<const D: usize> {
    rows: Range<usize>,
    lower: Triangle<D>,
    upper: Triangle<D>,
    inverse_diagonal: Vec<Block<D>>,
}

/// Rows of a strict triangle; columns are places of the dissection.
#[derive(Debug)]
struct Triangle<const D: usize> {
    starts: Vec<usize>,
    columns: Vec<u32>,
    blocks: Vec<[[f32; D]; D]>,
}

/// What is known of a vector from a place on.
#[derive(Clone, Copy)]
struct Piece<'a> {
    first: usize,
    values: &'a [f64],
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

    /// Subtracts row `i` times a vector from `sum`.
    ///
    /// - `before`, `after`: the vector before a place and from it on
    #[inline(always)]
    fn subtract<S: Simd, const W: usize>(
        &self,
        simd: S,
        i: usize,
        [before, after]: [Piece<'_>; 2],
        sum: &mut [[f64; W]; D],
    ) {
        let range = self.starts[i]..self.starts[i + 1];
        let columns = &self.columns[range.clone()];
        let n_before = columns.partition_point(|&j| (j as usize) < after.first);
        let (columns, blocks) = (columns.split_at(n_before), self.blocks[range].split_at(n_before));
        Self::subtract_some(simd, columns.0, blocks.0, before, sum);
        Self::subtract_some(simd, columns.1, blocks.1, after, sum);
    }

    #[inline(always)]
    fn subtract_some<S: Simd, const W: usize>(
        simd: S,
        columns: &[u32],
        blocks: &[[[f32; D]; D]],
        vector: Piece<'_>,
        sum: &mut [[f64; W]; D],
    ) {
        if W == GROUP {
            let Piece { first, values } = vector;
            LaneRow { columns, blocks, first, values }.add_to(simd, -1.0, sum.as_flattened_mut());
            return;
        }
        for (&j, block) in columns.iter().zip(blocks) {
            let start = (j as usize - vector.first) * D * W;
            let x = &vector.values[start..start + D * W];
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
    /// Factors a matrix in the order of a dissection.
    ///
    /// - `is_fuller`: nodes whose rows keep smaller blocks and more of them
    pub fn new(matrix: &BlockRows<D>, dissection: Dissection, is_fuller: &[bool]) -> Self {
        let mut stages: Vec<Vec<PartFactor<D>>> = vec![];
        for parts in &dissection.stages {
            let source =
                Source { matrix, dissection: &dissection, is_fuller, earlier: stages.iter().flatten().collect() };
            let stage = parts.par_iter().map(|rows| PartFactor::new(&source, rows.clone())).collect();
            stages.push(stage);
        }
        Self { dissection, stages }
    }

    /// Number of blocks kept.
    pub fn n_blocks(&self) -> usize {
        let of_part = |p: &PartFactor<D>| p.lower.columns.len() + p.upper.columns.len() + p.inverse_diagonal.len();
        self.stages.iter().flatten().map(of_part).sum()
    }

    /// `z = M⁻¹ r` for `W` vectors at once, whose entries stand side by side.
    ///
    /// - `work`: memory of the same length
    pub fn solve<const W: usize>(&self, r: &[f64], z: &mut [f64], work: &mut [f64]) {
        let (Dissection { order, places, .. }, arch) = (&self.dissection, Arch::new());
        let gather = |from: &[f64], to: &mut [f64], source: &[u32]| {
            to.par_chunks_exact_mut(D * W).zip(source).with_min_len(LEAST_GATHERED).for_each(|(to, &i)| {
                to.copy_from_slice(&from[i as usize * D * W..(i as usize + 1) * D * W]);
            });
        };
        gather(r, work, order);
        for stage in &self.stages {
            let (done, own) = work.split_at_mut(first_row(stage) * D * W);
            let done = Piece { first: 0, values: done };
            pieces::<D, W>(stage, own)
                .into_par_iter()
                .for_each(|(part, own)| arch.dispatch(Substitution::<D, W> { part, side: Side::Lower, done, own }));
        }
        let mut end = work.len();
        for stage in self.stages.iter().rev() {
            let (rest, done) = work.split_at_mut(end);
            let first = first_row(stage) * D * W;
            let done = Piece { first: end / (D * W), values: done };
            pieces::<D, W>(stage, &mut rest[first..])
                .into_par_iter()
                .for_each(|(part, own)| arch.dispatch(Substitution::<D, W> { part, side: Side::Upper, done, own }));
            end = first;
        }
        gather(work, z, places);
    }
}

/// Nodes that a thread gathers at least.
const LEAST_GATHERED: usize = 4096;

fn first_row<const D: usize>(stage: &[PartFactor<D>]) -> usize {
    stage[0].rows.start
}

/// The vectors of the parts of a stage, from one that begins with the stage.
fn pieces<'a, const D: usize, const W: usize>(
    stage: &'a [PartFactor<D>],
    mut rest: &'a mut [f64],
) -> Vec<(&'a PartFactor<D>, &'a mut [f64])> {
    let mut found = vec![];
    for part in stage {
        let (own, after) = rest.split_at_mut(part.rows.len() * D * W);
        found.push((part, own));
        rest = after;
    }
    found
}

/// Which factor.
#[derive(Clone, Copy)]
enum Side {
    Lower,
    Upper,
}

/// The solution with one factor in one part.
struct Substitution<'a, const D: usize, const W: usize> {
    part: &'a PartFactor<D>,
    side: Side,
    done: Piece<'a>,
    own: &'a mut [f64],
}

impl<const D: usize, const W: usize> WithSimd for Substitution<'_, D, W> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match self.side {
            Side::Lower => self.part.solve_lower::<S, W>(simd, self.done, self.own),
            Side::Upper => self.part.solve_upper::<S, W>(simd, self.done, self.own),
        }
    }
}

/// What parts are factored from.
struct Source<'a, const D: usize> {
    matrix: &'a BlockRows<D>,
    dissection: &'a Dissection,
    is_fuller: &'a [bool],
    /// Parts of the stages before, in the order of their rows.
    earlier: Vec<&'a PartFactor<D>>,
}

impl<const D: usize> PartFactor<D> {
    fn new(source: &Source<'_, D>, rows: Range<usize>) -> Self {
        let mut this = Self {
            rows: rows.clone(),
            lower: Triangle::new(),
            upper: Triangle::new(),
            inverse_diagonal: Vec::with_capacity(rows.len()),
        };
        let mut row = WorkRow::new(source.dissection.order.len());
        for i in rows {
            let node = source.dissection.order[i] as usize;
            let (columns, blocks) = source.matrix.row(node);
            let limits = if source.is_fuller[node] { Limits::FULLER } else { Limits::USUAL };
            row.start(i);
            for (&j, block) in columns.iter().zip(blocks) {
                *row.block(source.dissection.places[j as usize]) = *block;
            }
            let mean = row.entries.iter().map(|e| size(&e.1)).sum::<f64>() / row.entries.len() as f64;
            this.eliminate(&mut row, &source.earlier, limits);
            this.keep(&mut row, mean, limits);
        }
        this
    }

    /// The inverse of the diagonal block of a row and what is right of it.
    #[inline]
    fn upper_row(&self, row: usize) -> (&Block<D>, &[u32], &[[[f32; D]; D]]) {
        let i = row - self.rows.start;
        let range = self.upper.starts[i]..self.upper.starts[i + 1];
        (&self.inverse_diagonal[i], &self.upper.columns[range.clone()], &self.upper.blocks[range])
    }

    /// Subtracts the rows above from a row, in the order of their columns.
    fn eliminate(&self, row: &mut WorkRow<D>, earlier: &[&Self], limits: Limits) {
        while let Some(Reverse(k)) = row.open.pop() {
            let at = row.places[k as usize] as usize;
            let k = k as usize;
            let part = if k < self.rows.start { earlier[earlier.partition_point(|p| p.rows.end <= k)] } else { self };
            let (inverse_diagonal, columns, blocks) = part.upper_row(k);
            let factor = product(&row.entries[at].1, inverse_diagonal);
            if size(&factor) < limits.drop {
                row.entries[at].1 = [[0.0; D]; D];
                continue;
            }
            row.entries[at].1 = factor;
            for (&j, block) in columns.iter().zip(blocks) {
                row.subtract_product(j, &factor, block);
            }
        }
    }

    /// Moves the largest blocks of a row, whose mean size was `mean`, to the factors.
    fn keep(&mut self, row: &mut WorkRow<D>, mean: f64, limits: Limits) {
        let Limits { drop, most_blocks } = limits;
        let threshold = drop * mean;
        let (mut before, mut after, mut diagonal) = (vec![], vec![], [[0.0; D]; D]);
        for &(j, block) in &row.entries {
            row.places[j as usize] = u32::MAX;
            match (j as usize).cmp(&row.index) {
                std::cmp::Ordering::Equal => diagonal = block,
                std::cmp::Ordering::Less if size(&block) >= drop => before.push((j, block)),
                std::cmp::Ordering::Greater if size(&block) >= threshold => after.push((j, block)),
                std::cmp::Ordering::Less | std::cmp::Ordering::Greater => {}
            }
        }
        for side in [&mut before, &mut after] {
            if side.len() > most_blocks {
                let larger =
                    |a: &(u32, Block<D>), b: &(u32, Block<D>)| size(&b.1).total_cmp(&size(&a.1)).then(a.0.cmp(&b.0));
                side.select_nth_unstable_by(most_blocks, larger);
                side.truncate(most_blocks);
            }
            side.sort_unstable_by_key(|e| e.0);
        }
        self.lower.push(&before);
        self.upper.push(&after);
        self.inverse_diagonal.push(inverse(&diagonal));
    }

    /// Replaces the own piece of a vector by that of the solution with the lower factor, from the pieces before.
    #[inline(always)]
    fn solve_lower<S: Simd, const W: usize>(&self, simd: S, done: Piece<'_>, z: &mut [f64]) {
        for i in 0..self.rows.len() {
            let mut sum: [[f64; W]; D] = std::array::from_fn(|a| std::array::from_fn(|l| z[(i * D + a) * W + l]));
            let own = Piece { first: self.rows.start, values: z };
            self.lower.subtract(simd, i, [done, own], &mut sum);
            z[i * D * W..(i + 1) * D * W].copy_from_slice(sum.as_flattened());
        }
    }

    /// The same with the upper factor, from the pieces after.
    #[inline(always)]
    fn solve_upper<S: Simd, const W: usize>(&self, simd: S, done: Piece<'_>, z: &mut [f64]) {
        for i in (0..self.rows.len()).rev() {
            let mut sum: [[f64; W]; D] = std::array::from_fn(|a| std::array::from_fn(|l| z[(i * D + a) * W + l]));
            let own = Piece { first: self.rows.start, values: z };
            self.upper.subtract(simd, i, [own, done], &mut sum);
            for a in 0..D {
                for l in 0..W {
                    z[(i * D + a) * W + l] = (0..D).map(|b| self.inverse_diagonal[i][a][b] * sum[b][l]).sum();
                }
            }
        }
    }
}

/// What is left out of a row.
#[derive(Clone, Copy)]
struct Limits {
    drop: f64,
    most_blocks: usize,
}

impl Limits {
    const USUAL: Self = Self { drop: DROP, most_blocks: MOST_BLOCKS };
    const FULLER: Self = Self { drop: FULLER_DROP, most_blocks: FULLER_MOST_BLOCKS };
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::block_rows::RowChunk;

    /// Nothing is dropped in a matrix of few rows with large blocks: the factorization is complete, also where two parts
    /// stand side by side.
    #[test]
    fn small_systems_are_solved_up_to_single_precision() {
        let numbers: Vec<u32> = (0..6).collect();
        let stages = vec![std::iter::once(0..6).collect()];
        check(&Dissection { order: numbers.clone(), places: numbers, stages }, |_, _| true);
        let order = vec![4, 0, 1, 5, 2, 3];
        let places = vec![1, 2, 4, 5, 0, 3];
        let stages = vec![vec![0..2, 2..4], std::iter::once(4..6).collect()];
        let part = |i: u32| [0, 1, 2, 2, 0, 1][i as usize];
        check(&Dissection { order, places, stages }, |i, j| part(i) == part(j) || part(i) == 2 || part(j) == 2);
    }

    /// One vector, and as many as stand in registers.
    fn check(dissection: &Dissection, meet: impl Fn(u32, u32) -> bool) {
        let n = 6u32;
        let mut chunk = RowChunk::<3>::default();
        for i in 0..n {
            let row: Vec<(u32, Block<3>)> = (0..n)
                .filter(|&j| meet(i, j))
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
        let factor = IncompleteFactor::new(&matrix, dissection.clone(), &[false; 6]);
        factor.solve::<1>(&right, &mut found, &mut [0.0; 18]);
        assert!(found.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-5), "{found:?}");

        let wide = |v: &[f64]| (0..18 * GROUP).map(|i| v[i / GROUP] * (i % GROUP) as f64).collect::<Vec<f64>>();
        let (wide_x, mut wide_right) = (wide(&x), vec![0.0; 18 * GROUP]);
        matrix.multiply_lanes::<GROUP>(&wide_x, &mut wide_right);
        assert!(wide(&right).iter().zip(&wide_right).all(|(a, b)| (a - b).abs() < 1e-12), "{wide_right:?}");
        let (mut wide_found, mut work) = (wide_right.clone(), wide_right.clone());
        factor.solve::<GROUP>(&wide_right, &mut wide_found, &mut work);
        assert!(wide_found.iter().zip(&wide_x).all(|(a, b)| (a - b).abs() < 1e-4), "{wide_found:?}");
    }
}
