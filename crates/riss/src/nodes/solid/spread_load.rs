//! Loads that nodes cannot follow, such as narrow ones with kinks, spread over about a spacing.
//!
//! What acts on a node is the load at its place. Spread by a kernel whose second moments are zero, the load keeps its resultant
//! and its moment, smooth loads stay as they are up to third order, and what nodes a spacing apart take of it adds up.

use super::SolidSpacing;
use super::loads::{Steep, is_near_crack, steep_pieces};
use crate::crack::CrackSurface;
use crate::geometry::surface::Surface;
use crate::geometry::surface::makers::across;
use crate::math::gauss_legendre::gauss_legendre;
use crate::math::{Vector2, Vector3};
use crate::model::{SurfacePoint, VectorField};
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Radius of the kernel over the spacing. Of a load that changes from node to node and back it leaves nothing.
const RADIUS: f64 = 1.45;
/// A load is spread if that changes it by more than this share of its largest value anywhere.
const NOTICED: f64 = 0.02;
/// Nothing is spread nearer to cracks, over the spacing: what acts there may be the field of the crack.
const CLEAR: f64 = 3.0;
/// Points of the kernel along the radius and around.
const RADIAL: usize = 6;
const ANGULAR: usize = 16;

/// A load and what spreads it.
struct Spread {
    load: VectorField<3>,
    spacing: SolidSpacing,
    cracks: Vec<CrackSurface>,
    /// Points in a disc of unit radius, with weights.
    kernel: Vec<(Vector2, f64)>,
}

impl Spread {
    fn value(&self, at: &SurfacePoint<3>) -> Vector3 {
        let spacing = self.spacing.at(at.position);
        if is_near_crack(&self.cracks, at.position, CLEAR * spacing) {
            return self.load.value(at);
        }
        let [s, t] = across(at.normal);
        let inward = at.sight - at.position;
        let there = |p: &Vector2| {
            let position = at.position + (s * p.x + t * p.y) * (RADIUS * spacing);
            self.load.value(&SurfacePoint { position, normal: at.normal, sight: position + inward })
        };
        self.kernel.iter().map(|(p, weight)| there(p) * *weight).sum()
    }

    /// Whether nodes cannot follow the load.
    fn is_noticed(&self, pieces: &[Steep]) -> bool {
        let most = pieces.iter().map(|p| p.most).fold(0.0, f64::max);
        pieces.par_iter().any(|piece| {
            let at = piece.middle();
            let may_change = piece.slope * RADIUS * self.spacing.at(at.position) > NOTICED * most;
            may_change && (self.value(&at) - self.load.value(&at)).norm() > NOTICED * most
        })
    }
}

/// `(4 - 6 r²)/π` over the disc of unit radius: its integral is one, its second moments are zero.
fn kernel() -> Vec<(Vector2, f64)> {
    let angles = (0..ANGULAR).map(|k| TAU * k as f64 / ANGULAR as f64);
    let ring = |(r, w): (f64, f64)| {
        let weight = w * 2.0 * r * (4.0 - 6.0 * r * r) / ANGULAR as f64;
        angles.clone().map(move |a| (Vector2::new(a.cos(), a.sin()) * r, weight)).collect::<Vec<_>>()
    };
    gauss_legendre(RADIAL).into_iter().flat_map(ring).collect()
}

/// The load on a part of a body spread over about a spacing, if nodes could not follow it as it is.
pub fn spread_load(
    body: &Surface,
    part: u32,
    load: &VectorField<3>,
    cracks: &[CrackSurface],
    spacing: &SolidSpacing,
) -> Option<VectorField<3>> {
    let pieces = steep_pieces(body, part, load, cracks, spacing.largest(), CLEAR);
    let spread = Spread { load: load.clone(), spacing: spacing.clone(), cracks: cracks.to_vec(), kernel: kernel() };
    if !spread.is_noticed(&pieces) {
        return None;
    }
    let spread = Arc::new(spread);
    Some(VectorField::Function(Arc::new(move |at| spread.value(at))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::aabb::Aabb;
    use crate::geometry::surface::makers::cuboid;

    fn spread(load: impl Fn(Vector3) -> f64 + Send + Sync + 'static) -> Option<VectorField<3>> {
        let upper = Vector3::repeat(10.0);
        let body = Surface::closed(cuboid(Aabb { lower: Vector3::zeros(), upper }), 0.5).unwrap();
        let top = body.parts().iter().position(|p| p.name == "z-max").unwrap() as u32;
        let load = VectorField::of_position(move |p| Vector3::z() * load(p));
        spread_load(&body, top, &load, &[], &SolidSpacing::uniform(1.0))
    }

    fn at(x: f64) -> SurfacePoint<3> {
        let position = Vector3::new(x, 5.0, 10.0);
        SurfacePoint { position, normal: Vector3::z(), sight: position - Vector3::z() * 1e-6 }
    }

    #[test]
    fn sums_over_nodes_are_those_of_the_load_wherever_they_stand() {
        let patch = |width: f64| move |p: Vector3| (1.0 - ((p.x - 5.0) / width).powi(2)).max(0.0);
        for width in [0.6, 1.0, 1.7, 2.4] {
            let load = spread(patch(width)).unwrap();
            for start in [0.0, 0.2, 0.5, 0.7] {
                let sum = |value: &dyn Fn(f64) -> f64| (0..10).map(|k| value(start + k as f64)).sum::<f64>();
                let exact = 4.0 / 3.0 * width;
                let found = sum(&|x| load.value(&at(x)).z);
                let plain = sum(&|x| patch(width)(Vector3::new(x, 0.0, 0.0)));
                assert!((found / exact - 1.0).abs() < 0.025, "{width} {start}: {found} {plain} {exact}");
                let moment = sum(&|x| load.value(&at(x)).z * (x - 5.0)) / exact;
                assert!(moment.abs() < 0.07, "{width} {start}: {moment}");
            }
        }
    }

    #[test]
    fn loads_that_nodes_follow_stay_as_they_are() {
        assert!(spread(|p| 1.0 + p.x - 0.3 * p.y * p.x + 0.1 * p.x.powi(3)).is_none());
        assert!(spread(|p| (0.4 * p.x).sin()).is_none());
        assert!(spread(|p| if p.x < 5.0 { 1.0 } else { 0.0 }).is_some());
    }
}
