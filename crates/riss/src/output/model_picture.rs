//! A picture of the problem: body, cracks, supports and loads, with nodes and background cells.

use super::svg::{LineEnd, MARGIN, Pixel, Svg, View};
use super::whole_file::write_whole;
use crate::crack::End;
use crate::geometry::polygon;
use crate::math::{Vector2, turn_left};
use crate::model::{Direction, EdgeId, FieldPoint, Model, PrescribedValue, RigidMotion};
use std::collections::BTreeSet;
use std::io;
use std::path::Path;

/// Edges of background cells beyond which they are left out: lines closer than a pixel show nothing.
const MAX_CELL_EDGES: usize = 200_000;
/// Distance of symbols along the boundary [pixel].
const SPACING: f64 = 40.0;
/// Length of the longest load arrow [pixel].
const ARROW: f64 = 36.0;
/// Size of other symbols [pixel].
const SYMBOL: f64 = 11.0;

const SUPPORT: &str = "fill=\"none\" stroke=\"#1a7f37\" stroke-width=\"14\"";
const LOAD: &str = "fill=\"none\" stroke=\"#0b57d0\" stroke-width=\"14\"";
const CRACK: &str = "fill=\"none\" stroke=\"#d62728\" stroke-width=\"24\"";

/// Writes an SVG of the model, its nodes and its background cells (corners of each).
///
/// # Errors
/// What the system says.
pub fn write_model_picture(path: &Path, model: &Model, nodes: &[Vector2], cells: &[Vec<Vector2>]) -> io::Result<()> {
    // Names stand beside the body, clear of the symbols; a letter has about eight pixels.
    let longest = model.domain.parts.iter().map(|p| p.name.chars().count()).max().unwrap_or(0);
    let side = MARGIN + 8.0 * longest as f64;
    let (svg, view) = Svg::around(model.domain.aabb(), [side, side]);
    let mut picture = Picture { model, svg, view };
    picture.body(cells);
    picture.dots(nodes);
    picture.cracks();
    picture.supports();
    picture.loads();
    picture.part_names();
    picture.svg.text((MARGIN, 25.0), "font-size=\"180\"", &model.title);
    if model.rigid_motion == RigidMotion::MeanIsZero {
        let (_, height) = picture.svg.size();
        picture.svg.text((MARGIN, height - 8.0), "fill=\"#1a7f37\"", "mean displacement and rotation are zero");
    }
    write_whole(path, picture.svg.finish().as_bytes())
}

struct Picture<'a> {
    model: &'a Model,
    svg: Svg,
    view: View,
}

impl Picture<'_> {
    fn pixels(&self, points: &[Vector2]) -> Vec<Pixel> {
        points.iter().map(|p| self.view.pixel(*p)).collect()
    }

    /// Length of so many pixels.
    fn length(&self, pixels: f64) -> f64 {
        pixels * self.view.pixel_length()
    }

    fn body(&mut self, cells: &[Vec<Vector2>]) {
        let domain = &self.model.domain;
        let tolerance = self.length(0.1);
        let loops: Vec<Vec<Pixel>> = domain
            .loops
            .iter()
            .map(|edges| {
                let points = domain.edges[edges.clone()].iter().flat_map(|e| e.flattened(tolerance));
                points.map(|p| self.view.pixel(p)).collect()
            })
            .collect();
        self.svg.paths(loops.iter().cloned(), LineEnd::Closed, "fill=\"#eef2f5\"");
        let edges: BTreeSet<[Pixel; 2]> = cells
            .iter()
            .flat_map(|cell| polygon::edges(cell))
            .map(|(a, b)| [self.view.pixel(a), self.view.pixel(b)])
            .map(|[a, b]| [a.min(b), a.max(b)])
            .filter(|[a, b]| a != b)
            .collect();
        if edges.len() <= MAX_CELL_EDGES {
            let lines = edges.into_iter().map(|e| e.to_vec());
            self.svg.paths(lines, LineEnd::Open, "fill=\"none\" stroke=\"#b8c4ce\" stroke-width=\"5\"");
        }
        self.svg.paths(loops, LineEnd::Closed, "fill=\"none\" stroke=\"#222222\" stroke-width=\"14\"");
    }

    /// At most one dot on two by two pixels.
    fn dots(&mut self, nodes: &[Vector2]) {
        let mut taken = BTreeSet::new();
        let dots: Vec<Vec<Pixel>> = nodes
            .iter()
            .map(|p| self.view.pixel(*p))
            .filter(|p| taken.insert((p.0.div_euclid(20), p.1.div_euclid(20))))
            .map(|p| vec![p])
            .collect();
        self.svg.paths(dots, LineEnd::Open, "stroke=\"#52616e\" stroke-width=\"22\"");
    }

    fn cracks(&mut self) {
        for crack in &self.model.cracks {
            let line = self.pixels(&crack.vertices);
            self.svg.paths([line], LineEnd::Open, CRACK);
            let tips: Vec<_> = crack.tip_ends().map(|end| vec![self.view.pixel(crack.frame(end).position)]).collect();
            self.svg.paths(tips, LineEnd::Open, "stroke=\"#d62728\" stroke-width=\"70\"");
            let frame = crack.frame(End::End);
            let middle = 0.5 * (crack.vertices[0] + crack.vertices[crack.vertices.len() - 1]);
            let up = if frame.x2().y < 0.0 { -frame.x2() } else { frame.x2() };
            self.label(middle + up * self.length(14.0), up, "fill=\"#d62728\"", &crack.name);
        }
    }

    fn supports(&mut self) {
        let model = self.model;
        for support in &model.supports {
            for at in self.samples(&model.domain.parts[support.part].edges) {
                let d = support.direction.vector(&at);
                let value = support.value.value(&model.material, support.direction, &at);
                // A known field has a value nearly everywhere, and means a support.
                if value == 0.0 || matches!(support.value, PrescribedValue::Exact(_)) {
                    self.support_symbol(at.position, if d.dot(&at.normal) > 1e-6 { d } else { -d });
                } else {
                    self.arrow(at.position, d * value.signum() * self.length(2.0 * SYMBOL), SUPPORT);
                }
            }
        }
        for support in &model.point_supports {
            for (axis, d) in [Vector2::x(), Vector2::y()].into_iter().enumerate() {
                match support.displacement[axis] {
                    None => {}
                    Some(0.0) => self.support_symbol(support.at, -d),
                    Some(u) => self.arrow(support.at, d * u.signum() * self.length(2.0 * SYMBOL), SUPPORT),
                }
            }
        }
        for spring in &model.springs {
            for at in self.samples(&model.domain.parts[spring.part].edges) {
                self.spring_symbol(spring.direction, &at);
            }
        }
    }

    /// A triangle that stands beside the point and touches it.
    fn support_symbol(&mut self, at: Vector2, away: Vector2) {
        let (d, side) = (away * self.length(SYMBOL), turn_left(away) * self.length(0.55 * SYMBOL));
        let triangle = self.pixels(&[at, at + d + side, at + d - side]);
        self.svg.paths([triangle], LineEnd::Closed, SUPPORT);
    }

    fn spring_symbol(&mut self, direction: Direction, at: &FieldPoint) {
        let d = direction.vector(at);
        let away = if d.dot(&at.normal) > 1e-6 { d } else { -d } * self.length(0.4 * SYMBOL);
        let side = turn_left(away) * 0.8;
        let zigzag = (0..=6).map(|k| at.position + away * f64::from(k) + side * [0.0, 1.0, 0.0, -1.0][k as usize % 4]);
        let line = self.pixels(&zigzag.collect::<Vec<_>>());
        self.svg.paths([line], LineEnd::Open, SUPPORT);
    }

    fn loads(&mut self) {
        let model = self.model;
        let outline: Vec<EdgeId> = model.domain.outline().collect();
        let mut arrows = vec![];
        for load in &model.loads {
            let edges = load.part.map_or(&outline, |part| &model.domain.parts[part].edges);
            let tractions = self.samples(edges).into_iter().map(|at| {
                let traction = load.value.traction(&model.material, &at);
                // Pulling tractions start at the boundary, pushing ones end there.
                (at.position, traction, traction.dot(&at.normal) >= 0.0)
            });
            arrows.extend(tractions.filter(|a| a.1.norm().is_finite()));
        }
        let greatest = arrows.iter().map(|a| a.1.norm()).fold(0.0, f64::max);
        for (at, traction, pulls) in arrows {
            // What is less than 2 % of the greatest is roundoff or hard to see.
            if traction.norm() > 0.02 * greatest {
                let arrow = traction * (self.length(ARROW) / greatest);
                self.arrow(if pulls { at } else { at - arrow }, arrow, LOAD);
            }
        }
        for load in model.point_loads.iter().filter(|l| l.force.norm() > 0.0) {
            let arrow = load.force.normalize() * self.length(1.3 * ARROW);
            self.arrow(load.at, arrow, LOAD);
        }
        if let Some(force) = &model.body_force {
            let at = FieldPoint { position: model.domain.aabb().center(), normal: Vector2::zeros() };
            let force = Vector2::new(force.0[0].value(&at), force.0[1].value(&at));
            if let Some(d) = force.try_normalize(0.0) {
                self.arrow(at.position, d * self.length(1.3 * ARROW), LOAD);
                self.label(at.position - d * self.length(10.0), -d, "fill=\"#0b57d0\"", "body force");
            }
        }
    }

    fn arrow(&mut self, from: Vector2, arrow: Vector2, style: &str) {
        let to = from + arrow;
        let head = (arrow * 0.5).cap_magnitude(self.length(8.0));
        let side = turn_left(head) * 0.45;
        let lines = [self.pixels(&[from, to]), self.pixels(&[to - head + side, to, to - head - side])];
        self.svg.paths(lines, LineEnd::Open, style);
    }

    fn part_names(&mut self) {
        let domain = &self.model.domain;
        for part in &domain.parts {
            // In the middle of a hole, otherwise beside the middle of the part, clear of its symbols.
            let hole = domain.loops[1..].iter().find(|edges| (**edges).clone().all(|e| part.edges.contains(&e)));
            let (at, outward) = match (hole, self.points_along(&part.edges, 1).first()) {
                (Some(hole), _) => {
                    let thirds =
                        domain.edges[hole.clone()].iter().flat_map(|e| [0.0, 1.0, 2.0].map(|t| e.point(t / 3.0)));
                    let bounds = crate::geometry::aabb::Aabb::of_points(thirds);
                    (bounds.center(), Vector2::zeros())
                }
                (None, Some(at)) => (at.position + at.normal * self.length(ARROW + 9.0), at.normal),
                (None, None) => continue,
            };
            self.label(at, outward, "fill=\"#444444\"", &part.name);
        }
    }

    /// A text that grows away from a point in the direction `outward`; around it where that is zero.
    fn label(&mut self, at: Vector2, outward: Vector2, style: &str, text: &str) {
        let anchor = if outward.x > 0.5 {
            "start"
        } else if outward.x < -0.5 {
            "end"
        } else {
            "middle"
        };
        let (x, y) = self.view.place(at);
        self.svg.text((x, y + 5.0), &format!("{style} text-anchor=\"{anchor}\""), text);
    }

    fn samples(&self, edges: &[EdgeId]) -> Vec<FieldPoint> {
        let length: f64 = edges.iter().map(|&e| self.model.domain.edges[e].length()).sum();
        self.points_along(edges, ((length / self.length(SPACING)).round() as usize).max(1))
    }

    /// Points in the middle of `n` equal pieces of a chain of edges.
    fn points_along(&self, edges: &[EdgeId], n: usize) -> Vec<FieldPoint> {
        let curves = || edges.iter().map(|&e| &self.model.domain.edges[e]);
        let total: f64 = curves().map(|c| c.length()).sum();
        let mut points = vec![];
        let mut before = 0.0;
        for curve in curves() {
            let length = curve.length();
            while points.len() < n {
                let t = ((points.len() as f64 + 0.5) / n as f64 * total - before) / length;
                if t > 1.0 {
                    break;
                }
                points.push(FieldPoint { position: curve.point(t), normal: curve.right_normal(t) });
            }
            before += length;
        }
        points
    }
}
