//! Shapes of crack surfaces, as they are given, and their triangles.

use crate::geometry::polygon;
use crate::geometry::surface::makers::{across, unit_disc};
use crate::geometry::surface::{Shape, SurfaceDefect, TriangleMesh};
use crate::geometry::triangle::Triangle;
use crate::math::{Vector2, Vector3};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation as _};

/// Straight pieces of an elliptical front: positions between its points are off by no more than 0.0001 of the radius.
const AROUND: usize = 256;
/// Pieces of each edge of a polygon.
const PIECES: usize = 8;
/// Corners of a polygon may leave their plane by this share of its size.
const FLATNESS: f64 = 1e-6;

/// A crack surface as it is given. Its positive side is the one that the normal points to.
#[derive(Clone, Debug)]
pub enum CrackShape {
    /// A plane polygon; seen from the positive side its corners run counterclockwise.
    Polygon {
        /// Corners in order.
        corners: Vec<Vector3>,
    },
    /// An ellipse, or a disc if both radii are equal.
    Ellipse {
        /// Its center.
        center: Vector3,
        /// Unit normal.
        normal: Vector3,
        /// Unit vector of the first half axis, in the plane of the crack.
        first_axis: Vector3,
        /// Half axes [length].
        radii: [f64; 2],
    },
    /// Any triangles with a rim.
    Triangles(TriangleMesh),
}

/// Why a crack surface makes no sense.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CrackDefect {
    /// The triangles are no surface.
    #[error(transparent)]
    Surface(#[from] SurfaceDefect),
    /// A polygon with corners off its plane.
    #[error("corner {corner} of the polygon is {distance} away from the plane of the others")]
    NotPlane {
        /// Index of the corner, from 1.
        corner: usize,
        /// Its distance from the mean plane [length].
        distance: f64,
    },
    /// Edges of a polygon that cross.
    #[error("edges {first} and {second} of the polygon cross")]
    Crosses {
        /// Index of an edge, from 1.
        first: usize,
        /// Index of the other.
        second: usize,
    },
    /// No part of it is inside the body.
    #[error("the crack lies outside the body")]
    Outside,
}

impl CrackShape {
    /// A disc.
    pub fn disc(center: Vector3, normal: Vector3, radius: f64) -> Self {
        let normal = normal.normalize();
        Self::Ellipse { center, normal, first_axis: across(normal)[0], radii: [radius; 2] }
    }

    /// Its triangles.
    ///
    /// # Errors
    /// What is wrong with a polygon.
    pub fn mesh(&self) -> Result<TriangleMesh, CrackDefect> {
        match self {
            Self::Polygon { corners } => polygon_mesh(corners),
            Self::Ellipse { center, normal, first_axis, radii } => {
                let second = normal.cross(first_axis);
                let (points, triangles) = unit_disc(AROUND);
                let place = |k: u32| {
                    let p = points[k as usize];
                    center + first_axis * (radii[0] * p.x) + second * (radii[1] * p.y)
                };
                Ok(mesh_of(triangles.iter().map(|t| t.map(place))))
            }
            Self::Triangles(mesh) => Ok(mesh.clone()),
        }
    }
}

fn mesh_of(triangles: impl Iterator<Item = Triangle>) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let part = mesh.add_part("crack", Shape::Triangles);
    triangles.for_each(|t| mesh.push(t, part));
    mesh
}

fn polygon_mesh(corners: &[Vector3]) -> Result<TriangleMesh, CrackDefect> {
    let n = corners.len();
    let middle = corners.iter().sum::<Vector3>() / n.max(1) as f64;
    // Newell's normal, twice the area long.
    let area = (0..n).map(|k| (corners[k] - middle).cross(&(corners[(k + 1) % n] - middle))).sum::<Vector3>();
    let normal = area.try_normalize(0.0).ok_or(SurfaceDefect::Empty)?;
    let size = corners.iter().map(|p| (p - middle).norm()).fold(0.0, f64::max);
    let height = |k: usize| (corners[k] - middle).dot(&normal).abs();
    if let Some(k) = (0..n).find(|k| height(*k) > FLATNESS * size) {
        return Err(CrackDefect::NotPlane { corner: k + 1, distance: height(k) });
    }
    let [x, y] = across(normal);
    let flat: Vec<Vector2> = corners.iter().map(|p| Vector2::new((p - middle).dot(&x), (p - middle).dot(&y))).collect();
    if let Some((first, second)) = polygon::self_crossing(&flat) {
        return Err(CrackDefect::Crosses { first: first + 1, second: second + 1 });
    }
    let points: Vec<Vector2> = (0..n)
        .flat_map(|k| (0..PIECES).map(move |j| (k, j)))
        .map(|(k, j)| flat[k] + (flat[(k + 1) % n] - flat[k]) * (j as f64 / PIECES as f64))
        .collect();
    let triangles = fill_polygon(&points).ok_or(SurfaceDefect::Empty)?;
    Ok(mesh_of(triangles.into_iter().map(|t| t.map(|p| middle + x * p.x + y * p.y))))
}

/// Constrained Delaunay triangles of a simple polygon, counterclockwise.
fn fill_polygon(points: &[Vector2]) -> Option<Vec<[Vector2; 3]>> {
    let mut cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let handles: Option<Vec<_>> = points.iter().map(|p| cdt.insert(Point2::new(p.x, p.y)).ok()).collect();
    let handles = handles?;
    for k in 0..handles.len() {
        let (a, b) = (handles[k], handles[(k + 1) % handles.len()]);
        if a != b && cdt.can_add_constraint(a, b) {
            cdt.add_constraint(a, b);
        }
    }
    let corners = |f: spade::handles::FaceHandle<'_, spade::handles::InnerTag, _, _, _, _>| {
        f.vertices().map(|v| Vector2::new(v.position().x, v.position().y))
    };
    let is_inside = |t: &[Vector2; 3]| polygon::contains(points, (t[0] + t[1] + t[2]) / 3.0);
    Some(cdt.inner_faces().map(corners).filter(is_inside).collect())
}
