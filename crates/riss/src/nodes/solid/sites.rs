//! Places of nodes, before those on cracks are split.

use super::CLEARANCE;
use super::bins::Bins;
use super::spacing::SolidSpacing;
use crate::crack::{CrackSurface, FrontPoint};
use crate::geometry::aabb::Aabb;
use crate::geometry::surface::{Foot, Surface};
use crate::geometry::tree::BoxTree;
use crate::geometry::triangle::area_vector;
use crate::math::Vector3;

/// A place for a node, or for two if it is on a crack.
#[derive(Clone, Copy, Debug)]
pub(super) struct Site {
    pub position: Vector3,
    pub spacing: f64,
    pub stand: Stand,
}

/// What a place is on.
#[derive(Clone, Copy, Debug)]
pub(super) enum Stand {
    /// The boundary; the crack is the one whose faces meet it there.
    Boundary { foot: Foot, crack: Option<u32> },
    /// The faces of a crack.
    Face { crack: u32, foot: Foot },
    /// The front of a crack, perhaps where it meets the boundary.
    Front { crack: u32, point: FrontPoint, foot: Option<Foot> },
    /// Nothing; surfaces are at least this far away [length].
    Inside { clearance: f64 },
}

/// All places, and what they must respect.
pub(super) struct Sites<'a> {
    pub body: &'a Surface,
    pub cracks: &'a [CrackSurface],
    pub spacing: &'a SolidSpacing,
    pub list: Vec<Site>,
    bins: Bins,
    /// Straight pieces of all fronts.
    fronts: Lines,
    /// Folds of each crack, where a row of nodes stands.
    pub folds: Vec<Vec<[Vector3; 2]>>,
    fold_lines: Lines,
}

/// Straight pieces of lines.
struct Lines {
    pieces: Vec<[Vector3; 2]>,
    tree: BoxTree<3>,
}

impl Lines {
    fn new(pieces: Vec<[Vector3; 2]>) -> Self {
        let boxes: Vec<_> = pieces.iter().map(|s| Aabb::of_points(*s)).collect();
        Self { pieces, tree: BoxTree::new(&boxes) }
    }

    fn is_near(&self, p: Vector3, distance: f64) -> bool {
        let mut near = false;
        self.tree.visit(&Aabb::around(p, Vector3::repeat(distance)), |i| {
            let [a, b] = self.pieces[i as usize];
            let e = b - a;
            let t = ((p - a).dot(&e) / e.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            near |= (p - a - e * t).norm() < distance;
        });
        near
    }
}

impl<'a> Sites<'a> {
    pub fn new(body: &'a Surface, cracks: &'a [CrackSurface], spacing: &'a SolidSpacing) -> Self {
        let fronts = cracks.iter().flat_map(|c| &c.fronts).flat_map(|f| f.segments().collect::<Vec<_>>());
        let folds: Vec<Vec<_>> = cracks.iter().map(|c| folds(&c.surface, spacing)).collect();
        let fold_lines = Lines::new(folds.iter().flatten().copied().collect());
        let fronts = Lines::new(fronts.collect());
        Self { body, cracks, spacing, list: vec![], bins: Bins::default(), fronts, folds, fold_lines }
    }

    /// Size of the whole body [length].
    pub fn size(&self) -> f64 {
        self.body.bounds().size().norm()
    }

    /// Whether nothing is nearer than `closeness` times the spacing.
    pub fn is_clear(&self, p: Vector3, spacing: f64, closeness: f64) -> bool {
        self.bins.is_clear(p, spacing, closeness)
    }

    /// Adds a place in any case.
    pub fn push(&mut self, position: Vector3, spacing: f64, stand: Stand) {
        self.bins.insert(position, spacing);
        self.list.push(Site { position, spacing, stand });
    }

    /// Whether fronts are nearer than a distance.
    pub fn is_near_front(&self, p: Vector3, distance: f64) -> bool {
        self.fronts.is_near(p, distance)
    }

    /// Whether folds of cracks are nearer than a distance.
    pub fn is_near_fold(&self, p: Vector3, distance: f64) -> bool {
        self.fold_lines.is_near(p, distance)
    }

    /// Distance to the boundary inside the body, up to a limit; none outside if the boundary is within the limit.
    pub fn depth(&self, p: Vector3, limit: f64) -> Option<f64> {
        match self.body.closest_within(p, limit) {
            None => Some(limit),
            Some(foot) => self.body.is_behind(p, &foot).then_some(foot.distance),
        }
    }

    /// Distance to the nearest crack, up to a limit.
    pub fn crack_distance(&self, p: Vector3, limit: f64) -> f64 {
        let distance = |c: &CrackSurface| c.surface.closest_within(p, limit).map_or(limit, |f| f.distance);
        self.cracks.iter().map(distance).fold(limit, f64::min)
    }

    /// Least distance that a node of a spacing keeps from surfaces and fronts.
    pub fn clearance(spacing: f64) -> f64 {
        CLEARANCE * spacing
    }

    /// Where to step to from a point, in a direction: as far as the mean of the spacings at both ends.
    pub fn step(&self, p: Vector3, spacing: f64, direction: Vector3) -> (Vector3, f64) {
        let there = self.spacing.at(p + direction * spacing);
        let q = p + direction * (0.5 * (spacing + there));
        (q, self.spacing.at(q))
    }
}

/// The folds of a crack that nodes can tell from a smooth bend: sharp edges, and others where the triangles at both sides are
/// wider than the spacing.
fn folds(surface: &Surface, spacing: &SolidSpacing) -> Vec<[Vector3; 2]> {
    let fold = |(t, k): (u32, usize)| {
        let corners = surface.corners(t);
        let ends = [corners[k], corners[(k + 1) % 3]];
        let other = surface.across(t, k)?;
        let height = |t: u32| area_vector(surface.corners(t)).norm() / (ends[1] - ends[0]).norm();
        let is_wide = height(t).min(height(other)) > spacing.at((ends[0] + ends[1]) * 0.5);
        (surface.is_sharp(t, k) || is_wide).then_some(ends)
    };
    surface.folds(super::FOLD).filter_map(fold).collect()
}

/// A number in [0, 1) that depends on nothing but two indices (SplitMix64).
pub(super) fn scatter(index: usize, k: u64) -> f64 {
    let mut z = (index as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(k.wrapping_mul(0xD1B5_4A32_D192_ED03));
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
}
