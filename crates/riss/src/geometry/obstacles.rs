//! Opaque segments and triangles: what sight lines cannot pass.

use super::aabb::Aabb;
use super::predicates::segment_is_cut;
use super::surface::Surface;
use super::tree::BoxTree;
use super::triangle::{self, Triangle, cuts_segment};
use crate::math::{Vector, Vector2, Vector3};
use rayon::prelude::*;

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
        !self.tree.any_along(a, b, |i| {
            let [c, d] = self.segments[i as usize];
            segment_is_cut(a, b, c, d)
        })
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

    /// Whether nothing in a box can hide anything; false if that is not known.
    fn is_clear(&self, _bounds: &Aabb<D>) -> bool {
        false
    }
}

impl Opaque<2> for Obstacles {
    fn visible(&self, from: Vector2, to: Vector2) -> bool {
        Obstacles::visible(self, from, to)
    }

    fn is_clear(&self, bounds: &Aabb<2>) -> bool {
        self.tree.is_clear(bounds)
    }
}

/// Opaque triangles with a tree over them.
#[derive(Clone, Debug)]
pub struct OpaqueTriangles {
    triangles: Vec<Triangle>,
    tree: BoxTree<3>,
}

impl OpaqueTriangles {
    /// Makes the tree.
    pub fn new(triangles: Vec<Triangle>) -> Self {
        let boxes: Vec<_> = triangles.iter().map(|t| triangle::bounds(*t)).collect();
        Self { triangles, tree: BoxTree::new(&boxes) }
    }

    /// The triangles.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }
}

impl Opaque<3> for OpaqueTriangles {
    fn visible(&self, from: Vector3, to: Vector3) -> bool {
        !self.tree.any_along(from, to, |i| cuts_segment(self.triangles[i as usize], from, to))
    }

    fn is_clear(&self, bounds: &Aabb<3>) -> bool {
        self.tree.is_clear(bounds)
    }
}

/// The triangles of a closed surface that can stand between two points of its inside: those that have some of the
/// surface in front of them.
pub fn opaque_part(surface: &Surface) -> Vec<Triangle> {
    let tolerance = 1e-9 * surface.bounds().size().norm();
    let rises = |t: &u32| {
        let (a, normal) = (surface.corners(*t)[0], surface.normals()[*t as usize]);
        surface.vertices().iter().any(|p| (p - a).dot(&normal) > tolerance)
    };
    (0..surface.triangles().len() as u32).into_par_iter().filter(rises).map(|t| surface.corners(t)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::surface::makers::{ball, cuboid};
    use super::*;

    #[test]
    fn only_what_is_not_convex_is_opaque() {
        let v = Vector3::new;
        let mut mesh = cuboid(Aabb { lower: v(0.0, 0.0, 0.0), upper: v(4.0, 4.0, 4.0) });
        assert!(opaque_part(&Surface::closed(mesh.clone(), 0.5).unwrap()).is_empty());
        mesh.append(&ball(v(2.0, 2.0, 2.0), 1.0, "void"));
        let obstacles = OpaqueTriangles::new(opaque_part(&Surface::closed(mesh, 0.5).unwrap()));
        assert_eq!(obstacles.triangles().len(), 20 * 256);
        assert!(!obstacles.visible(v(0.5, 2.0, 2.0), v(3.5, 2.0, 2.0)));
        assert!(obstacles.visible(v(0.5, 3.01, 2.0), v(3.5, 3.01, 2.0)));
        assert!(!obstacles.visible(v(0.5, 2.9, 2.0), v(3.5, 2.9, 2.0)));
    }
}
