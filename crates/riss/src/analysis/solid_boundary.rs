//! Fields on the boundary of a solid, on small triangles that end at its cracks.

use super::solid_static::Solved;
use crate::approximation::{FitBuffer, ShapeFunctions};
use crate::error::Result;
use crate::math::{Matrix, Vector3};
use crate::model::SolidModel;
use crate::nodes::solid::SolidSpacing;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// Triangles at most, unless the body has more; where more would be as fine as the nodes, they are larger.
const MOST_TRIANGLES: usize = 24_000;
/// How much larger they get in a round: edges are halved, so that less could change nothing.
const COARSER: f64 = 2.0;
/// An edge is cut by a crack where that is further than this from its ends, over its length.
const LEAST_PART: f64 = 0.02;
/// Halvings that find where an edge is cut.
const HALVINGS: usize = 40;
/// A vertex is on a crack within this distance, over the size of triangles there.
const ON_CRACK: f64 = 1e-3;
/// How far inside the body a place is seen from, over the size of triangles there.
const INSIDE: f64 = 5e-3;

/// Fields on the boundary of a solid.
#[derive(Clone, Debug, Default)]
pub struct BoundaryFields {
    /// Vertices; two in one place on the two faces of a crack.
    pub positions: Vec<Vector3>,
    /// Corners of triangles, counterclockwise as seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Displacements [length]; not a number where the nodes around do not determine them.
    pub displacements: Vec<Vector3>,
    /// Stresses [stress], likewise.
    pub stresses: Vec<Matrix<3>>,
}

/// Triangles with the places from which their vertices are seen.
#[derive(Default)]
struct Skin {
    positions: Vec<Vector3>,
    sights: Vec<Vector3>,
    triangles: Vec<[u32; 3]>,
}

/// Evaluates a solution on the boundary.
pub(super) fn boundary_fields(solved: &Solved, model: &SolidModel, spacing: &SolidSpacing) -> BoundaryFields {
    let mut factor = 1.0;
    let mut skin = Skin::new(model, &|p| factor * spacing.at(p));
    while skin.triangles.len() > MOST_TRIANGLES {
        factor *= COARSER;
        let coarser = Skin::new(model, &|p| factor * spacing.at(p));
        // The body itself may have more.
        if coarser.triangles.len() >= skin.triangles.len() {
            break;
        }
        skin = coarser;
    }
    let unknown = (Vector3::repeat(f64::NAN), Matrix::repeat(f64::NAN));
    let one = |(fit, shape): &mut (FitBuffer<3>, ShapeFunctions<3>), k: usize| {
        let found: Result<_> = solved.at(skin.positions[k], skin.sights[k], fit, shape);
        found.unwrap_or(unknown)
    };
    let values: Vec<_> = (0..skin.positions.len()).into_par_iter().map_init(Default::default, one).collect();
    let (displacements, stresses) = values.into_iter().unzip();
    BoundaryFields { positions: skin.positions, triangles: skin.triangles, displacements, stresses }
}

impl Skin {
    /// Splits the triangles of the body to a size, and at its cracks.
    fn new(model: &SolidModel, size: &dyn Fn(Vector3) -> f64) -> Self {
        let split = |p: Vector3, q: Vector3| {
            let middle = 0.5 * (p + q);
            let cut = model.cracks.iter().find_map(|c| crossing(|r| c.surface.cuts(p, r), p, q));
            cut.or_else(|| ((p - q).norm() > 1.5 * size(middle)).then_some(middle))
        };
        let (vertices, triangles) = model.body.subdivided(split);
        let mut skin = Self::default();
        let mut copies: FxHashMap<(u32, Option<(usize, bool)>), u32> = FxHashMap::default();
        for corners in triangles {
            let places = corners.map(|v| vertices[v as usize]);
            let middle = places.iter().sum::<Vector3>() / 3.0;
            let inward = (places[2] - places[0]).cross(&(places[1] - places[0])).normalize();
            let copy = [0, 1, 2].map(|k| {
                let (vertex, place) = (corners[k], places[k]);
                let size = size(place);
                let side = side_of_crack(model, place, middle, ON_CRACK * size);
                let copy = *copies.entry((vertex, side.map(|s| s.0))).or_insert_with(|| {
                    skin.positions.push(place);
                    skin.sights.push(place + side.map_or(Vector3::zeros(), |s| s.1 * (INSIDE * size)));
                    skin.positions.len() as u32 - 1
                });
                // Of all triangles at a vertex, so that places on edges are seen from within the body.
                skin.sights[copy as usize] += inward * (INSIDE * size);
                copy
            });
            skin.triangles.push(copy);
        }
        skin
    }
}

/// Where a segment is cut for the first time from `p` on, if not right at its ends.
fn crossing(is_cut_before: impl Fn(Vector3) -> bool, p: Vector3, q: Vector3) -> Option<Vector3> {
    if !is_cut_before(q) {
        return None;
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let half = 0.5 * (low + high);
        if is_cut_before(p + half * (q - p)) { high = half } else { low = half }
    }
    (LEAST_PART..=1.0 - LEAST_PART).contains(&high).then(|| p + high * (q - p))
}

/// The crack that a vertex is on and the side of it that a triangle around `middle` is on, with the way there.
fn side_of_crack(model: &SolidModel, vertex: Vector3, middle: Vector3, limit: f64) -> Option<((usize, bool), Vector3)> {
    model.cracks.iter().enumerate().find_map(|(c, crack)| {
        let foot = crack.surface.closest_within(vertex, limit)?;
        let normal = crack.surface.normal_at(foot.triangle, foot.position);
        let is_positive = (middle - foot.position).dot(&normal) > 0.0;
        Some(((c, is_positive), if is_positive { normal } else { -normal }))
    })
}
