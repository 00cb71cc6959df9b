//! Smooth pieces of a surface, the sharp edges between them, and the corners where those meet.

use super::Surface;
use super::query::Foot;
use super::shape::Shape;
use crate::geometry::triangle::{Feature, area_vector};
use crate::math::Vector3;

/// Turn of a chain of sharp edges from which a vertex is a corner [rad].
const CORNER_TURN: f64 = 0.5;

/// Smooth pieces, edges and corners.
#[derive(Clone, Debug, Default)]
pub struct Patches {
    /// Patch of each triangle.
    of_triangle: Vec<u32>,
    n_patches: u32,
    /// Whether the edges of each triangle bound its patch.
    is_sharp: Vec<[bool; 3]>,
    /// Smooth normals at the corners of each triangle.
    corner_normals: Vec<[Vector3; 3]>,
    /// Curvatures of each triangle with its neighbors, where the surface is hollow as seen along its normal, and
    /// where it is so as seen against it [1/length].
    hollowness: Vec<[f64; 2]>,
    chains: Vec<Chain>,
    corners: Vec<u32>,
}

/// Vertices along sharp edges, from corner to corner or around.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// Vertices in order; the last is the first again if the chain is a loop.
    pub vertices: Vec<u32>,
    /// Whether it is on the rim of an open surface.
    pub is_rim: bool,
}

/// A sector of surface at a point, between two directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wedge {
    /// Smooth piece.
    pub patch: u32,
    /// Named part.
    pub part: u32,
    /// Unit normal of the surface at the point.
    pub normal: Vector3,
    /// Unit directions along the surface that bound the sector, less than a half turn apart.
    pub sides: [Vector3; 2],
}

impl Patches {
    pub(super) fn new(surface: &Surface, feature_angle: f64) -> Self {
        let n = surface.triangles.len();
        let is_sharp = (0..n as u32).map(|t| [0, 1, 2].map(|k| is_sharp(surface, t, k, feature_angle))).collect();
        let mut this = Self { is_sharp, ..Self::default() };
        this.spread(surface);
        this.corner_normals = (0..n as u32).map(|t| [0, 1, 2].map(|k| this.smooth_normal(surface, t, k))).collect();
        this.hollowness = (0..n as u32).map(|t| this.hollow(surface, t)).collect();
        (this.chains, this.corners) = this.trace(surface);
        this
    }

    /// Gives triangles that are not separated by sharp edges one patch.
    fn spread(&mut self, surface: &Surface) {
        self.of_triangle = vec![u32::MAX; surface.triangles.len()];
        for start in 0..surface.triangles.len() {
            if self.of_triangle[start] != u32::MAX {
                continue;
            }
            self.of_triangle[start] = self.n_patches;
            let mut stack = vec![start];
            while let Some(t) = stack.pop() {
                for k in 0..3 {
                    let Some(other) = surface.neighbors[t][k] else { continue };
                    if !self.is_sharp[t][k] && self.of_triangle[other as usize] == u32::MAX {
                        self.of_triangle[other as usize] = self.n_patches;
                        stack.push(other as usize);
                    }
                }
            }
            self.n_patches += 1;
        }
    }

    /// Angle-weighted normal at a corner, over the triangles of the same patch.
    fn smooth_normal(&self, surface: &Surface, t: u32, k: usize) -> Vector3 {
        let vertex = surface.triangles[t as usize][k];
        let own = surface.normals[t as usize];
        let mut sum = Vector3::zeros();
        for &other in surface.fan(vertex) {
            // Two sheets of one patch may touch at a vertex; only what agrees belongs together.
            let normal = surface.normals[other as usize];
            if self.of_triangle[other as usize] == self.of_triangle[t as usize] && normal.dot(&own) > 0.0 {
                let corner = surface.triangles[other as usize].iter().position(|v| *v == vertex).unwrap_or(0);
                sum += normal * surface.corner_angle(other, corner);
            }
        }
        sum.try_normalize(0.0).unwrap_or(own)
    }

    fn hollow(&self, surface: &Surface, t: u32) -> [f64; 2] {
        let corners = surface.corners(t);
        let middle = corners.iter().sum::<Vector3>() / 3.0;
        let shape = &surface.parts[surface.part_of[t as usize] as usize].shape;
        let normal = surface.normals[t as usize];
        if *shape != Shape::Triangles {
            return [shape.hollowness(middle, normal), shape.hollowness(middle, -normal)];
        }
        let mut most = [0.0f64; 2];
        for k in 0..3 {
            let Some(other) = surface.neighbors[t as usize][k] else { continue };
            let apart = surface.corners(other).iter().sum::<Vector3>() / 3.0 - middle;
            if self.is_sharp[t as usize][k] {
                continue;
            }
            let way = usize::from(apart.dot(&normal) < 0.0);
            let cross = normal.cross(&surface.normals[other as usize]).norm();
            let angle = cross.atan2(normal.dot(&surface.normals[other as usize]));
            let edge = (corners[(k + 1) % 3] - corners[k]).norm();
            let height = |t: u32| area_vector(surface.corners(t)).norm() / edge;
            most[way] = most[way].max(2.0 * angle / (height(t) + height(other)));
        }
        most
    }

    /// Chains of sharp edges, and the vertices where they end or turn.
    fn trace(&self, surface: &Surface) -> (Vec<Chain>, Vec<u32>) {
        // Sharp edges once each, as pairs of vertices.
        let mut edges = vec![];
        for (t, corners) in surface.triangles.iter().enumerate() {
            for k in 0..3 {
                let is_first = surface.neighbors[t][k].is_none_or(|o| t < o as usize);
                if self.is_sharp[t][k] && is_first {
                    edges.push(([corners[k], corners[(k + 1) % 3]], surface.neighbors[t][k].is_none()));
                }
            }
        }
        let mut at_vertex = vec![vec![]; surface.vertices.len()];
        for (e, (ends, _)) in edges.iter().enumerate() {
            ends.iter().for_each(|v| at_vertex[*v as usize].push(e as u32));
        }
        let is_corner: Vec<bool> =
            (0..at_vertex.len()).map(|v| is_corner(surface, v as u32, &edges, &at_vertex[v])).collect();
        let corners = (0..at_vertex.len() as u32).filter(|v| is_corner[*v as usize]).collect();
        let (mut is_used, mut chains) = (vec![false; edges.len()], vec![]);
        let starts = (0..edges.len()).filter(|e| edges[*e].0.iter().any(|v| is_corner[*v as usize]));
        for e in starts.chain(0..edges.len()) {
            if is_used[e] {
                continue;
            }
            let (ends, is_rim) = edges[e];
            let from = if is_corner[ends[0] as usize] || !is_corner[ends[1] as usize] { 0 } else { 1 };
            let mut vertices = vec![ends[from]];
            let mut edge = e;
            loop {
                is_used[edge] = true;
                let [a, b] = edges[edge].0;
                let last = *vertices.last().expect("never empty");
                let next = if a == last { b } else { a };
                vertices.push(next);
                let onward = at_vertex[next as usize].iter().find(|f| !is_used[**f as usize]);
                match onward {
                    Some(f) if !is_corner[next as usize] => edge = *f as usize,
                    _ => break,
                }
            }
            chains.push(Chain { vertices, is_rim });
        }
        (chains, corners)
    }
}

/// Whether an edge separates parts or smooth pieces.
fn is_sharp(surface: &Surface, t: u32, k: usize, feature_angle: f64) -> bool {
    let Some(other) = surface.neighbors[t as usize][k] else { return true };
    let (part, other_part) = (surface.part_of[t as usize], surface.part_of[other as usize]);
    if part != other_part {
        return true;
    }
    let (a, b) = (surface.normals[t as usize], surface.normals[other as usize]);
    surface.parts[part as usize].shape == Shape::Triangles && a.cross(&b).norm().atan2(a.dot(&b)) > feature_angle
}

fn is_corner(surface: &Surface, v: u32, edges: &[([u32; 2], bool)], at_vertex: &[u32]) -> bool {
    let [first, second] = *at_vertex else { return !at_vertex.is_empty() };
    let away = |e: u32| {
        let [a, b] = edges[e as usize].0;
        let other = if a == v { b } else { a };
        surface.vertices[other as usize] - surface.vertices[v as usize]
    };
    let (p, q) = (-away(first), away(second));
    p.cross(&q).norm().atan2(p.dot(&q)) > CORNER_TURN
}

impl Surface {
    /// Chains of sharp edges.
    pub fn chains(&self) -> &[Chain] {
        &self.patches.chains
    }

    /// Vertices where chains end, meet or turn.
    pub fn corner_vertices(&self) -> &[u32] {
        &self.patches.corners
    }

    /// Number of smooth pieces.
    pub fn n_patches(&self) -> u32 {
        self.patches.n_patches
    }

    /// Smooth piece that a triangle belongs to.
    pub fn patch_of(&self, triangle: u32) -> u32 {
        self.patches.of_triangle[triangle as usize]
    }

    /// Whether an edge bounds its smooth piece.
    pub fn is_sharp(&self, triangle: u32, edge: usize) -> bool {
        self.patches.is_sharp[triangle as usize][edge]
    }

    /// Curvature around a triangle where the surface is hollow as seen along its normal, else zero [1/length].
    pub fn hollowness(&self, triangle: u32) -> f64 {
        self.patches.hollowness[triangle as usize][0]
    }

    /// The same as seen against its normal.
    pub fn bulge(&self, triangle: u32) -> f64 {
        self.patches.hollowness[triangle as usize][1]
    }

    /// Unit normal at a point of a triangle: that of its shape, or smoothed over the triangles of its patch.
    pub fn normal_at(&self, triangle: u32, p: Vector3) -> Vector3 {
        let [a, b, c] = self.corners(triangle);
        let own = self.normals[triangle as usize];
        let shape = self.parts[self.part_of[triangle as usize] as usize].shape;
        if shape != Shape::Triangles {
            return shape.normal(p, own);
        }
        let area = area_vector([a, b, c]);
        let share = |q: Vector3, r: Vector3| (area_vector([p, q, r]).dot(&area) / area.norm_squared()).clamp(0.0, 1.0);
        let normals = self.patches.corner_normals[triangle as usize];
        let mean = normals[0] * share(b, c) + normals[1] * share(c, a) + normals[2] * share(a, b);
        mean.try_normalize(0.0).unwrap_or(own)
    }

    /// The sectors of surface around a point of it; `at` is where the node stands, which a shape may move off its triangle.
    pub fn wedges(&self, foot: &Foot, at: Vector3) -> Vec<Wedge> {
        let t = foot.triangle;
        match foot.feature {
            Feature::Face => {
                let normal = self.normals[t as usize];
                let [a, b, _] = self.corners(t);
                let x = (b - a).normalize();
                let y = normal.cross(&x);
                [[x, y], [y, -x], [-x, -y], [-y, x]].iter().map(|sides| self.wedge(t, at, *sides)).collect()
            }
            Feature::Edge(k) => {
                let c = self.corners(t);
                let along = (c[(k + 1) % 3] - c[k]).normalize();
                let mut wedges = vec![];
                for side in [Some(t), self.neighbors[t as usize][k]].into_iter().flatten() {
                    let normal = self.normals[side as usize];
                    let middle = self.corners(side).iter().sum::<Vector3>() / 3.0 - foot.position;
                    let across = normal.cross(&along);
                    let across = if across.dot(&middle) < 0.0 { -across } else { across };
                    wedges.extend([[along, across], [across, -along]].map(|sides| self.wedge(side, at, sides)));
                }
                wedges
            }
            Feature::Corner(k) => {
                let vertex = self.triangles[t as usize][k];
                let sector = |t: &u32| {
                    let k = self.triangles[*t as usize].iter().position(|v| *v == vertex).unwrap_or(0);
                    let c = self.corners(*t);
                    let sides = [c[(k + 1) % 3] - c[k], c[(k + 2) % 3] - c[k]].map(|d| d.normalize());
                    self.wedge(*t, at, sides)
                };
                self.fan(vertex).iter().map(sector).collect()
            }
        }
    }

    fn wedge(&self, t: u32, at: Vector3, sides: [Vector3; 2]) -> Wedge {
        Wedge { patch: self.patch_of(t), part: self.part_of(t), normal: self.normal_at(t, at), sides }
    }
}

impl Wedge {
    /// Angle between the sides [rad].
    pub fn angle(&self) -> f64 {
        let [a, b] = self.sides;
        a.cross(&b).norm().atan2(a.dot(&b))
    }

    /// Unit normal of the plane of the sector, on the side of that of the surface.
    pub fn flat_normal(&self) -> Vector3 {
        let flat = self.sides[0].cross(&self.sides[1]).try_normalize(0.0).unwrap_or(self.normal);
        if flat.dot(&self.normal) < 0.0 { -flat } else { flat }
    }

    /// The part of the sector on the side of a plane through its point that `normal` points to.
    pub fn above(&self, normal: Vector3) -> Option<Self> {
        let [s, t] = self.sides.map(|d| d.dot(&normal));
        let on = 1e-9;
        if s >= -on && t >= -on {
            return (s > on || t > on).then_some(*self);
        }
        if s <= on && t <= on {
            return None;
        }
        let cut = (self.sides[0] * t - self.sides[1] * s) * (t - s).signum();
        let cut = cut.try_normalize(0.0)?;
        let sides = if s > 0.0 { [self.sides[0], cut] } else { [cut, self.sides[1]] };
        Some(Self { sides, ..*self })
    }
}
