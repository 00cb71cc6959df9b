//! Where supports end amid a surface.
//!
//! Nodes that are held there would make the support wider by half a spacing on each side, and nodes that are free narrower:
//! with the end midway between the last node that is held and the first one that is free, the error is of higher order. So
//! nodes there get neither condition, but the displacement that the nodes around give, as long as others hold the support.

use super::node_conditions::part;
use crate::geometry::point_tree::PointTree;
use crate::math::Vector;
use crate::model::Solid;
use crate::nodes::cloud::{Cloud, Facet, Place, SurfaceId};

/// Sine of the angle by which a surface may turn where it goes on smoothly.
const SMOOTH: f64 = 0.3;
/// How near a node that is held must be, over the spacing.
const REACH: f64 = 2.0;

/// Whether supports end at each node, with others that hold them nearby.
pub(super) fn support_ends<const D: usize>(solid: &Solid<D>, cloud: &Cloud<D>) -> Vec<bool> {
    let mut held: Vec<Vec<Vector<D>>> = vec![vec![]; solid.parts.len()];
    let mut ends = vec![];
    for (node, place) in cloud.places.iter().enumerate() {
        let Place::Surface(facets) = place else { continue };
        for facet in facets {
            let SurfaceId::Part(own) = facet.surface else { continue };
            match ends_at(solid, cloud.positions[node], facet, facets) {
                true => ends.push((node, own as usize)),
                false => held[own as usize].push(cloud.positions[node]),
            }
        }
    }
    let tree = |(k, p): (usize, &Vec<Vector<D>>)| ends.iter().any(|e| e.1 == k).then(|| PointTree::new(p));
    let trees: Vec<Option<PointTree<D>>> = held.iter().enumerate().map(tree).collect();
    let mut found = vec![false; cloud.len()];
    for (node, own) in ends {
        let nearest = trees[own].as_ref().and_then(|t| t.nearest(cloud.positions[node]));
        let distance = nearest.map(|j| (held[own][j as usize] - cloud.positions[node]).norm());
        found[node] |= distance.is_some_and(|d| d <= REACH * cloud.spacings[node]);
    }
    found
}

/// Whether what a facet prescribes ends at a node while the surface goes on smoothly.
pub(super) fn ends_at<const D: usize>(
    solid: &Solid<D>,
    position: Vector<D>,
    facet: &Facet<D>,
    facets: &[Facet<D>],
) -> bool {
    let Some(own) = part(solid, facet) else { return false };
    let goes_on = |other: &&Facet<D>| {
        let off = other.sight - position;
        let along = off - other.normal * off.dot(&other.normal);
        along.norm() > 0.0 && along.dot(&facet.normal).abs() < SMOOTH * along.norm()
    };
    own.displacements.iter().any(|d| {
        let direction = d.unit(facet.normal);
        let is_free = |other: &Facet<D>| part(solid, other).is_none_or(|p| p.is_free(direction, other.normal));
        facets.iter().filter(|o| o.surface != facet.surface).filter(goes_on).any(is_free)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Elasticity, PlaneState};
    use crate::model::{RigidMotion, SurfaceConditions, VectorField};

    type V = Vector<2>;

    fn solid(parts: Vec<SurfaceConditions<2>>) -> Solid<2> {
        let material = Elasticity { young: 1.0, poisson: 0.3, plane: PlaneState::Strain };
        let zero = VectorField::zero();
        Solid { material, parts, faces: vec![], body_force: zero, rigid_motion: RigidMotion::Supported }
    }

    fn facet(part: u32, normal: V, along: V) -> Facet<2> {
        Facet { surface: SurfaceId::Part(part), normal, sight: (along - normal) * 1e-6, angle: 1.0 }
    }

    #[test]
    fn supports_end_amid_a_surface_but_not_at_edges() {
        let solid =
            solid(vec![SurfaceConditions::symmetry(), SurfaceConditions::free(), SurfaceConditions::symmetry()]);
        let ends = |other: Facet<2>| {
            let own = facet(0, V::y(), -V::x());
            ends_at(&solid, V::zeros(), &own, &[own.clone(), other])
        };
        assert!(ends(facet(1, V::y(), V::x())));
        assert!(!ends(facet(2, V::y(), V::x())), "the next part holds too");
        assert!(!ends(facet(1, V::x(), -V::y())), "convex");
        assert!(!ends(facet(1, V::x(), V::y())), "concave");
    }

    #[test]
    fn ends_hold_where_nothing_else_does() {
        let solid = solid(vec![SurfaceConditions::symmetry(), SurfaceConditions::free()]);
        let mut cloud = Cloud::default();
        let end = |along: V| Place::Surface(vec![facet(0, V::y(), along), facet(1, V::y(), -along)]);
        cloud.push(V::zeros(), -V::y(), 1.0, end(V::x()));
        cloud.push(V::x() * 1.5, -V::y(), 1.0, end(-V::x()));
        assert_eq!(support_ends(&solid, &cloud), [false, false]);
        cloud.push(V::x() * 0.7, -V::y(), 1.0, Place::Surface(vec![facet(0, V::y(), V::zeros())]));
        assert_eq!(support_ends(&solid, &cloud), [true, true, false]);
    }
}
