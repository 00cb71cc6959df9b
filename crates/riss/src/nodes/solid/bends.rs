//! Bent walls: nodes stand closer there, or their equations hold the wall of a hole only loosely.

use super::spacing::Region;
use crate::geometry::surface::Surface;
use crate::geometry::triangle::area_vector;

/// Spacing over the radius of a bent wall: equations at nodes farther apart hold the wall of a hole only loosely.
const BEND_FRACTION: f64 = 1.0 / 4.0;
/// No smaller share of the largest spacing is asked for by bends.
const LEAST_AT_BENDS: f64 = 1.0 / 8.0;
/// Way around a bend from one triangle to the next over the sum of their heights: 1/2 for strips, 1/3 if they are equilateral.
const HEIGHTS: f64 = 0.4;
/// Angles between triangles of a bent wall [rad]: less is flat, more is an edge.
const BENDS: [f64; 2] = [1e-3, 0.5];

/// Regions of bent walls with the spacings that they ask for.
pub fn bend_regions(body: &Surface, largest: f64) -> Vec<(Region, f64)> {
    let mut regions = vec![];
    for t in 0..body.triangles().len() as u32 {
        let (corners, normal) = (body.corners(t), body.normals()[t as usize]);
        let radius = |k: usize| {
            let other = body.across(t, k)?;
            let next = body.normals()[other as usize];
            let angle = normal.cross(&next).norm().atan2(normal.dot(&next));
            let edge = (corners[(k + 1) % 3] - corners[k]).norm();
            let heights = [t, other].map(|t| area_vector(body.corners(t)).norm() / edge);
            (angle > BENDS[0] && angle < BENDS[1]).then(|| HEIGHTS * (heights[0] + heights[1]) / angle)
        };
        let least = (0..3).filter_map(radius).fold(f64::INFINITY, f64::min);
        if BEND_FRACTION * least < largest {
            regions.push((Region::Triangle(corners), (BEND_FRACTION * least).max(LEAST_AT_BENDS * largest)));
        }
    }
    regions
}

#[cfg(test)]
mod tests {
    use super::super::SolidSpacing;
    use super::*;
    use crate::geometry::aabb::Aabb;
    use crate::geometry::surface::makers::{ball, cuboid};
    use crate::math::Vector3;

    fn block(size: f64) -> Surface {
        let upper = Vector3::repeat(size);
        Surface::closed(cuboid(Aabb { lower: Vector3::zeros(), upper }), 0.5).unwrap()
    }

    #[test]
    fn walls_of_narrow_holes_ask_for_close_nodes() {
        assert!(bend_regions(&block(4.0), 1.0).is_empty());
        let mut mesh = block(4.0).mesh();
        mesh.append(&ball(Vector3::repeat(2.0), 0.8, "void"));
        let field = SolidSpacing::new(0.5, 0.2, bend_regions(&Surface::closed(mesh, 0.5).unwrap(), 0.5));
        assert!((field.at(Vector3::new(2.0, 2.0, 2.8)) - 0.2).abs() < 0.05);
        assert_eq!(field.at(Vector3::new(0.1, 0.1, 0.1)), 0.5);
    }
}
