//! Triangles between points, fitted to boundary and cracks (the `spade` crate), and the sectors around each point.
//!
//! A point on a crack has one *copy* for each sector of material around it: two on an ordinary stretch, one at a
//! tip, as many as there are arms where cracks meet.

use super::chains::{BoundarySegment, Chains};
use crate::error::{Error, Result};
use crate::math::{Vector2, cross, direction};
use rustc_hash::FxHashSet;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation as _};
use std::f64::consts::TAU;

/// How far a copy's point of view is moved into its sector, over the local point distance.
///
/// Far above rounding, so that sight lines along a face do not cross it, far below anything that shapes the fields.
pub const SIGHT_SHIFT: f64 = 1e-6;

/// One sector of material around a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointCopy {
    /// The point.
    pub point: u32,
    /// From where visibility is asked: slightly inside the sector.
    pub sight: Vector2,
    /// Angle of the sector [rad]: 2π at a tip and inside the body.
    pub opening: f64,
    /// Unit vector along the middle of the sector; zero inside the body.
    pub middle: Vector2,
}

/// Triangles that cover the body.
#[derive(Clone, Debug, Default)]
pub struct Triangulation {
    /// Positions of the points.
    pub positions: Vec<Vector2>,
    /// Corners of triangles, counterclockwise, by copy.
    pub triangles: Vec<[u32; 3]>,
    /// Copies of the points, ordered by point.
    pub copies: Vec<PointCopy>,
    /// Boundary segments with their ends by copy.
    pub boundary: Vec<BoundarySegment>,
    /// Mean length of the edges at each point [length].
    pub edge_length: Vec<f64>,
}

impl Triangulation {
    /// Position of a copy.
    #[inline]
    pub fn position(&self, copy: u32) -> Vector2 {
        self.positions[self.copies[copy as usize].point as usize]
    }

    /// Mean length of the edges at the point next to a place [length].
    pub fn spacing_at(&self, place: Vector2) -> f64 {
        let away = |i: usize| (self.positions[i] - place).norm_squared();
        let nearest = (0..self.positions.len()).min_by(|a, b| away(*a).total_cmp(&away(*b)));
        nearest.map_or(f64::INFINITY, |i| self.edge_length[i])
    }

    /// Triangulates the points of `chains`; segments of the boundary and pieces of cracks become edges.
    pub fn new(chains: &Chains) -> Result<Self> {
        let triangles = inner_triangles(chains)?;
        let cracks: FxHashSet<[u32; 2]> = chains.crack_pieces.iter().map(|p| sorted(p.points)).collect();
        let mut result = Self { positions: chains.positions.clone(), ..Self::default() };
        result.measure_edges(&triangles);
        result.make_copies(&triangles, &cracks, chains);
        Ok(result)
    }

    fn measure_edges(&mut self, triangles: &[[u32; 3]]) {
        let mut sums = vec![(0.0, 0usize); self.positions.len()];
        for t in triangles {
            for k in 0..3 {
                let (a, b) = (t[k] as usize, t[(k + 1) % 3] as usize);
                let length = (self.positions[a] - self.positions[b]).norm();
                for i in [a, b] {
                    sums[i] = (sums[i].0 + length, sums[i].1 + 1);
                }
            }
        }
        self.edge_length = sums.iter().map(|s| s.0 / s.1.max(1) as f64).collect();
    }

    /// Walks around each point, from crack or boundary edge to crack or boundary edge.
    fn make_copies(&mut self, triangles: &[[u32; 3]], cracks: &FxHashSet<[u32; 2]>, chains: &Chains) {
        let mut around: Vec<Vec<(u32, u8)>> = vec![vec![]; self.positions.len()];
        for (i, t) in triangles.iter().enumerate() {
            for k in 0..3 {
                around[t[k] as usize].push((i as u32, k as u8));
            }
        }
        self.triangles = vec![[u32::MAX; 3]; triangles.len()];
        let mut starts_boundary = vec![u32::MAX; self.positions.len()];
        let mut ends_boundary = vec![u32::MAX; self.positions.len()];
        for (point, corners) in around.iter().enumerate() {
            for sector in sectors(point as u32, corners, triangles, cracks) {
                let copy = self.copies.len() as u32;
                self.copies.push(self.copy(point, &sector, triangles));
                for &(triangle, corner) in &sector.corners {
                    self.triangles[triangle as usize][corner as usize] = copy;
                }
                if sector.closed {
                    continue;
                }
                // The body lies to the left of a boundary segment: the first sector edge may start one, the last end one.
                let (first, last) = (sector.corners[0], sector.corners[sector.corners.len() - 1]);
                let next = triangles[first.0 as usize][(first.1 as usize + 1) % 3];
                let before = triangles[last.0 as usize][(last.1 as usize + 2) % 3];
                if !cracks.contains(&sorted([point as u32, next])) {
                    starts_boundary[point] = copy;
                }
                if !cracks.contains(&sorted([point as u32, before])) {
                    ends_boundary[point] = copy;
                }
            }
        }
        self.boundary = chains
            .boundary
            .iter()
            .map(|s| {
                let [a, b] = s.points;
                BoundarySegment { points: [starts_boundary[a as usize], ends_boundary[b as usize]], ..*s }
            })
            .collect();
    }

    fn copy(&self, point: usize, sector: &Sector, triangles: &[[u32; 3]]) -> PointCopy {
        let p = self.positions[point];
        if sector.closed {
            return PointCopy { point: point as u32, sight: p, opening: TAU, middle: Vector2::zeros() };
        }
        let (first, k) = sector.corners[0];
        let start = self.positions[triangles[first as usize][(k as usize + 1) % 3] as usize] - p;
        let opening: f64 = sector
            .corners
            .iter()
            .map(|&(t, k)| {
                let corner = |j: usize| self.positions[triangles[t as usize][(k as usize + j) % 3] as usize] - p;
                cross(corner(1), corner(2)).atan2(corner(1).dot(&corner(2)))
            })
            .sum();
        let middle = direction(start.y.atan2(start.x) + 0.5 * opening);
        let sight = if sector.is_tip { p } else { p + middle * (SIGHT_SHIFT * self.edge_length[point]) };
        PointCopy { point: point as u32, sight, opening, middle }
    }
}

/// Consecutive corners at one point, counterclockwise.
struct Sector {
    corners: Vec<(u32, u8)>,
    /// All around, without any edge that bounds it.
    closed: bool,
    /// All around, up to both sides of one and the same crack edge.
    is_tip: bool,
}

fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

fn sectors(point: u32, corners: &[(u32, u8)], triangles: &[[u32; 3]], cracks: &FxHashSet<[u32; 2]>) -> Vec<Sector> {
    let after = |c: (u32, u8)| triangles[c.0 as usize][(c.1 as usize + 1) % 3];
    let before = |c: (u32, u8)| triangles[c.0 as usize][(c.1 as usize + 2) % 3];
    let cut = |q: u32| cracks.contains(&sorted([point, q]));
    let mut used = vec![false; corners.len()];
    let mut result = vec![];
    // First those that begin at a bounding edge, then what is left: closed circles.
    for only_begins in [true, false] {
        for i in 0..corners.len() {
            let begins = cut(after(corners[i])) || !corners.iter().any(|&c| before(c) == after(corners[i]));
            if used[i] || (only_begins && !begins) {
                continue;
            }
            let mut sector = vec![];
            let mut current = Some(i);
            while let Some(j) = current {
                used[j] = true;
                sector.push(corners[j]);
                let edge = before(corners[j]);
                current =
                    if cut(edge) { None } else { (0..corners.len()).find(|&n| !used[n] && after(corners[n]) == edge) };
            }
            let (first, last) = (after(sector[0]), before(sector[sector.len() - 1]));
            let closed = !only_begins;
            result.push(Sector { corners: sector, closed, is_tip: !closed && first == last && cut(first) });
        }
    }
    result
}

/// Triangles inside the body, by point, without copies.
pub fn inner_triangles(chains: &Chains) -> Result<Vec<[u32; 3]>> {
    let failed = |reason: String| Error::NodeGeneration { reason };
    // Shifted and scaled to the unit box, where the predicates of the triangulation are safe for any unit.
    let bounds = crate::geometry::aabb::Aabb::of_points(chains.positions.iter().copied());
    let (origin, scale) = (bounds.lower, 1.0 / bounds.size().max());
    let points = chains.positions.iter().map(|p| (p - origin) * scale).map(|p| Point2::new(p.x, p.y)).collect();
    let lines: Vec<[usize; 2]> = chains
        .boundary
        .iter()
        .map(|s| s.points)
        .chain(chains.crack_pieces.iter().map(|c| c.points))
        .map(|[a, b]| [a as usize, b as usize])
        .collect();
    let mut conflict = None;
    let cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(points, lines, |e| conflict = Some(e))
        .map_err(|e| failed(format!("the triangulation refused a point: {e}")))?;
    if let Some([a, _]) = conflict {
        let p = chains.positions[a];
        return Err(failed(format!("boundary or crack lines cross near ({}, {})", p.x, p.y)));
    }
    if cdt.num_vertices() != chains.positions.len() {
        return Err(failed(format!("{} nodes coincide", chains.positions.len() - cdt.num_vertices())));
    }
    // Start at the triangles to the left of the boundary and flow to all that no boundary separates.
    let edge_of = |[a, b]: [u32; 2]| -> Option<_> {
        let from = cdt.get_vertex(spade::handles::FixedVertexHandle::from_index(a as usize))?;
        from.out_edges().find(|e| e.to().fix().index() == b as usize)
    };
    let boundary: FxHashSet<[u32; 2]> = chains.boundary.iter().map(|s| sorted(s.points)).collect();
    let mut inside = vec![false; cdt.num_all_faces()];
    let mut queue = vec![];
    for segment in &chains.boundary {
        let [a, b] = segment.points.map(|i| chains.positions[i as usize]);
        let edge = edge_of(segment.points).ok_or_else(|| {
            failed(format!("a node lies on the boundary between ({}, {}) and ({}, {})", a.x, a.y, b.x, b.y))
        })?;
        queue.extend(edge.face().as_inner().map(|f| f.fix()));
    }
    while let Some(face) = queue.pop() {
        if std::mem::replace(&mut inside[face.index()], true) {
            continue;
        }
        for edge in cdt.face(face).adjacent_edges() {
            let ends = sorted([edge.from().fix().index() as u32, edge.to().fix().index() as u32]);
            if !boundary.contains(&ends) {
                queue.extend(edge.rev().face().as_inner().map(|f| f.fix()));
            }
        }
    }
    Ok(cdt
        .inner_faces()
        .filter(|f| inside[f.fix().index()])
        .map(|f| f.vertices().map(|v| v.fix().index() as u32))
        .collect())
}
