//! What the analysis of a solid finds.

use super::solid_boundary::BoundaryFields;
use super::warnings::Warning;
use crate::crack::{CrackSurface, FrontPoint};
use crate::fracture::FrontFactors;
use crate::geometry::surface::makers::across;
use crate::math::{Matrix, Vector2, Vector3};
use crate::nodes::cloud::Cloud;
use crate::nodes::solid::FacePair;
use crate::system::SolverEffort;
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation as _};

/// Displacement, stress and fracture quantities of a solid.
#[derive(Clone, Debug)]
pub struct SolidResult {
    /// Number of nodes.
    pub n_nodes: usize,
    /// The nodes, in the order of the values.
    pub cloud: Cloud<3>,
    /// Displacements of the nodes [length].
    pub displacements: Vec<Vector3>,
    /// Stresses at the nodes [stress].
    pub stresses: Vec<Matrix<3>>,
    /// Pairs of nodes on crack faces.
    pub pairs: Vec<FacePair>,
    /// Each crack with its opening.
    pub opened_cracks: Vec<OpenedCrack>,
    /// Fields on the boundary of the body.
    pub boundary: BoundaryFields,
    /// Every front.
    pub fronts: Vec<FrontRecord>,
    /// What the linear solver did.
    pub effort: SolverEffort,
    /// What deserves a second look.
    pub warnings: Vec<Warning>,
}

/// A front with its fracture quantities.
#[derive(Clone, Debug)]
pub struct FrontRecord {
    /// Index of the crack.
    pub crack: usize,
    /// Whether it is a loop.
    pub is_closed: bool,
    /// Its length [length].
    pub length: f64,
    /// Points along it.
    pub points: Vec<FrontPointRecord>,
}

/// Fracture quantities at a point of a front.
#[derive(Clone, Debug)]
pub struct FrontPointRecord {
    /// The point.
    pub point: FrontPoint,
    /// The quantities, if a disc fits around the point.
    pub factors: Option<FrontFactors>,
    /// Radius of the largest disc [length].
    pub radius: Option<f64>,
}

/// The surface of a crack with its opening.
#[derive(Clone, Debug, Default)]
pub struct OpenedCrack {
    /// Places of pairs of nodes, then points of fronts.
    pub positions: Vec<Vector3>,
    /// Displacement of the positive face over that of the negative one [length]; zero on fronts.
    pub openings: Vec<Vector3>,
    /// Its component along the normal of the crack [length]; negative where faces overlap.
    pub gaps: Vec<f64>,
    /// Triangles between the positions.
    pub triangles: Vec<[u32; 3]>,
}

struct Vertex {
    at: Point2<f64>,
    index: u32,
}

impl HasPosition for Vertex {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        self.at
    }
}

/// Principal values of a stress, the largest first [stress]; not numbers where the stress is none.
pub fn principal_stresses(stress: &Matrix<3>) -> [f64; 3] {
    if stress.iter().any(|s| !s.is_finite()) {
        return [f64::NAN; 3];
    }
    let values = stress.symmetric_eigenvalues();
    let mut sorted = [values[0], values[1], values[2]];
    sorted.sort_by(|a, b| b.total_cmp(a));
    sorted
}

impl SolidResult {
    /// Principal stresses at a node, the largest first [stress].
    pub fn principal_stresses(&self, node: usize) -> [f64; 3] {
        principal_stresses(&self.stresses[node])
    }

    /// The surface of a crack, in triangles between its nodes.
    pub(super) fn opened_crack(&self, crack: &CrackSurface, index: usize) -> OpenedCrack {
        let mut faces = OpenedCrack::default();
        for pair in self.pairs.iter().filter(|p| p.crack as usize == index) {
            let [a, b] = pair.nodes.map(|k| k as usize);
            let p = self.cloud.positions[a];
            let foot = crack.surface.closest(p);
            let opening = self.displacements[a] - self.displacements[b];
            faces.positions.push(p);
            faces.openings.push(opening);
            faces.gaps.push(opening.dot(&crack.surface.normal_at(foot.triangle, foot.position)));
        }
        for p in crack.fronts.iter().flat_map(|f| &f.points) {
            faces.positions.push(p.position);
            faces.openings.push(Vector3::zeros());
            faces.gaps.push(0.0);
        }
        faces.triangles = self.joined(&faces.positions, crack);
        faces
    }

    /// Delaunay triangles in the mean plane of the crack, those off the crack left out.
    fn joined(&self, positions: &[Vector3], crack: &CrackSurface) -> Vec<[u32; 3]> {
        let surface = &crack.surface;
        let mean = surface.normals().iter().sum::<Vector3>().try_normalize(1e-6);
        let Some(normal) = mean else { return vec![] };
        let [x, y] = across(normal);
        let flat = |p: &Vector3| Vector2::new(p.dot(&x), p.dot(&y));
        let mut plane = DelaunayTriangulation::<Vertex>::new();
        for (index, p) in positions.iter().enumerate() {
            let q = flat(p);
            if plane.insert(Vertex { at: Point2::new(q.x, q.y), index: index as u32 }).is_err() {
                return vec![];
            }
        }
        let corners: Vec<[u32; 3]> = plane.inner_faces().map(|f| f.vertices().map(|v| v.data().index)).collect();
        let is_on_crack = |t: &[u32; 3]| {
            let p = t.map(|k| positions[k as usize]);
            let middle = (p[0] + p[1] + p[2]) / 3.0;
            let longest = (0..3).map(|k| (p[k] - p[(k + 1) % 3]).norm()).fold(0.0, f64::max);
            surface.closest_within(middle, 0.1 * longest).is_some()
        };
        corners.into_iter().filter(is_on_crack).collect()
    }
}
