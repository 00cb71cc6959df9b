//! Everything discrete about a body, read-only once built: nodes, supports, cells, neighbor lists.

use crate::approximation::discontinuity::visibility_obstacles;
use crate::approximation::moving_least_squares::{Derivatives, support_radii};
use crate::approximation::{ApproximationSettings, MovingLeastSquares, SpacingFrom, Surroundings};
use crate::error::{Error, Result};
use crate::geometry::aabb::Aabb;
use crate::geometry::obstacles::Obstacles;
use crate::geometry::tree::BoxTree;
use crate::integration::cells::as_usize;
use crate::integration::{
    BoundaryElement, GradientCorrection, IntegrationCells, IntegrationSettings, Scheme, boundary_elements,
};
use crate::math::Vector2;
use crate::model::Model;
use crate::nodes::support::neighbor_distances;
use crate::nodes::{Layered, Nodes, Triangulation};
use rayon::prelude::*;
use std::ops::Range;

/// Moment matrices with a smaller scaled pivot than this get more neighbors.
const POOR_PIVOT: f64 = 0.02;
/// Rounds of support enlargement before a poor point is taken as it is (or refused, if singular).
const SUPPORT_ROUNDS: usize = 12;
/// Growth of the supports around a poor point in each round.
const SUPPORT_GROWTH: f64 = 1.15;

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
    /// Neighbors of each cell.
    pub cell_nodes: NodeLists,
    /// Neighbors of each boundary element.
    pub boundary_nodes: NodeLists,
}

impl Discretization {
    /// Builds supports, cells and neighbor lists on generated nodes.
    ///
    /// # Errors
    /// [`Error::SingularMomentMatrix`] where no enlargement of supports makes the fit possible.
    pub fn new(
        model: &Model,
        layered: Layered,
        approximation: &ApproximationSettings,
        integration: &IntegrationSettings,
    ) -> Result<Self> {
        let Layered { chains, triangulation, is_regular } = layered;
        let (mut nodes, node_of_copy) = nodes_of(&triangulation, &chains.is_node);
        let obstacles = visibility_obstacles(model, &triangulation);
        set_supports(&mut nodes, &triangulation, &node_of_copy, &obstacles, approximation, is_regular);
        let tips: Vec<Vector2> = model.tips().iter().map(|t| t.1.position).collect();
        let mut cells = match integration.scheme {
            Scheme::Elements => {
                IntegrationCells::elements(&triangulation, &model.domain, &tips, is_regular, integration)
            }
            Scheme::Cells { size } => IntegrationCells::background(model, &triangulation, &tips, size, integration)?,
        };
        if integration.gradient_correction == GradientCorrection::None {
            cells.drop_outlines();
        }
        let boundary = boundary_elements(&triangulation, &model.domain, integration);
        let approximation = safeguard(nodes, obstacles, *approximation, &cells, &boundary)?;
        let mut result = Self {
            approximation,
            triangulation,
            node_of_copy,
            cells,
            boundary,
            cell_nodes: NodeLists::default(),
            boundary_nodes: NodeLists::default(),
        };
        result.list_neighbors();
        Ok(result)
    }

    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.approximation.nodes().len()
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

    fn list_neighbors(&mut self) {
        let lists: Vec<Vec<u32>> = (0..self.cells.len())
            .into_par_iter()
            .map_init(Surroundings::default, |around, cell| {
                self.approximation.survey(&self.cells.bounds(cell), around);
                neighbors_of(&self.approximation, cell_views(&self.cells, cell), around)
            })
            .collect();
        self.cell_nodes = NodeLists::from_lists(&lists);
        let lists: Vec<Vec<u32>> = self
            .boundary
            .par_iter()
            .map_init(Surroundings::default, |around, element| {
                self.approximation.survey(&element.bounds(), around);
                neighbors_of(&self.approximation, element.points.iter().map(|p| (p.position, p.sight)), around)
            })
            .collect();
        self.boundary_nodes = NodeLists::from_lists(&lists);
    }
}

/// Position and sight of all points of a cell, those of its outline included.
fn cell_views(cells: &IntegrationCells, cell: usize) -> impl Iterator<Item = (Vector2, Vector2)> + '_ {
    let points = cells.points[as_usize(&cells.point_ranges[cell])].iter().map(|p| (p.position, p.position));
    points.chain(cells.edge_points[as_usize(&cells.edge_ranges[cell])].iter().map(|p| (p.position, p.sight)))
}

/// All nodes that any of the points sees, ascending.
fn neighbors_of(
    approximation: &MovingLeastSquares,
    views: impl Iterator<Item = (Vector2, Vector2)>,
    around: &mut Surroundings,
) -> Vec<u32> {
    let mut found: Vec<u32> = vec![];
    for (at, sight) in views {
        approximation.gather(at, sight, Derivatives::First, around);
        found.extend_from_slice(&around.near.nodes);
    }
    found.sort_unstable();
    found.dedup();
    found
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
    is_regular: bool,
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
        SpacingFrom::Automatic => {
            if is_regular {
                2
            } else {
                3
            }
        }
    };
    let dilation = settings.dilation(is_regular);
    let spacings = neighbor_distances(nodes, obstacles, &guess, k);
    nodes.support_radii =
        spacings.iter().map(|c| support_radii(settings.support, dilation, Vector2::repeat(*c))).collect();
}

/// Enlarges supports until every integration point has a well-conditioned moment matrix.
fn safeguard(
    mut nodes: Nodes<2>,
    obstacles: Obstacles,
    settings: ApproximationSettings,
    cells: &IntegrationCells,
    boundary: &[BoundaryElement],
) -> Result<MovingLeastSquares> {
    let n_cells = cells.len();
    let mut suspects: Vec<usize> = (0..n_cells + boundary.len()).collect();
    let tree = BoxTree::of_points(&nodes.positions);
    for round in 0..=SUPPORT_ROUNDS {
        let approximation = MovingLeastSquares::new(nodes, obstacles.clone(), settings);
        let poor: Vec<Vec<Poor>> = suspects
            .par_iter()
            .map_init(Surroundings::default, |around, &i| {
                if i < n_cells {
                    approximation.survey(&cells.bounds(i), around);
                    poor_points(&approximation, cell_views(cells, i), around)
                } else {
                    let element = &boundary[i - n_cells];
                    approximation.survey(&element.bounds(), around);
                    poor_points(&approximation, element.points.iter().map(|p| (p.position, p.sight)), around)
                }
            })
            .collect();
        if poor.iter().all(Vec::is_empty) {
            return Ok(approximation);
        }
        if round == SUPPORT_ROUNDS {
            // Poor but not singular is taken; the fit itself refuses what is singular.
            let worst = poor.iter().flatten().min_by(|a, b| a.quality.total_cmp(&b.quality)).expect("some are poor");
            if worst.quality == 0.0 {
                return Err(Error::SingularMomentMatrix {
                    point: worst.at,
                    n_neighbors: worst.n_neighbors,
                    needed: approximation.n_needed(),
                });
            }
            return Ok(approximation);
        }
        suspects = suspects.iter().zip(&poor).filter(|(_, p)| !p.is_empty()).map(|(i, _)| *i).collect();
        let wanted = approximation.n_needed() + 3;
        nodes = approximation.nodes().clone();
        for p in poor.iter().flatten() {
            enlarge_around(&mut nodes, &obstacles, &tree, p, wanted);
        }
    }
    unreachable!("the last round returns")
}

struct Poor {
    at: Vector2,
    sight: Vector2,
    quality: f64,
    n_neighbors: usize,
}

fn poor_points(
    approximation: &MovingLeastSquares,
    views: impl Iterator<Item = (Vector2, Vector2)>,
    around: &mut Surroundings,
) -> Vec<Poor> {
    let mut poor = vec![];
    for (at, sight) in views {
        approximation.gather(at, sight, Derivatives::First, around);
        let n_neighbors = around.near.nodes.len();
        let quality = if n_neighbors < approximation.n_needed() { 0.0 } else { approximation.quality(around) };
        if quality < POOR_PIVOT {
            poor.push(Poor { at, sight, quality, n_neighbors });
        }
    }
    poor
}

/// Lets the `wanted` nearest visible nodes reach the point well.
fn enlarge_around(nodes: &mut Nodes<2>, obstacles: &Obstacles, tree: &BoxTree<2>, poor: &Poor, wanted: usize) {
    let mut nearest: Vec<(f64, u32)> = vec![];
    let mut reach = nodes.support_radii[nearest_node(nodes, tree, poor.at)].max();
    for _ in 0..12 {
        nearest.clear();
        tree.visit(&Aabb::around(poor.at, Vector2::repeat(reach)), |i| {
            if obstacles.visible(poor.sight, nodes.sights[i as usize]) {
                nearest.push(((nodes.positions[i as usize] - poor.at).norm(), i));
            }
        });
        if nearest.len() >= wanted {
            break;
        }
        reach *= 1.5;
    }
    nearest.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for &(distance, i) in nearest.iter().take(wanted) {
        let radii = &mut nodes.support_radii[i as usize];
        // Far beyond the present reach only if nothing nearer helps: grow step by step.
        if distance < 3.0 * radii.min() {
            *radii *= SUPPORT_GROWTH;
        }
    }
}

fn nearest_node(nodes: &Nodes<2>, tree: &BoxTree<2>, at: Vector2) -> usize {
    let mut reach = nodes.support_radii[0].max();
    loop {
        let mut best: Option<(f64, u32)> = None;
        tree.visit(&Aabb::around(at, Vector2::repeat(reach)), |i| {
            let d = (nodes.positions[i as usize] - at).norm();
            if best.is_none_or(|b| (d, i) < b) {
                best = Some((d, i));
            }
        });
        if let Some((_, i)) = best {
            return i as usize;
        }
        reach *= 2.0;
    }
}
