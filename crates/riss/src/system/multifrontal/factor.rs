//! The whole factor, and solutions by it.

use super::super::block_matrix::BlockMatrix;
use super::front::{Child, eliminate, subtract_product};
use super::tree::{EliminationTree, Front};
use crate::error::Result;
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::{solve_lower_triangular_in_place, solve_upper_triangular_in_place};
use faer::traits::{ComplexField, RealField};
use faer::{Accum, MatMut, MatRef, Par};
use rayon::prelude::*;
use std::ops::{AddAssign, SubAssign};
use std::sync::{Arc, Mutex, MutexGuard};

/// Branches with fewer operations are one task.
const TASK: f64 = 4e6;

/// Branches with fewer values are one task of a solution.
const SOLVE_TASK: usize = 100_000;

/// A number that a factor may consist of.
pub trait Scalar: RealField + ComplexField + Copy + AddAssign + SubAssign + Send + Sync {}

impl Scalar for f64 {}
impl Scalar for f32 {}

/// A Cholesky factor, front by front.
pub struct Cholesky<T> {
    tree: Arc<EliminationTree>,
    /// The panel of each front: columns of its nodes, with the rows of its border below.
    values: Vec<T>,
}

impl<T: Scalar> Cholesky<T> {
    /// Factors the lower triangle of a matrix.
    ///
    /// - `convert`: entry of the matrix at a row and a column of dofs to entry of the matrix that is factored
    ///
    /// # Errors
    /// [`crate::Error::Factorization`] if it is not positive definite.
    pub fn new(
        tree: Arc<EliminationTree>,
        matrix: &BlockMatrix,
        convert: impl Fn(f64, usize, usize) -> T + Sync,
    ) -> Result<Self> {
        let mut values = vec![T::zero_impl(); tree.n_values()];
        if let Some(last) = tree.fronts.len().checked_sub(1) {
            let job = Job { tree: &tree, matrix, convert: &convert, work: &tree.work(), buffers: Mutex::default() };
            job.branch(last, &mut values)?;
        }
        Ok(Self { tree, values })
    }

    /// Solves for one load in its place; the same bits for any number of threads.
    pub fn solve_in_place(&self, x: &mut [T]) {
        let Some(last) = self.tree.fronts.len().checked_sub(1) else { return };
        let places = || self.tree.order.iter().flat_map(|&i| [2 * i as usize, 2 * i as usize + 1]);
        let mut y: Vec<T> = places().map(|dof| x[dof]).collect();
        self.forward(last, &mut y);
        self.backward(last, &mut y, &[]);
        places().zip(y).for_each(|(dof, v)| x[dof] = v);
    }

    /// The panel of a front.
    fn panel(&self, front: &Front) -> MatRef<'_, T> {
        let (k, m) = front.size();
        MatRef::from_column_major_slice(&self.values[front.values.clone()], k + m, k)
    }

    /// The children of a front, each with its part of the dofs `y` of their branches.
    fn children<'a>(&self, front: &Front, mut y: &'a mut [T]) -> Vec<(usize, &'a mut [T])> {
        let mut children = vec![];
        for &child in &front.children {
            let (head, tail) = y.split_at_mut(2 * self.tree.places_of_branch(child));
            children.push((child, head));
            y = tail;
        }
        children
    }

    /// Eliminates forward in a branch with dofs `y`; returns what is to be subtracted on the border of its last front.
    fn forward(&self, f: usize, y: &mut [T]) -> Vec<T> {
        let front = &self.tree.fronts[f];
        let (k, m) = front.size();
        let (rest, own) = y.split_at_mut(y.len() - k);
        let children = self.children(front, rest);
        let left: Vec<Vec<T>> = match self.tree.values_of_branch(f).len() > SOLVE_TASK {
            true => children.into_par_iter().map(|(c, y)| self.forward(c, y)).collect(),
            false => children.into_iter().map(|(c, y)| self.forward(c, y)).collect(),
        };
        let mut outside = vec![T::zero_impl(); m];
        for (&child, left) in front.children.iter().zip(&left) {
            for (place, v) in front.places_of(&self.tree.fronts[child]).zip(left.chunks_exact(2)) {
                for (c, v) in v.iter().enumerate() {
                    match (2 * place + c).checked_sub(k) {
                        None => own[2 * place + c] -= *v,
                        Some(p) => outside[p] += *v,
                    }
                }
            }
        }
        let panel = self.panel(front);
        solve_lower_triangular_in_place(panel.subrows(0, k), as_column_mut(own), Par::Seq);
        let below = panel.subrows(k, m);
        matmul(as_column_mut(&mut outside), Accum::Add, below, as_column(own), T::one_impl(), Par::Seq);
        outside
    }

    /// Substitutes back in a branch with dofs `y`.
    ///
    /// - `border`: the solution on the border of its last front
    fn backward(&self, f: usize, y: &mut [T], border: &[T]) {
        let front = &self.tree.fronts[f];
        let (k, m) = front.size();
        let (rest, own) = y.split_at_mut(y.len() - k);
        let panel = self.panel(front);
        let below = panel.subrows(k, m).transpose();
        matmul(as_column_mut(own), Accum::Add, below, as_column(border), -T::one_impl(), Par::Seq);
        solve_upper_triangular_in_place(panel.subrows(0, k).transpose(), as_column_mut(own), Par::Seq);
        let of_child = |(child, y): (usize, &mut [T])| {
            let at = |dof: usize| dof.checked_sub(k).map_or_else(|| own[dof], |p| border[p]);
            let places = front.places_of(&self.tree.fronts[child]);
            let its_border: Vec<T> = places.flat_map(|p| [at(2 * p), at(2 * p + 1)]).collect();
            self.backward(child, y, &its_border);
        };
        let children = self.children(front, rest);
        match self.tree.values_of_branch(f).len() > SOLVE_TASK {
            true => children.into_par_iter().for_each(of_child),
            false => children.into_iter().for_each(of_child),
        }
    }
}

fn as_column<T>(x: &[T]) -> MatRef<'_, T> {
    MatRef::from_column_major_slice(x, x.len(), 1)
}

fn as_column_mut<T>(x: &mut [T]) -> MatMut<'_, T> {
    let n = x.len();
    MatMut::from_column_major_slice_mut(x, n, 1)
}

/// A factorization under way.
struct Job<'a, T, F> {
    tree: &'a EliminationTree,
    matrix: &'a BlockMatrix,
    convert: &'a F,
    /// Operations of each branch.
    work: &'a [f64],
    /// For what fronts leave on their borders, to be used again: fresh memory costs as much as what is computed in it.
    buffers: Mutex<Vec<Vec<T>>>,
}

impl<T: Scalar, F: Fn(f64, usize, usize) -> T + Sync> Job<'_, T, F> {
    /// Factors a branch and returns what it leaves on the border of its last front, a lower triangle column by column.
    ///
    /// - `values`: the panels of the branch
    fn branch(&self, f: usize, values: &mut [T]) -> Result<Vec<T>> {
        let front = &self.tree.fronts[f];
        let (mut rest, own) = values.split_at_mut(values.len() - front.values.len());
        let mut branches = vec![];
        for &child in &front.children {
            let (head, tail) = rest.split_at_mut(self.tree.values_of_branch(child).len());
            branches.push((child, head));
            rest = tail;
        }
        // The same for any number of threads.
        let is_large = self.work[f] > TASK;
        let left: Vec<Vec<T>> = match is_large {
            true => branches.into_par_iter().map(|(c, v)| self.branch(c, v)).collect::<Result<_>>()?,
            false => branches.into_iter().map(|(c, v)| self.branch(c, v)).collect::<Result<_>>()?,
        };
        let fronts = front.children.iter().map(|c| &self.tree.fronts[*c]);
        let children: Vec<Child<T>> = fronts.zip(&left).map(|(child, left)| Child::new(front, child, left)).collect();
        let (k, m) = front.size();
        // Memory that is read before it is written is mapped twice, and the second time stops all threads.
        own.fill(T::zero_impl());
        self.fill(front, own);
        children.iter().for_each(|child| child.add_to_panel(own, (k, m)));
        eliminate(MatMut::from_column_major_slice_mut(own, k + m, k), is_large)?;
        let mut update = self.buffer(m * m);
        let border = MatRef::from_column_major_slice(own, k + m, k).subrows(k, m);
        let product = MatMut::from_column_major_slice_mut(&mut update[..m * m], m, m);
        subtract_product(product, Accum::Replace, border, is_large);
        children.iter().for_each(|child| child.add_to_border(&mut update, m));
        self.buffers().extend(left);
        Ok(update)
    }

    fn buffers(&self) -> MutexGuard<'_, Vec<Vec<T>>> {
        self.buffers.lock().expect("nothing panics while it is held")
    }

    /// At least as long as asked for, with any contents.
    fn buffer(&self, n: usize) -> Vec<T> {
        let mut buffers = self.buffers();
        let fits = buffers.iter().enumerate().filter(|(_, b)| b.len() >= n).min_by_key(|(_, b)| b.len());
        if let Some((i, _)) = fits {
            return buffers.swap_remove(i);
        }
        drop(buffers);
        // Fronts further up are larger.
        vec![T::zero_impl(); n + n / 2]
    }

    /// Entries of the matrix in the columns of a front.
    fn fill(&self, front: &Front, panel: &mut [T]) {
        let (order, blocks) = (&self.tree.order, &self.matrix.blocks);
        let height = front.size().0 + front.size().1;
        for p in front.own.clone() {
            let (column, a) = (2 * (p - front.own.start), order[p] as usize);
            let mut place = 0;
            for &(q, k) in self.tree.entries(p) {
                let row = match (q as usize).checked_sub(front.own.end) {
                    None => q as usize - front.own.start,
                    Some(_) => {
                        place += front.border[place..].iter().take_while(|b| **b < q).count();
                        front.own.len() + place
                    }
                };
                let (b, block) = (order[q as usize] as usize, blocks[k as usize]);
                for (c, d) in [(0, 0), (1, 0), (1, 1), (0, 1)].into_iter().take(if a == b { 3 } else { 4 }) {
                    let v = if b >= a { block[2 * c + d] } else { block[2 * d + c] };
                    panel[(column + d) * height + 2 * row + c] = (self.convert)(v, 2 * b + c, 2 * a + d);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::discretization::NodeLists;
    use super::*;
    use crate::error::Error;
    use crate::math::Vector2;
    use nalgebra::{DMatrix, DVector};

    /// Two separate bodies of nodes in rows, each coupled to those nearby.
    fn bodies(n: usize) -> (Vec<Vector2>, BlockMatrix) {
        let positions: Vec<Vector2> = (0..2 * n * n)
            .map(|i| Vector2::new((i % n) as f64 + if i < n * n { 0.0 } else { 1e3 }, (i / n % n) as f64))
            .collect();
        let pairs = (0..positions.len()).flat_map(|i| (0..=i).map(move |j| (j, i)));
        let near = pairs.filter(|(j, i)| (positions[*i] - positions[*j]).norm() < 2.9);
        let lists: Vec<Vec<u32>> =
            near.map(|(j, i)| if j == i { vec![i as u32] } else { vec![j as u32, i as u32] }).collect();
        let mut matrix = BlockMatrix::of_pattern(positions.len(), &[&NodeLists::from_lists(&lists)]);
        for i in 0..matrix.n_nodes() {
            for k in matrix.row_starts[i]..matrix.row_starts[i + 1] {
                let j = matrix.columns[k] as usize;
                let v = |c: usize| ((i * 31 + j * 17 + c * 7) % 23) as f64 / 23.0 - 0.5;
                matrix.blocks[k] = if i == j { [60.0, 1.0, 1.0, 50.0] } else { [v(0), v(1), v(2), v(3)] };
            }
        }
        (positions, matrix)
    }

    fn dense(matrix: &BlockMatrix) -> DMatrix<f64> {
        let mut full = DMatrix::zeros(2 * matrix.n_nodes(), 2 * matrix.n_nodes());
        for i in 0..matrix.n_nodes() {
            for k in matrix.row_starts[i]..matrix.row_starts[i + 1] {
                let j = matrix.columns[k] as usize;
                for c in 0..4 {
                    full[(2 * i + c / 2, 2 * j + c % 2)] = matrix.blocks[k][c];
                    full[(2 * j + c % 2, 2 * i + c / 2)] = matrix.blocks[k][c];
                }
            }
        }
        full
    }

    fn factor(positions: &[Vector2], matrix: &BlockMatrix) -> Result<Cholesky<f64>> {
        Cholesky::new(Arc::new(EliminationTree::new(positions, matrix)), matrix, |v, _, _| v)
    }

    #[test]
    fn solutions_are_those_of_dense_elimination() {
        for n in [1, 3, 14] {
            let (positions, matrix) = bodies(n);
            let load: Vec<f64> = (0..4 * n * n).map(|i| (i % 13) as f64 - 6.0).collect();
            let exact = dense(&matrix).lu().solve(&DVector::from_column_slice(&load)).unwrap();
            let mut x = load.clone();
            factor(&positions, &matrix).unwrap().solve_in_place(&mut x);
            assert!((DVector::from_vec(x) - &exact).amax() < 1e-13 * exact.amax());
            let tree = Arc::new(EliminationTree::new(&positions, &matrix));
            let mut single: Vec<f32> = load.iter().map(|v| *v as f32).collect();
            Cholesky::new(tree, &matrix, |v, _, _| v as f32).unwrap().solve_in_place(&mut single);
            assert!(single.iter().zip(&exact).all(|(a, b)| (*a as f64 - b).abs() < 1e-5 * exact.amax()));
        }
    }

    #[test]
    fn every_entry_of_the_matrix_is_in_one_column() {
        let (positions, matrix) = bodies(14);
        let tree = EliminationTree::new(&positions, &matrix);
        let mut seen = vec![0; matrix.blocks.len()];
        for front in &tree.fronts {
            assert!(front.border.iter().all(|p| *p as usize >= front.own.end));
            for &child in &front.children {
                let handed_on = |p: &u32| front.own.contains(&(*p as usize)) || front.border.contains(p);
                assert!(tree.fronts[child].border.iter().all(handed_on));
            }
            front.own.clone().flat_map(|p| tree.entries(p)).for_each(|e| seen[e.1 as usize] += 1);
        }
        assert!(seen.iter().all(|n| *n == 1));
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let (positions, matrix) = bodies(40);
        let values = |n: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
            pool.install(|| factor(&positions, &matrix).unwrap().values)
        };
        assert!(EliminationTree::new(&positions, &matrix).work().last() > Some(&(4.0 * TASK)));
        assert_eq!(values(1), values(3));
        let solution = |n: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap();
            let mut x: Vec<f64> = (0..2 * matrix.n_nodes()).map(|i| (i % 7) as f64).collect();
            pool.install(|| factor(&positions, &matrix).unwrap().solve_in_place(&mut x));
            x
        };
        assert!(values(1).len() > 2 * SOLVE_TASK);
        assert_eq!(solution(1), solution(3));
    }

    #[test]
    fn indefinite_matrices_are_refused() {
        let (positions, mut matrix) = bodies(9);
        matrix.add_diagonal(57, -80.0);
        assert!(matches!(factor(&positions, &matrix), Err(Error::Factorization { .. })));
        matrix.add_diagonal(57, f64::NAN);
        assert!(matches!(factor(&positions, &matrix), Err(Error::Factorization { .. })));
    }
}
