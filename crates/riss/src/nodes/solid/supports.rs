//! Narrow supports: where they end amid a surface, nodes stand close enough to tell how wide they are.

use super::spacing::Region;
use crate::geometry::surface::Surface;
use crate::geometry::triangle::area_vector;
use crate::model::SurfaceConditions;

/// Spacing over the width of a support.
const WIDTH_FRACTION: f64 = 1.0 / 5.0;
/// No smaller share of the largest spacing is asked for by supports.
const LEAST_AT_SUPPORTS: f64 = 1.0 / 8.0;
/// Sine by which a surface may turn down at the end of a support: at edges of the body supports do not end.
const SMOOTH: f64 = 0.3;

/// Regions of narrow supports with the spacings that they ask for.
///
/// - `conditions`: of each part of the body
pub fn support_regions(body: &Surface, conditions: &[SurfaceConditions<3>], largest: f64) -> Vec<(Region, f64)> {
    let mut regions = vec![];
    for (part, own) in conditions.iter().enumerate().filter(|(_, c)| !c.displacements.is_empty()) {
        let triangles: Vec<u32> =
            (0..body.triangles().len() as u32).filter(|t| body.part_of(*t) as usize == part).collect();
        let (mut area, mut ends) = (0.0, 0.0);
        for t in &triangles {
            let (corners, normal) = (body.corners(*t), body.normals()[*t as usize]);
            area += 0.5 * area_vector(corners).norm();
            for (k, other) in (0..3).filter_map(|k| Some((k, body.across(*t, k)?))) {
                let edge = corners[(k + 1) % 3] - corners[k];
                let along = body.normals()[other as usize].cross(&edge).normalize();
                let beyond = &conditions[body.part_of(other) as usize];
                let is_end =
                    own.displacements.iter().any(|d| beyond.is_free(d.unit(normal), body.normals()[other as usize]));
                // Into the neighbor, which lies on the other side of the edge.
                if is_end && body.part_of(other) as usize != part && (-along).dot(&normal) > -SMOOTH {
                    ends += edge.norm();
                }
            }
        }
        // Twice the area over the length around: of a strip its width, of a disk its radius.
        let spacing = WIDTH_FRACTION * 2.0 * area / ends;
        if spacing < largest {
            let spacing = spacing.max(LEAST_AT_SUPPORTS * largest);
            regions.extend(triangles.iter().map(|t| (Region::Triangle(body.corners(*t)), spacing)));
        }
    }
    regions
}

#[cfg(test)]
mod tests {
    use super::super::SolidSpacing;
    use super::*;
    use crate::geometry::aabb::Aabb;
    use crate::geometry::surface::makers::cuboid;
    use crate::geometry::surface::{Shape, TriangleMesh};
    use crate::math::Vector3;
    use crate::model::VectorField;

    /// A block of edge 10 with the parts `rest` and, across its upper side around the middle, `strip`.
    fn block(width: f64) -> Surface {
        let mesh = cuboid(Aabb { lower: Vector3::zeros(), upper: Vector3::repeat(10.0) });
        let mut surface = Surface::closed(mesh, 0.5).unwrap();
        for level in [5.0 - 0.5 * width, 5.0 + 0.5 * width] {
            let cut = |p: Vector3, q: Vector3| {
                let s = (level - p.x) / (q.x - p.x);
                ((p.x - level) * (q.x - level) < -1e-12).then(|| p + s * (q - p))
            };
            let (vertices, triangles) = surface.subdivided(cut);
            let mut mesh = TriangleMesh { vertices, triangles, ..TriangleMesh::default() };
            let parts = ["rest", "strip"].map(|name| mesh.add_part(name, Shape::Triangles));
            let middle = |t: &[u32; 3]| t.map(|v| mesh.vertices[v as usize]).iter().sum::<Vector3>() / 3.0;
            let in_strip = |p: Vector3| p.z > 10.0 - 1e-9 && (p.x - 5.0).abs() < 0.5 * width;
            mesh.part_of = mesh.triangles.iter().map(|t| parts[usize::from(in_strip(middle(t)))]).collect();
            surface = Surface::closed(mesh, 0.5).unwrap();
        }
        surface
    }

    #[test]
    fn narrow_supports_ask_for_close_nodes() {
        let held = || SurfaceConditions::displacement(VectorField::zero());
        let at = |width: f64, conditions: &[SurfaceConditions<3>]| {
            let regions = support_regions(&block(width), conditions, 1.0);
            SolidSpacing::new(1.0, 0.3, regions).at(Vector3::new(5.0, 5.0, 10.0))
        };
        assert!((at(1.5, &[SurfaceConditions::free(), held()]) - 0.3).abs() < 1e-9);
        assert_eq!(at(0.1, &[SurfaceConditions::free(), held()]), 0.125);
        assert_eq!(at(6.0, &[SurfaceConditions::free(), held()]), 1.0);
        // What goes on as it is does not end, nor does what is loaded.
        assert_eq!(at(1.5, &[held(), held()]), 1.0);
        assert_eq!(at(1.5, &[SurfaceConditions::free(), SurfaceConditions::free()]), 1.0);
    }
}
