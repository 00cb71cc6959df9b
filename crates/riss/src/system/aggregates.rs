//! Groups of nodes that move as one on the coarse level of the solver.
//!
//! Grown along neighbors that see each other, so that no group straddles a crack, except around its front.

use super::block_rows::BlockRows;
use crate::math::{Matrix, Vector};
use rayon::prelude::*;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Nearest visible neighbors along which groups grow.
const NEAREST: usize = 12;
/// Rounds in which the groups are centered.
const CENTERINGS: usize = 2;
/// Pieces of a first group with less than this share of its size are no seeds.
const LEAST_SHARE: usize = 6;
/// Marks nodes without a group.
pub const NO_GROUP: u32 = u32::MAX;

/// Groups of nodes.
#[derive(Clone, Debug)]
pub struct Aggregates {
    /// Group of each node; [`NO_GROUP`] for nodes that are held in all directions.
    pub of_node: Vec<u32>,
    /// Nodes of each group, ascending.
    pub members: Vec<Vec<u32>>,
}

impl Aggregates {
    /// Groups of about `size` nodes; nodes must be ordered such that near ones have near numbers.
    pub fn new<const D: usize>(
        positions: &[Vector<D>],
        matrix: &BlockRows<D>,
        fixed: &[Matrix<D>],
        size: usize,
    ) -> Self {
        let is_free: Vec<bool> = fixed.iter().map(|f| f.trace() < D as f64 - 0.5).collect();
        let graph: Vec<Vec<(f64, u32)>> = (0..positions.len())
            .into_par_iter()
            .map(|i| if is_free[i] { nearest(i, positions, matrix, &is_free) } else { vec![] })
            .collect();
        let mut seeds = first_seeds(positions, &graph, &is_free, size);
        let mut of_node = grow(&graph, &is_free, &mut seeds);
        for _ in 0..CENTERINGS {
            let members = members(&of_node, seeds.len());
            seeds = members.iter().filter(|m| !m.is_empty()).map(|m| central(positions, m)).collect();
            of_node = grow(&graph, &is_free, &mut seeds);
        }
        let members = members(&of_node, seeds.len());
        Self { of_node, members }
    }
}

/// The nearest of the free nodes in a row of the matrix.
fn nearest<const D: usize>(
    i: usize,
    positions: &[Vector<D>],
    matrix: &BlockRows<D>,
    is_free: &[bool],
) -> Vec<(f64, u32)> {
    let near = matrix.row(i).0.iter().filter(|&&j| j as usize != i && is_free[j as usize]);
    let mut near: Vec<(f64, u32)> = near.map(|&j| ((positions[j as usize] - positions[i]).norm(), j)).collect();
    let order = |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
    if near.len() > NEAREST {
        near.select_nth_unstable_by(NEAREST, order);
        near.truncate(NEAREST);
    }
    near.sort_unstable_by(order);
    near
}

fn members(of_node: &[u32], n: usize) -> Vec<Vec<u32>> {
    let mut members = vec![vec![]; n];
    for (i, &group) in of_node.iter().enumerate().filter(|g| *g.1 != NO_GROUP) {
        members[group as usize].push(i as u32);
    }
    members
}

/// The node nearest to the mean position of some.
fn central<const D: usize>(positions: &[Vector<D>], nodes: &[u32]) -> u32 {
    let mean = nodes.iter().fold(Vector::zeros(), |sum, &i| sum + positions[i as usize]) / nodes.len() as f64;
    let distance = |i: &u32| (positions[*i as usize] - mean).norm_squared();
    nodes.iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0)
}

/// Centers of the connected pieces of runs of nodes.
fn first_seeds<const D: usize>(
    positions: &[Vector<D>],
    graph: &[Vec<(f64, u32)>],
    is_free: &[bool],
    size: usize,
) -> Vec<u32> {
    let free: Vec<u32> = (0..positions.len() as u32).filter(|&i| is_free[i as usize]).collect();
    let n_runs = free.len().div_ceil(size);
    let mut run_of = vec![u32::MAX; positions.len()];
    let mut seeds = vec![];
    for run in 0..n_runs {
        let nodes = &free[run * free.len() / n_runs..(run + 1) * free.len() / n_runs];
        nodes.iter().for_each(|&i| run_of[i as usize] = run as u32);
        for &start in nodes {
            if run_of[start as usize] != run as u32 {
                continue;
            }
            let mut piece = vec![start];
            run_of[start as usize] = u32::MAX;
            let mut at = 0;
            while at < piece.len() {
                for &(_, j) in &graph[piece[at] as usize] {
                    if run_of[j as usize] == run as u32 {
                        run_of[j as usize] = u32::MAX;
                        piece.push(j);
                    }
                }
                at += 1;
            }
            if piece.len() * LEAST_SHARE >= size {
                seeds.push(central(positions, &piece));
            }
        }
    }
    seeds
}

/// Gives every node to the seed with the shortest way along the graph; pieces without a seed get one.
fn grow(graph: &[Vec<(f64, u32)>], is_free: &[bool], seeds: &mut Vec<u32>) -> Vec<u32> {
    let mut of_node = vec![NO_GROUP; graph.len()];
    let mut open: BinaryHeap<Reverse<(Length, u32, u32)>> =
        seeds.iter().enumerate().map(|(group, &node)| Reverse((Length(0.0), group as u32, node))).collect();
    let mut next = 0;
    loop {
        while let Some(Reverse((length, group, node))) = open.pop() {
            if of_node[node as usize] != NO_GROUP {
                continue;
            }
            of_node[node as usize] = group;
            for &(step, j) in &graph[node as usize] {
                if of_node[j as usize] == NO_GROUP {
                    open.push(Reverse((Length(length.0 + step), group, j)));
                }
            }
        }
        while next < graph.len() && (!is_free[next] || of_node[next] != NO_GROUP) {
            next += 1;
        }
        if next == graph.len() {
            return of_node;
        }
        open.push(Reverse((Length(0.0), seeds.len() as u32, next as u32)));
        seeds.push(next as u32);
    }
}

/// A length that can be ordered.
#[derive(Clone, Copy, PartialEq)]
struct Length(f64);

impl Eq for Length {}

impl PartialOrd for Length {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Length {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}
