//! Cells of a background grid, clipped by the boundary (cell quadrature [EFG, section 3.2, Fig. 3]).
//!
//! Squares that nothing cuts are integrated whole. The others are cut into convex pieces: their intersections with
//! coarse triangles of the body, which end at boundary and cracks.

use super::IntegrationPoint;
use super::cells::{EdgePoint, IntegrationCells, edge_rule, rule_at_tip};
use super::rules::{graded_line, triangle_rule};
use super::settings::{IntegrationSettings, TipRule};
use crate::error::{Error, Result};
use crate::geometry::aabb::Aabb;
use crate::geometry::polygon::{area, clipped, edges};
use crate::geometry::tree::BoxTree;
use crate::math::gauss_legendre::gauss_legendre;
use crate::math::{Vector2, cross, turn_left};
use crate::model::Model;
use crate::nodes::Triangulation;
use crate::nodes::chains::{Chains, CrackNodes};
use crate::nodes::spacing::SpacingField;
use crate::nodes::triangulation::SIGHT_SHIFT;

/// Arcs are replaced by chords of at most this length over the radius: the area beside them is good to 4e-5.
const CHORD: f64 = 0.03;
/// Pieces below this share of a square are left out.
const SLIVER: f64 = 1e-10;
/// A square with more nodes is split into four, so that integration follows the grading.
const MAX_NODES_IN_SQUARE: usize = 4;
/// Splits in a row.
const MAX_SPLITS: usize = 14;
/// More squares than this are refused.
const MAX_SQUARES: f64 = 4e6;

impl IntegrationCells {
    /// Squares of edge length `size` over the body, clipped by boundary and cracks; split where nodes are denser.
    ///
    /// # Errors
    /// [`Error::NodeGeneration`] if the grid would have too many squares.
    pub fn background(
        model: &Model,
        nodal: &Triangulation,
        tips: &[Vector2],
        size: f64,
        settings: &IntegrationSettings,
    ) -> Result<Self> {
        let bounds = model.domain.aabb();
        // The grid fits the box of the body, so that straight sides fall on its lines.
        let counts = (bounds.size() / size).map(|n| (n - 1e-9).ceil().max(1.0));
        if counts.x * counts.y > MAX_SQUARES {
            return Err(Error::NodeGeneration {
                reason: "the background grid has too many cells; enlarge `size`".into(),
            });
        }
        let step = bounds.size().component_div(&counts);
        let pieces = Pieces::new(model, nodal)?;
        let nodes = BoxTree::of_points(&nodal.positions);
        let mut cells = Self::default();
        for j in 0..counts.y as usize {
            for i in 0..counts.x as usize {
                let lower = bounds.lower + step.component_mul(&Vector2::new(i as f64, j as f64));
                let square = Aabb { lower, upper: lower + step };
                for square in split(square, &nodes, MAX_SPLITS) {
                    cells.add_square(&square, &pieces, model, tips, settings);
                }
            }
        }
        Ok(cells)
    }

    /// Forgets the points on the outlines.
    pub fn drop_outlines(&mut self) {
        self.edge_points.clear();
        self.edge_ranges.iter_mut().for_each(|r| *r = 0..0);
    }

    fn add_square(
        &mut self,
        square: &Aabb<2>,
        pieces: &Pieces,
        model: &Model,
        tips: &[Vector2],
        settings: &IntegrationSettings,
    ) {
        let (a, b) = (square.lower, square.upper);
        let corners = [a, Vector2::new(b.x, a.y), b, Vector2::new(a.x, b.y)];
        let has_tip = tips.iter().any(|t| square.intersects(&Aabb { lower: *t, upper: *t }));
        let inner = Aabb::around(square.center(), square.size() * (0.5 - 1e-9));
        if pieces.lines.is_clear(&inner) {
            if model.domain.contains(square.center()) {
                let rule = gauss_legendre(if has_tip { settings.tip_points } else { settings.points });
                for &(s, ws) in &rule {
                    for &(t, wt) in &rule {
                        let position = a + Vector2::new(s, t).component_mul(&square.size());
                        let weight = ws * wt * square.size().product();
                        self.points.push(IntegrationPoint { position, weight });
                    }
                }
                self.add_outline(&corners, square.center(), &[], settings);
                self.close(corners.to_vec());
            }
            return;
        }
        let mut found = vec![];
        pieces.tree.visit(square, |i| found.push(i));
        found.sort_unstable();
        for i in found {
            let piece = clipped(&pieces.triangles[i as usize], square);
            if piece.len() < 3 || area(&piece) < SLIVER * square.size().product() {
                continue;
            }
            self.add_piece(&piece, tips, settings);
        }
    }

    /// A convex piece: triangles from a tip if there is one in it, else from its center.
    fn add_piece(&mut self, piece: &[Vector2], tips: &[Vector2], settings: &IntegrationSettings) {
        let center = piece.iter().sum::<Vector2>() / piece.len() as f64;
        let size = area(piece).sqrt();
        let tip =
            tips.iter().find(|t| edges(piece).all(|(p, q)| cross(q - p, **t - p) >= -1e-9 * size * (q - p).norm()));
        let (apex, rule) = match tip {
            Some(tip) => (*tip, rule_at_tip(settings)),
            None => (center, triangle_rule(settings.points.min(3))),
        };
        for (p, q) in edges(piece) {
            let twice = cross(p - apex, q - apex);
            if twice > SLIVER * size * size {
                for &(l, w) in &rule {
                    let position = apex * l[0] + p * l[1] + q * l[2];
                    self.points.push(IntegrationPoint { position, weight: 0.5 * twice * w });
                }
            }
        }
        self.add_outline(piece, center, tips, settings);
        self.close(piece.to_vec());
    }

    fn add_outline(&mut self, corners: &[Vector2], center: Vector2, tips: &[Vector2], settings: &IntegrationSettings) {
        let line = edge_rule(settings);
        let at_tip = graded_line(settings.tip_points);
        for (p, q) in edges(corners) {
            let [starts, stops] = [p, q].map(|e| settings.tip_rule == TipRule::Graded && tips.contains(&e));
            for &(t, w) in if starts || stops { &at_tip } else { &line } {
                let t = if stops && !starts { 1.0 - t } else { t };
                let position = p * (1.0 - t) + q * t;
                // Every point sees from inside its own cell, since any edge may lie on a crack.
                let sight = position + (center - position) * SIGHT_SHIFT;
                self.edge_points.push(EdgePoint { position, sight, normal: -turn_left(q - p) * w });
            }
        }
    }
}

/// The quarters of a square, quartered again, until none holds many nodes.
fn split(square: Aabb<2>, nodes: &BoxTree<2>, depth: usize) -> Vec<Aabb<2>> {
    let mut count = 0;
    nodes.visit(&square, |_| count += 1);
    if count <= MAX_NODES_IN_SQUARE || depth == 0 {
        return vec![square];
    }
    let half = square.size() * 0.5;
    let quarter = |i: usize, j: usize| {
        let lower = square.lower + half.component_mul(&Vector2::new(i as f64, j as f64));
        split(Aabb { lower, upper: lower + half }, nodes, depth - 1)
    };
    [quarter(0, 0), quarter(1, 0), quarter(0, 1), quarter(1, 1)].concat()
}

/// Coarse triangles of the body, fitted to boundary and cracks.
struct Pieces {
    triangles: Vec<[Vector2; 3]>,
    tree: BoxTree<2>,
    /// Boxes of boundary and cracks.
    lines: BoxTree<2>,
}

impl Pieces {
    /// Arcs are subdivided between the boundary points of the nodes, so that no piece reaches behind their chords.
    fn new(model: &Model, nodal: &Triangulation) -> Result<Self> {
        let size = model.domain.aabb().size().max();
        let mut chains = Chains::default();
        for range in &model.domain.loops {
            chains.add_loop(nodal, range.clone(), &model.domain, CHORD);
        }
        chains.add_cracks(model, &SpacingField::uniform(size), CrackNodes::AtSpacing, 0);
        let triangulation = Triangulation::new(&chains)?;
        let triangles: Vec<[Vector2; 3]> =
            triangulation.triangles.iter().map(|t| t.map(|c| triangulation.position(c))).collect();
        let boxes: Vec<_> = triangles.iter().map(|t| Aabb::of_points(*t)).collect();
        let boundary = chains.boundary.iter().map(|s| s.points).chain(chains.crack_pieces.iter().map(|c| c.points));
        let lines: Vec<_> = boundary.map(|ends| Aabb::of_points(ends.map(|i| chains.positions[i as usize]))).collect();
        Ok(Self { triangles, tree: BoxTree::new(&boxes), lines: BoxTree::new(&lines) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curve::Curve;
    use crate::model::Domain;

    #[test]
    fn clipped_grid_has_the_area_of_the_body() {
        let hole = vec![Curve::circle(Vector2::new(0.6, 0.5), 0.23)];
        let corners = [(0.0, 0.0), (1.3, 0.1), (1.0, 1.0), (0.2, 0.8)].map(|(x, y)| Vector2::new(x, y));
        let outline = edges(&corners).map(|(start, end)| Curve::Line { start, end }).collect();
        let model = Model::plain(Domain::new(outline, vec![hole]));
        let nodal = crate::nodes::generate(&model, &Default::default(), Default::default()).unwrap().triangulation;
        let cells = IntegrationCells::background(&model, &nodal, &[], 0.07, &IntegrationSettings::default()).unwrap();
        let sum: f64 = cells.points.iter().map(|p| p.weight).sum();
        assert!((sum - model.domain.area()).abs() < 1e-4, "{sum} {}", model.domain.area());
        assert!(cells.points.iter().all(|p| p.weight > 0.0 && model.domain.contains(p.position)));
    }
}
