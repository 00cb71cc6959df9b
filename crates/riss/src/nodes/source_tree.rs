//! A tree over what asks for a spacing: the least one at a point without asking all.

use crate::geometry::aabb::Aabb;
use crate::math::Vector;

/// Sources in a leaf.
const LEAF: usize = 4;
/// Bounds are lowered by this part, so that rounding hides no source: the answer has the bits of a scan of all.
const ROUNDING: f64 = 1e-12;

/// Sources in a binary tree, split at the median of the longest side.
#[derive(Clone, Debug)]
pub(super) struct SourceTree<const D: usize> {
    branches: Vec<Branch<D>>,
    order: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Branch<const D: usize> {
    bounds: Aabb<D>,
    /// Least spacing of all sources below.
    least: f64,
    /// First source of a leaf, or the index of the second child (the first one follows its parent).
    start: u32,
    /// Number of sources of a leaf, 0 for a branch with children.
    count: u32,
}

impl<const D: usize> SourceTree<D> {
    /// Builds the tree over the box and the spacing of each source.
    pub fn new(boxes: &[Aabb<D>], spacings: &[f64]) -> Self {
        let mut tree = Self { branches: vec![], order: (0..boxes.len() as u32).collect() };
        let mut order = std::mem::take(&mut tree.order);
        if !order.is_empty() {
            tree.build(boxes, spacings, &mut order, 0);
        }
        tree.order = order;
        tree
    }

    fn build(&mut self, boxes: &[Aabb<D>], spacings: &[f64], items: &mut [u32], offset: usize) {
        let bounds = items.iter().fold(Aabb::empty(), |b, &i| b.union(boxes[i as usize]));
        let least = items.iter().map(|&i| spacings[i as usize]).fold(f64::INFINITY, f64::min);
        let index = self.branches.len();
        self.branches.push(Branch { bounds, least, start: offset as u32, count: items.len() as u32 });
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
        let (first, second) = items.split_at_mut(middle);
        self.build(boxes, spacings, first, offset);
        self.branches[index].start = self.branches.len() as u32;
        self.branches[index].count = 0;
        self.build(boxes, spacings, second, offset + middle);
    }

    /// The least of `start` and the values of all sources.
    ///
    /// - `growth`: slope of the spacing with the distance from a source
    /// - `value`: spacing that a source asks for at the point [length]
    pub fn least(&self, p: Vector<D>, growth: f64, start: f64, value: impl Fn(u32) -> f64) -> f64 {
        let mut best = start;
        if self.branches.is_empty() {
            return best;
        }
        let bound = |index: u32| {
            let branch = &self.branches[index as usize];
            let outside = (branch.bounds.lower - p).sup(&(p - branch.bounds.upper)).sup(&Vector::zeros());
            (branch.least + growth * outside.norm()) * (1.0 - ROUNDING)
        };
        let mut stack = [(0u32, 0.0); 64];
        stack[0] = (0, bound(0));
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let (index, lowest) = stack[depth];
            if lowest > best {
                continue;
            }
            let branch = &self.branches[index as usize];
            if branch.count > 0 {
                let items = &self.order[branch.start as usize..][..branch.count as usize];
                best = items.iter().fold(best, |b, &i| b.min(value(i)));
                continue;
            }
            let children = [index + 1, branch.start].map(|c| (c, bound(c)));
            let nearer = usize::from(children[1].1 < children[0].1);
            stack[depth] = children[1 - nearer];
            stack[depth + 1] = children[nearer];
            depth += 2;
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector2;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn finds_the_bits_of_a_scan(
            sources in proptest::collection::vec((0.0..1.0f64, 0.0..1.0f64, 1e-6..0.2f64), 0..200),
            query in (-0.5..1.5f64, -0.5..1.5f64),
            growth in 0.02..1.0f64,
        ) {
            let points: Vec<_> = sources.iter().map(|s| Vector2::new(s.0, s.1)).collect();
            let boxes: Vec<_> = points.iter().map(|p| Aabb { lower: *p, upper: *p }).collect();
            let spacings: Vec<_> = sources.iter().map(|s| s.2).collect();
            let p = Vector2::new(query.0, query.1);
            let value = |i: u32| spacings[i as usize] + growth * (p - points[i as usize]).norm();
            let scan = (0..points.len() as u32).map(value).fold(0.3, f64::min);
            let found = SourceTree::new(&boxes, &spacings).least(p, growth, 0.3, value);
            prop_assert_eq!(found.to_bits(), scan.to_bits());
        }
    }
}
