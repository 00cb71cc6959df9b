//! Fewer triangles with nearly the same picture: vertices move onto neighbors where the fields are closest to linear.
//!
//! By hand, because crates for it either bind C++ or know closed surfaces without fields. Kept vertices keep their values.

use crate::math::{Vector2, cross};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Number of fields that must stay as they are.
pub(super) const N_FEATURES: usize = 5;
/// Least area of a triangle over the square of its longest side.
const THINNEST: f64 = 0.02;
/// Weight of a moved boundary, as a share of the body, against that of the fields, as a share of their range.
const OUTLINE: f64 = 30.0;
/// Weight of a long side, so that where nothing happens triangles stay of like size.
const SIZE: f64 = 0.005;

/// Triangles that can be thinned.
pub(super) struct Mesh<'a> {
    positions: &'a [Vector2],
    features: &'a [[f64; N_FEATURES]],
    size: f64,
    triangles: Vec<[u32; 3]>,
    is_alive: Vec<bool>,
    /// Triangles around each vertex.
    around: Vec<Vec<u32>>,
    n_vertices: usize,
    /// Error that each vertex has taken over from those that moved onto it.
    inherited: Vec<f64>,
    stamps: Vec<u32>,
    queue: BinaryHeap<Candidate>,
}

/// A vertex that may move onto a neighbor.
struct Candidate {
    cost: f64,
    vertex: u32,
    onto: u32,
    stamp: u32,
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        other.cost.total_cmp(&self.cost).then(other.vertex.cmp(&self.vertex))
    }
}
impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Candidate {}

impl<'a> Mesh<'a> {
    /// - `features`: what must stay nearly linear within triangles, each of a range of about 1
    pub fn new(positions: &'a [Vector2], features: &'a [[f64; N_FEATURES]], triangles: &[[u32; 3]]) -> Self {
        let mut around = vec![vec![]; positions.len()];
        for (k, t) in triangles.iter().enumerate() {
            t.iter().for_each(|&v| around[v as usize].push(k as u32));
        }
        let n_vertices = around.iter().filter(|a| !a.is_empty()).count();
        let bounds = crate::geometry::aabb::Aabb::of_points(positions.iter().copied());
        Self {
            positions,
            features,
            size: bounds.size().max().max(f64::MIN_POSITIVE),
            is_alive: vec![true; triangles.len()],
            triangles: triangles.to_vec(),
            around,
            n_vertices,
            inherited: vec![0.0; positions.len()],
            stamps: vec![0; positions.len()],
            queue: BinaryHeap::new(),
        }
    }

    /// The triangles that are left.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        self.triangles.iter().zip(&self.is_alive).filter(|t| *t.1).map(|t| *t.0).collect()
    }

    /// Number of vertices that are left.
    pub fn n_vertices(&self) -> usize {
        self.n_vertices
    }

    /// Takes vertices away until so many are left, or none can go.
    pub fn thin(&mut self, n_vertices: usize) {
        if self.n_vertices <= n_vertices {
            return;
        }
        (0..self.positions.len() as u32).for_each(|v| self.consider(v));
        while self.n_vertices > n_vertices {
            let Some(next) = self.queue.pop() else { break };
            if next.stamp == self.stamps[next.vertex as usize] {
                self.collapse(&next);
            }
        }
        self.queue.clear();
    }

    fn consider(&mut self, vertex: u32) {
        self.stamps[vertex as usize] += 1;
        let stamp = self.stamps[vertex as usize];
        if let Some((cost, onto)) = self.cheapest(vertex) {
            self.queue.push(Candidate { cost, vertex, onto, stamp });
        }
    }

    fn collapse(&mut self, candidate: &Candidate) {
        let (from, onto) = (candidate.vertex, candidate.onto);
        let mut ring = self.neighbors(from);
        for k in std::mem::take(&mut self.around[from as usize]) {
            let triangle = self.triangles[k as usize];
            if triangle.contains(&onto) {
                self.is_alive[k as usize] = false;
                for v in triangle.into_iter().filter(|v| *v != from) {
                    self.around[v as usize].retain(|t| *t != k);
                }
            } else {
                self.triangles[k as usize] = triangle.map(|v| if v == from { onto } else { v });
                self.around[onto as usize].push(k);
            }
        }
        self.inherited[onto as usize] = self.inherited[onto as usize].max(candidate.cost);
        self.stamps[from as usize] += 1;
        self.n_vertices -= 1;
        ring.sort_unstable();
        ring.into_iter().for_each(|v| self.consider(v));
    }

    fn neighbors(&self, vertex: u32) -> Vec<u32> {
        let mut found = Vec::with_capacity(8);
        for &k in &self.around[vertex as usize] {
            for v in self.triangles[k as usize] {
                if v != vertex && !found.contains(&v) {
                    found.push(v);
                }
            }
        }
        found
    }

    /// The neighbor most like the vertex among those onto which it can move, with the error of the picture.
    fn cheapest(&self, vertex: u32) -> Option<(f64, u32)> {
        let neighbors = self.neighbors(vertex);
        let n_triangles = self.around[vertex as usize].len();
        let ends: Vec<u32> = neighbors.iter().copied().filter(|v| self.shared(vertex, *v).count() == 1).collect();
        let mut targets: Vec<(f64, u32)> = match (ends.as_slice(), neighbors.len()) {
            ([], n) if n == n_triangles => neighbors.iter().map(|v| (self.unlikeness(vertex, *v), *v)).collect(),
            // On an outline only along it; the corner of a single triangle stays.
            ([a, b], n) if n == n_triangles + 1 && n > 2 => [*a, *b].map(|v| (self.unlikeness(vertex, v), v)).to_vec(),
            // Pieces that touch in a point.
            _ => return None,
        };
        targets.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let is_allowed = |onto: u32| {
            let near_both = self.neighbors(onto).iter().filter(|v| neighbors.contains(v)).count();
            near_both == self.shared(vertex, onto).count() && self.keeps_shape(vertex, onto)
        };
        let onto = targets.into_iter().map(|t| t.1).find(|v| is_allowed(*v))?;
        let error = match ends.as_slice() {
            [a, b] => self.error_on_outline(vertex, onto, if *a == onto { *b } else { *a }),
            _ => self.error_inside(vertex, onto),
        };
        let length = neighbors.iter().map(|v| self.distance(*v, onto)).fold(0.0, f64::max);
        let cost = error + self.inherited[vertex as usize] + SIZE * length / self.size;
        cost.is_finite().then_some((cost, onto))
    }

    fn shared(&self, a: u32, b: u32) -> impl Iterator<Item = u32> {
        self.around[a as usize].iter().copied().filter(move |k| self.triangles[*k as usize].contains(&b))
    }

    fn distance(&self, a: u32, b: u32) -> f64 {
        (self.positions[a as usize] - self.positions[b as usize]).norm()
    }

    fn unlikeness(&self, a: u32, b: u32) -> f64 {
        let [fa, fb] = [a, b].map(|v| &self.features[v as usize]);
        fa.iter().zip(fb).map(|(x, y)| (x - y).abs()).sum::<f64>() + self.distance(a, b) / self.size
    }

    /// Whether no triangle turns over or becomes a needle.
    fn keeps_shape(&self, vertex: u32, onto: u32) -> bool {
        self.moved(vertex, onto).all(|t| {
            let [a, b, c] = t.map(|v| self.positions[v as usize]);
            let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
            cross(b - a, c - a) > THINNEST * longest
        })
    }

    /// Triangles around `vertex` once it lies on `onto`.
    fn moved(&self, vertex: u32, onto: u32) -> impl Iterator<Item = [u32; 3]> {
        let around = self.around[vertex as usize].iter().map(|k| self.triangles[*k as usize]);
        around.filter(move |t| !t.contains(&onto)).map(move |t| t.map(|v| if v == vertex { onto } else { v }))
    }

    /// What the picture loses at the vertex.
    fn error_inside(&self, vertex: u32, onto: u32) -> f64 {
        let p = self.positions[vertex as usize];
        let weights = |t: [u32; 3]| {
            let [a, b, c] = t.map(|v| self.positions[v as usize]);
            let area = cross(b - a, c - a);
            [cross(b - p, c - p) / area, cross(c - p, a - p) / area, cross(a - p, b - p) / area]
        };
        let least = |w: &[f64; 3]| w.iter().copied().fold(f64::INFINITY, f64::min);
        let found =
            self.moved(vertex, onto).map(|t| (t, weights(t))).max_by(|a, b| least(&a.1).total_cmp(&least(&b.1)));
        found.map_or(f64::INFINITY, |(t, w)| self.difference(vertex, &t, &w))
    }

    fn error_on_outline(&self, vertex: u32, onto: u32, other: u32) -> f64 {
        let [p, a, b] = [vertex, onto, other].map(|v| self.positions[v as usize]);
        let along = b - a;
        let share = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        let off = (a + along * share - p).norm();
        self.difference(vertex, &[onto, other], &[1.0 - share, share]) + OUTLINE * off / self.size
    }

    fn difference(&self, vertex: u32, others: &[u32], weights: &[f64]) -> f64 {
        let own = &self.features[vertex as usize];
        (0..N_FEATURES)
            .map(|k| {
                let there: f64 = others.iter().zip(weights).map(|(v, w)| w * self.features[*v as usize][k]).sum();
                (own[k] - there).abs()
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of `n` times `n` cells with a slit from the left side to its middle.
    fn slit_square(n: u32) -> (Vec<Vector2>, Vec<[u32; 3]>) {
        let width = n + 1;
        let mut positions: Vec<Vector2> = (0..width * width)
            .map(|v| Vector2::new(f64::from(v % width), f64::from(v / width)) / f64::from(n))
            .collect();
        let upper = positions.len() as u32;
        positions.extend((0..n / 2).map(|c| Vector2::new(f64::from(c) / f64::from(n), 0.5)));
        let mut triangles = vec![];
        for row in 0..n {
            for c in 0..n {
                let low = |c: u32| if row == n / 2 && c < n / 2 { upper + c } else { row * width + c };
                let (d, e) = ((row + 1) * width + c, (row + 1) * width + c + 1);
                triangles.extend([[low(c), low(c + 1), e], [low(c), e, d]]);
            }
        }
        (positions, triangles)
    }

    fn area(positions: &[Vector2], triangles: &[[u32; 3]]) -> f64 {
        let corner = |v: u32| positions[v as usize];
        triangles.iter().map(|t| 0.5 * cross(corner(t[1]) - corner(t[0]), corner(t[2]) - corner(t[0]))).sum()
    }

    #[test]
    fn what_is_linear_needs_few_vertices_and_the_slit_stays_open() {
        let (positions, triangles) = slit_square(40);
        let features: Vec<_> = positions.iter().map(|p| [p.x, p.y, p.x - p.y, 0.5, 0.0]).collect();
        let mut mesh = Mesh::new(&positions, &features, &triangles);
        mesh.thin(60);
        let left = mesh.triangles();
        assert!(mesh.n_vertices() <= 60);
        // Exactly the square: no corner is cut, nothing overlaps.
        assert!((area(&positions, &left) - 1.0).abs() < 1e-12);
        // Euler: a disk with a slit from its rim is a disk, with V - E + F = 1.
        let mut edges: Vec<[u32; 2]> = left
            .iter()
            .flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]])
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        edges.sort_unstable();
        edges.dedup();
        assert_eq!(mesh.n_vertices() as i64 - edges.len() as i64 + left.len() as i64, 1);
        let tip = 20 * 41 + 20;
        assert!(left.iter().flatten().any(|&v| v == tip), "the tip stays");
    }

    #[test]
    fn vertices_stay_where_a_field_bends() {
        let (positions, triangles) = slit_square(40);
        let bump = |p: &Vector2| (-((p - Vector2::new(0.75, 0.25)).norm_squared() / 0.005)).exp();
        let features: Vec<_> = positions.iter().map(|p| [bump(p), 0.0, 0.0, 0.0, 0.0]).collect();
        let mut mesh = Mesh::new(&positions, &features, &triangles);
        mesh.thin(300);
        let mut kept: Vec<u32> = mesh.triangles().concat();
        kept.sort_unstable();
        kept.dedup();
        assert_eq!(kept.len(), 300);
        let near = kept.iter().filter(|v| (positions[**v as usize] - Vector2::new(0.75, 0.25)).norm() < 0.2).count();
        // There were 1701 vertices, of which the disk, an eighth of the square, had 213: its share is four times as large.
        let (share_near, share_far) = (near as f64 / 213.0, (300 - near) as f64 / 1488.0);
        assert!(share_near > 4.0 * share_far, "{near} of 300 at the bump");
    }

    #[test]
    fn nothing_is_lost_where_nothing_may_go() {
        let positions = [Vector2::zeros(), Vector2::new(1.0, 0.0), Vector2::new(0.0, 1.0)];
        let mut mesh = Mesh::new(&positions, &[[0.0; N_FEATURES]; 3], &[[0, 1, 2]]);
        mesh.thin(1);
        assert_eq!(mesh.triangles(), [[0, 1, 2]]);
    }
}
