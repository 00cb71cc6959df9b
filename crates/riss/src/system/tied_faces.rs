//! Crack faces tied to each other, and what it takes to open them.
//!
//! Both nodes of a pair move as one, `u_a = u_b + w` with a given opening `w`, and the sum of their equations holds, in
//! which the traction between them cancels. The matrix is then the same for every opening, and tractions and displacements
//! are linear in the load and in the openings.
//!
//! Near the edge of a surface both nodes see the same neighbors, and the sum of their tractions alone would say nothing. There
//! the forces on the layer of half a spacing on both faces are added, `-(h_a div σ_a + h_b div σ_b)/2`, by the share of neighbors
//! that both see. Elsewhere they are left out: with them the equations of some clouds are nearly singular.

use super::block_rows::{Block, BlockRows, CHUNK, RowChunk};
use super::collocation::{Collocation, CollocationSystem};
use crate::error::Result;
use crate::math::{Matrix, Vector};
use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

/// A pair is tied along directions that its supports leave free by more than this sine.
const FREE: f64 = 0.1;

/// Two nodes on both faces of a crack.
#[derive(Clone, Debug)]
pub struct TiedPair<const D: usize> {
    /// The node on the positive side and that on the negative side.
    pub nodes: [usize; 2],
    /// Unit vectors along which the faces can part: the normal of the crack first, towards its positive side.
    pub directions: Vec<Vector<D>>,
    /// Weight of the equation of the first node in the sum with that of the second.
    weight: f64,
    /// What the traction counts in the equation of the second node [length/stress].
    scale: f64,
}

impl<const D: usize> TiedPair<D> {
    /// A pair of nodes; none if they cannot part along the normal.
    ///
    /// - `normal`: unit normal of the crack
    pub fn new(nodes: [usize; 2], normal: Vector<D>, system: &CollocationSystem<D>) -> Option<Self> {
        let [first, second] = nodes.map(|i| system.face_scales[i]);
        let free = Matrix::<D>::identity() - system.fixed[nodes[1]];
        let along = (free * normal).try_normalize(FREE)?;
        if !(first > 0.0 && second > 0.0) {
            return None;
        }
        let mut directions = vec![along];
        for d in 0..D {
            let mut rest = free * crate::math::axis::<D>(d);
            directions.iter().for_each(|e| rest -= e * e.dot(&rest));
            // Of three axes across two others the longest rest is never shorter.
            if let Some(unit) = rest.try_normalize(0.5) {
                directions.push(unit);
            }
        }
        Some(Self { nodes, directions, weight: second / first, scale: second })
    }
}

/// A system in which pairs of nodes are tied.
pub struct TiedFaces<const D: usize> {
    /// The pairs.
    pub pairs: Vec<TiedPair<D>>,
    /// The equations; those of the first node of each pair say nothing.
    pub system: CollocationSystem<D>,
    /// Rows of the first node of each pair, which its opening moves to the right-hand side.
    columns: Vec<Vec<(u32, Block<D>)>>,
    /// Forces on the layer of the second node of each pair by itself.
    rows: Vec<Row<D>>,
}

/// An equation of a node.
pub(super) struct Row<const D: usize> {
    pub columns: Vec<u32>,
    pub blocks: Vec<Block<D>>,
    pub load: Vector<D>,
}

impl<const D: usize> Row<D> {
    fn times(mut self, factor: f64) -> Self {
        self.blocks.iter_mut().flatten().flatten().for_each(|v| *v *= factor);
        self.load *= factor;
        self
    }
}

/// Share of the columns of two rows that both have, of the shorter one.
fn shared_fraction([a, b]: [&[u32]; 2]) -> f64 {
    let own: FxHashSet<u32> = a.iter().copied().collect();
    let shared = b.iter().filter(|j| own.contains(j)).count();
    shared as f64 / a.len().min(b.len()).max(1) as f64
}

impl<const D: usize> TiedFaces<D> {
    /// Ties pairs of nodes.
    ///
    /// # Errors
    /// Those of the shape functions.
    pub fn new(collocation: &Collocation<D>, system: &CollocationSystem<D>, pairs: Vec<TiedPair<D>>) -> Result<Self> {
        let layers: Vec<[Row<D>; 2]> = pairs
            .par_iter()
            .map(|p| {
                let share = shared_fraction(p.nodes.map(|i| system.tangent.row(i).0));
                let [first, second] = p.nodes.map(|i| Ok(collocation.layer(i as u32)?.times(share)));
                Ok([first?, second?])
            })
            .collect::<Result<_>>()?;
        let n = system.tangent.n_rows();
        let pair_of_first: FxHashMap<u32, usize> =
            pairs.iter().enumerate().map(|(k, p)| (p.nodes[0] as u32, k)).collect();
        let pair_of_second: FxHashMap<usize, usize> = pairs.iter().enumerate().map(|(k, p)| (p.nodes[1], k)).collect();
        let mut columns = vec![vec![]; pairs.len()];
        let mut chunks = vec![];
        let (mut load, mut fixed) = (system.load.clone(), system.fixed.clone());
        let mut entries: Vec<(u32, Block<D>)> = vec![];
        for start in (0..n).step_by(CHUNK) {
            let mut chunk = RowChunk::default();
            for i in start..(start + CHUNK).min(n) {
                entries.clear();
                let mut add = |(own, blocks): (&[u32], &[Block<D>]), weight: f64| {
                    for (j, block) in own.iter().zip(blocks) {
                        let block = block.map(|r| r.map(|v| v * weight));
                        match pair_of_first.get(j) {
                            Some(&k) => {
                                columns[k].push((i as u32, block));
                                entries.push((pairs[k].nodes[1] as u32, block));
                            }
                            None => entries.push((*j, block)),
                        }
                    }
                };
                if pair_of_first.contains_key(&(i as u32)) {
                    let identity: Block<D> = std::array::from_fn(|a| std::array::from_fn(|b| f64::from(a == b)));
                    entries.push((i as u32, identity));
                    load[i * D..(i + 1) * D].fill(0.0);
                    fixed[i] = Matrix::identity();
                } else {
                    add(system.tangent.row(i), 1.0);
                    if let Some(&k) = pair_of_second.get(&i) {
                        let (first, weight) = (pairs[k].nodes[0], pairs[k].weight);
                        let [of_first, of_second] = &layers[k];
                        add(system.tangent.row(first), weight);
                        add((&of_first.columns, &of_first.blocks), weight);
                        add((&of_second.columns, &of_second.blocks), 1.0);
                        for d in 0..D {
                            load[i * D + d] +=
                                weight * (system.load[first * D + d] + of_first.load[d]) + of_second.load[d];
                        }
                    }
                }
                entries.sort_by_key(|e| e.0);
                chunk.push(&entries);
            }
            chunks.push(chunk);
        }
        let row = |(p, [_, layer]): (&TiedPair<D>, [Row<D>; 2])| {
            let (columns, blocks) = system.tangent.row(p.nodes[1]);
            let load = Vector::from_column_slice(&system.load[p.nodes[1] * D..(p.nodes[1] + 1) * D]);
            Row {
                columns: columns.iter().copied().chain(layer.columns).collect(),
                blocks: blocks.iter().copied().chain(layer.blocks).collect(),
                load: load + layer.load,
            }
        };
        let rows = pairs.iter().zip(layers).map(row).collect();
        let face_scales = vec![0.0; n];
        let system = CollocationSystem { tangent: BlockRows::new(chunks), load, fixed, face_scales };
        Ok(Self { pairs, system, columns, rows })
    }

    /// Motions without those of the first nodes, as unit vectors.
    pub fn tied_motions(&self, mut motions: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        for motion in &mut motions {
            self.pairs.iter().for_each(|p| motion[p.nodes[0] * D..(p.nodes[0] + 1) * D].fill(0.0));
            let length = motion.iter().map(|v| v * v).sum::<f64>().sqrt();
            motion.iter_mut().for_each(|v| *v /= length);
        }
        motions
    }

    /// Adds to a right-hand side what an opening of a pair gives.
    pub fn open(&self, pair: usize, opening: Vector<D>, right: &mut [f64]) {
        for (row, block) in &self.columns[pair] {
            for a in 0..D {
                for b in 0..D {
                    right[*row as usize * D + a] -= block[a][b] * opening[b];
                }
            }
        }
    }

    /// Puts the displacements of the first nodes in place.
    ///
    /// - `openings`: of each pair [length]
    pub fn complete(&self, displacements: &mut [f64], openings: impl Fn(usize) -> Vector<D>) {
        for (k, pair) in self.pairs.iter().enumerate() {
            let ([first, second], opening) = (pair.nodes, openings(k));
            for d in 0..D {
                displacements[first * D + d] = displacements[second * D + d] + opening[d];
            }
        }
    }

    /// Traction that pulls the faces of a pair together, along its directions [stress].
    ///
    /// - `displacements`: complete ones
    /// - `load_factor`: factor on all loads
    pub fn traction(&self, pair: usize, displacements: &[f64], load_factor: f64) -> impl Iterator<Item = f64> + '_ {
        let (row, own) = (&self.rows[pair], &self.pairs[pair]);
        let mut sum = -row.load * load_factor;
        for (j, block) in row.columns.iter().zip(&row.blocks) {
            let u = &displacements[*j as usize * D..(*j as usize + 1) * D];
            for a in 0..D {
                for b in 0..D {
                    sum[a] += block[a][b] * u[b];
                }
            }
        }
        own.directions.iter().map(move |e| e.dot(&sum) / own.scale)
    }
}
