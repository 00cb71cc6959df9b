//! Integration points along the boundary of the body.

use super::cells::edge_rule;
use super::settings::IntegrationSettings;
use crate::geometry::aabb::Aabb;
use crate::math::Vector2;
use crate::math::turn_left;
use crate::model::{Domain, EdgeId, FieldPoint};
use crate::nodes::Triangulation;
use crate::nodes::triangulation::SIGHT_SHIFT;

/// A stretch of boundary between two neighboring points.
#[derive(Clone, Debug)]
pub struct BoundaryElement {
    /// Edge of the domain.
    pub edge: EdgeId,
    /// Copies of the triangulation at both ends.
    pub ends: [u32; 2],
    /// Length [length].
    pub length: f64,
    /// Gauss points.
    pub points: Vec<BoundaryPoint>,
}

/// An integration point on the boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundaryPoint {
    /// Position.
    pub position: Vector2,
    /// From where visibility is asked: slightly inside.
    pub sight: Vector2,
    /// Outward unit normal.
    pub normal: Vector2,
    /// Integration weight [length].
    pub weight: f64,
    /// Parameter along the element, 0 at its first end.
    pub along: f64,
}

impl BoundaryPoint {
    /// What boundary values depend on.
    pub fn field_point(&self) -> FieldPoint {
        FieldPoint { position: self.position, normal: self.normal }
    }
}

impl BoundaryElement {
    /// The least box around the points.
    pub fn bounds(&self) -> Aabb<2> {
        Aabb::of_points(self.points.iter().flat_map(|p| [p.position, p.sight]))
    }
}

/// Elements along the whole boundary, with the points that the cells beside them use.
pub fn boundary_elements(
    triangulation: &Triangulation,
    domain: &Domain,
    settings: &IntegrationSettings,
) -> Vec<BoundaryElement> {
    let line = edge_rule(settings);
    let element = |s: &crate::nodes::BoundarySegment| {
        let curve = match domain.edges[s.edge] {
            arc @ crate::geometry::curve::Curve::Arc { .. } => arc.piece(s.range[0], s.range[1]),
            _ => {
                let [start, end] = s.points.map(|c| triangulation.position(c));
                crate::geometry::curve::Curve::Line { start, end }
            }
        };
        let points = line
            .iter()
            .map(|&(along, w)| {
                let velocity = curve.velocity(along);
                let right = -turn_left(velocity);
                let position = curve.point(along);
                let weight = w * velocity.norm();
                BoundaryPoint {
                    position,
                    sight: position - right * SIGHT_SHIFT,
                    normal: right.normalize(),
                    weight,
                    along,
                }
            })
            .collect();
        BoundaryElement { edge: s.edge, ends: s.points, length: curve.length(), points }
    };
    triangulation.boundary.iter().map(element).collect()
}
