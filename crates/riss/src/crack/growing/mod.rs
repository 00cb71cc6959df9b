//! Crack surfaces that grow by their fronts [C3D, section 2.4].
//!
//! A crack is a mesh in the body; its fronts are the edges of the rim that do not lie on the boundary. [`strip`] puts a
//! strip of triangles ahead of each front, past the boundary where it has to, and [`clip`] cuts off what leaves the
//! body: ends of fronts slide on the boundary, and what reaches it is front no more. [`join`] closes the gap between
//! fronts that meet, [`contact`] finds strips that run into the crack, [`smooth`] rounds
//! the fronts for others. Old triangles stay where they are; only what is new is added.

mod clip;
mod contact;
mod join;
mod smooth;
mod strip;
#[cfg(test)]
mod tests;

use super::front::{CrackFront, FrontPoint};
use super::shape::{CrackDefect, CrackShape};
use super::surface::{FEATURE_ANGLE, Position, position};
use crate::geometry::surface::{Shape, Surface, SurfaceDefect, TriangleMesh};
use crate::geometry::triangle::area_vector;
use crate::math::Vector3;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// A crack with its fronts, as plain values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GrowingCrack {
    vertices: Vec<Vector3>,
    triangles: Vec<[u32; 3]>,
    fronts: Vec<GrowingFront>,
}

/// A front: vertices of the crack in the direction of its tangents.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GrowingFront {
    /// Indices of the vertices; a closed front does not repeat its first.
    pub vertices: Vec<u32>,
    /// The same with axes.
    pub line: CrackFront,
}

/// How a vertex of a front moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontStep {
    /// Unit vector.
    pub direction: Vector3,
    /// How far [length]; the vertex stays if it is zero.
    pub length: f64,
}

/// What new fronts are made of.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EdgeLimits {
    /// Shorter edges of a new front lose a vertex [length].
    pub shortest: f64,
    /// Longer ones are split [length]; at least twice the shortest.
    pub longest: f64,
}

/// What is done otherwise where strips would run into the crack.
#[derive(Default)]
struct Changes {
    /// Ends of fronts whose strips are not carried on past them.
    short_ends: BTreeSet<u32>,
    /// Vertices that stay.
    held: BTreeSet<u32>,
}

impl EdgeLimits {
    /// Half and one and a half of a crack increment.
    pub fn of_increment(increment: f64) -> Self {
        Self { shortest: 0.5 * increment, longest: 1.5 * increment }
    }
}

impl FrontStep {
    /// A vertex that stays.
    pub fn none() -> Self {
        Self { direction: Vector3::zeros(), length: 0.0 }
    }

    /// Straight on.
    pub fn ahead(point: &FrontPoint, length: f64) -> Self {
        Self { direction: point.ahead, length }
    }

    fn is_move(&self) -> bool {
        self.length > 0.0
    }
}

impl GrowingCrack {
    /// The part of a shape inside a body.
    ///
    /// # Errors
    /// [`CrackDefect`] if the shape is none, or lies outside.
    pub fn new(shape: &CrackShape, body: &Surface) -> Result<Self, CrackDefect> {
        let surface = Surface::open(shape.mesh()?, FEATURE_ANGLE)?;
        let mut crack = Self { vertices: surface.vertices().to_vec(), triangles: vec![], fronts: vec![] };
        crack.triangles = clip::clip(&mut crack.vertices, surface.triangles(), body).triangles;
        if crack.triangles.is_empty() {
            return Err(CrackDefect::Outside);
        }
        crack.compact(0);
        crack.finished(body)
    }

    /// A first strip from a line, such as the root of a notch; its normal is that of line × direction.
    ///
    /// - `line`: points in order; those of an open line end on the boundary
    /// - `steps`: for each point, length above zero
    ///
    /// # Errors
    /// [`CrackDefect::Outside`] if no part of the strip is in the body.
    pub fn from_line(
        line: &[Vector3],
        is_closed: bool,
        steps: &[FrontStep],
        limits: &EdgeLimits,
        body: &Surface,
    ) -> Result<Self, CrackDefect> {
        let n = line.len();
        let at = |k: usize| line[if is_closed { k % n } else { k.min(n - 1) }];
        let normal = |k: usize| {
            let before = if is_closed || k > 0 { at(k + n - 1 - if is_closed { 0 } else { n }) } else { at(k) };
            (at(k + 1) - before).cross(&steps[k].direction).normalize()
        };
        let normals: Vec<Vector3> = (0..n).map(normal).collect();
        let front =
            GrowingFront { vertices: (0..n as u32).collect(), line: CrackFront::new(line, &normals, is_closed) };
        let seed = Self { vertices: line.to_vec(), triangles: vec![], fronts: vec![front] };
        let crack = seed.advanced(&[steps.to_vec()], limits, body, &[])?;
        if crack.triangles.is_empty() { Err(CrackDefect::Outside) } else { Ok(crack) }
    }

    /// The crack after its fronts moved.
    ///
    /// - `steps`: for each front, for each of its vertices
    /// - `others`: cracks that stop a front half of `limits.shortest` away from them
    ///
    /// Vertices near which strips would run into the crack itself stay. Old vertices keep their indices, and so do old
    /// triangles, unless a strip needs another vertex on an edge of theirs.
    ///
    /// # Errors
    /// [`CrackDefect::Surface`] if the strips make no surface.
    pub fn advanced(
        &self,
        steps: &[Vec<FrontStep>],
        limits: &EdgeLimits,
        body: &Surface,
        others: &[&Surface],
    ) -> Result<Self, CrackDefect> {
        let mut changes = Changes::default();
        loop {
            let (crack, contacts) = self.tried(steps, &changes, limits, body, others);
            if contacts.is_empty() {
                return crack.finished(body);
            }
            if !self.change_near(&contacts, steps, limits, &mut changes) {
                return Ok(self.clone());
            }
        }
    }

    /// The crack after a step with some changes, and where its new triangles run into others.
    fn tried(
        &self,
        steps: &[Vec<FrontStep>],
        changes: &Changes,
        limits: &EdgeLimits,
        body: &Surface,
        others: &[&Surface],
    ) -> (Self, Vec<Vector3>) {
        let mut crack = Self { vertices: self.vertices.clone(), triangles: self.triangles.clone(), fronts: vec![] };
        let bridges = join::bridges(self, &mut crack.vertices, steps, limits);
        let mut strips = strip::Strips::new(&mut crack.vertices, limits, body, others, &changes.short_ends);
        for (f, front) in self.fronts.iter().enumerate() {
            let stays = |k: usize| bridges.holds(f, k) || changes.held.contains(&front.vertices[k]);
            let step = |k: usize| if stays(k) { FrontStep::none() } else { steps[f][k] };
            strips.advance(front, &(0..front.vertices.len()).map(step).collect::<Vec<_>>());
        }
        let (mut triangles, mut bases) = (strips.triangles, strips.bases);
        triangles.extend(&bridges.triangles);
        bases.extend(&bridges.bases);
        let cut = clip::clip(&mut crack.vertices, &triangles, body);
        clip::split_edges(&mut crack.triangles, &cut.on_edges);
        let n_old = crack.triangles.len();
        crack.triangles.extend(clip::connected(&cut, &bases));
        crack.compact(self.vertices.len());
        let contacts = contact::contacts(&crack.vertices, &crack.triangles, n_old);
        (crack, contacts)
    }

    /// Changes the step near some places: ends of fronts are no longer carried on beyond the boundary, then vertices
    /// stay; false if there is nothing to change.
    fn change_near(
        &self,
        places: &[Vector3],
        steps: &[Vec<FrontStep>],
        limits: &EdgeLimits,
        changes: &mut Changes,
    ) -> bool {
        let n_before = (changes.short_ends.len(), changes.held.len());
        let is_near = |k: &FrontPoint, reach: f64| places.iter().any(|p| (p - k.position).norm() <= reach);
        for (front, steps) in self.fronts.iter().zip(steps) {
            for k in [0, front.vertices.len() - 1] {
                let reach = strip::PAST_END * steps[k].length.max(limits.longest) + steps[k].length;
                if !front.line.is_closed && is_near(&front.line.points[k], reach) {
                    changes.short_ends.insert(front.vertices[k]);
                }
            }
        }
        if changes.short_ends.len() > n_before.0 {
            return true;
        }
        for (front, steps) in self.fronts.iter().zip(steps) {
            for ((v, point), step) in front.vertices.iter().zip(&front.line.points).zip(steps) {
                if step.is_move() && is_near(point, step.length + limits.longest) {
                    changes.held.insert(*v);
                }
            }
        }
        changes.held.len() > n_before.1
    }

    /// Corner points.
    pub fn vertices(&self) -> &[Vector3] {
        &self.vertices
    }

    /// Corners of the triangles, counterclockwise as seen from the positive side.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Where it ends inside the body.
    pub fn fronts(&self) -> &[GrowingFront] {
        &self.fronts
    }

    /// Its area in the body [area].
    pub fn area(&self) -> f64 {
        self.triangles.iter().map(|t| 0.5 * area_vector(t.map(|v| self.vertices[v as usize])).norm()).sum()
    }

    /// Its triangles.
    pub fn mesh(&self) -> TriangleMesh {
        mesh_of(self.vertices.clone(), self.triangles.clone())
    }

    /// The shape with smooth fronts, for [`super::CrackSurface::new`].
    pub fn shape(&self) -> CrackShape {
        let (vertices, triangles) = smooth::smoothed(self);
        CrackShape::Triangles(mesh_of(vertices, triangles))
    }

    /// Two cracks as one with the steps of its fronts, if their fronts face each other in one plane and would meet;
    /// the second is turned if its normals disagree with those of the first.
    pub fn joined(
        cracks: [&Self; 2],
        steps: [&[Vec<FrontStep>]; 2],
        limits: &EdgeLimits,
        body: &Surface,
    ) -> Option<(Self, Vec<Vec<FrontStep>>)> {
        join::united(cracks, steps, limits, body)
    }

    /// Both cracks as one.
    fn united(&self, other: &Self, body: &Surface) -> Result<Self, CrackDefect> {
        let mean =
            |c: &Self| c.triangles.iter().map(|t| area_vector(t.map(|v| c.vertices[v as usize]))).sum::<Vector3>();
        let is_turned = mean(self).dot(&mean(other)) < 0.0;
        let mut crack = self.clone();
        let n = self.vertices.len() as u32;
        crack.vertices.extend(&other.vertices);
        let turn = |[a, b, c]: [u32; 3]| if is_turned { [a + n, c + n, b + n] } else { [a + n, b + n, c + n] };
        crack.triangles.extend(other.triangles.iter().map(|t| turn(*t)));
        crack.finished(body)
    }

    /// Leaves out vertices from `first` on that no triangle uses.
    fn compact(&mut self, first: usize) {
        let mut is_used = vec![false; self.vertices.len()];
        is_used[..first].fill(true);
        self.triangles.iter().flatten().for_each(|v| is_used[*v as usize] = true);
        let mut next = 0;
        let index: Vec<u32> = is_used
            .iter()
            .map(|used| {
                next += u32::from(*used);
                next.wrapping_sub(1)
            })
            .collect();
        self.triangles.iter_mut().flatten().for_each(|v| *v = index[*v as usize]);
        let mut k = 0;
        self.vertices.retain(|_| {
            k += 1;
            is_used[k - 1]
        });
    }

    /// Checks the mesh and finds its fronts.
    fn finished(mut self, body: &Surface) -> Result<Self, CrackDefect> {
        let mut edges: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        for (t, corners) in self.triangles.iter().enumerate() {
            for k in 0..3 {
                let edge = [corners[k], corners[(k + 1) % 3]];
                if edges.insert(edge, t as u32).is_some() {
                    let at = (self.vertices[edge[0] as usize] + self.vertices[edge[1] as usize]) * 0.5;
                    return Err(SurfaceDefect::Branches { at }.into());
                }
            }
        }
        let is_front = |[a, b]: [u32; 2]| {
            let middle = (self.vertices[a as usize] + self.vertices[b as usize]) * 0.5;
            !edges.contains_key(&[b, a]) && position(body, middle) != Position::OnBoundary
        };
        // The rim runs against the tangents.
        let mut next: BTreeMap<u32, Vec<(u32, u32)>> = BTreeMap::new();
        let mut n_before: BTreeMap<u32, usize> = BTreeMap::new();
        for ([a, b], t) in edges.iter().filter(|(e, _)| is_front(**e)) {
            next.entry(*b).or_default().push((*a, *t));
            *n_before.entry(*a).or_default() += 1;
        }
        let starts: Vec<u32> = next.keys().copied().collect();
        let is_first = |v: &u32| n_before.get(v).copied().unwrap_or(0) < next[v].len();
        let order: Vec<u32> = starts.iter().copied().filter(is_first).chain(starts.iter().copied()).collect();
        let mut fronts = vec![];
        for start in order {
            while let Some((to, t)) = next.get_mut(&start).and_then(Vec::pop) {
                let (mut vertices, mut triangles) = (vec![start, to], vec![t]);
                while let Some((to, t)) = next.get_mut(&vertices[vertices.len() - 1]).and_then(Vec::pop) {
                    triangles.push(t);
                    if to == start {
                        break;
                    }
                    vertices.push(to);
                }
                let is_closed = triangles.len() == vertices.len();
                fronts.push(self.front(vertices, &triangles, is_closed));
            }
        }
        self.fronts = fronts;
        Ok(self)
    }

    /// A front with its axes; `triangles` are those at its edges.
    fn front(&self, vertices: Vec<u32>, triangles: &[u32], is_closed: bool) -> GrowingFront {
        let m = triangles.len();
        let unit = |k: usize| {
            area_vector(self.triangles[triangles[k] as usize].map(|v| self.vertices[v as usize])).normalize()
        };
        let normal = |k: usize| match (is_closed, k) {
            (true, _) => unit(k) + unit((k + m - 1) % m),
            (false, 0) => unit(0),
            (false, _) => unit(k - 1) + unit(k.min(m - 1)),
        };
        let normals: Vec<Vector3> = (0..vertices.len()).map(|k| normal(k).normalize()).collect();
        let positions: Vec<Vector3> = vertices.iter().map(|v| self.vertices[*v as usize]).collect();
        GrowingFront { vertices, line: CrackFront::new(&positions, &normals, is_closed) }
    }
}

fn mesh_of(vertices: Vec<Vector3>, triangles: Vec<[u32; 3]>) -> TriangleMesh {
    let mut mesh = TriangleMesh { part_of: vec![0; triangles.len()], vertices, triangles, parts: vec![] };
    mesh.add_part("crack", Shape::Triangles);
    mesh
}
