//! Opaque segments: what sight lines cannot pass.

use super::aabb::Aabb;
use super::predicates::segment_is_cut;
use super::tree::BoxTree;
use crate::math::{Vector, Vector2};

/// Opaque segments with a tree over them.
#[derive(Clone, Debug)]
pub struct Obstacles {
    segments: Vec<[Vector2; 2]>,
    tree: BoxTree<2>,
}

impl Obstacles {
    /// Makes the tree.
    pub fn new(segments: Vec<[Vector2; 2]>) -> Self {
        let boxes: Vec<_> = segments.iter().map(|s| Aabb::of_points(*s)).collect();
        Self { segments, tree: BoxTree::new(&boxes) }
    }

    /// The segments.
    pub fn segments(&self) -> &[[Vector2; 2]] {
        &self.segments
    }

    /// Whether no obstacle cuts the segment from `a` to `b`; touching at `a` or `b` does not cut.
    pub fn visible(&self, a: Vector2, b: Vector2) -> bool {
        let mut clear = true;
        self.tree.visit(&Aabb::of_points([a, b]), |i| {
            let [c, d] = self.segments[i as usize];
            clear = clear && !segment_is_cut(a, b, c, d);
        });
        clear
    }

    /// Indices of the obstacles near a box, into a buffer.
    pub fn near_into(&self, bounds: &Aabb<2>, found: &mut Vec<u32>) {
        found.clear();
        self.tree.visit(bounds, |i| found.push(i));
    }

    /// The same as [`Self::visible`] for obstacles that were looked up before.
    #[inline]
    pub fn visible_past(&self, near: &[u32], a: Vector2, b: Vector2) -> bool {
        near.iter().all(|&i| {
            let [c, d] = self.segments[i as usize];
            !segment_is_cut(a, b, c, d)
        })
    }
}

/// What sight lines cannot pass, in any dimension.
pub trait Opaque<const D: usize>: Sync {
    /// Whether nothing cuts the segment from `from` to `to`; touching at an end does not cut.
    fn visible(&self, from: Vector<D>, to: Vector<D>) -> bool;
}

impl Opaque<2> for Obstacles {
    fn visible(&self, from: Vector2, to: Vector2) -> bool {
        Obstacles::visible(self, from, to)
    }
}
