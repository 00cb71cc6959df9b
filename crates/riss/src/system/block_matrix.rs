//! Symmetric sparse matrix of 2×2 blocks, one for each pair of nodes that meet in a cell.

use super::discretization::NodeLists;
use rayon::prelude::*;
use std::ops::Range;

/// Blocks of the lower triangle, row by row: row `i` holds the columns `j <= i`, ascending.
///
/// A block is `[xx, xy, yx, yy]`, its first letter the component of the row.
#[derive(Clone, Debug, Default)]
pub struct BlockMatrix {
    /// Start of each row in the two lists below.
    pub row_starts: Vec<usize>,
    /// Column of each block.
    pub columns: Vec<u32>,
    /// Blocks.
    pub blocks: Vec<[f64; 4]>,
}

impl BlockMatrix {
    /// The pattern in which all nodes of each list meet; all blocks zero.
    pub fn of_pattern(n_nodes: usize, lists: &[&NodeLists]) -> Self {
        // Lists that hold each node.
        let mut starts = vec![0usize; n_nodes + 1];
        for list in lists.iter().flat_map(|l| l.iter()) {
            list.iter().for_each(|&i| starts[i as usize + 1] += 1);
        }
        for i in 0..n_nodes {
            starts[i + 1] += starts[i];
        }
        let mut fill = starts.clone();
        let mut holders = vec![0u32; starts[n_nodes]];
        let flat: Vec<&[u32]> = lists.iter().flat_map(|l| l.iter()).collect();
        for (k, list) in flat.iter().enumerate() {
            for &i in *list {
                holders[fill[i as usize]] = k as u32;
                fill[i as usize] += 1;
            }
        }
        let chunk = n_nodes.div_ceil(64).max(1);
        let rows: Vec<(Vec<u32>, Vec<usize>)> = (0..n_nodes.div_ceil(chunk))
            .into_par_iter()
            .map(|c| {
                let mut mark = vec![u32::MAX; n_nodes];
                let (mut columns, mut ends) = (vec![], vec![]);
                for i in c * chunk..((c + 1) * chunk).min(n_nodes) {
                    let begin = columns.len();
                    for &k in &holders[starts[i]..starts[i + 1]] {
                        for &j in flat[k as usize].iter().take_while(|j| **j as usize <= i) {
                            if std::mem::replace(&mut mark[j as usize], i as u32) != i as u32 {
                                columns.push(j);
                            }
                        }
                    }
                    columns[begin..].sort_unstable();
                    ends.push(columns.len());
                }
                (columns, ends)
            })
            .collect();
        let mut result = Self { row_starts: vec![0], ..Self::default() };
        for (columns, ends) in rows {
            let offset = result.columns.len();
            result.row_starts.extend(ends.iter().map(|e| e + offset));
            result.columns.extend(columns);
        }
        result.blocks = vec![[0.0; 4]; result.columns.len()];
        // Memory that is read before it is written is mapped twice, and the second time stops all threads.
        result.blocks.par_chunks_mut(1 << 15).for_each(|blocks| blocks.fill([0.0; 4]));
        result
    }

    /// The same matrix in a pattern in which all nodes of each list meet, too.
    pub fn widened<'a>(&self, lists: impl Iterator<Item = &'a [u32]>) -> Self {
        let row = |i: usize| self.row_starts[i]..self.row_starts[i + 1];
        let mut rows: Vec<Vec<u32>> = (0..self.n_nodes()).map(|i| self.columns[row(i)].to_vec()).collect();
        for list in lists {
            for (k, &i) in list.iter().enumerate() {
                rows[i as usize].extend_from_slice(&list[..=k]);
            }
        }
        let mut result = Self { row_starts: vec![0], ..Self::default() };
        for (i, mut columns) in rows.into_iter().enumerate() {
            columns.sort_unstable();
            columns.dedup();
            let known = &self.columns[row(i)];
            result.blocks.extend(
                columns
                    .iter()
                    .map(|j| known.binary_search(j).map_or([0.0; 4], |k| self.blocks[self.row_starts[i] + k])),
            );
            result.columns.extend(columns);
            result.row_starts.push(result.columns.len());
        }
        result
    }

    /// Leaves the rows and columns of the first nodes alone.
    pub fn truncate(&mut self, n_nodes: usize) {
        self.row_starts.truncate(n_nodes + 1);
        let n = self.row_starts[n_nodes];
        self.columns.truncate(n);
        self.blocks.truncate(n);
    }

    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.row_starts.len() - 1
    }

    /// Adds local matrices in their order; rows go to threads by range, so that any number of threads gives the
    /// same sums.
    ///
    /// - `buffers`: one for each range of rows; any contents
    pub fn scatter(&mut self, locals: &[LocalMatrix], buffers: &mut [RowBuffer]) {
        let n = self.n_nodes();
        let n_ranges = buffers.len();
        let mut slices = vec![];
        let mut rest = &mut self.blocks[..];
        let mut begin = 0;
        for (r, buffer) in buffers.iter_mut().enumerate() {
            let end = n * (r + 1) / n_ranges;
            let (head, tail) = rest.split_at_mut(self.row_starts[end] - self.row_starts[begin]);
            slices.push((begin..end, head, buffer));
            rest = tail;
            begin = end;
        }
        let (starts, columns) = (&self.row_starts, &self.columns);
        slices.into_par_iter().for_each(|(rows, blocks, buffer)| {
            buffer.find_holders(&rows, locals);
            buffer.places.resize(n, 0);
            let RowBuffer { ends, holders, places } = buffer;
            let base = starts[rows.start];
            for (k, i) in rows.enumerate() {
                let held = (if k == 0 { 0 } else { ends[k - 1] }) as usize..ends[k] as usize;
                if held.is_empty() {
                    continue;
                }
                let row = starts[i]..starts[i + 1];
                for (place, &j) in columns[row.clone()].iter().enumerate() {
                    places[j as usize] = place as u32;
                }
                let sums = &mut blocks[row.start - base..row.end - base];
                for &(local, a) in &holders[held] {
                    let local = &locals[local as usize];
                    for (&j, block) in local.nodes.iter().zip(local.row(a as usize)) {
                        // Not all nodes of a patch meet; those that do not have no place.
                        if *block == [0.0; 4] {
                            continue;
                        }
                        for (sum, v) in sums[places[j as usize] as usize].iter_mut().zip(block) {
                            *sum += v;
                        }
                    }
                }
            }
        });
    }

    /// `y = A x`, both node-major.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        for i in 0..self.n_nodes() {
            let (xi, mut yi) = ([x[2 * i], x[2 * i + 1]], [0.0; 2]);
            for k in self.row_starts[i]..self.row_starts[i + 1] {
                let (j, b) = (self.columns[k] as usize, self.blocks[k]);
                yi[0] += b[0] * x[2 * j] + b[1] * x[2 * j + 1];
                yi[1] += b[2] * x[2 * j] + b[3] * x[2 * j + 1];
                if i != j {
                    y[2 * j] += b[0] * xi[0] + b[2] * xi[1];
                    y[2 * j + 1] += b[1] * xi[0] + b[3] * xi[1];
                }
            }
            y[2 * i] += yi[0];
            y[2 * i + 1] += yi[1];
        }
    }

    /// Adds to a diagonal entry of a dof.
    pub fn add_diagonal(&mut self, dof: usize, value: f64) {
        let last = self.row_starts[dof / 2 + 1] - 1;
        self.blocks[last][3 * (dof % 2)] += value;
    }

    /// Largest diagonal entry.
    pub fn largest_diagonal(&self) -> f64 {
        self.row_starts
            .iter()
            .skip(1)
            .map(|&end| self.blocks[end - 1][0].max(self.blocks[end - 1][3]))
            .fold(0.0, f64::max)
    }
}

/// Matrix and load of some cells or a boundary element. A buffer.
#[derive(Clone, Debug, Default)]
pub struct LocalMatrix {
    /// Nodes, ascending.
    pub nodes: Vec<u32>,
    /// Lower triangle of blocks, row by row.
    pub blocks: Vec<[f64; 4]>,
    /// Load vector, node-major.
    pub load: Vec<f64>,
}

impl LocalMatrix {
    /// Empties the buffer for new nodes.
    pub fn reset(&mut self, nodes: &[u32]) {
        self.nodes.clear();
        self.nodes.extend_from_slice(nodes);
        let n = nodes.len();
        self.blocks.clear();
        self.blocks.resize(n * (n + 1) / 2, [0.0; 4]);
        self.load.clear();
        self.load.resize(2 * n, 0.0);
    }

    /// The blocks of local node `a` with those up to itself.
    #[inline]
    fn row(&self, a: usize) -> &[[f64; 4]] {
        &self.blocks[a * (a + 1) / 2..][..=a]
    }

    /// The block of local nodes `a >= b`.
    #[inline]
    pub fn block_mut(&mut self, a: usize, b: usize) -> &mut [f64; 4] {
        &mut self.blocks[a * (a + 1) / 2 + b]
    }
}

/// What a range of rows needs to know of local matrices. A buffer.
#[derive(Clone, Debug, Default)]
pub struct RowBuffer {
    /// For each row the end of its holders.
    ends: Vec<u32>,
    /// Local matrices that hold a row, and its index there; row by row, in the order of the matrices.
    holders: Vec<(u32, u32)>,
    /// Place of each column in the row at hand.
    places: Vec<u32>,
}

impl RowBuffer {
    fn find_holders(&mut self, rows: &Range<usize>, locals: &[LocalMatrix]) {
        let of = |local: &LocalMatrix| {
            let first = local.nodes.partition_point(|&i| (i as usize) < rows.start);
            first..local.nodes.partition_point(|&i| (i as usize) < rows.end)
        };
        self.ends.clear();
        self.ends.resize(rows.len() + 1, 0);
        for local in locals {
            local.nodes[of(local)].iter().for_each(|&i| self.ends[i as usize - rows.start + 1] += 1);
        }
        for k in 0..rows.len() {
            self.ends[k + 1] += self.ends[k];
        }
        self.holders.resize(self.ends[rows.len()] as usize, (0, 0));
        // The start of each row moves to its end.
        for (l, local) in locals.iter().enumerate() {
            for a in of(local) {
                let next = &mut self.ends[local.nodes[a] as usize - rows.start];
                self.holders[*next as usize] = (l as u32, a as u32);
                *next += 1;
            }
        }
    }
}
