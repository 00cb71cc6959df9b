//! A packed tree of points: which of them lie in a ball.

use super::aabb::Aabb;
use crate::math::Vector;

const LEAF: usize = 16;

/// Points in a binary tree, split at the median of the longest side; built once, then only read.
#[derive(Clone, Debug)]
pub struct PointTree<const D: usize> {
    nodes: Vec<TreeNode<D>>,
    /// Points in the order of the leaves, with their indices.
    points: Vec<(Vector<D>, u32)>,
}

#[derive(Clone, Debug)]
struct TreeNode<const D: usize> {
    bounds: Aabb<D>,
    /// First point of a leaf, or the index of the right child (the left one follows its parent).
    start: u32,
    /// Number of points of a leaf, 0 for an inner node.
    count: u32,
}

impl<const D: usize> PointTree<D> {
    /// Builds the tree.
    pub fn new(points: &[Vector<D>]) -> Self {
        let mut items: Vec<_> = points.iter().zip(0..).map(|(p, i)| (*p, i)).collect();
        let mut nodes = Vec::with_capacity(4 * points.len() / LEAF + 1);
        if !items.is_empty() {
            build(&mut items, 0, &mut nodes);
        }
        Self { nodes, points: items }
    }

    /// Squared distances from `center` and indices of the points no farther than `radius`, in an order that depends only on
    /// the tree.
    pub fn within_into(&self, center: Vector<D>, radius: f64, found: &mut Vec<(f64, u32)>) {
        found.clear();
        if self.nodes.is_empty() {
            return;
        }
        let r2 = radius * radius;
        let mut stack = [0u32; 64];
        let (mut depth, mut n) = (1, 0);
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            // Whoever is in reach by rounding of the box is decided by its own distance.
            if node.bounds.squared_distance(&center) > r2 * (1.0 + 1e-12) {
                continue;
            }
            if node.count == 0 {
                stack[depth] = node.start;
                stack[depth + 1] = index + 1;
                depth += 2;
                continue;
            }
            let leaf = &self.points[node.start as usize..][..node.count as usize];
            found.resize(n + leaf.len(), (0.0, 0));
            // Every point is written, and overwritten by the next if it is out of reach: no branch to guess.
            for (p, i) in leaf {
                let d2 = (p - center).norm_squared();
                found[n] = (d2, *i);
                n += usize::from(d2 <= r2);
            }
        }
        found.truncate(n);
    }

    /// Index of the point nearest to `center`, of the first of those as near; none if there are no points.
    pub fn nearest(&self, center: Vector<D>) -> Option<u32> {
        let mut best = (f64::INFINITY, u32::MAX);
        let mut stack = [0u32; 64];
        let mut depth = usize::from(!self.nodes.is_empty());
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            if node.bounds.squared_distance(&center) > best.0 * (1.0 + 1e-12) {
                continue;
            }
            if node.count > 0 {
                for (p, i) in &self.points[node.start as usize..][..node.count as usize] {
                    let d2 = (p - center).norm_squared();
                    if d2 < best.0 || (d2 == best.0 && *i < best.1) {
                        best = (d2, *i);
                    }
                }
                continue;
            }
            // The nearer half is looked at first.
            let [left, right] = [index + 1, node.start];
            let distance = |i: u32| self.nodes[i as usize].bounds.squared_distance(&center);
            let halves = if distance(left) <= distance(right) { [right, left] } else { [left, right] };
            stack[depth..depth + 2].copy_from_slice(&halves);
            depth += 2;
        }
        (best.1 != u32::MAX).then_some(best.1)
    }
}

fn build<const D: usize>(items: &mut [(Vector<D>, u32)], offset: usize, nodes: &mut Vec<TreeNode<D>>) {
    let bounds = Aabb::of_points(items.iter().map(|i| i.0));
    let index = nodes.len();
    nodes.push(TreeNode { bounds, start: offset as u32, count: items.len() as u32 });
    if items.len() <= LEAF {
        return;
    }
    let axis = bounds.size().imax();
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1)));
    let (left, right) = items.split_at_mut(middle);
    build(left, offset, nodes);
    nodes[index].start = nodes.len() as u32;
    nodes[index].count = 0;
    build(right, offset + middle, nodes);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn finds_what_a_naive_search_finds(
            points in proptest::collection::vec((0.0..1.0f64, 0.0..1.0f64, 0.0..0.2f64), 0..300),
            center in (0.0..1.0f64, 0.0..1.0f64, 0.0..0.3f64),
            radius in 0.0..0.8f64,
        ) {
            let make = |(x, y, z)| Vector::<3>::new(x, y, z);
            let points: Vec<_> = points.into_iter().map(make).collect();
            let center = make(center);
            let mut found = vec![];
            PointTree::new(&points).within_into(center, radius, &mut found);
            found.sort_by_key(|f| f.1);
            let all = points.iter().zip(0..).map(|(p, i)| ((p - center).norm_squared(), i));
            let naive: Vec<(f64, u32)> = all.filter(|f| f.0 <= radius * radius).collect();
            prop_assert_eq!(found, naive);
            let order = |p: &(f64, u32), q: &(f64, u32)| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1));
            let all = points.iter().zip(0..).map(|(p, i)| ((p - center).norm_squared(), i));
            prop_assert_eq!(PointTree::new(&points).nearest(center), all.min_by(order).map(|f| f.1));
        }
    }
}
