//! Triangulated surfaces: boundaries of bodies (closed) and cracks (open).
//!
//! Reading order: [`mesh`] (what was given), [`Surface`], [`orient`], [`patches`] (smooth pieces, edges and corners),
//! [`query`] (distances, inside), [`subdivide`] (smaller triangles), [`makers`] (boxes, cylinders, balls).

pub mod makers;
pub mod mesh;
mod orient;
pub mod patches;
pub mod query;
pub mod shape;
pub mod subdivide;
#[cfg(test)]
mod tests;

use super::aabb::Aabb;
use super::tree::BoxTree;
use super::triangle::{Triangle, area_vector, bounds};
use crate::math::Vector3;
pub use mesh::{Part, SurfaceDefect, TriangleMesh};
pub use patches::{Chain, Wedge};
pub use query::Foot;
use rustc_hash::FxHashMap;
pub use shape::Shape;

/// An oriented triangulated surface in which at most two triangles share an edge.
///
/// The edge `k` of a triangle runs from its corner `k` to the next one.
#[derive(Clone, Debug)]
pub struct Surface {
    vertices: Vec<Vector3>,
    triangles: Vec<[u32; 3]>,
    /// Part of each triangle.
    part_of: Vec<u32>,
    parts: Vec<Part>,
    /// Triangle across each edge.
    neighbors: Vec<[Option<u32>; 3]>,
    /// Unit normals of the triangles.
    normals: Vec<Vector3>,
    /// Triangles at each vertex, in rows that `fan_start` bounds.
    fans: Vec<u32>,
    fan_start: Vec<u32>,
    /// Angle-weighted normals at the vertices.
    vertex_normals: Vec<Vector3>,
    patches: patches::Patches,
    tree: BoxTree<3>,
    bounds: Aabb<3>,
}

impl Surface {
    /// A closed surface around a body, turned so that all normals point out of it: shells inside others are voids.
    ///
    /// - `feature_angle`: angle between normals from which an edge is sharp [rad]
    ///
    /// # Errors
    /// A [`SurfaceDefect`] if the triangles do not enclose a volume.
    pub fn closed(mesh: TriangleMesh, feature_angle: f64) -> Result<Self, SurfaceDefect> {
        Self::build(mesh, feature_angle, orient::Kind::Closed)
    }

    /// A surface with a rim, turned so that its triangles agree with the first of each piece.
    ///
    /// # Errors
    /// A [`SurfaceDefect`] if it branches or has but one side.
    pub fn open(mesh: TriangleMesh, feature_angle: f64) -> Result<Self, SurfaceDefect> {
        Self::build(mesh, feature_angle, orient::Kind::Open)
    }

    fn build(mesh: TriangleMesh, feature_angle: f64, kind: orient::Kind) -> Result<Self, SurfaceDefect> {
        let TriangleMesh { vertices, mut triangles, part_of, parts } = mesh.welded()?;
        let neighbors = adjacency(&vertices, &triangles)?;
        orient::orient(&vertices, &mut triangles, &neighbors, kind)?;
        // Turning triangles changes which edge is which.
        let neighbors = adjacency(&vertices, &triangles)?;
        let corners = |t: &[u32; 3]| t.map(|v| vertices[v as usize]);
        let normals: Vec<Vector3> = triangles.iter().map(|t| area_vector(corners(t)).normalize()).collect();
        let boxes: Vec<_> = triangles.iter().map(|t| bounds(corners(t))).collect();
        let (fans, fan_start) = fans(vertices.len(), &triangles);
        let mut surface = Self {
            vertices,
            triangles,
            part_of,
            parts,
            neighbors,
            normals,
            fans,
            fan_start,
            vertex_normals: vec![],
            patches: patches::Patches::default(),
            tree: BoxTree::new(&boxes),
            bounds: boxes.iter().fold(Aabb::empty(), |b, t| b.union(*t)),
        };
        surface.vertex_normals = surface.mean_normals();
        surface.patches = patches::Patches::new(&surface, feature_angle);
        Ok(surface)
    }

    /// Angle-weighted normals at the vertices, which tell inside from outside near them [Baerentzen2005].
    fn mean_normals(&self) -> Vec<Vector3> {
        let mut normals = vec![Vector3::zeros(); self.vertices.len()];
        for (t, corners) in self.triangles.iter().enumerate() {
            for k in 0..3 {
                normals[corners[k] as usize] += self.normals[t] * self.corner_angle(t as u32, k);
            }
        }
        normals.into_iter().map(|n| n.try_normalize(0.0).unwrap_or(n)).collect()
    }

    /// Corner points.
    pub fn vertices(&self) -> &[Vector3] {
        &self.vertices
    }

    /// Corners of the triangles, counterclockwise as seen from where the normal points to.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Unit normals of the triangles.
    pub fn normals(&self) -> &[Vector3] {
        &self.normals
    }

    /// Named parts.
    pub fn parts(&self) -> &[Part] {
        &self.parts
    }

    /// Part of a triangle.
    pub fn part_of(&self, triangle: u32) -> u32 {
        self.part_of[triangle as usize]
    }

    /// Tree over the triangles.
    pub fn tree(&self) -> &BoxTree<3> {
        &self.tree
    }

    /// Positions of the corners of a triangle.
    #[inline]
    pub fn corners(&self, triangle: u32) -> Triangle {
        self.triangles[triangle as usize].map(|v| self.vertices[v as usize])
    }

    /// Pieces of a triangle whose edges are no longer than given: halves of halves, so that a strip becomes a row of pieces
    /// as wide as it is.
    ///
    /// - `longest`: of a piece with this center
    pub fn for_each_piece(&self, triangle: u32, longest: impl Fn(Vector3) -> f64, mut visit: impl FnMut(Triangle)) {
        let mut open = vec![self.corners(triangle)];
        while let Some([a, b, c]) = open.pop() {
            let edges = [(b - a).norm(), (c - b).norm(), (a - c).norm()];
            let long = (0..3).fold(0, |m, k| if edges[k] > edges[m] { k } else { m });
            if edges[long] > longest((a + b + c) / 3.0) {
                let [p, q, r] = [[a, b, c], [b, c, a], [c, a, b]][long];
                let middle = 0.5 * (p + q);
                open.extend([[p, middle, r], [middle, q, r]]);
            } else {
                visit([a, b, c]);
            }
        }
    }

    /// Triangle across an edge, if it is not on the rim.
    pub fn across(&self, triangle: u32, edge: usize) -> Option<u32> {
        self.neighbors[triangle as usize][edge]
    }

    /// Triangles at a vertex.
    pub fn fan(&self, vertex: u32) -> &[u32] {
        let range = self.fan_start[vertex as usize] as usize..self.fan_start[vertex as usize + 1] as usize;
        &self.fans[range]
    }

    /// Angle of a triangle at its corner `k` [rad].
    pub fn corner_angle(&self, triangle: u32, k: usize) -> f64 {
        let c = self.corners(triangle);
        let (a, b) = (c[(k + 1) % 3] - c[k], c[(k + 2) % 3] - c[k]);
        a.cross(&b).norm().atan2(a.dot(&b))
    }

    /// Area of a part, or of everything [area].
    pub fn area(&self, part: Option<u32>) -> f64 {
        let area = |t: u32| 0.5 * area_vector(self.corners(t)).norm();
        (0..self.triangles.len() as u32).filter(|t| part.is_none_or(|p| self.part_of(*t) == p)).map(area).sum()
    }

    /// Enclosed volume.
    pub fn volume(&self) -> f64 {
        let origin = self.vertices[0];
        let volume = |t: u32| {
            let [a, b, c] = self.corners(t).map(|p| p - origin);
            a.dot(&b.cross(&c)) / 6.0
        };
        (0..self.triangles.len() as u32).map(volume).sum()
    }

    /// The same surface moved and turned into a mesh again.
    pub fn mesh(&self) -> TriangleMesh {
        TriangleMesh {
            vertices: self.vertices.clone(),
            triangles: self.triangles.clone(),
            part_of: self.part_of.clone(),
            parts: self.parts.clone(),
        }
    }
}

/// Triangle across each edge of each triangle.
fn adjacency(vertices: &[Vector3], triangles: &[[u32; 3]]) -> Result<Vec<[Option<u32>; 3]>, SurfaceDefect> {
    let mut neighbors = vec![[None; 3]; triangles.len()];
    let mut seen: FxHashMap<[u32; 2], (u32, usize, bool)> = FxHashMap::default();
    for (t, corners) in triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            match seen.get_mut(&[a.min(b), a.max(b)]) {
                None => {
                    seen.insert([a.min(b), a.max(b)], (t as u32, k, false));
                }
                Some((other, edge, is_paired)) if !*is_paired => {
                    *is_paired = true;
                    neighbors[t][k] = Some(*other);
                    neighbors[*other as usize][*edge] = Some(t as u32);
                }
                Some(_) => {
                    let at = (vertices[a as usize] + vertices[b as usize]) * 0.5;
                    return Err(SurfaceDefect::Branches { at });
                }
            }
        }
    }
    Ok(neighbors)
}

/// Triangles at each vertex, as rows.
fn fans(n_vertices: usize, triangles: &[[u32; 3]]) -> (Vec<u32>, Vec<u32>) {
    let mut start = vec![0u32; n_vertices + 1];
    triangles.iter().flatten().for_each(|v| start[*v as usize + 1] += 1);
    for v in 0..n_vertices {
        start[v + 1] += start[v];
    }
    let (mut next, mut fans) = (start.clone(), vec![0; 3 * triangles.len()]);
    for (t, corners) in triangles.iter().enumerate() {
        for v in corners {
            fans[next[*v as usize] as usize] = t as u32;
            next[*v as usize] += 1;
        }
    }
    (fans, start)
}
