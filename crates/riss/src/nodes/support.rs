//! Support radii from the distances to visible neighbors [EFG, Eq. 2].

use super::Nodes;
use crate::geometry::aabb::Aabb;
use crate::geometry::obstacles::Obstacles;
use crate::geometry::tree::BoxTree;
use crate::math::Vector2;
use rayon::prelude::*;

/// Distance from each node to its `k`-th nearest visible neighbor along each axis, or `guess` times a large factor if
/// there is none.
///
/// Lengths are counted in `step`: the steps of a grid, so that a neighbor along the longer one is as near as one along
/// the shorter; equal steps for irregular nodes. `guess` is a typical distance to neighbors at each node, from which
/// the search starts.
pub fn neighbor_distances(
    nodes: &Nodes<2>,
    obstacles: &Obstacles,
    guess: &[f64],
    k: usize,
    step: Vector2,
) -> Vec<Vector2> {
    let scaled: Vec<Vector2> = nodes.positions.iter().map(|p| p.component_div(&step)).collect();
    let tree = BoxTree::of_points(&scaled);
    let one = |i: usize| {
        let (p, sight) = (scaled[i], nodes.sights[i]);
        let mut radius = 1.5 * guess[i] / step.max();
        let mut distances = Vec::with_capacity(32);
        for _ in 0..24 {
            distances.clear();
            let query = Aabb::around(p, Vector2::repeat(radius));
            tree.visit(&query, |j| {
                let j = j as usize;
                let d = (scaled[j] - p).norm();
                if j != i && d <= radius && obstacles.visible(sight, nodes.sights[j]) {
                    distances.push(d);
                }
            });
            if distances.len() >= k {
                break;
            }
            radius *= 1.6;
        }
        if distances.len() < k {
            return step * radius;
        }
        step * *distances.select_nth_unstable_by(k - 1, f64::total_cmp).1
    };
    (0..nodes.len()).into_par_iter().map(one).collect()
}
