//! A packed tree of boxes: which boxes meet a given one.
//!
//! Serves point clouds (boxes of no size), node supports and segments alike, for any grading.

use super::aabb::Aabb;
use crate::math::Vector;

const LEAF: usize = 4;
/// Bound of what rounding does to coordinates, over their size.
const ROUNDING: f64 = 1e-14;

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
        self.search(
            |b| b.intersects(query),
            |item| {
                visit(item);
                false
            },
        );
    }

    /// Whether `test` holds for one of the items whose boxes the segment between two points meets.
    #[inline]
    pub fn any_along(&self, from: Vector<D>, to: Vector<D>, test: impl FnMut(u32) -> bool) -> bool {
        let span = Span { middle: 0.5 * (from + to), half: 0.5 * (to - from) };
        self.search(|b| span.meets(b), test)
    }

    /// Asks for the items whose boxes `meets` accepts until the answer is yes; returns the last answer.
    #[inline]
    fn search(&self, meets: impl Fn(&Aabb<D>) -> bool, mut ask: impl FnMut(u32) -> bool) -> bool {
        if self.nodes.is_empty() {
            return false;
        }
        let mut stack = [0u32; 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let index = stack[depth];
            let node = &self.nodes[index as usize];
            if !meets(&node.bounds) {
                continue;
            }
            if node.count > 0 {
                for k in node.start..node.start + node.count {
                    if meets(&self.boxes[k as usize]) && ask(self.items[k as usize]) {
                        return true;
                    }
                }
            } else {
                stack[depth] = node.start;
                stack[depth + 1] = index + 1;
                depth += 2;
            }
        }
        false
    }

    /// Whether no box meets `query`.
    pub fn is_clear(&self, query: &Aabb<D>) -> bool {
        let mut clear = true;
        self.visit(query, |_| clear = false);
        clear
    }
}

/// A segment by its middle and half of it.
struct Span<const D: usize> {
    middle: Vector<D>,
    half: Vector<D>,
}

impl<const D: usize> Span<D> {
    /// Whether no axis separates the segment from a box [Ericson2005, section 5.3.3]; rounding errs towards yes.
    #[inline]
    fn meets(&self, b: &Aabb<D>) -> bool {
        let size = 0.5 * (b.upper - b.lower);
        let (from, reach) = (self.middle - 0.5 * (b.lower + b.upper), self.half.abs());
        let slack = ROUNDING * (from.amax() + size.amax() + reach.amax() + self.middle.amax());
        (0..D).all(|i| from[i].abs() <= size[i] + reach[i] + slack)
            && (0..D).all(|i| {
                (i + 1..D).all(|j| {
                    let turn = from[i] * self.half[j] - from[j] * self.half[i];
                    turn.abs() <= (size[i] + slack) * (reach[j] + slack) + (size[j] + slack) * (reach[i] + slack)
                })
            })
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

        #[test]
        fn no_box_along_a_segment_is_missed_and_few_others_are_found(
            points in proptest::collection::vec((0.0..1.0f64, 0.0..1.0f64, 0.0..1.0f64), 0..200),
            ends in ((0.0..1.0f64, 0.0..1.0f64, 0.0..1.0f64), (0.0..1.0f64, 0.0..1.0f64, 0.0..1.0f64)),
        ) {
            let vector = |(x, y, z): (f64, f64, f64)| Vector::<3>::new(x, y, z);
            let radius = 0.04;
            let boxes: Vec<_> = points.iter().map(|p| Aabb::around(vector(*p), Vector::repeat(radius))).collect();
            let (from, to) = (vector(ends.0), vector(ends.1));
            let mut found = vec![];
            BoxTree::new(&boxes).any_along(from, to, |i| {
                found.push(i as usize);
                false
            });
            for (i, p) in points.iter().enumerate() {
                let share = ((vector(*p) - from).dot(&(to - from)) / (to - from).norm_squared()).clamp(0.0, 1.0);
                let distance = vector(*p) - (from + share * (to - from));
                // Within the ball in the box it must be found, beyond the ball around the box it must not.
                prop_assert!(distance.norm() > radius || found.contains(&i));
                prop_assert!(distance.norm() <= 3f64.sqrt() * radius + 1e-12 || !found.contains(&i));
            }
        }
    }
}
