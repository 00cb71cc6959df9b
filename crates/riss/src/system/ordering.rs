//! Elimination order of the nodes by geometric nested dissection [George1973].

use super::block_matrix::BlockMatrix;
use crate::math::Vector2;

/// Sets with no more nodes than this are not split further.
const LEAF: usize = 60;

/// Nodes in elimination order: halves at the median along the axis that leaves fewer nodes between them, then these.
pub fn nested_dissection(positions: &[Vector2], matrix: &BlockMatrix) -> Vec<u32> {
    let graph = Graph::of(matrix);
    let mut order = Vec::with_capacity(positions.len());
    let mut mark = vec![0u32; positions.len()];
    let mut stamp = 0;
    dissect(positions, &graph, (0..positions.len() as u32).collect(), &mut order, &mut mark, &mut stamp);
    order
}

/// Full adjacency of the nodes.
struct Graph {
    starts: Vec<usize>,
    neighbors: Vec<u32>,
}

impl Graph {
    fn of(matrix: &BlockMatrix) -> Self {
        let n = matrix.n_nodes();
        let pairs = || {
            (0..n).flat_map(move |i| {
                let row = &matrix.columns[matrix.row_starts[i]..matrix.row_starts[i + 1]];
                row.iter().filter(move |j| **j as usize != i).map(move |j| (i, *j as usize))
            })
        };
        let mut starts = vec![0usize; n + 1];
        for (i, j) in pairs() {
            starts[i + 1] += 1;
            starts[j + 1] += 1;
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        let mut fill = starts.clone();
        let mut neighbors = vec![0u32; starts[n]];
        for (i, j) in pairs() {
            neighbors[fill[i]] = j as u32;
            fill[i] += 1;
            neighbors[fill[j]] = i as u32;
            fill[j] += 1;
        }
        Self { starts, neighbors }
    }

    /// Whether a node has a neighbor with a mark.
    fn touches(&self, i: u32, mark: &[u32], stamp: u32) -> bool {
        let neighbors = &self.neighbors[self.starts[i as usize]..self.starts[i as usize + 1]];
        neighbors.iter().any(|&j| mark[j as usize] == stamp)
    }
}

/// Puts the lower half along an axis first, and marks the upper one.
fn cut(positions: &[Vector2], nodes: &mut [u32], axis: usize, mark: &mut [u32], stamp: &mut u32) {
    let middle = nodes.len() / 2;
    nodes.select_nth_unstable_by(middle, |&a, &b| {
        positions[a as usize][axis].total_cmp(&positions[b as usize][axis]).then(a.cmp(&b))
    });
    *stamp += 1;
    nodes[middle..].iter().for_each(|&i| mark[i as usize] = *stamp);
}

fn dissect(
    positions: &[Vector2],
    graph: &Graph,
    mut nodes: Vec<u32>,
    order: &mut Vec<u32>,
    mark: &mut [u32],
    stamp: &mut u32,
) {
    if nodes.len() <= LEAF {
        order.extend(nodes);
        return;
    }
    let middle = nodes.len() / 2;
    // Nodes crowd around tips: the way across the longer side may lead through all of them.
    let [across_y, across_x] = [1, 0].map(|axis| {
        cut(positions, &mut nodes, axis, mark, stamp);
        nodes[..middle].iter().filter(|i| graph.touches(**i, mark, *stamp)).count()
    });
    if across_y < across_x {
        cut(positions, &mut nodes, 1, mark, stamp);
    }
    let right = nodes.split_off(middle);
    let (separator, left): (Vec<u32>, Vec<u32>) = nodes.into_iter().partition(|i| graph.touches(*i, mark, *stamp));
    dissect(positions, graph, left, order, mark, stamp);
    dissect(positions, graph, right, order, mark, stamp);
    order.extend(separator);
}
