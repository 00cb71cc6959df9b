//! From elements to boundary loops: the edges that belong to one cell only.

use super::format::{RawElement, RawMesh, RawNode, Shape};
use super::{BoundaryEdge, GmshError, GmshModel, Place};
use crate::geometry::aabb::Aabb;
use crate::geometry::polygon;
use crate::math::Vector2;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Deviation of z from the plane, over the size of the mesh: beyond the 16 digits of the file.
const PLANE_TOLERANCE: f64 = 1e-9;
/// Area of a cell over the square of its longest edge below which it counts as degenerate: far from any useful cell,
/// well above roundoff.
const AREA_TOLERANCE: f64 = 1e-12;

/// Boundary loops of a mesh.
pub(in crate::case) fn build(mesh: &RawMesh) -> Result<GmshModel, GmshError> {
    let surface = || mesh.elements.iter().filter(|e| matches!(e.shape, Shape::Triangle | Shape::Quad));
    check_nodes(mesh, surface())?;
    let mut cells = Cells::default();
    let mut seen = HashSet::new();
    for element in surface() {
        // A cell in two physical groups is in a file of version 2.2 twice.
        let mut corners = element.nodes[..n_corners(element.shape)].to_vec();
        corners.sort_unstable();
        if seen.insert(corners) {
            cells.push(mesh, element)?;
        }
    }
    let (parts, parts_of_line) = line_parts(mesh);
    let mut loops = cells.loops(mesh, &parts_of_line)?;
    let (vertices, midside) = (cells.vertices, cells.midside);
    order_loops(&vertices, &mut loops)?;
    let mut model =
        GmshModel { vertices, triangles: cells.triangles, quads: cells.quads, parts, boundary: loops, midside };
    drop_unused_parts(&mut model);
    Ok(model)
}

fn n_corners(shape: Shape) -> usize {
    match shape {
        // Solids are refused before.
        Shape::Point | Shape::Solid => 1,
        Shape::Line => 2,
        Shape::Triangle => 3,
        Shape::Quad => 4,
    }
}

/// Cells so far, and all their edges.
#[derive(Default)]
struct Cells {
    vertices: Vec<Vector2>,
    /// Tag of each vertex.
    tags: Vec<u64>,
    index: HashMap<u64, u32>,
    triangles: Vec<[u32; 3]>,
    quads: Vec<[u32; 4]>,
    /// Edges with their cell to the left, in the order of the cells; with the midside node, if there is one.
    edges: Vec<(u32, u32, Option<u64>)>,
    /// Vertices in the middle of an edge.
    midside: BTreeSet<u32>,
    /// The edges by both ends.
    by_ends: HashSet<(u32, u32)>,
}

impl Cells {
    fn vertex(&mut self, mesh: &RawMesh, tag: u64) -> u32 {
        *self.index.entry(tag).or_insert_with(|| {
            let [x, y, _] = mesh.nodes[&tag].position;
            self.vertices.push(Vector2::new(x, y));
            self.tags.push(tag);
            self.vertices.len() as u32 - 1
        })
    }

    fn push(&mut self, mesh: &RawMesh, element: &RawElement) -> Result<(), GmshError> {
        let n = n_corners(element.shape);
        let place = element.place;
        let mut corners: Vec<u32> = element.nodes[..n].iter().map(|&tag| self.vertex(mesh, tag)).collect();
        let mut middles: Vec<Option<u64>> = (0..n).map(|k| element.nodes.get(n + k).copied()).collect();
        let points: Vec<Vector2> = corners.iter().map(|&v| self.vertices[v as usize]).collect();
        let area = polygon::area(&points);
        let longest = polygon::edges(&points).map(|(a, b)| (b - a).norm_squared()).fold(0.0, f64::max);
        // Coordinates beyond 1e154 overflow.
        if area.abs() <= AREA_TOLERANCE * longest || !area.is_finite() {
            return Err(element_error(place, format!("the cell at ({}, {}) has no area", points[0].x, points[0].y)));
        }
        if area < 0.0 {
            // Corners n-1, …, 0; the edge after corner k ends at corner k-1 and was number k-1.
            corners.reverse();
            middles.reverse();
            middles.rotate_left(1);
        }
        for k in 0..n {
            let (a, b) = (corners[k], corners[(k + 1) % n]);
            if !self.by_ends.insert((a, b)) {
                let at = points[0];
                return Err(element_error(place, format!("the cell at ({}, {}) overlaps another", at.x, at.y)));
            }
            self.edges.push((a, b, middles[k]));
        }
        match element.shape {
            Shape::Triangle => self.triangles.push([corners[0], corners[1], corners[2]]),
            _ => self.quads.push([corners[0], corners[1], corners[2], corners[3]]),
        }
        Ok(())
    }

    /// Closed loops of edges without a neighbor, each with the parts of the line on it.
    fn loops(&mut self, mesh: &RawMesh, parts_of_line: &PartsOfLine) -> Result<Vec<Vec<BoundaryEdge>>, GmshError> {
        let edges = std::mem::take(&mut self.edges);
        let free: Vec<_> = edges.into_iter().filter(|(a, b, _)| !self.by_ends.contains(&(*b, *a))).collect();
        let mut after: HashMap<u32, (u32, Option<u64>)> = HashMap::new();
        for &(a, b, middle) in &free {
            if after.insert(a, (b, middle)).is_some() {
                return Err(GmshError::TouchingBoundary { at: self.vertices[a as usize] });
            }
        }
        let mut loops = vec![];
        // Each edge of a closed chain of cells has a next one, so every walk ends where it began.
        for (first, ..) in free {
            let mut edges = vec![];
            let mut start = first;
            while let Some((end, middle)) = after.remove(&start) {
                let ends = [self.tags[start as usize], self.tags[end as usize]];
                let parts: Vec<usize> =
                    parts_of_line.get(&ordered(ends)).map(|p| p.iter().copied().collect()).unwrap_or_default();
                let mut from = start;
                if let Some(tag) = middle {
                    let middle = self.vertex(mesh, tag);
                    self.midside.insert(middle);
                    edges.push(BoundaryEdge { start: from, end: middle, parts: parts.clone() });
                    from = middle;
                }
                edges.push(BoundaryEdge { start: from, end, parts });
                start = end;
            }
            if !edges.is_empty() {
                loops.push(edges);
            }
        }
        Ok(loops)
    }
}

fn element_error(place: Place, problem: String) -> GmshError {
    GmshError::Content { place, section: "Elements".into(), problem }
}

fn ordered([a, b]: [u64; 2]) -> (u64, u64) {
    (a.min(b), a.max(b))
}

/// All nodes of the surface are there and in one plane.
fn check_nodes<'a>(mesh: &RawMesh, surface: impl Iterator<Item = &'a RawElement> + Clone) -> Result<(), GmshError> {
    let mut bounds = Aabb::<3>::empty();
    for element in surface.clone() {
        for tag in &element.nodes {
            let missing = || element_error(element.place, format!("node {tag} is missing"));
            bounds = bounds.including(mesh.nodes.get(tag).ok_or_else(missing)?.position.into());
        }
    }
    let mut nodes = surface.flat_map(|e| &e.nodes);
    let plane = mesh.nodes[nodes.clone().next().ok_or(GmshError::NoSurface)?].position[2];
    let tolerance = PLANE_TOLERANCE * bounds.size().norm();
    match nodes.find(|tag| (mesh.nodes[tag].position[2] - plane).abs() > tolerance) {
        None => Ok(()),
        Some(&node) => {
            let RawNode { position: [_, _, z], place } = mesh.nodes[&node];
            Err(GmshError::NotPlane { place, node, z, plane })
        }
    }
}

/// Parts of each line by the tags of its ends, the lesser first.
type PartsOfLine = HashMap<(u64, u64), BTreeSet<usize>>;

/// Names of all physical line groups in the order of tags, and those of each line by the tags of its ends.
fn line_parts(mesh: &RawMesh) -> (Vec<String>, PartsOfLine) {
    let lines = || mesh.elements.iter().filter(|e| e.shape == Shape::Line);
    let tags: BTreeSet<u32> = lines().flat_map(|e| e.groups.iter().copied()).collect();
    let mut names: Vec<String> = vec![];
    let mut part_of_name = HashMap::new();
    let mut part_of_tag = BTreeMap::new();
    for tag in tags {
        let name = mesh.line_groups.get(&tag).cloned().unwrap_or_else(|| format!("physical-{tag}"));
        // Two groups of one name are one part.
        let part = *part_of_name.entry(name.clone()).or_insert(names.len());
        if part == names.len() {
            names.push(name);
        }
        part_of_tag.insert(tag, part);
    }
    let mut parts_of_line: HashMap<_, BTreeSet<usize>> = HashMap::new();
    for line in lines() {
        let parts = line.groups.iter().map(|tag| part_of_tag[tag]);
        parts_of_line.entry(ordered([line.nodes[0], line.nodes[1]])).or_default().extend(parts);
    }
    (names, parts_of_line)
}

/// Outline first, holes sorted, each from its least vertex.
fn order_loops(vertices: &[Vector2], loops: &mut [Vec<BoundaryEdge>]) -> Result<(), GmshError> {
    let at = |v: u32| vertices[v as usize];
    let key = |v: u32| (at(v).x, at(v).y);
    let less = |a: (f64, f64), b: (f64, f64)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1));
    let mut outlines = vec![];
    for edges in loops.iter_mut() {
        let least = (0..edges.len()).min_by(|&i, &j| less(key(edges[i].start), key(edges[j].start)));
        edges.rotate_left(least.unwrap_or(0));
        let points: Vec<Vector2> = edges.iter().map(|e| at(e.start)).collect();
        let area = polygon::area(&points);
        let perimeter: f64 = polygon::edges(&points).map(|(a, b)| (b - a).norm()).sum();
        if area.abs() <= AREA_TOLERANCE * perimeter * perimeter || !area.is_finite() {
            return Err(GmshError::CutOpen { at: points[0] });
        }
        if area > 0.0 {
            outlines.push(points[0]);
        }
    }
    match outlines[..] {
        [] => return Err(GmshError::NoSurface),
        [_] => {}
        [_, second, ..] => return Err(GmshError::SeveralPieces { count: outlines.len(), at: second }),
    }
    let is_hole = |edges: &[BoundaryEdge]| {
        let points: Vec<Vector2> = edges.iter().map(|e| at(e.start)).collect();
        polygon::area(&points) < 0.0
    };
    loops.sort_by(|a, b| is_hole(a).cmp(&is_hole(b)).then(less(key(a[0].start), key(b[0].start))));
    Ok(())
}

/// Groups of lines inside the body name no part of the boundary.
fn drop_unused_parts(model: &mut GmshModel) {
    let used: BTreeSet<usize> = model.boundary.iter().flatten().flat_map(|e| e.parts.iter().copied()).collect();
    let new: BTreeMap<usize, usize> = used.iter().enumerate().map(|(new, &old)| (old, new)).collect();
    model.parts = used.iter().map(|&old| std::mem::take(&mut model.parts[old])).collect();
    for part in model.boundary.iter_mut().flatten().flat_map(|e| e.parts.iter_mut()) {
        *part = new[part];
    }
}
