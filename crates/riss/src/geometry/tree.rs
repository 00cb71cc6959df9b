//! A packed tree of boxes: which boxes meet a given one.
//!
//! Serves point clouds (boxes of no size), node supports and segments alike, for any grading.

use super::aabb::Aabb;
use crate::math::Vector;

const LEAF: usize = 4;

/// Boxes in a binary tree, split at the median of the longest side; built once, then only read.
#[derive(Clone, Debug)]
pub struct BoxTree<const D: usize> {
    nodes: Vec<TreeNode<D>>,
    boxes: Vec<Aabb<D>>,
    items: Vec<u32>,
}

#[derive(Clone, Debug)]
struct TreeNode<const D: usize> {
    bounds: Aabb<D>,
    /// First item of a leaf, or the index of the right child (the left one follows its parent).
    start: u32,
    /// Number of items of a leaf, 0 for an inner node.
    count: u32,
}

impl<const D: usize> BoxTree<D> {
    /// Builds the tree; item `i` of a query answer is `boxes[i]`.
    pub fn new(boxes: &[Aabb<D>]) -> Self {
        let mut items: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut nodes = Vec::with_capacity(2 * boxes.len() / LEAF + 1);
        if !boxes.is_empty() {
            build(boxes, &mut items, 0, &mut nodes);
        }
        let boxes = items.iter().map(|&i| boxes[i as usize]).collect();
        Self { nodes, boxes, items }
    }

    /// Builds the tree of points.
    pub fn of_points(points: &[Vector<D>]) -> Self {
        Self::new(&points.iter().map(|p| Aabb { lower: *p, upper: *p }).collect::<Vec<_>>())
    }

    /// Calls `visit` with every item whose box meets `query`, in an order that depends only on the tree.
    #[inline]
    pub fn visit(&self, query: &Aabb<D>, mut visit: impl FnMut(u32)) {
        if self.nodes.is_empty() {
            return;
        }
        let mut stack = [0u32; 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            if !node.bounds.intersects(query) {
                continue;
            }
            if node.count > 0 {
                for k in node.start..node.start + node.count {
                    if self.boxes[k as usize].intersects(query) {
                        visit(self.items[k as usize]);
                    }
                }
            } else {
                stack[depth] = node.start;
                stack[depth + 1] = index + 1;
                depth += 2;
            }
        }
    }

    /// Whether no box meets `query`.
    pub fn is_clear(&self, query: &Aabb<D>) -> bool {
        let mut clear = true;
        self.visit(query, |_| clear = false);
        clear
    }
}

fn build<const D: usize>(boxes: &[Aabb<D>], items: &mut [u32], offset: usize, nodes: &mut Vec<TreeNode<D>>) {
    let bounds = items.iter().fold(Aabb::empty(), |b, &i| b.union(boxes[i as usize]));
    let index = nodes.len();
    nodes.push(TreeNode { bounds, start: offset as u32, count: items.len() as u32 });
    if items.len() <= LEAF {
        return;
    }
    let centers = items.iter().fold(Aabb::empty(), |b, &i| b.including(boxes[i as usize].center()));
    let axis = centers.size().imax();
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |&a, &b| {
        let (p, q) = (boxes[a as usize].center()[axis], boxes[b as usize].center()[axis]);
        p.total_cmp(&q).then(a.cmp(&b))
    });
    let (left, right) = items.split_at_mut(middle);
    build(boxes, left, offset, nodes);
    nodes[index].start = nodes.len() as u32;
    nodes[index].count = 0;
    build(boxes, right, offset + middle, nodes);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn finds_what_a_naive_search_finds(
            points in proptest::collection::vec((0.0..1.0f64, 0.0..1.0f64, 0.0..0.2f64), 0..200),
            query in (0.0..1.0f64, 0.0..1.0f64, 0.0..0.3f64),
        ) {
            let make = |(x, y, r): (f64, f64, f64)| Aabb::around(Vector::<2>::new(x, y), Vector::repeat(r));
            let boxes: Vec<_> = points.into_iter().map(make).collect();
            let query = make(query);
            let mut found = vec![];
            BoxTree::new(&boxes).visit(&query, |i| found.push(i as usize));
            found.sort();
            let naive: Vec<usize> = (0..boxes.len()).filter(|&i| boxes[i].intersects(&query)).collect();
            prop_assert_eq!(found, naive);
        }
    }
}
