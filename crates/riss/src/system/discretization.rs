//! Everything discrete about a body, read-only once built: nodes, supports, cells, neighbor lists.

use super::constraints::Supports;
use super::safeguard::{Parts, safeguard};
use super::settings::ConstraintMethod;
use crate::approximation::discontinuity::{Barriers, barriers, visibility_obstacles};
use crate::approximation::enrichment::TipSpacing;
use crate::approximation::moving_least_squares::{Derivatives, support_radii};
use crate::approximation::{
    ApproximationSettings, CrackSmoothing, Enrichment, FiniteElements, MovingLeastSquares, SpacingFrom, Surroundings,
};
use crate::crack::{CrackParticles, CrackPath};
use crate::error::Result;
use crate::geometry::aabb::Aabb;
use crate::geometry::obstacles::Obstacles;
use crate::geometry::predicates::distance_to_segment;
use crate::integration::{
    BoundaryElement, CrackFaceElement, GradientCorrection, IntegrationCells, IntegrationSettings, Scheme, TipRule,
    boundary_elements, crack_face_elements,
};
use crate::math::Vector2;
use crate::model::Model;
use crate::nodes::elements::Element;
use crate::nodes::support::neighbor_distances;
use crate::nodes::triangulation::PointCopy;
use crate::nodes::{Layered, Nodes, Triangulation};
use std::borrow::Cow;
use std::ops::Range;

/// Lists of node indices, one after the other.
#[derive(Clone, Debug, Default)]
pub struct NodeLists {
    ends: Vec<usize>,
    nodes: Vec<u32>,
}

impl NodeLists {
    /// Joins lists, each ascending.
    pub fn from_lists(lists: &[Vec<u32>]) -> Self {
        let mut result = Self::default();
        for list in lists {
            result.nodes.extend_from_slice(list);
            result.ends.push(result.nodes.len());
        }
        result
    }

    /// Number of lists.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    fn range(&self, i: usize) -> Range<usize> {
        (if i == 0 { 0 } else { self.ends[i - 1] })..self.ends[i]
    }

    /// The list at `i`, ascending.
    pub fn get(&self, i: usize) -> &[u32] {
        &self.nodes[self.range(i)]
    }

    /// All lists.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        (0..self.len()).map(|i| self.get(i))
    }
}

/// The discrete body.
#[derive(Clone, Debug)]
pub struct Discretization {
    /// Shape functions.
    pub approximation: MovingLeastSquares,
    /// Points, triangles and boundary behind nodes and cells.
    pub triangulation: Triangulation,
    /// Node at each copy of the triangulation, if one stands there.
    pub node_of_copy: Vec<Option<u32>>,
    /// Integration cells.
    pub cells: IntegrationCells,
    /// Boundary elements.
    pub boundary: Vec<BoundaryElement>,
    /// Elements along cracks whose faces something acts on.
    pub crack_faces: Vec<CrackFaceElement>,
    /// Particles of each crack; none where cracks are paths.
    pub particles: Vec<CrackParticles>,
    /// Neighbors of each cell, additional functions included.
    pub cell_nodes: NodeLists,
    /// Cells around which nothing hides or enriches nodes.
    pub plain_cells: Vec<bool>,
    /// Neighbors of each boundary element.
    pub boundary_nodes: NodeLists,
    /// What could not be done as the settings say.
    pub notes: Vec<String>,
}

impl Discretization {
    /// Builds supports, cells and neighbor lists on generated nodes.
    ///
    /// # Errors
    /// [`crate::Error::SingularMomentMatrix`] where no enlargement of supports makes the fit possible.
    pub fn new(
        model: &Model,
        layered: Layered,
        approximation: &ApproximationSettings,
        integration: &IntegrationSettings,
        constraints: &ConstraintMethod,
    ) -> Result<Self> {
        let Layered { mut chains, triangulation, grid_step, particles } = layered;
        let elements = match grid_step {
            Some(_) => Element::joined(&triangulation, &model.domain),
            None => Element::triangles(&triangulation),
        };
        let is_meshfree = meshfree_copies(model, &triangulation, approximation, constraints);
        for element in elements.iter().filter(|e| e.corners().iter().any(|c| !is_meshfree[*c as usize])) {
            // Its functions belong to nodes.
            element
                .corners()
                .iter()
                .for_each(|c| chains.is_node[triangulation.copies[*c as usize].point as usize] = true);
        }
        let (mut nodes, mut node_of_copy) = nodes_of(&triangulation, &chains.is_node);
        let seen = &as_particles_say(model, &particles);
        let obstacles = visibility_obstacles(seen, &triangulation);
        set_supports(&mut nodes, &triangulation, &node_of_copy, &obstacles, approximation, grid_step);
        let spacings = TipSpacing::of_tips(model, &nodes, approximation.dilation(grid_step.is_some()));
        let approximation = &match integration.scheme {
            Scheme::Elements | Scheme::Cells { .. } => approximation.decided(model, &spacings),
            Scheme::Nodal { .. } => approximation.without_automatic_enrichment(),
        };
        let smoothing = approximation.resolved_smoothing();
        let barriers = barriers(seen, &triangulation, &smoothing);
        let (enrichment, notes) = Enrichment::of_model(model, &approximation.enrichment, &spacings);
        if let Some(enrichment) = &enrichment {
            enlarge_in_regions(&mut nodes, enrichment, approximation, grid_step);
        }
        if smoothing.cracks() == CrackSmoothing::SeeThrough {
            join_sides(&mut nodes, &mut node_of_copy, &barriers, approximation);
        }
        let integration = &match enrichment {
            Some(_) => integration.at_tips(TipRule::Graded),
            None => integration.at_tips(TipRule::Product),
        };
        let tips: Vec<Vector2> = model.tips().iter().map(|t| t.1.position).collect();
        let mut cells = match integration.scheme {
            Scheme::Elements => {
                IntegrationCells::elements(&triangulation, &model.domain, &tips, grid_step.is_some(), integration)
            }
            Scheme::Cells { size } => IntegrationCells::background(model, &triangulation, &tips, size, integration)?,
            Scheme::Nodal { stabilization } => {
                IntegrationCells::nodal(&triangulation, &model.domain, stabilization, integration)
            }
        };
        if integration.gradient_correction == GradientCorrection::None && cells.smoothing.is_none() {
            cells.drop_outlines();
        }
        let boundary = boundary_elements(&triangulation, &model.domain, integration);
        let elements = FiniteElements::new(&elements, &triangulation, &model.domain, &is_meshfree, &node_of_copy);
        let start =
            MovingLeastSquares::new(nodes, barriers.clone(), *approximation).enriched(enrichment).coupled(elements);
        let crack_faces = crack_face_elements(model, &chains, integration);
        let parts = Parts { cells: &cells, boundary: &boundary, crack_faces: &crack_faces };
        let (approximation, lists, mut plain_cells) = safeguard(start, obstacles, &barriers, &parts)?;
        plain_cells.truncate(cells.len());
        let (of_cells, rest) = lists.split_at(cells.len());
        let [cell_nodes, boundary_nodes] = [of_cells, &rest[..boundary.len()]].map(NodeLists::from_lists);
        Ok(Self {
            approximation,
            triangulation,
            node_of_copy,
            cells,
            boundary,
            crack_faces,
            particles,
            cell_nodes,
            plain_cells,
            boundary_nodes,
            notes,
        })
    }

    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.approximation.nodes().len()
    }

    /// Number of functions, each with two unknowns: those of nodes, and further ones of enriched nodes.
    pub fn n_functions(&self) -> usize {
        self.approximation.n_functions()
    }

    /// From where a given point sees: slightly inside if it lies on the boundary.
    pub fn sight_at(&self, model: &Model, p: Vector2) -> Vector2 {
        let (edge, t) = model.domain.closest_edge(p);
        let curve = &model.domain.edges[edge];
        let size = model.domain.aabb().size().max();
        if (curve.point(t) - p).norm() > 1e-9 * size {
            return p;
        }
        let nearest =
            |c: &crate::nodes::triangulation::PointCopy| (self.triangulation.positions[c.point as usize] - p).norm();
        let boundary = self.triangulation.boundary.iter().map(|s| &self.triangulation.copies[s.points[0] as usize]);
        let copy = boundary.min_by(|a, b| nearest(a).total_cmp(&nearest(b))).expect("the boundary has points");
        // Toward where the nearest boundary node sees from: inside, at corners too.
        let q = self.triangulation.positions[copy.point as usize];
        p + (copy.sight - q)
    }
}

/// The model with its cracks as the particles on them describe them.
fn as_particles_say<'m>(model: &'m Model, particles: &[CrackParticles]) -> Cow<'m, Model> {
    match particles {
        [] => Cow::Borrowed(model),
        _ => Cow::Owned(Model { cracks: particles.iter().map(CrackParticles::union).collect(), ..model.clone() }),
    }
}

/// Which copies of points stand among meshfree nodes: those that are not on supports with elements along them, nor
/// farther from all cracks than elements begin.
fn meshfree_copies(
    model: &Model,
    triangulation: &Triangulation,
    approximation: &ApproximationSettings,
    constraints: &ConstraintMethod,
) -> Vec<bool> {
    let beyond = approximation.finite_elements_beyond.unwrap_or(f64::INFINITY);
    let is_near = |copy: &PointCopy| {
        let p = triangulation.positions[copy.point as usize];
        let mut segments = model.cracks.iter().flat_map(CrackPath::segments);
        beyond.is_infinite() || segments.any(|(a, b)| distance_to_segment(p, a, b) <= beyond)
    };
    let mut result: Vec<bool> = triangulation.copies.iter().map(is_near).collect();
    if *constraints == ConstraintMethod::FiniteElementCoupled {
        let on = Supports::new(model, constraints);
        for segment in triangulation.boundary.iter().filter(|s| !on.on(s.edge).is_empty()) {
            segment.points.iter().for_each(|copy| result[*copy as usize] = false);
        }
    }
    result
}

fn nodes_of(triangulation: &Triangulation, is_node: &[bool]) -> (Nodes<2>, Vec<Option<u32>>) {
    let mut nodes = Nodes::default();
    let mut node_of_copy = vec![None; triangulation.copies.len()];
    for (i, copy) in triangulation.copies.iter().enumerate() {
        if is_node[copy.point as usize] {
            node_of_copy[i] = Some(nodes.positions.len() as u32);
            nodes.positions.push(triangulation.positions[copy.point as usize]);
            nodes.sights.push(copy.sight);
        }
    }
    (nodes, node_of_copy)
}

fn set_supports(
    nodes: &mut Nodes<2>,
    triangulation: &Triangulation,
    node_of_copy: &[Option<u32>],
    obstacles: &Obstacles,
    settings: &ApproximationSettings,
    grid_step: Option<Vector2>,
) {
    let mut guess = vec![0.0; nodes.len()];
    for (copy, node) in node_of_copy.iter().enumerate() {
        if let Some(node) = node {
            guess[*node as usize] = triangulation.edge_length[triangulation.copies[copy].point as usize];
        }
    }
    let k = match settings.spacing_from {
        SpacingFrom::SecondNeighbor => 2,
        SpacingFrom::ThirdNeighbor => 3,
        SpacingFrom::Automatic => 3 - usize::from(grid_step.is_some()),
    };
    let step = grid_step.unwrap_or(Vector2::repeat(1.0));
    let dilation = settings.dilation(grid_step.is_some());
    let spacings = neighbor_distances(nodes, obstacles, &guess, k, step);
    nodes.support_radii = spacings.iter().map(|c| support_radii(settings.support, dilation, *c)).collect();
}

/// Nodes that reach into an enriched region have enough neighbors for the longer basis.
fn enlarge_in_regions(
    nodes: &mut Nodes<2>,
    enrichment: &Enrichment,
    settings: &ApproximationSettings,
    grid_step: Option<Vector2>,
) {
    let is_regular = grid_step.is_some();
    let factor = settings.enrichment.dilation(is_regular) / settings.dilation(is_regular);
    if factor > 1.0 {
        for (p, radii) in nodes.positions.iter().zip(&mut nodes.support_radii) {
            if enrichment.is_reached(*p, radii.norm() * factor) {
                *radii *= factor;
            }
        }
    }
}

/// Makes nodes one that stand at the same place and see each other through a crack: their functions would be the same.
fn join_sides(
    nodes: &mut Nodes<2>,
    node_of_copy: &mut [Option<u32>],
    barriers: &Barriers,
    settings: &ApproximationSettings,
) {
    let approximation = MovingLeastSquares::new(nodes.clone(), barriers.clone(), *settings);
    let mut around = Surroundings::default();
    let mut kept = Nodes::default();
    let mut new_index: Vec<u32> = vec![];
    // Nodes at one place follow each other.
    for i in 0..nodes.len() {
        let (at, sight) = (nodes.positions[i], nodes.sights[i]);
        let before = (0..i).rev().take_while(|j| nodes.positions[*j] == at).collect::<Vec<_>>();
        if !before.is_empty() {
            approximation.survey(&Aabb::of_points([at, sight]), &mut around);
            approximation.gather(at, sight, Derivatives::First, &mut around);
        }
        let twin = before.into_iter().find(|j| around.near.nodes.contains(&(*j as u32)));
        new_index.push(match twin {
            Some(j) => new_index[j],
            None => {
                kept.positions.push(at);
                kept.sights.push(sight);
                kept.support_radii.push(nodes.support_radii[i]);
                kept.positions.len() as u32 - 1
            }
        });
    }
    node_of_copy.iter_mut().flatten().for_each(|node| *node = new_index[*node as usize]);
    *nodes = kept;
}
