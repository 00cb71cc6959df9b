//! Supports that are large enough: every integration point sees enough nodes, well placed, for the fit there.

use crate::approximation::discontinuity::Barriers;
use crate::approximation::moving_least_squares::{Derivatives, POOR_PIVOT};
use crate::approximation::point_batch::{PointBatch, Wanted};
use crate::approximation::{MovingLeastSquares, ShapeFunctions, Surroundings};
use crate::error::{Error, Result};
use crate::geometry::aabb::Aabb;
use crate::geometry::obstacles::Obstacles;
use crate::geometry::tree::BoxTree;
use crate::integration::cells::as_usize;
use crate::integration::{BoundaryElement, CrackFaceElement, IntegrationCells};
use crate::math::Vector2;
use crate::nodes::Nodes;
use rayon::prelude::*;

/// Rounds of support enlargement before a poor point is taken as it is (or refused, if singular).
const SUPPORT_ROUNDS: usize = 12;
/// Growth of the supports around a poor point in each round.
const SUPPORT_GROWTH: f64 = 1.15;

/// Position and sight of all points of a cell, those of its outline included.
fn cell_views(cells: &IntegrationCells, cell: usize) -> impl Iterator<Item = (Vector2, Vector2)> + Clone + '_ {
    let points = cells.points[as_usize(&cells.point_ranges[cell])].iter().map(|p| (p.position, p.position));
    points.chain(cells.edge_points[as_usize(&cells.edge_ranges[cell])].iter().map(|p| (p.position, p.sight)))
}

#[derive(Default)]
struct Buffer {
    around: Surroundings,
    shape: ShapeFunctions<2>,
    batch: PointBatch,
    nodes: Vec<u32>,
}

/// All that holds integration points: cells, then boundary elements, then elements of cracks.
pub(super) struct Parts<'a> {
    pub cells: &'a IntegrationCells,
    pub boundary: &'a [BoundaryElement],
    pub crack_faces: &'a [CrackFaceElement],
}

/// What the points of one cell or element see.
#[derive(Default)]
struct Inspection {
    /// All functions that are not zero at any of the points, ascending.
    neighbors: Vec<u32>,
    /// Points whose moment matrix is poor.
    poor: Vec<Poor>,
    /// Whether the points can stand in a batch.
    is_plain: bool,
}

struct Poor {
    at: Vector2,
    sight: Vector2,
    quality: f64,
    n_neighbors: usize,
    /// Least number of neighbors of a fit.
    needed: usize,
    is_enriched: bool,
}

/// - `views`: position and sight of the points
fn inspect(
    approximation: &MovingLeastSquares,
    bounds: &Aabb<2>,
    views: impl Iterator<Item = (Vector2, Vector2)> + Clone,
    buffer: &mut Buffer,
) -> Inspection {
    approximation.survey(bounds, &mut buffer.around);
    if approximation.is_plain(&buffer.around) {
        return inspect_plain(approximation, bounds, views, buffer);
    }
    let Buffer { around, shape, .. } = buffer;
    let mut result = Inspection::default();
    let mut seen = vec![false; around.candidates.len()];
    let mut corners: Vec<u32> = vec![];
    for (at, sight) in views {
        if let Some(element) = approximation.element_at(sight, around) {
            corners.extend_from_slice(element.nodes());
            if element.is_plain() {
                continue;
            }
        }
        approximation.gather(at, sight, Derivatives::First, around);
        let mut k = 0;
        for &i in &around.near.nodes {
            while around.candidates[k] != i {
                k += 1;
            }
            seen[k] = true;
        }
        let n_neighbors = around.near.nodes.len();
        let quality = approximation.quality(at, sight, around, shape);
        if quality < POOR_PIVOT {
            let needed = approximation.n_needed(at, around);
            let is_enriched = approximation.is_enriched(at, around);
            result.poor.push(Poor { at, sight, quality, n_neighbors, needed, is_enriched });
        }
    }
    let visible = around.candidates.iter().zip(&seen).filter(|(_, seen)| **seen);
    result.neighbors = visible.map(|(i, _)| *i).collect();
    if !corners.is_empty() {
        result.neighbors.append(&mut corners);
        result.neighbors.sort_unstable();
        result.neighbors.dedup();
    }
    approximation.append_functions(&mut result.neighbors);
    result
}

/// The same where nothing hides or enriches: all points at once.
fn inspect_plain(
    approximation: &MovingLeastSquares,
    bounds: &Aabb<2>,
    views: impl Iterator<Item = (Vector2, Vector2)> + Clone,
    buffer: &mut Buffer,
) -> Inspection {
    let Buffer { around, batch, nodes, .. } = buffer;
    nodes.clear();
    nodes.extend(around.candidates.iter().filter(|i| approximation.may_reach(**i, bounds)));
    approximation.fill_nodes(nodes.iter().copied(), batch);
    batch.set_points(views.clone().map(|(at, _)| (at, Vector2::zeros())));
    approximation.evaluate_batch(Wanted::Quality, batch);
    let reached = nodes.iter().zip(&batch.is_reached).filter(|(_, is_reached)| **is_reached);
    let mut result = Inspection { neighbors: reached.map(|(i, _)| *i).collect(), poor: vec![], is_plain: true };
    for (q, (at, sight)) in views.enumerate() {
        let n_neighbors = batch.quality[1][q] as usize;
        let needed = approximation.n_needed(at, around);
        let quality = if n_neighbors < needed { 0.0 } else { batch.quality[0][q] };
        if quality < POOR_PIVOT {
            result.poor.push(Poor { at, sight, quality, n_neighbors, needed, is_enriched: false });
        }
    }
    result
}

impl Parts<'_> {
    fn len(&self) -> usize {
        self.cells.len() + self.boundary.len() + self.crack_faces.len()
    }

    fn inspect(&self, approximation: &MovingLeastSquares, i: usize, buffer: &mut Buffer) -> Inspection {
        let (n_cells, n_boundary) = (self.cells.len(), self.boundary.len());
        if i < n_cells {
            inspect(approximation, &self.cells.bounds(i), cell_views(self.cells, i), buffer)
        } else if i < n_cells + n_boundary {
            let element = &self.boundary[i - n_cells];
            inspect(approximation, &element.bounds(), element.points.iter().map(|p| (p.position, p.sight)), buffer)
        } else {
            let element = &self.crack_faces[i - n_cells - n_boundary];
            let views = element.points.iter().flat_map(|p| p.sights.map(|sight| (p.position, sight)));
            inspect(approximation, &element.bounds(), views, buffer)
        }
    }

    /// Inspects parts by index.
    fn inspect_all(&self, approximation: &MovingLeastSquares, which: &[usize]) -> Vec<Inspection> {
        which.par_iter().map_init(Buffer::default, |buffer, &i| self.inspect(approximation, i, buffer)).collect()
    }
}

/// Enlarges supports until every integration point has a well-conditioned moment matrix; returns the neighbors of all
/// parts, and which of them are plain.
pub(super) fn safeguard(
    mut approximation: MovingLeastSquares,
    obstacles: Obstacles,
    barriers: &Barriers,
    parts: &Parts,
) -> Result<(MovingLeastSquares, Vec<Vec<u32>>, Vec<bool>)> {
    let all: Vec<usize> = (0..parts.len()).collect();
    let mut suspects = all.clone();
    let tree = BoxTree::of_points(&approximation.nodes().positions);
    for round in 0..=SUPPORT_ROUNDS {
        let found = parts.inspect_all(&approximation, &suspects);
        let poor = || found.iter().flat_map(|i| &i.poor);
        // Poor but not singular is taken after the last round.
        if let Some(worst) = poor().min_by(|a, b| a.quality.total_cmp(&b.quality)) {
            if round == SUPPORT_ROUNDS && worst.quality == 0.0 {
                let (n_neighbors, needed) = (worst.n_neighbors, worst.needed);
                return Err(Error::SingularMomentMatrix { point: worst.at, n_neighbors, needed });
            }
            if round < SUPPORT_ROUNDS {
                let mut nodes = approximation.nodes().clone();
                let mut grown = vec![false; nodes.len()];
                poor().for_each(|p| enlarge_around(&mut nodes, &obstacles, &tree, p, &mut grown));
                suspects = suspects.iter().zip(&found).filter(|(_, f)| !f.poor.is_empty()).map(|(i, _)| *i).collect();
                let (settings, elements) = (*approximation.settings(), approximation.elements().cloned());
                let enrichment = approximation.enrichment().cloned();
                let larger = MovingLeastSquares::new(nodes, barriers.clone(), settings);
                approximation = larger.enriched(enrichment).coupled(elements);
                continue;
            }
        }
        // Larger supports reach other cells too.
        let lists = if round == 0 { found } else { parts.inspect_all(&approximation, &all) };
        let is_plain = lists.iter().map(|i| i.is_plain).collect();
        return Ok((approximation, lists.into_iter().map(|i| i.neighbors).collect(), is_plain));
    }
    unreachable!("the last round returns")
}

/// Lets the nearest visible nodes reach the point well: as many as a good fit needs.
///
/// - `grown`: nodes that have grown for an enriched point in this round, which they do only once, since the points in a
///   cell at a tip are many
fn enlarge_around(nodes: &mut Nodes<2>, obstacles: &Obstacles, tree: &BoxTree<2>, poor: &Poor, grown: &mut [bool]) {
    let wanted = if poor.is_enriched { 2 * poor.needed } else { poor.needed + 3 };
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
    // The longer basis does not bear supports of very different sizes side by side.
    let n = if poor.is_enriched { nearest.len() } else { wanted };
    for &(distance, i) in nearest.iter().take(n) {
        let radii = &mut nodes.support_radii[i as usize];
        // Far beyond the present reach only if nothing nearer helps: grow step by step.
        let again = poor.is_enriched && std::mem::replace(&mut grown[i as usize], true);
        if distance < 3.0 * radii.min() && !again {
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
