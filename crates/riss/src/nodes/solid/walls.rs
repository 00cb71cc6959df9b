//! Walls: where a body is thinner than some spacings, nodes stand closer, or they would not see it bend.

use super::spacing::{Region, SolidSpacing};
use crate::geometry::surface::Surface;
use crate::geometry::triangle::Triangle;
use crate::math::Vector3;

/// Spacings through a wall that nodes are placed for.
const THROUGH: f64 = 4.0;
/// The spacing in a wall is no less than this share of the largest.
const LEAST: f64 = 1.0 / 8.0;
/// Triangles are looked at in pieces of this share of the size of the body, or of some spacings.
const PIECE: f64 = 1.0 / 16.0;
const PIECE_SPACINGS: f64 = 2.0;

/// A thin place of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// A piece of its surface.
    pub corners: Triangle,
    /// Its thickness there [length].
    pub thickness: f64,
}

/// Pieces of the surface behind which the body is thinner than [`THROUGH`] times `largest`.
fn walls(body: &Surface, largest: f64) -> Vec<Wall> {
    let longest = (PIECE * body.bounds().size().norm()).max(PIECE_SPACINGS * largest);
    let mut found = vec![];
    for t in 0..body.triangles().len() as u32 {
        body.for_each_piece(
            t,
            |_| longest,
            |corners| {
                let middle = corners.iter().sum::<Vector3>() / 3.0;
                if let Some(thickness) = body.wall(t, middle, THROUGH * largest) {
                    found.push(Wall { corners, thickness });
                }
            },
        );
    }
    found
}

/// Regions with the spacing that their walls ask for.
pub fn wall_regions(body: &Surface, largest: f64) -> Vec<(Region, f64)> {
    let spacing = |w: &Wall| (w.thickness / THROUGH).max(LEAST * largest);
    walls(body, largest).iter().map(|w| (Region::Triangle(w.corners), spacing(w))).filter(|r| r.1 < largest).collect()
}

/// The wall with the fewest spacings through it, if there are fewer than `least`, and how many there are.
pub fn thinnest_wall(body: &Surface, spacing: &SolidSpacing, least: f64) -> Option<(Wall, f64)> {
    let through = |w: Wall| (w, w.thickness / spacing.at(w.corners.iter().sum::<Vector3>() / 3.0));
    let all = walls(body, spacing.largest()).into_iter().map(through);
    all.filter(|w| w.1 < least).min_by(|a, b| a.1.total_cmp(&b.1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::aabb::Aabb;
    use crate::geometry::surface::Shape;
    use crate::geometry::surface::makers::cuboid;
    use crate::geometry::surface::mesh::TriangleMesh;

    fn cuboid_of(size: Vector3) -> Surface {
        Surface::closed(cuboid(Aabb { lower: Vector3::zeros(), upper: size }), 0.5).unwrap()
    }

    #[test]
    fn nodes_stand_closer_in_thin_plates_alone() {
        let spacing = |size: Vector3, largest: f64| {
            SolidSpacing::new(largest, 0.2, wall_regions(&cuboid_of(size), largest)).at(0.5 * size)
        };
        assert_eq!(spacing(Vector3::new(1.0, 1.0, 1.0), 0.2), 0.2);
        // A quarter of the thickness, and what it grows by on the way to the middle.
        assert!((spacing(Vector3::new(1.0, 1.0, 0.2), 0.1) - 0.07).abs() < 1e-12);
        // No wall asks for less than an eighth of the largest spacing.
        assert!((spacing(Vector3::new(1.0, 1.0, 0.01), 0.1) - 0.0135).abs() < 1e-12);
        let thin = cuboid_of(Vector3::new(1.0, 1.0, 0.01));
        let field = SolidSpacing::new(0.1, 0.2, wall_regions(&thin, 0.1));
        let (wall, through) = thinnest_wall(&thin, &field, 3.0).unwrap();
        assert!((wall.thickness - 0.01).abs() < 1e-12 && (through - 0.8).abs() < 1e-9);
    }

    /// A wedge of 45 degrees has no wall at its edge.
    #[test]
    fn edges_are_no_walls() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
        let at = |k: usize, y: f64| Vector3::new(corners[k % 3][0], y, corners[k % 3][1]);
        let mut mesh = TriangleMesh::default();
        let part = mesh.add_part("wedge", Shape::Triangles);
        mesh.push([at(0, 0.0), at(1, 0.0), at(2, 0.0)], part);
        mesh.push([at(0, 3.0), at(2, 3.0), at(1, 3.0)], part);
        for k in 0..3 {
            mesh.push([at(k, 0.0), at(k + 1, 3.0), at(k + 1, 0.0)], part);
            mesh.push([at(k, 0.0), at(k, 3.0), at(k + 1, 3.0)], part);
        }
        let wedge = Surface::closed(mesh, 0.5).unwrap();
        assert!((wedge.volume() - 1.5).abs() < 1e-12);
        assert_eq!(wall_regions(&wedge, 0.2), vec![]);
    }
}
