//! Cells between the nodes: triangles fitted to boundary and cracks, and rectangles where nodes are regular
//! (element quadrature [EFG, section 3.2]).

use super::IntegrationPoint;
use super::rules::{collapsed_rule, graded_line, graded_rule, triangle_rule};
use super::settings::{IntegrationSettings, Scheme, TipRule};
use crate::geometry::aabb::Aabb;
use crate::geometry::curve::Curve;
use crate::math::gauss_legendre::gauss_legendre;
use crate::math::{Vector2, cross, turn_left};
use crate::model::Domain;
use crate::nodes::Triangulation;
use crate::nodes::elements::{Element, arcs, left_of};
use crate::nodes::triangulation::SIGHT_SHIFT;
use rustc_hash::FxHashMap;
use std::ops::Range;

/// A point on the outline of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgePoint {
    /// Position.
    pub position: Vector2,
    /// From where visibility is asked.
    pub sight: Vector2,
    /// Outward unit normal times integration weight [length].
    pub normal: Vector2,
}

/// Integration points cell by cell, with points on the cells' outlines for the gradient correction.
#[derive(Clone, Debug, Default)]
pub struct IntegrationCells {
    /// Points of all cells.
    pub points: Vec<IntegrationPoint<2>>,
    /// Outline points of all cells.
    pub edge_points: Vec<EdgePoint>,
    /// Points of each cell.
    pub point_ranges: Vec<Range<u32>>,
    /// Outline points of each cell.
    pub edge_ranges: Vec<Range<u32>>,
    /// Corners of each cell, for pictures.
    pub corners: Vec<Vec<Vector2>>,
    /// Where gradients are means over parts of cells, one part a point.
    pub smoothing: Option<Smoothing>,
}

/// Gradients that are means over parts of cells.
#[derive(Clone, Debug, Default)]
pub struct Smoothing {
    /// For each outline point the points of its cell whose parts it lies between: it points out of the first, into the
    /// second if there is one.
    pub between: Vec<[Option<u32>; 2]>,
    /// Part of the difference to the mean of the cell that is kept: the root of the stabilization.
    pub share: f64,
}

impl IntegrationCells {
    /// Number of cells.
    pub fn len(&self) -> usize {
        self.point_ranges.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.point_ranges.is_empty()
    }

    /// The least box around all points of a cell.
    pub fn bounds(&self, cell: usize) -> Aabb<2> {
        let points = self.points[as_usize(&self.point_ranges[cell])].iter().map(|p| p.position);
        let edges = self.edge_points[as_usize(&self.edge_ranges[cell])].iter().flat_map(|p| [p.position, p.sight]);
        Aabb::of_points(points.chain(edges))
    }

    /// Triangles and rectangles of a triangulation.
    pub fn elements(
        triangulation: &Triangulation,
        domain: &Domain,
        tips: &[Vector2],
        merge: bool,
        settings: &IntegrationSettings,
    ) -> Self {
        let elements = match merge {
            true => Element::joined(triangulation, domain),
            false => Element::triangles(triangulation),
        };
        let mut builder = Builder::new(triangulation, domain, tips, settings);
        for element in elements {
            match element {
                Element::Rectangle(corners) => builder.add_rectangle(corners),
                Element::Triangle(corners) => builder.add_triangle(corners),
            }
        }
        builder.cells
    }

    /// Ends a cell: everything added since the last call belongs to it.
    pub(super) fn close(&mut self, corners: Vec<Vector2>) {
        let start = |ranges: &[Range<u32>]| ranges.last().map_or(0, |r| r.end);
        let (p, e) = (start(&self.point_ranges), start(&self.edge_ranges));
        self.point_ranges.push(p..self.points.len() as u32);
        self.edge_ranges.push(e..self.edge_points.len() as u32);
        self.corners.push(corners);
    }
}

/// A range as slices take it.
pub fn as_usize(range: &Range<u32>) -> Range<usize> {
    range.start as usize..range.end as usize
}

struct Builder<'a> {
    triangulation: &'a Triangulation,
    /// Curved boundary pieces by the copies at their ends.
    arcs: FxHashMap<[u32; 2], Curve>,
    /// The triangle to the left of each directed edge.
    left_of: FxHashMap<[u32; 2], u32>,
    is_tip: Vec<bool>,
    regular: Vec<([f64; 3], f64)>,
    at_tip: Vec<([f64; 3], f64)>,
    line: Vec<(f64, f64)>,
    square: usize,
    square_at_tip: usize,
    /// Points along an edge that starts at a tip, where they are graded.
    line_at_tip: Option<Vec<(f64, f64)>>,
    cells: IntegrationCells,
}

impl<'a> Builder<'a> {
    fn new(
        triangulation: &'a Triangulation,
        domain: &Domain,
        tips: &[Vector2],
        settings: &IntegrationSettings,
    ) -> Self {
        let is_tip = triangulation
            .copies
            .iter()
            .map(|c| tips.iter().any(|t| *t == triangulation.positions[c.point as usize]))
            .collect();
        Self {
            triangulation,
            arcs: arcs(triangulation, domain),
            left_of: left_of(triangulation),
            is_tip,
            regular: triangle_rule(settings.points),
            at_tip: rule_at_tip(settings),
            line_at_tip: (settings.tip_rule == TipRule::Graded).then(|| graded_line(settings.tip_points)),
            line: edge_rule(settings),
            square: settings.points,
            square_at_tip: settings.tip_points,
            cells: IntegrationCells::default(),
        }
    }

    fn add_rectangle(&mut self, corners: [u32; 4]) {
        let [a, b, c, d] = corners.map(|v| self.triangulation.position(v));
        let tip = corners.iter().position(|v| self.is_tip[*v as usize]);
        match (tip, &self.line_at_tip) {
            (Some(k), Some(_)) => {
                let [tip, p, q, r] = [0, 1, 2, 3].map(|j| [a, b, c, d][(k + j) % 4]);
                self.add_straight([tip, p, q], true);
                self.add_straight([tip, q, r], true);
            }
            (tip, _) => {
                let rule = gauss_legendre(if tip.is_some() { self.square_at_tip } else { self.square });
                let area = cross(b - a, d - a);
                for &(s, ws) in &rule {
                    for &(t, wt) in &rule {
                        let position = a + (b - a) * s + (d - a) * t;
                        self.cells.points.push(IntegrationPoint { position, weight: ws * wt * area });
                    }
                }
            }
        }
        for k in 0..4 {
            self.add_edge(corners[k], corners[(k + 1) % 4]);
        }
        self.cells.close(vec![a, b, c, d]);
    }

    fn add_triangle(&mut self, corners: [u32; 3]) {
        let positions = corners.map(|v| self.triangulation.position(v));
        let arcs: [Option<Curve>; 3] =
            std::array::from_fn(|k| self.arcs.get(&[corners[k], corners[(k + 1) % 3]]).copied());
        let tip = (0..3).find(|&k| self.is_tip[corners[k] as usize]);
        match (arcs.iter().flatten().count(), tip) {
            (0, Some(k)) => self.add_straight([0, 1, 2].map(|j| positions[(k + j) % 3]), true),
            (0, None) => self.add_straight(positions, false),
            (1, _) => {
                let k = arcs.iter().position(Option::is_some).expect("one is curved");
                let order = if tip.is_some() { self.square_at_tip } else { self.square };
                self.add_fan(positions[(k + 2) % 3], arcs[k].expect("it is curved"), order);
            }
            _ => {
                let center = (positions[0] + positions[1] + positions[2]) / 3.0;
                for k in 0..3 {
                    let line = Curve::Line { start: positions[k], end: positions[(k + 1) % 3] };
                    self.add_fan(center, arcs[k].unwrap_or(line), self.square);
                }
            }
        }
        for k in 0..3 {
            self.add_edge(corners[k], corners[(k + 1) % 3]);
        }
        self.cells.close(positions.to_vec());
    }

    fn add_straight(&mut self, [a, b, c]: [Vector2; 3], at_tip: bool) {
        let area = 0.5 * cross(b - a, c - a);
        for &(l, w) in if at_tip { &self.at_tip } else { &self.regular } {
            let position = a * l[0] + b * l[1] + c * l[2];
            self.cells.points.push(IntegrationPoint { position, weight: w * area });
        }
    }

    /// The region swept by straight lines from `apex` to the points of a curve: exact up to curved edges.
    fn add_fan(&mut self, apex: Vector2, curve: Curve, order: usize) {
        let line = gauss_legendre(order.max(2));
        for &(t, wt) in &line {
            let (rim, velocity) = (curve.point(t), curve.velocity(t));
            for &(s, ws) in &line {
                let weight = s * cross(rim - apex, velocity) * ws * wt;
                self.cells.points.push(IntegrationPoint { position: apex + (rim - apex) * s, weight });
            }
        }
    }

    /// Outline points between two corners; the same positions from both sides of an edge.
    fn add_edge(&mut self, a: u32, b: u32) {
        let inner = self.left_of.contains_key(&[b, a]);
        let forward = inner && a > b;
        let ends = if forward { [b, a] } else { [a, b] };
        let curve = self.arcs.get(&[a, b]).copied().unwrap_or_else(|| {
            let [start, end] = ends.map(|v| self.triangulation.position(v));
            Curve::Line { start, end }
        });
        let [starts, stops] = ends.map(|v| self.is_tip[v as usize]);
        let line = match &self.line_at_tip {
            Some(line) if starts || stops => line,
            Some(_) | None => &self.line,
        };
        for &(t, w) in line {
            let t = if stops && !starts { 1.0 - t } else { t };
            let (position, velocity) = (curve.point(t), curve.velocity(t));
            let right = -turn_left(velocity);
            let sight = if inner { position } else { position - right * SIGHT_SHIFT };
            let normal = if forward { -right * w } else { right * w };
            self.cells.edge_points.push(EdgePoint { position, sight, normal });
        }
    }
}

/// Points in a triangle whose first corner is a tip.
pub(super) fn rule_at_tip(settings: &IntegrationSettings) -> Vec<([f64; 3], f64)> {
    match settings.tip_rule {
        TipRule::Automatic | TipRule::Product => collapsed_rule(settings.tip_points),
        TipRule::Graded => graded_rule(settings.tip_points),
    }
}

/// Positions and weights along an edge of the boundary or of a crack, from 0 to 1; those of cells lie there, too.
pub(super) fn edge_rule(settings: &IntegrationSettings) -> Vec<(f64, f64)> {
    let line = gauss_legendre(settings.points.clamp(2, 5));
    match settings.scheme {
        Scheme::Elements | Scheme::Cells { .. } => line,
        // Cells of nodes meet in the middle.
        Scheme::Nodal { .. } => {
            [0.0, 0.5].iter().flat_map(|start| line.iter().map(move |(t, w)| (start + 0.5 * t, 0.5 * w))).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crack::CrackPath;
    use crate::model::Model;
    use crate::nodes::{NodeSettings, generate};

    fn disk_with_crack() -> Model {
        let mut model = crate::model::Model::plain(Domain::new(
            vec![Curve::circle(Vector2::new(0.3, 0.1), 2.0)],
            vec![vec![Curve::circle(Vector2::new(1.0, 0.5), 0.4)]],
        ));
        model.cracks.push(CrackPath {
            name: "c".into(),
            vertices: vec![Vector2::new(-0.8, -0.5), Vector2::new(0.2, -0.3), Vector2::new(0.5, -0.9)],
            ends: [crate::crack::EndKind::Tip; 2],
        });
        model
    }

    #[test]
    fn curved_cells_have_the_exact_area_and_closed_outlines() {
        let model = disk_with_crack();
        let layered = generate(&model, &NodeSettings::default(), Default::default()).unwrap();
        let tips: Vec<_> = model.tips().iter().map(|t| t.1.position).collect();
        let cells = IntegrationCells::elements(
            &layered.triangulation,
            &model.domain,
            &tips,
            false,
            &IntegrationSettings::default(),
        );
        let area: f64 = cells.points.iter().map(|p| p.weight).sum();
        assert!((area - model.domain.area()).abs() < 1e-9, "{area} {}", model.domain.area());
        assert!(cells.points.iter().all(|p| p.weight > 0.0));
        for cell in 0..cells.len() {
            let edges = &cells.edge_points[as_usize(&cells.edge_ranges[cell])];
            let own: f64 = cells.points[as_usize(&cells.point_ranges[cell])].iter().map(|p| p.weight).sum();
            let sum = edges.iter().fold(Vector2::zeros(), |s, e| s + e.normal);
            assert!(sum.norm() < 1e-9);
            let flux: f64 = edges.iter().map(|e| e.position.dot(&e.normal)).sum();
            assert!((flux - 2.0 * own).abs() < 1e-9 * own.max(1e-3));
        }
    }
}
