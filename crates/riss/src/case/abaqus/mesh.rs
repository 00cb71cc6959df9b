//! Elements to boundary loops with named parts: surfaces, sets of nodes, sets of line elements and loaded faces.

use super::AbaqusError;
use super::deck::{Deck, Element, Kind, key};
use crate::case::gmsh::{GmshError, GmshModel, Place, RawElement, RawMesh, RawNode, Shape, build};
use std::collections::{BTreeMap, HashMap, HashSet};

/// Corners of an edge, the lesser first.
type Edge = (u64, u64);

/// Edges of the boundary with their midside node.
pub(super) struct Faces {
    boundary: BTreeMap<Edge, Option<u64>>,
}

fn ordered(a: u64, b: u64) -> Edge {
    (a.min(b), a.max(b))
}

/// Corners of face `face` (from 1), and its midside node.
fn face(element: &Element, face: usize) -> Option<(Edge, Option<u64>)> {
    let n = element.n_corners;
    let (a, b) = (*element.nodes[..n].get(face - 1)?, element.nodes[face % n]);
    let middle = (element.nodes.len() > n).then(|| element.nodes[n + face - 1]);
    Some((ordered(a, b), middle))
}

pub(super) fn is_plane(element: &Element) -> bool {
    element.kind != Kind::Line
}

impl Faces {
    pub fn new(deck: &Deck) -> Self {
        let mut count: HashMap<Edge, (usize, Option<u64>)> = HashMap::new();
        for element in deck.elements.iter().filter(|e| is_plane(e)) {
            for (edge, middle) in (1..=element.n_corners).filter_map(|k| face(element, k)) {
                count.entry(edge).or_insert((0, middle)).0 += 1;
            }
        }
        let free = count.into_iter().filter(|(_, (n, _))| *n == 1);
        Self { boundary: free.map(|(edge, (_, middle))| (edge, middle)).collect() }
    }

    /// Edges of the boundary all of whose nodes are in a set.
    pub fn within(&self, nodes: &HashSet<u64>) -> Vec<Edge> {
        let holds = |(edge, middle): &(&Edge, &Option<u64>)| {
            nodes.contains(&edge.0) && nodes.contains(&edge.1) && middle.is_none_or(|m| nodes.contains(&m))
        };
        self.boundary.iter().filter(holds).map(|(edge, _)| *edge).collect()
    }

    /// All nodes of some edges.
    pub fn nodes_of(&self, edges: &[Edge]) -> HashSet<u64> {
        let nodes = |e: &Edge| [e.0, e.1].into_iter().chain(self.boundary.get(e).copied().flatten());
        edges.iter().flat_map(nodes).collect()
    }

    fn is_free(&self, edge: &Edge) -> bool {
        self.boundary.contains_key(edge)
    }
}

/// Elements by label or set, without those that are not read.
pub(super) fn elements<'d>(deck: &'d Deck, target: &str) -> Option<Vec<&'d Element>> {
    let by_label = |label: &u64| deck.by_label.get(label).map(|k| &deck.elements[*k]);
    if let Ok(label) = target.parse::<u64>() {
        return by_label(&label).map(|e| vec![e]);
    }
    deck.element_sets.get(&key(target)).map(|set| set.members.iter().filter_map(by_label).collect())
}

/// Name of the part that a load on faces of elements makes.
pub(super) fn face_part(target: &str, face: usize) -> String {
    format!("{target}-P{face}")
}

/// Boundary edges of face `number` of elements.
fn edges_of(deck: &Deck, faces: &Faces, target: &str, number: usize) -> Option<Vec<Edge>> {
    let edges = elements(deck, target)?.into_iter().filter_map(|e| face(e, number)).map(|f| f.0);
    Some(edges.filter(|e| faces.is_free(e)).collect())
}

/// Parts of the boundary by name, in the order of the alphabet within each family; a name comes once.
pub(super) fn parts(deck: &Deck, faces: &Faces) -> Result<Vec<(String, Vec<Edge>)>, AbaqusError> {
    let mut parts: Vec<(String, Vec<Edge>)> = vec![];
    let mut push = |name: &str, edges: Vec<Edge>| {
        if !edges.is_empty() && !parts.iter().any(|p| key(&p.0) == key(name)) {
            parts.push((name.into(), edges));
        }
    };
    for (name, list) in deck.surfaces.values() {
        let mut edges = vec![];
        for (target, number) in list {
            let unknown = || AbaqusError::Whole(format!("surface {name}: there are no elements `{target}`"));
            edges.extend(edges_of(deck, faces, target, *number).ok_or_else(unknown)?);
        }
        push(name, edges);
    }
    for set in deck.node_sets.values() {
        push(&set.name, faces.within(&set.members.iter().copied().collect()));
    }
    for set in deck.element_sets.values() {
        let lines = elements(deck, &set.name).unwrap_or_default();
        let nodes = |e: &&Element| e.nodes.clone();
        let mut edges: Vec<Edge> = vec![];
        for nodes in lines.iter().filter(|e| !is_plane(e)).map(nodes) {
            // Programs put the midside node of a line second or last; any pair of corners will do.
            edges.extend(nodes.iter().flat_map(|a| nodes.iter().map(|b| ordered(*a, *b))));
        }
        edges.retain(|e| faces.is_free(e));
        edges.sort_unstable();
        edges.dedup();
        push(&set.name, edges);
    }
    for load in &deck.element_loads {
        if let Some(number) = pressure_face(&load.fields[0]) {
            let edges = edges_of(deck, faces, &load.target, number).unwrap_or_default();
            push(&face_part(&load.target, number), edges);
        }
    }
    Ok(parts)
}

/// The face of a load such as `P2`.
pub(super) fn pressure_face(kind: &str) -> Option<usize> {
    kind.to_uppercase().strip_prefix('P')?.parse().ok().filter(|face| (1..=4).contains(face))
}

/// The mesh with its loops, and which of its vertices are midside nodes.
pub(super) fn model(deck: &Deck, parts: &[(String, Vec<Edge>)]) -> Result<GmshModel, AbaqusError> {
    let raw_node = |(label, (position, line)): (&u64, &([f64; 3], usize))| {
        (*label, RawNode { position: *position, place: Place::Line(*line) })
    };
    let mut mesh = RawMesh { nodes: deck.nodes.iter().map(raw_node).collect(), ..RawMesh::default() };
    for element in deck.elements.iter().filter(|e| is_plane(e)) {
        mesh.elements.push(RawElement {
            shape: if element.n_corners == 3 { Shape::Triangle } else { Shape::Quad },
            nodes: element.nodes.clone(),
            groups: vec![],
            place: Place::Line(element.line),
        });
    }
    for (index, (name, edges)) in parts.iter().enumerate() {
        let tag = index as u32;
        mesh.line_groups.insert(tag, name.clone());
        let line = |e: &Edge| RawElement {
            shape: Shape::Line,
            nodes: vec![e.0, e.1],
            groups: vec![tag],
            place: Place::Line(0),
        };
        mesh.elements.extend(edges.iter().map(line));
    }
    build(&mesh).map_err(in_words)
}

/// What is wrong with the mesh, without the words of Gmsh.
fn in_words(error: GmshError) -> AbaqusError {
    match error {
        GmshError::Content { place: Place::Line(line), problem, .. } => {
            AbaqusError::Line { line, keyword: "ELEMENT".into(), problem }
        }
        GmshError::NotPlane { place: Place::Line(line), node, z, plane } => {
            let problem = format!("the mesh is not plane: node {node} has z = {z}, others have z = {plane}");
            AbaqusError::Line { line, keyword: "NODE".into(), problem }
        }
        GmshError::NoSurface => {
            AbaqusError::Whole("there are no plane elements such as CPS4, CPS8R, CPE3 or CPE6".into())
        }
        GmshError::TouchingBoundary { at } => {
            AbaqusError::Whole(format!("the boundary of the mesh touches itself at ({}, {})", at.x, at.y))
        }
        GmshError::CutOpen { at } => AbaqusError::Whole(format!(
            "the mesh is cut open at ({}, {}); leave cracks out of the mesh and give them as [[crack]]",
            at.x, at.y
        )),
        GmshError::SeveralPieces { count, at } => AbaqusError::Whole(format!(
            "the mesh falls into {count} pieces, one of them at ({}, {}); one connected body is needed",
            at.x, at.y
        )),
        other @ (GmshError::Content { .. } | GmshError::NotPlane { .. } | GmshError::Version { .. }) => {
            AbaqusError::Whole(other.to_string())
        }
    }
}
