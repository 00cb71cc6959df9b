//! An order of nodes in which parts of a body stand side by side and what separates them comes last [George1973].
//!
//! Parts of one stage do not meet in the matrix, so that they are factored and solved at the same time. The order
//! depends on the nodes alone, not on the number of threads.

use super::block_rows::BlockRows;
use crate::geometry::aabb::Aabb;
use crate::math::Vector;
use std::ops::Range;

/// A part with fewer nodes is not divided.
const LEAST_NODES: usize = 40_000;
/// Times that a part is divided.
const MOST_CUTS: usize = 2;
/// Share of the nodes on one side of a cut. Not half of them: cracks like the middle of bodies, and factors lose most where
/// a cut runs along a front.
const LEFT_SHARE: f64 = 0.42;

/// The order, and where its parts stand.
#[derive(Clone, Debug)]
pub struct Dissection {
    /// Node at each place.
    pub order: Vec<u32>,
    /// Place of each node.
    pub places: Vec<u32>,
    /// Places of the parts, stage by stage: those inside first, then what separates two of them, and so on.
    pub stages: Vec<Vec<Range<usize>>>,
}

impl Dissection {
    /// Divides nodes by the pattern of their matrix; within a part they keep their order.
    pub fn new<const D: usize>(matrix: &BlockRows<D>, positions: &[Vector<D>]) -> Self {
        let n = positions.len();
        let mut cuts = Cuts { matrix, positions, sides: vec![NONE; n], parts: vec![vec![]; MOST_CUTS + 1] };
        cuts.divide((0..n as u32).collect(), MOST_CUTS);
        let (mut order, mut stages) = (Vec::with_capacity(n), vec![]);
        for parts in cuts.parts {
            let mut stage = vec![];
            for part in parts.into_iter().filter(|p| !p.is_empty()) {
                stage.push(order.len()..order.len() + part.len());
                order.extend(part);
            }
            if !stage.is_empty() {
                stages.push(stage);
            }
        }
        let mut places = vec![0; n];
        order.iter().enumerate().for_each(|(place, &node)| places[node as usize] = place as u32);
        Self { order, places, stages }
    }
}

const NONE: u8 = 0;
const LEFT: u8 = 1;
const RIGHT: u8 = 2;
const BETWEEN: u8 = 3;

/// A dissection while it is made.
struct Cuts<'a, const D: usize> {
    matrix: &'a BlockRows<D>,
    positions: &'a [Vector<D>],
    /// Side of each node of the part that is being cut.
    sides: Vec<u8>,
    /// Parts by the number of cuts below them.
    parts: Vec<Vec<Vec<u32>>>,
}

impl<const D: usize> Cuts<'_, D> {
    fn divide(&mut self, nodes: Vec<u32>, cuts_left: usize) {
        if cuts_left == 0 || nodes.len() < LEAST_NODES {
            self.parts[0].push(nodes);
            return;
        }
        let along = |i: u32, axis: usize| self.positions[i as usize][axis];
        let size = Aabb::of_points(nodes.iter().map(|&i| self.positions[i as usize])).size();
        let axis = size.imax();
        let mut coordinates: Vec<f64> = nodes.iter().map(|&i| along(i, axis)).collect();
        let n_left = (LEFT_SHARE * coordinates.len() as f64) as usize;
        let (_, cut, _) = coordinates.select_nth_unstable_by(n_left, f64::total_cmp);
        let sides: Vec<u8> = nodes.iter().map(|&i| if along(i, axis) < *cut { LEFT } else { RIGHT }).collect();
        nodes.iter().zip(sides).for_each(|(&i, side)| self.sides[i as usize] = side);
        self.separate(&nodes);
        let of_side = |side: u8| nodes.iter().copied().filter(|&i| self.sides[i as usize] == side).collect::<Vec<_>>();
        let (left, right, between) = (of_side(LEFT), of_side(RIGHT), of_side(BETWEEN));
        nodes.iter().for_each(|&i| self.sides[i as usize] = NONE);
        self.parts[cuts_left].push(between);
        self.divide(left, cuts_left - 1);
        self.divide(right, cuts_left - 1);
    }

    /// Moves the nodes on the right that meet any on the left in between.
    fn separate(&mut self, nodes: &[u32]) {
        for &i in nodes {
            let meets = |j: &u32| self.sides[*j as usize] == LEFT;
            match self.sides[i as usize] {
                LEFT => {
                    for &j in self.matrix.row(i as usize).0 {
                        let side = &mut self.sides[j as usize];
                        if *side == RIGHT {
                            *side = BETWEEN;
                        }
                    }
                }
                RIGHT if self.matrix.row(i as usize).0.iter().any(meets) => self.sides[i as usize] = BETWEEN,
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::block_rows::{CHUNK, RowChunk};

    /// A long row of nodes, each of which meets its neighbors; some only one way.
    #[test]
    fn parts_of_a_stage_do_not_meet() {
        let n = 70_000usize;
        let positions: Vec<Vector<2>> = (0..n).map(|i| Vector::<2>::new(i as f64, (i % 7) as f64)).collect();
        let columns = |i: usize| [i.saturating_sub(3), i, (i + 2 + i % 3).min(n - 1)];
        let mut chunks = vec![];
        for start in (0..n).step_by(CHUNK) {
            let mut chunk = RowChunk::default();
            for i in start..(start + CHUNK).min(n) {
                let mut row: Vec<(u32, [[f64; 2]; 2])> = columns(i).map(|j| (j as u32, [[1.0; 2]; 2])).to_vec();
                row.sort_unstable_by_key(|e| e.0);
                chunk.push(&row);
            }
            chunks.push(chunk);
        }
        let matrix = BlockRows::new(chunks);
        let found = Dissection::new(&matrix, &positions);
        assert!(found.stages.len() > 1 && found.stages[0].len() > 1, "{:?}", found.stages);
        assert!((0..n).all(|i| found.order[found.places[i] as usize] as usize == i));
        let mut part_of = vec![0; n];
        for (stage, parts) in found.stages.iter().enumerate() {
            for (k, part) in parts.iter().enumerate() {
                part.clone().for_each(|place| part_of[found.order[place] as usize] = 100 * stage + k);
            }
        }
        for i in 0..n {
            for &j in matrix.row(i).0 {
                let (a, b) = (part_of[i], part_of[j as usize]);
                assert!(a == b || a / 100 != b / 100, "{i} {j}: {a} {b}");
            }
        }
    }
}
