//! What is eliminated together, and after what: the sets of a geometric nested dissection [George1973].

use super::super::block_matrix::BlockMatrix;
use crate::geometry::aabb::Aabb;
use crate::math::Vector2;
use std::ops::Range;

/// Sets with no more nodes than this are not divided.
const LEAF: usize = 60;
/// Nodes of such a set that are eliminated together.
const CHUNK: usize = 20;
/// Shares of the nodes on the left of a cut that are tried, all of them in sets of fewer than [`MANY`] nodes.
const SHARES: [f64; 5] = [0.5, 0.45, 0.55, 0.42, 0.58];
const MANY: usize = 4000;

/// An order of elimination, and the fronts in which it is done.
#[derive(Clone, Debug)]
pub struct EliminationTree {
    /// Node at each place.
    pub order: Vec<u32>,
    /// Each after its children.
    pub fronts: Vec<Front>,
    /// Starts of the entries of each place.
    starts: Vec<usize>,
    /// Places from a place on that it is coupled to, ascending, and the block of the matrix.
    entries: Vec<(u32, u32)>,
}

/// Nodes that are eliminated together.
#[derive(Clone, Debug)]
pub struct Front {
    /// Their places.
    pub own: Range<usize>,
    /// Places after them that they are coupled to by then, ascending.
    pub border: Vec<u32>,
    /// Fronts that hand on their border to this one.
    pub children: Vec<usize>,
    /// Fronts of the whole branch, itself last.
    pub branch: Range<usize>,
    /// Where its panel is among the values of a factor.
    pub values: Range<usize>,
}

impl Front {
    /// Dofs that are eliminated, and those on the border.
    pub fn size(&self) -> (usize, usize) {
        (2 * self.own.len(), 2 * self.border.len())
    }

    /// Where nodes on the border of a child are in this front: its own nodes, then its border.
    pub fn places_of<'a>(&'a self, child: &'a Front) -> impl Iterator<Item = usize> + 'a {
        let mut on_border = 0;
        child.border.iter().map(move |&p| match (p as usize).checked_sub(self.own.end) {
            None => p as usize - self.own.start,
            Some(_) => {
                on_border += self.border[on_border..].iter().take_while(|q| **q < p).count();
                self.own.len() + on_border
            }
        })
    }
}

impl EliminationTree {
    /// Cuts the nodes in two where few are between, and each part again; those between come last.
    pub fn new(positions: &[Vector2], matrix: &BlockMatrix) -> Self {
        let graph = Graph::of(matrix);
        let mut tree =
            Self { order: Vec::with_capacity(positions.len()), fronts: vec![], starts: vec![], entries: vec![] };
        let mut cuts = Cuts { positions, graph: &graph, marks: vec![0; positions.len()], stamp: 0 };
        cuts.dissect((0..positions.len() as u32).collect(), &mut tree);
        let mut places = vec![0u32; positions.len()];
        tree.order.iter().enumerate().for_each(|(place, &node)| places[node as usize] = place as u32);
        tree.find_entries(&graph, &places);
        tree.find_borders();
        tree
    }

    /// Entries of the column of a place, from itself on.
    pub fn entries(&self, place: usize) -> &[(u32, u32)] {
        &self.entries[self.starts[place]..self.starts[place + 1]]
    }

    /// Operations of each branch.
    pub fn work(&self) -> Vec<f64> {
        let mut work: Vec<f64> = vec![];
        for front in &self.fronts {
            let (k, m) = (front.size().0 as f64, front.size().1 as f64);
            let below: f64 = front.children.iter().map(|c| work[*c]).sum();
            work.push(below + k * k * k / 3.0 + k * k * m + k * m * m);
        }
        work
    }

    /// Entries of the factor, with those that stay zero.
    pub fn n_values(&self) -> usize {
        self.fronts.last().map_or(0, |f| f.values.end)
    }

    /// Where the panels of a branch are among them.
    pub fn values_of_branch(&self, front: usize) -> Range<usize> {
        let front = &self.fronts[front];
        self.fronts[front.branch.start].values.start..front.values.end
    }

    /// Number of places in a branch.
    pub fn places_of_branch(&self, front: usize) -> usize {
        let front = &self.fronts[front];
        front.own.end - self.fronts[front.branch.start].own.start
    }

    fn find_entries(&mut self, graph: &Graph, places: &[u32]) {
        let n = places.len();
        let mut starts = vec![0usize; n + 1];
        for node in 0..n {
            let here = places[node];
            starts[here as usize + 1] +=
                graph.neighbors(node as u32).iter().filter(|j| places[j.0 as usize] >= here).count();
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        let mut fill = starts.clone();
        self.entries = vec![(0, 0); starts[n]];
        for (q, &node) in self.order.iter().enumerate() {
            for &(j, block) in graph.neighbors(node) {
                let p = places[j as usize] as usize;
                if p <= q {
                    self.entries[fill[p]] = (q as u32, block);
                    fill[p] += 1;
                }
            }
        }
        self.starts = starts;
    }

    /// - `children`: fronts whose borders may touch these nodes
    fn push(&mut self, nodes: &[u32], children: Vec<usize>) -> usize {
        let own = self.order.len()..self.order.len() + nodes.len();
        self.order.extend_from_slice(nodes);
        let first = children.first().map_or(self.fronts.len(), |c| self.fronts[*c].branch.start);
        self.fronts.push(Front { own, border: vec![], children, branch: first..self.fronts.len() + 1, values: 0..0 });
        self.fronts.len() - 1
    }

    fn find_borders(&mut self) {
        let mut marks = vec![u32::MAX; self.order.len()];
        let mut n_values = 0;
        for f in 0..self.fronts.len() {
            let end = self.fronts[f].own.end as u32;
            let mut border = vec![];
            let mut take = |place: u32| {
                if place >= end && std::mem::replace(&mut marks[place as usize], f as u32) != f as u32 {
                    border.push(place);
                }
            };
            for place in self.fronts[f].own.clone() {
                self.entries[self.starts[place]..self.starts[place + 1]].iter().for_each(|e| take(e.0));
            }
            for &child in &self.fronts[f].children {
                self.fronts[child].border.iter().for_each(|p| take(*p));
            }
            border.sort_unstable();
            let n = self.fronts[f].own.len();
            self.fronts[f].values = n_values..n_values + 4 * n * (n + border.len());
            n_values = self.fronts[f].values.end;
            self.fronts[f].border = border;
        }
    }
}

/// Full adjacency of the nodes, themselves included.
struct Graph {
    starts: Vec<usize>,
    /// Neighbor, and the block of the matrix.
    neighbors: Vec<(u32, u32)>,
}

impl Graph {
    fn of(matrix: &BlockMatrix) -> Self {
        let n = matrix.n_nodes();
        let mut starts = vec![0usize; n + 1];
        for i in 0..n {
            let row = &matrix.columns[matrix.row_starts[i]..matrix.row_starts[i + 1]];
            starts[i + 1] += row.len();
            row.iter().filter(|j| **j as usize != i).for_each(|j| starts[*j as usize + 1] += 1);
        }
        for i in 0..n {
            starts[i + 1] += starts[i];
        }
        let mut fill = starts.clone();
        let mut neighbors = vec![(0, 0); starts[n]];
        for i in 0..n {
            for k in matrix.row_starts[i]..matrix.row_starts[i + 1] {
                let j = matrix.columns[k] as usize;
                neighbors[fill[i]] = (j as u32, k as u32);
                fill[i] += 1;
                if i != j {
                    neighbors[fill[j]] = (i as u32, k as u32);
                    fill[j] += 1;
                }
            }
        }
        Self { starts, neighbors }
    }

    fn neighbors(&self, i: u32) -> &[(u32, u32)] {
        &self.neighbors[self.starts[i as usize]..self.starts[i as usize + 1]]
    }
}

/// A dissection while it is made.
struct Cuts<'a> {
    positions: &'a [Vector2],
    graph: &'a Graph,
    marks: Vec<u32>,
    stamp: u32,
}

impl Cuts<'_> {
    fn sort(&self, nodes: &mut [u32], axis: usize) {
        let at = |i: u32| self.positions[i as usize][axis];
        nodes.sort_unstable_by(|&a, &b| at(a).total_cmp(&at(b)).then(a.cmp(&b)));
    }

    /// Puts the `left` lowest nodes along an axis first, and marks the others.
    fn cut(&mut self, nodes: &mut [u32], axis: usize, left: usize) {
        let at = |i: u32| self.positions[i as usize][axis];
        nodes.select_nth_unstable_by(left, |&a, &b| at(a).total_cmp(&at(b)).then(a.cmp(&b)));
        self.stamp += 1;
        nodes[left..].iter().for_each(|&i| self.marks[i as usize] = self.stamp);
    }

    /// Axis, and how many nodes to put on the left: few are between then, and the parts are not too different. Nodes crowd
    /// around tips, and the way through the middle may lead through all of them.
    fn best_cut(&mut self, nodes: &mut [u32]) -> (usize, usize) {
        let shares = if nodes.len() < MANY { &SHARES[..] } else { &SHARES[..3] };
        let mut best = (f64::INFINITY, (0, 0));
        for axis in [0, 1] {
            for share in shares {
                let left = (share * nodes.len() as f64) as usize;
                self.cut(nodes, axis, left);
                let between = nodes[..left].iter().filter(|i| self.touches(**i)).count();
                let cost = between as f64 / (share * (1.0 - share));
                if cost < best.0 {
                    best = (cost, (axis, left));
                }
            }
        }
        best.1
    }

    /// Whether a node is coupled to marked ones.
    fn touches(&self, i: u32) -> bool {
        self.graph.neighbors(i).iter().any(|j| self.marks[j.0 as usize] == self.stamp)
    }

    /// The front that comes last.
    fn dissect(&mut self, mut nodes: Vec<u32>, tree: &mut EliminationTree) -> Option<usize> {
        if nodes.len() <= LEAF {
            return self.sweep(nodes, tree);
        }
        let (axis, left) = self.best_cut(&mut nodes);
        self.cut(&mut nodes, axis, left);
        let right = nodes.split_off(left);
        let (mut separator, left): (Vec<u32>, Vec<u32>) = nodes.into_iter().partition(|i| self.touches(*i));
        self.sort(&mut separator, 1 - axis);
        let children: Vec<usize> = [left, right].into_iter().filter_map(|part| self.dissect(part, tree)).collect();
        if separator.is_empty() {
            // Nothing is between the halves.
            return match children[..] {
                [] => None,
                [one] => Some(one),
                _ => Some(tree.push(&[], children)),
            };
        }
        Some(tree.push(&separator, children))
    }

    /// Eliminates a small set from one end to the other: fronts stay short along its longer side.
    fn sweep(&self, mut nodes: Vec<u32>, tree: &mut EliminationTree) -> Option<usize> {
        let axis = Aabb::of_points(nodes.iter().map(|&i| self.positions[i as usize])).size().imax();
        self.sort(&mut nodes, axis);
        let n = nodes.len().div_ceil(nodes.len().div_ceil(CHUNK).max(1)).max(1);
        nodes.chunks(n).fold(None, |before, chunk| Some(tree.push(chunk, before.into_iter().collect())))
    }
}
