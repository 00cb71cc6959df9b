//! Loads that change over short ways: nodes stand closer there, or what acts on them does not add up to the load.

use super::spacing::Region;
use crate::crack::CrackSurface;
use crate::geometry::surface::Surface;
use crate::geometry::triangle::Triangle;
use crate::math::Vector3;
use crate::model::{SurfacePoint, VectorField};
use rayon::prelude::*;

/// Loads are looked at in pieces of this share of the largest spacing.
const PIECE: f64 = 1.0 / 4.0;
/// Spacing over the way in which a load would rise from nothing to its largest value. What acts on nodes is the load at each of
/// them: where it is less than about twice as wide as their spacing, they do not add up to it.
const RISE_FRACTION: f64 = 0.5;
/// No smaller share of the largest spacing is asked for by loads.
const LEAST_AT_LOADS: f64 = 1.0 / 4.0;
/// Tractions are looked at from this far inside, over the size of a piece.
const OFF: f64 = 1e-6;
/// Regions where tractions change fast, with the spacings that they ask for; near cracks, whose fields may be what acts
/// on the boundary, none.
///
/// - `tractions`: of each part of the body
pub fn load_regions(
    body: &Surface,
    tractions: &[&VectorField<3>],
    cracks: &[CrackSurface],
    largest: f64,
) -> Vec<(Region, f64)> {
    let mut regions = vec![];
    for (part, traction) in tractions.iter().enumerate() {
        if let VectorField::Function(_) = traction {
            let pieces = steep_pieces(body, part as u32, traction, cracks, largest, 1.0);
            let most = pieces.iter().map(|p| p.most).fold(0.0, f64::max);
            let asked = pieces.iter().map(|p| (Region::Triangle(p.corners), RISE_FRACTION * most / p.slope));
            regions.extend(asked.filter(|r| r.1 < largest).map(|(r, h)| (r, h.max(LEAST_AT_LOADS * largest))));
        }
    }
    regions
}

/// A traction on a piece of the boundary.
pub(super) struct Steep {
    pub corners: Triangle,
    normal: Vector3,
    /// Largest value [stress].
    pub most: f64,
    /// Change over its length [stress/length].
    pub slope: f64,
}

impl Steep {
    /// Its middle, seen from inside.
    pub fn middle(&self) -> SurfacePoint<3> {
        let position = self.corners.iter().sum::<Vector3>() / 3.0;
        let size = (self.corners[1] - self.corners[0]).norm();
        SurfacePoint { position, normal: self.normal, sight: position - self.normal * (OFF * size) }
    }
}

/// Pieces of a part, but those near cracks.
///
/// - `clear`: how near, over the largest spacing
pub(super) fn steep_pieces(
    body: &Surface,
    part: u32,
    traction: &VectorField<3>,
    cracks: &[CrackSurface],
    largest: f64,
    clear: f64,
) -> Vec<Steep> {
    let of_part: Vec<u32> = (0..body.triangles().len() as u32).filter(|t| body.part_of(*t) == part).collect();
    let pieces = of_part.into_par_iter().flat_map_iter(|t| pieces(body, t, traction, PIECE * largest));
    pieces.filter(|p| !is_near_crack(cracks, p.middle().position, clear * largest)).collect()
}

/// Whether a crack is nearer than `reach`.
pub(super) fn is_near_crack(cracks: &[CrackSurface], p: Vector3, reach: f64) -> bool {
    cracks.iter().any(|c| c.surface.closest_within(p, reach).is_some())
}

fn pieces(body: &Surface, triangle: u32, traction: &VectorField<3>, longest: f64) -> Vec<Steep> {
    let normal = body.normals()[triangle as usize];
    let value = |position: Vector3| {
        let sight = position - normal * (OFF * longest);
        traction.value(&SurfacePoint { position, normal, sight })
    };
    let mut found = vec![];
    body.for_each_piece(
        triangle,
        |_| longest,
        |corners| {
            let values = corners.map(value);
            let slope = |i: usize, j: usize| (values[i] - values[j]).norm() / (corners[i] - corners[j]).norm();
            let slope = slope(0, 1).max(slope(1, 2)).max(slope(2, 0));
            let most = values.iter().map(|v| v.norm()).fold(0.0, f64::max);
            found.push(Steep { corners, normal, most, slope });
        },
    );
    found
}

#[cfg(test)]
mod tests {
    use super::super::SolidSpacing;
    use super::*;
    use crate::geometry::aabb::Aabb;
    use crate::geometry::surface::makers::cuboid;

    fn block(size: f64) -> Surface {
        let upper = Vector3::repeat(size);
        Surface::closed(cuboid(Aabb { lower: Vector3::zeros(), upper }), 0.5).unwrap()
    }

    fn asked(body: &Surface, traction: impl Fn(Vector3) -> Vector3 + Send + Sync + Clone + 'static) -> SolidSpacing {
        let fields = vec![VectorField::of_position(traction); body.parts().len()];
        SolidSpacing::new(1.0, 0.3, load_regions(body, &fields.iter().collect::<Vec<_>>(), &[], 1.0))
    }

    #[test]
    fn narrow_loads_ask_for_close_nodes_and_wide_ones_do_not() {
        let body = block(10.0);
        let patch = |width: f64| move |p: Vector3| Vector3::z() * (1.0 - ((p.x - 5.0) / width).powi(2)).max(0.0);
        let (narrow, wide) = (asked(&body, patch(1.2)), asked(&body, patch(6.0)));
        for y in [0.5, 5.0] {
            assert!(narrow.at(Vector3::new(5.0, y, 10.0)) < 0.7);
            assert!((narrow.at(Vector3::new(3.8, y, 10.0)) / 1.2 - 0.28).abs() < 0.05);
            assert_eq!(narrow.at(Vector3::new(0.5, y, 10.0)), 1.0);
            assert_eq!(wide.at(Vector3::new(5.0, y, 10.0)), 1.0);
        }
        let linear = asked(&body, |p| Vector3::x() * (p.z - 5.0));
        assert_eq!(linear.at(Vector3::new(10.0, 5.0, 9.0)), 1.0);
    }
}
