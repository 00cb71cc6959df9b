//! How large the discs around a front may be.

use crate::fracture::DiscCut;
use crate::geometry::obstacles::{Opaque, OpaqueTriangles};
use crate::model::SolidModel;
use std::f64::consts::PI;

/// Largest disc over the spacing at the front, and the smallest that is of use.
const LARGEST_DISC: f64 = 8.0;
const SMALLEST_DISC: f64 = 2.0;
/// Directions in which a disc is probed.
const PROBES: usize = 24;
/// Share of a turn on each side of the crack that is not probed.
const BESIDE_CRACK: f64 = 0.02;
/// The crack is this near to where it should be, over the radius.
const ON_CRACK: f64 = 0.01;
/// A crack that has turned by more behind its front, as seen from that, is followed only if no smaller disc is without
/// such a turn [rad]: sharp kinks have fields of their own, which nodes at this distance do not resolve.
const TURN: f64 = 0.25;
/// More is not followed at all [rad].
const LARGEST_TURN: f64 = 1.0;

/// Radius of the largest disc around a front point that lies in the body with nothing but its own crack in it, up to
/// what is of use for the spacing `h`; none if that is too small.
pub(super) fn free_disc(
    model: &SolidModel,
    obstacles: &OpaqueTriangles,
    crack: usize,
    cut: &DiscCut<'_, 3>,
    h: f64,
) -> Option<f64> {
    let is_free = |r: f64, most: f64| {
        let above = cut.angle(r);
        let at = |k: usize| {
            let share = k as f64 / (PROBES - 1) as f64;
            cut.place(r, above - PI + 2.0 * PI * (share - 0.5) * (1.0 - 2.0 * BESIDE_CRACK))
        };
        let behind = cut.place(r, above);
        (above - PI).abs() <= most
            && (0..PROBES).all(|k| model.body.contains(at(k)))
            && (1..PROBES).all(|k| obstacles.visible(at(k - 1), at(k)))
            && model.cracks[crack].surface.closest_within(behind, ON_CRACK * r).is_some()
    };
    for most in [TURN, LARGEST_TURN] {
        let mut r = LARGEST_DISC * h;
        while r >= SMALLEST_DISC * h {
            if [1.0, 0.75, 0.5, 0.25].iter().all(|share| is_free(share * r, most)) {
                return Some(r);
            }
            r *= 0.9;
        }
    }
    None
}
