//! Triangles as they were given, and what can be wrong with them.

use super::shape::Shape;
use crate::geometry::aabb::Aabb;
use crate::geometry::triangle::area_vector;
use crate::math::Vector3;
use rustc_hash::FxHashMap;

/// Corners nearer than this share of the size of the whole are one.
const WELD: f64 = 1e-9;
/// A triangle lower than this share of its longest edge is left out.
const FLAT: f64 = 1e-12;
/// Sizes and distances from the origin that leave room for products of four lengths.
const SIZES: std::ops::Range<f64> = 1e-60..1e60;

/// Triangles with the parts they belong to.
#[derive(Clone, Debug, Default)]
pub struct TriangleMesh {
    /// Corner points.
    pub vertices: Vec<Vector3>,
    /// Corners of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Part of each triangle.
    pub part_of: Vec<u32>,
    /// The parts.
    pub parts: Vec<Part>,
}

/// A named part of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// The surface that its triangles stand for.
    pub shape: Shape,
}

/// What makes triangles no surface.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SurfaceDefect {
    /// There is nothing.
    #[error("there are no triangles")]
    Empty,
    /// A corner is not a number.
    #[error("corner {vertex} of the triangles is not a finite point")]
    NotFinite {
        /// Its index.
        vertex: usize,
    },
    /// Lengths whose products are no numbers.
    #[error("a surface of size {size} cannot be worked with; choose a unit in which it is near 1")]
    Size {
        /// Its size, or its distance from the origin if that is too large [length].
        size: f64,
    },
    /// A boundary with a rim.
    #[error("the surface is not closed: at ({}, {}, {}) it has a free edge", at.x, at.y, at.z)]
    NotClosed {
        /// Middle of a free edge.
        at: Vector3,
    },
    /// Three or more triangles at one edge.
    #[error("more than two triangles meet at the edge around ({}, {}, {})", at.x, at.y, at.z)]
    Branches {
        /// Middle of the edge.
        at: Vector3,
    },
    /// A surface with one side.
    #[error("the surface has but one side, like a Möbius strip, around ({}, {}, {})", at.x, at.y, at.z)]
    OneSided {
        /// A corner of a triangle that cannot be turned.
        at: Vector3,
    },
}

impl TriangleMesh {
    /// Adds a triangle given by positions; corners at one place become one when the surface is built.
    pub fn push(&mut self, corners: [Vector3; 3], part: u32) {
        let n = self.vertices.len() as u32;
        self.vertices.extend(corners);
        self.triangles.push([n, n + 1, n + 2]);
        self.part_of.push(part);
    }

    /// Adds all of another, with its parts.
    pub fn append(&mut self, other: &Self) {
        let (n, m) = (self.vertices.len() as u32, self.parts.len() as u32);
        self.vertices.extend(&other.vertices);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + n)));
        self.part_of.extend(other.part_of.iter().map(|p| p + m));
        self.parts.extend(other.parts.iter().cloned());
    }

    /// With corners at one place made one, and without triangles that have no area.
    pub(super) fn welded(self) -> Result<Self, SurfaceDefect> {
        if let Some(vertex) = self.vertices.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(SurfaceDefect::NotFinite { vertex });
        }
        let far = self.vertices.iter().map(|p| p.amax()).fold(0.0, f64::max);
        let size = Aabb::of_points(self.vertices.iter().copied()).size().amax();
        for length in [far, size] {
            if !self.vertices.is_empty() && !SIZES.contains(&length) && length != 0.0 {
                return Err(SurfaceDefect::Size { size: length });
            }
        }
        let size = size * 3f64.sqrt();
        let (vertices, index) = weld(&self.vertices, WELD * size);
        let (mut triangles, mut part_of) = (vec![], vec![]);
        for (t, part) in self.triangles.iter().zip(&self.part_of) {
            let corners = t.map(|v| index[v as usize]);
            let p = corners.map(|v| vertices[v as usize]);
            let longest2 = (0..3).map(|k| (p[k] - p[(k + 1) % 3]).norm_squared()).fold(0.0, f64::max);
            if area_vector(p).norm() > FLAT * longest2 {
                triangles.push(corners);
                part_of.push(*part);
            }
        }
        if triangles.is_empty() {
            return Err(SurfaceDefect::Empty);
        }
        Ok(Self { vertices, triangles, part_of, parts: self.parts })
    }
}

/// Points without repetitions, and for each given one which of them it is; those within `tolerance` are one.
pub fn weld(points: &[Vector3], tolerance: f64) -> (Vec<Vector3>, Vec<u32>) {
    let cell = tolerance.max(f64::MIN_POSITIVE) * 4.0;
    let key = |p: Vector3| p.map(|x| (x / cell).floor() as i64);
    let mut bins: FxHashMap<[i64; 3], Vec<u32>> = FxHashMap::default();
    let (mut kept, mut index): (Vec<Vector3>, Vec<u32>) = (vec![], Vec::with_capacity(points.len()));
    for p in points {
        let (low, high) = (key(p - Vector3::repeat(tolerance)), key(p + Vector3::repeat(tolerance)));
        let mut found = None;
        for x in low.x..=high.x {
            for y in low.y..=high.y {
                for z in low.z..=high.z {
                    let near = bins.get(&[x, y, z]).into_iter().flatten();
                    found = near.copied().find(|i| (kept[*i as usize] - p).norm() <= tolerance).or(found);
                }
            }
        }
        index.push(found.unwrap_or_else(|| {
            let k = key(*p);
            bins.entry([k.x, k.y, k.z]).or_default().push(kept.len() as u32);
            kept.push(*p);
            kept.len() as u32 - 1
        }));
    }
    (kept, index)
}
