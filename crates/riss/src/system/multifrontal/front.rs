//! Dense elimination of a front, and what its children hand on to it.

use super::factor::Scalar;
use super::tree::Front;
use crate::error::{Error, Result};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::{Accum, MatMut, MatRef, Par};
use rayon::prelude::*;

/// Columns that are eliminated at once.
const PANEL: usize = 128;
/// Rows or columns that are one task.
const TILE: usize = 256;

/// What a child left on its border, and where that goes.
pub(super) struct Child<'a, T> {
    left: &'a [T],
    /// Dofs of its border.
    n: usize,
    /// Nodes of its border that are eliminated now, then those on the border of its parent.
    runs: [Vec<Run>; 2],
}

/// Nodes that follow one another both on a child's border and in its parent.
struct Run {
    first: usize,
    /// Place of the first in the parent's panel, or on its border.
    place: usize,
    n: usize,
}

impl<'a, T: Scalar> Child<'a, T> {
    /// - `left`: lower triangle, column by column
    pub(super) fn new(parent: &Front, child: &Front, left: &'a [T]) -> Self {
        let mut runs = [vec![], vec![]];
        for (first, place) in parent.places_of(child).enumerate() {
            let is_outside = place >= parent.own.len();
            let place = if is_outside { place - parent.own.len() } else { place };
            let runs: &mut Vec<Run> = &mut runs[usize::from(is_outside)];
            match runs.last_mut() {
                Some(run) if run.place + run.n == place => run.n += 1,
                _ => runs.push(Run { first, place, n: 1 }),
            }
        }
        Self { left, n: 2 * child.border.len(), runs }
    }

    /// Adds what belongs to columns that are eliminated now.
    ///
    /// - `size`: that of the parent
    pub(super) fn add_to_panel(&self, panel: &mut [T], (k, m): (usize, usize)) {
        let [inside, border] = &self.runs;
        for (r, run) in inside.iter().enumerate() {
            for c in 0..2 * run.n {
                let column = &mut panel[(2 * run.place + c) * (k + m)..][..k + m];
                self.add(run, c, column, &inside[r..], c);
                self.add(run, c, &mut column[k..], border, 0);
            }
        }
    }

    /// Adds the rest to what the parent leaves on its border of `m` dofs.
    pub(super) fn add_to_border(&self, update: &mut [T], m: usize) {
        let border = &self.runs[1];
        for (r, run) in border.iter().enumerate() {
            for c in 0..2 * run.n {
                self.add(run, c, &mut update[(2 * run.place + c) * m..][..m], &border[r..], c);
            }
        }
    }

    /// Adds some rows of column `c` of a run.
    ///
    /// - `skip`: rows of the first run above the diagonal
    fn add(&self, of: &Run, c: usize, to: &mut [T], rows: &[Run], mut skip: usize) {
        let from = &self.left[(2 * of.first + c) * self.n..][..self.n];
        for run in rows {
            let to = &mut to[2 * run.place + skip..2 * (run.place + run.n)];
            let from = &from[2 * run.first + skip..2 * (run.first + run.n)];
            to.iter_mut().zip(from).for_each(|(t, v)| *t += *v);
            skip = 0;
        }
    }
}

/// Eliminates the columns of a panel, which holds rows beyond them too.
///
/// # Errors
/// [`Error::Factorization`] if a pivot is not positive.
pub(super) fn eliminate<T: Scalar>(mut panel: MatMut<'_, T>, is_large: bool) -> Result<()> {
    let (n, k) = (panel.nrows(), panel.ncols());
    let mut memory = MemBuffer::new(cholesky_in_place_scratch::<T>(PANEL.min(k), Par::Seq, Default::default()));
    for done in (0..k).step_by(PANEL) {
        let width = PANEL.min(k - done);
        let (now, later) = panel.as_mut().split_at_col_mut(done + width);
        let now = now.split_at_col_mut(done).1;
        let (mut diagonal, mut below) = now.subrows_mut(done, n - done).split_at_row_mut(width);
        let stack = MemStack::new(&mut memory);
        cholesky_in_place(diagonal.as_mut(), Default::default(), Par::Seq, stack, Default::default())
            .map_err(|e| Error::Factorization { reason: format!("it is not positive definite ({e:?})") })?;
        let triangle = diagonal.as_ref();
        let divide = |rows: MatMut<'_, T>| solve_lower_triangular_in_place(triangle, rows.transpose_mut(), Par::Seq);
        match is_large {
            true => below.as_mut().par_row_chunks_mut(TILE).for_each(divide),
            false => divide(below.as_mut()),
        }
        subtract_product(later.split_at_row_mut(done + width).1, Accum::Add, below.as_ref(), is_large);
    }
    Ok(())
}

/// Subtracts `B Bᵀ` in the lower triangle of `C`, whose columns may be fewer than the rows of `B`; or replaces `C`.
///
/// The same bits for any number of threads: tiles do not depend on it.
pub(super) fn subtract_product<T: Scalar>(c: MatMut<'_, T>, accumulate: Accum, b: MatRef<'_, T>, is_large: bool) {
    let n = c.nrows();
    let minus = -T::one_impl();
    let tile = |(i, columns): (usize, MatMut<'_, T>)| {
        let (first, width) = (i * TILE, columns.ncols());
        let (diagonal, below) = columns.subrows_mut(first, n - first).split_at_row_mut(width);
        let (here, rest) = (b.subrows(first, width), b.subrows(first + width, n - first - width));
        let (lower, full) = (BlockStructure::TriangularLower, BlockStructure::Rectangular);
        triangular::matmul(diagonal, lower, accumulate, here, full, here.transpose(), full, minus, Par::Seq);
        matmul(below, accumulate, rest, here.transpose(), minus, Par::Seq);
    };
    match is_large {
        true => c.par_col_chunks_mut(TILE).enumerate().for_each(tile),
        false => {
            let (mut rest, mut i) = (c, 0);
            while rest.ncols() > 0 {
                let width = TILE.min(rest.ncols());
                let (columns, later) = rest.split_at_col_mut(width);
                tile((i, columns));
                (rest, i) = (later, i + 1);
            }
        }
    }
}
