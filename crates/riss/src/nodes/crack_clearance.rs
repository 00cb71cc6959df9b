//! Room for particles along cracks among nodes that are given.

use super::generation::BOUNDARY_CLEARANCE;
use crate::crack::CrackForm;
use crate::geometry::aabb::Aabb;
use crate::geometry::predicates::distance_to_segment;
use crate::geometry::tree::BoxTree;
use crate::math::Vector2;
use crate::model::Model;

/// A node this close to a crack stands on it, over the spacing.
const ON_CRACK: f64 = 1e-6;

/// Which of the given nodes can stay beside the particles of cracks.
pub(super) struct CrackClearance {
    segments: Vec<[Vector2; 2]>,
    tree: BoxTree<2>,
}

impl CrackClearance {
    /// Asks for no room where cracks are paths.
    pub fn new(model: &Model, form: CrackForm) -> Self {
        let segments: Vec<[Vector2; 2]> = match form {
            CrackForm::Path => vec![],
            CrackForm::Particles => model.cracks.iter().flat_map(|c| c.segments().map(|(a, b)| [a, b])).collect(),
        };
        let boxes: Vec<_> = segments.iter().map(|s| Aabb::of_points(*s)).collect();
        Self { segments, tree: BoxTree::new(&boxes) }
    }

    /// Whether a node is clear of all cracks, or stands on one and will be cracked: but not close to a vertex, where a
    /// particle of its own stands.
    pub fn admits(&self, p: Vector2, spacing: f64) -> bool {
        let room = BOUNDARY_CLEARANCE * spacing;
        let mut nearest = f64::INFINITY;
        let mut to_vertex = f64::INFINITY;
        self.tree.visit(&Aabb::around(p, Vector2::repeat(room)), |i| {
            let [a, b] = self.segments[i as usize];
            nearest = nearest.min(distance_to_segment(p, a, b));
            to_vertex = to_vertex.min((p - a).norm()).min((p - b).norm());
        });
        let on = ON_CRACK * spacing;
        to_vertex <= on || (to_vertex > room && (nearest <= on || nearest > room))
    }
}
