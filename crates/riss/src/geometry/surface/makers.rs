//! Surfaces of simple bodies.

use super::mesh::{Part, TriangleMesh};
use super::shape::Shape;
use crate::geometry::aabb::Aabb;
use crate::math::{Vector2, Vector3};
use rustc_hash::FxHashMap;
use std::f64::consts::{PI, TAU};

/// Straight pieces of a circle: its triangles are off by no more than 0.0006 of the radius.
pub const AROUND: usize = 96;
/// How often the faces of an icosahedron are quartered for a sphere.
const QUARTERINGS: usize = 4;
/// Most rows of triangles along a cylinder.
const MOST_ROWS: f64 = 128.0;

/// A box with the parts `x-min`, `x-max`, `y-min`, `y-max`, `z-min`, `z-max`.
pub fn cuboid(bounds: Aabb<3>) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for axis in 0..3 {
        for end in 0..2 {
            let name = format!("{}-{}", ["x", "y", "z"][axis], ["min", "max"][end]);
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let corner = |a: f64, b: f64| {
                let mut share = Vector3::zeros();
                (share[axis], share[u], share[v]) = (end as f64, a, b);
                bounds.lower + bounds.size().component_mul(&share)
            };
            let [a, b, c, d] = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
            let part = mesh.add_part(&name, Shape::Triangles);
            if end == 1 {
                mesh.push([a, b, c], part);
                mesh.push([a, c, d], part);
            } else {
                mesh.push([a, c, b], part);
                mesh.push([a, d, c], part);
            }
        }
    }
    mesh
}

/// A ball with one part.
pub fn ball(center: Vector3, radius: f64, part: &str) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let part = mesh.add_part(part, Shape::Sphere { center, radius });
    let (mut vertices, mut triangles) = icosahedron();
    for _ in 0..QUARTERINGS {
        quarter(&mut vertices, &mut triangles);
    }
    mesh.vertices = vertices.iter().map(|v| center + v.normalize() * radius).collect();
    mesh.part_of = vec![part; triangles.len()];
    mesh.triangles = triangles;
    mesh
}

/// A circular cylinder from one end to the other, with the parts `side`, `bottom` (at `from`) and `top`, or what `names` says.
pub fn cylinder(from: Vector3, to: Vector3, radius: f64, names: [&str; 3]) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    let axis = (to - from).normalize();
    let [x, y] = across(axis);
    let side = mesh.add_part(names[0], Shape::Cylinder { center: from, axis, radius });
    let around = |k: usize| {
        let angle = TAU * (k % AROUND) as f64 / AROUND as f64;
        (x * angle.cos() + y * angle.sin()) * radius
    };
    let rows = ((to - from).norm() * AROUND as f64 / (TAU * radius)).ceil().clamp(1.0, MOST_ROWS) as usize;
    let level = |j: usize| from + (to - from) * (j as f64 / rows as f64);
    for j in 0..rows {
        for k in 0..AROUND {
            let [a, b] = [level(j) + around(k), level(j) + around(k + 1)];
            let [c, d] = [level(j + 1) + around(k + 1), level(j + 1) + around(k)];
            mesh.push([a, b, c], side);
            mesh.push([a, c, d], side);
        }
    }
    let (points, triangles) = unit_disc(AROUND);
    for (end, name, is_top) in [(from, names[1], false), (to, names[2], true)] {
        let part = mesh.add_part(name, Shape::Triangles);
        for t in &triangles {
            let [a, b, c] = t.map(|k| end + (x * points[k as usize].x + y * points[k as usize].y) * radius);
            mesh.push(if is_top { [a, b, c] } else { [a, c, b] }, part);
        }
    }
    mesh
}

/// Two unit vectors that make a right-handed frame with `axis`, `x × y = axis`.
pub fn across(axis: Vector3) -> [Vector3; 2] {
    let least = axis.abs().imin();
    let mut guess = Vector3::zeros();
    guess[least] = 1.0;
    let x = (guess - axis * axis[least]).normalize();
    [x, axis.cross(&x)]
}

/// Triangles of the unit disc with `n` (a multiple of 8) points around it, which come first; fewer and larger ones inside.
pub fn unit_disc(n: usize) -> (Vec<Vector2>, Vec<[u32; 3]>) {
    let ring = |n: usize, radius: f64| (0..n).map(move |k| crate::math::direction(TAU * k as f64 / n as f64) * radius);
    let (mut points, mut triangles) = (ring(n, 1.0).collect::<Vec<_>>(), vec![]);
    let (mut outer, mut n, mut radius) = (0u32, n, 1.0);
    while n >= 24 && n % 2 == 0 {
        let half = n / 2;
        // About as deep as the inner pieces are long.
        radius -= (2.0 * PI * radius / half as f64 * 0.8).min(0.5 * radius);
        let inner = points.len() as u32;
        points.extend(ring(half, radius));
        let at = |k: usize| outer + (k % n) as u32;
        for k in 0..half {
            let (p, q) = (inner + k as u32, inner + ((k + 1) % half) as u32);
            triangles.push([p, at(2 * k), at(2 * k + 1)]);
            triangles.push([p, at(2 * k + 1), q]);
            triangles.push([q, at(2 * k + 1), at(2 * k + 2)]);
        }
        (outer, n) = (inner, half);
    }
    let center = points.len() as u32;
    points.push(Vector2::zeros());
    triangles.extend((0..n as u32).map(|k| [center, outer + k, outer + (k + 1) % n as u32]));
    (points, triangles)
}

fn icosahedron() -> (Vec<Vector3>, Vec<[u32; 3]>) {
    let g = 0.5 * (1.0 + 5f64.sqrt());
    let mut vertices = vec![];
    for k in 0..3 {
        for (s, t) in [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0)] {
            let mut v = Vector3::zeros();
            (v[k], v[(k + 1) % 3]) = (s, t * g);
            vertices.push(v);
        }
    }
    // Faces are the triples of vertices at the least distance, 2.
    let near = |a: usize, b: usize| (vertices[a] - vertices[b]).norm() < 2.1;
    let mut triangles = vec![];
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if near(a, b) && near(b, c) && near(a, c) {
                    triangles.push([a as u32, b as u32, c as u32]);
                }
            }
        }
    }
    (vertices, triangles)
}

/// Cuts each triangle into four.
fn quarter(vertices: &mut Vec<Vector3>, triangles: &mut Vec<[u32; 3]>) {
    let mut middles: FxHashMap<[u32; 2], u32> = FxHashMap::default();
    let mut fine = Vec::with_capacity(4 * triangles.len());
    for [a, b, c] in triangles.iter().copied() {
        let mut middle = |p: u32, q: u32| {
            *middles.entry([p.min(q), p.max(q)]).or_insert_with(|| {
                let sum = vertices[p as usize].normalize() + vertices[q as usize].normalize();
                vertices.push(sum);
                vertices.len() as u32 - 1
            })
        };
        let (x, y, z) = (middle(a, b), middle(b, c), middle(c, a));
        fine.extend([[a, x, z], [x, b, y], [z, y, c], [x, y, z]]);
    }
    *triangles = fine;
}

impl TriangleMesh {
    /// Adds a part; returns its index.
    pub fn add_part(&mut self, name: &str, shape: Shape) -> u32 {
        self.parts.push(Part { name: name.into(), shape });
        self.parts.len() as u32 - 1
    }
}
