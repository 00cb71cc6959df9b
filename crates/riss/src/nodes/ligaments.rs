//! Material between a crack and what it runs beside: the boundary, a hole, another crack.

use super::spacing::SpacingField;
use crate::crack::meetings::shared_vertices;
use crate::crack::{CrackPath, End, EndKind};
use crate::geometry::aabb::Aabb;
use crate::geometry::predicates::distance_to_segment;
use crate::geometry::tree::BoxTree;
use crate::math::Vector2;
use crate::model::Model;

/// Spacing as a fraction of the ligament.
const FRACTION: f64 = 1.0 / 4.0;
/// A wall that a crack touches lies beside it if their angle has a smaller sine.
const BESIDE: f64 = 0.3;
/// Steps along a path are at least this part of its length.
const LEAST_STEP: f64 = 1e-3;

/// Asks for nodes across every ligament beside a crack that the field does not resolve yet.
pub(super) fn add(field: &mut SpacingField, model: &Model) {
    let segments: Vec<(usize, [Vector2; 2])> =
        model.cracks.iter().enumerate().flat_map(|(k, c)| c.segments().map(move |(a, b)| (k, [a, b]))).collect();
    let tree = BoxTree::new(&segments.iter().map(|s| Aabb::of_points(s.1)).collect::<Vec<_>>());
    // Where cracks start from a wall or end at one: no ligament gets thinner than the distance from there allows.
    let shared = shared_vertices(&model.cracks).into_iter().map(|m| m.place);
    let contacts: Vec<Vector2> = model.cracks.iter().flat_map(contacts).chain(shared).collect();
    for (index, crack) in model.cracks.iter().enumerate() {
        let mut wanted = vec![];
        let least = LEAST_STEP * crack.length();
        walk(crack, least, |p| {
            let mut distance = model.domain.distance_to_boundary(p);
            // The way to the next point is as long as the ligament, so none is passed over.
            tree.visit(&Aabb::around(p, Vector2::repeat(distance)), |i| {
                let (other, [a, b]) = segments[i as usize];
                if other != index {
                    distance = distance.min(distance_to_segment(p, a, b));
                }
            });
            let from_contact = contacts.iter().map(|c| (c - p).norm()).fold(f64::INFINITY, f64::min);
            // A step from a contact or less, the angle may be rounding.
            if from_contact > least && distance < BESIDE * from_contact {
                wanted.push((p, FRACTION * distance));
            }
            distance
        });
        for (p, spacing) in wanted {
            if spacing > 0.0 && field.at(p) > spacing {
                field.add_point(p, spacing);
            }
        }
    }
}

fn contacts(crack: &CrackPath) -> impl Iterator<Item = Vector2> + '_ {
    let is_contact = |e: &End| crack.end_kind(*e) != EndKind::Tip;
    [End::Start, End::End].into_iter().filter(is_contact).map(|e| crack.end_position(e))
}

/// Visits points along a path; `visit` returns how far the next one may be, but it is `least` away.
fn walk(crack: &CrackPath, least: f64, mut visit: impl FnMut(Vector2) -> f64) {
    let mut before = 0.0;
    let mut next = 0.0;
    for (a, b) in crack.segments() {
        let along = (b - a).norm();
        while next <= before + along {
            next += visit(a + (b - a) * ((next - before) / along)).max(least);
        }
        before += along;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curve::Curve;
    use crate::model::Domain;
    use crate::nodes::settings::Graded;

    /// Two cracks of a random plate: the way along the second comes to the meeting but for the last bits.
    #[test]
    fn a_crack_that_ends_on_another_asks_for_no_vanishing_spacing() {
        let point = |p: &[f64; 2]| Vector2::new(p[0], p[1]);
        let corners = [[0.0, 0.0], [10.0, 0.0], [10.0, 8.0], [0.0, 8.0]].map(|p| point(&p));
        let outline = (0..4).map(|k| Curve::Line { start: corners[k], end: corners[(k + 1) % 4] }).collect();
        let mut model = Model::plain(Domain::new(outline, vec![]));
        let meeting = [0.23401534753073747, 3.0222651029728245];
        let ending = [
            [0.9441155681814026, 3.277611040861346],
            [0.6620430677570649, 3.175458681591665],
            [0.3702146555627349, 3.1059160483647283],
            meeting,
        ];
        let through = [
            [0.0, 3.2464389600250048],
            meeting,
            [0.5297098167206706, 2.739006033143664],
            [1.0182801199944411, 2.71788682207563],
            [1.3181424051950341, 2.7087978224454043],
            [1.4417206574162111, 2.7826114415805305],
        ];
        let crack = |vertices: &[[f64; 2]], ends| {
            let vertices = vertices.iter().map(point).collect();
            CrackPath { name: "crack".into(), vertices, ends }
        };
        model.cracks =
            vec![crack(&ending, [EndKind::Tip, EndKind::Junction]), crack(&through, [EndKind::Mouth, EndKind::Tip])];
        let field = SpacingField::of_model(&model, &Graded { spacing: None, tip_spacing: Some(0.05), growth: None });
        assert!(field.at(point(&meeting)) > 0.01, "{}", field.at(point(&meeting)));
    }
}
