//! How far apart nodes shall stand: smallest at tips, holes and thin ligaments, growing linearly away from them.

use super::Nodes;
use super::ligaments;
use super::settings::Graded;
use super::source_tree::SourceTree;
use super::support::neighbor_distances;
use crate::crack::EndKind;
use crate::crack::meetings::{Meeting, shared_vertices};
use crate::geometry::aabb::Aabb;
use crate::geometry::curve::Curve;
use crate::geometry::obstacles::Obstacles;
use crate::geometry::predicates::distance_to_segment;
use crate::geometry::tree::BoxTree;
use crate::math::{Vector2, cross, turn_left};
use crate::model::Model;
use std::f64::consts::{PI, TAU};

/// Spacing without any feature, as a fraction of √area.
const BODY_FRACTION: f64 = 1.0 / 25.0;
/// Spacing at a tip as a fraction of the radius of the free disk around it, where the body's spacing is the default or wider:
/// what hides nodes behind a crack makes it longer or shorter by up to a tenth of the spacing at its tip, however fine the
/// nodes are elsewhere.
const TIP_FRACTION: f64 = 1.0 / 300.0;
/// Spacing along a cohesive crack as a fraction of the length that is tied, and of the length that the process zone is
/// proportional to.
const LIGAMENT_FRACTION: f64 = 1.0 / 64.0;
const ZONE_FRACTION: f64 = 1.0 / 20.0;
/// Spacing along an arc as a fraction of its radius.
const ARC_FRACTION: f64 = 0.12;
/// Spacing as a fraction of the thickness of the body at a boundary point.
const THICKNESS_FRACTION: f64 = 1.0 / 7.0;
/// Spacing at a kink of a crack as a fraction of the shorter segment there.
const KINK_FRACTION: f64 = 1.0 / 12.0;
/// Spacing at re-entrant corners and where forces act at a point, as a fraction of the body's spacing.
const SINGULAR_FRACTION: f64 = 1.0 / 8.0;
/// Spacing where the condition on the boundary changes, as a fraction of the body's spacing and of the shorter edge.
const CHANGE_FRACTIONS: [f64; 2] = [1.0 / 3.0, 1.0 / 12.0];
/// Turn of a crack or an outline below which a vertex is smooth [rad].
const SMOOTH_TURN: f64 = 0.2;
/// Default growth of the spacing with distance.
pub(super) const GROWTH: f64 = 0.2;

/// A spacing that every point of the body can be asked for.
#[derive(Clone, Debug)]
pub struct SpacingField {
    sources: Vec<Source>,
    /// Over all sources, once they are complete.
    tree: Option<SourceTree<2>>,
    largest: f64,
    growth: f64,
    given: Option<GivenNodes>,
}

/// Nodes at given places; each point takes the spacing of the nearest one.
#[derive(Clone, Debug)]
struct GivenNodes {
    positions: Vec<Vector2>,
    spacings: Vec<f64>,
    tree: BoxTree<2>,
}

#[derive(Clone, Debug)]
struct Source {
    place: Place,
    spacing: f64,
}

#[derive(Clone, Debug)]
enum Place {
    Point(Vector2),
    Curve(Curve),
    Rectangle(Aabb<2>),
}

impl Place {
    fn distance(&self, p: Vector2) -> f64 {
        match self {
            Self::Point(q) => (p - q).norm(),
            Self::Curve(curve) => curve.distance(p),
            Self::Rectangle(r) => (r.lower - p).sup(&(p - r.upper)).sup(&Vector2::zeros()).norm(),
        }
    }

    fn aabb(&self) -> Aabb<2> {
        match self {
            Self::Point(q) => Aabb { lower: *q, upper: *q },
            Self::Curve(curve) => curve.aabb(),
            Self::Rectangle(r) => *r,
        }
    }
}

impl SpacingField {
    /// The same spacing everywhere.
    pub fn uniform(spacing: f64) -> Self {
        Self { sources: vec![], tree: None, largest: spacing, growth: 1.0, given: None }
    }

    /// The spacing of given nodes: at each the distance to its third nearest, which is the edge length of a regular
    /// grid, at its sides too, and 0.97 of the mean spacing of random nodes. `mean` is a typical spacing.
    pub fn of_nodes(positions: &[Vector2], mean: f64) -> Self {
        const NEIGHBOR: usize = 3;
        if positions.len() <= NEIGHBOR {
            return Self::uniform(mean);
        }
        let (positions, sights) = (positions.to_vec(), positions.to_vec());
        let nodes = Nodes { positions, sights, support_radii: vec![] };
        let spacings = neighbor_distances(
            &nodes,
            &Obstacles::new(vec![]),
            &vec![mean; nodes.len()],
            NEIGHBOR,
            Vector2::repeat(1.0),
        );
        let spacings = spacings.iter().map(|s| s.x).collect();
        let tree = BoxTree::of_points(&nodes.positions);
        Self { given: Some(GivenNodes { positions: nodes.positions, spacings, tree }), ..Self::uniform(mean) }
    }

    /// The spacing that the features of a model ask for, overruled by what the settings say.
    pub fn of_model(model: &Model, settings: &Graded) -> Self {
        let automatic = BODY_FRACTION * model.domain.area().sqrt();
        let largest = settings.spacing.unwrap_or(automatic);
        let mut field = Self { growth: settings.growth.unwrap_or(GROWTH), ..Self::uniform(largest) };
        // Tips are refined with the body: else K would stay as far off as the nodes at the tip leave it.
        field.add_tips(model, settings.tip_spacing, TIP_FRACTION * (largest / automatic).min(1.0));
        field.add_ligaments(model, settings.tip_spacing, (largest / automatic).min(1.0));
        field.add_kinks(model);
        field.add_junctions(model);
        field.add_edges(model);
        field.add_changes(model);
        field.add_thickness(model);
        ligaments::add(&mut field, model);
        for p in model.point_loads.iter().map(|l| l.at).chain(model.point_supports.iter().map(|s| s.at)) {
            field.add(Place::Point(p), SINGULAR_FRACTION * largest);
        }
        field.index();
        field
    }

    /// The spacing of each of some rectangles within it, growing away from the finer ones.
    ///
    /// - `growth`: slope of the spacing with the distance, in (0, 1]
    pub fn of_rectangles(rectangles: &[(Aabb<2>, f64)], growth: f64) -> Self {
        let largest = rectangles.iter().map(|r| r.1).fold(0.0, f64::max);
        let mut field = Self { growth, ..Self::uniform(largest) };
        rectangles.iter().for_each(|(place, spacing)| field.add(Place::Rectangle(*place), *spacing));
        field.index();
        field
    }

    /// Builds the tree over the sources: before, each point asks all of them.
    fn index(&mut self) {
        let boxes: Vec<_> = self.sources.iter().map(|s| s.place.aabb()).collect();
        let spacings: Vec<_> = self.sources.iter().map(|s| s.spacing).collect();
        self.tree = Some(SourceTree::new(&boxes, &spacings));
    }

    /// Spacing at a point [length].
    pub fn at(&self, p: Vector2) -> f64 {
        if let Some(given) = &self.given {
            return given.spacings[given.nearest(p, self.largest)];
        }
        let asked = |source: &Source| source.spacing + self.growth * source.place.distance(p);
        match &self.tree {
            Some(tree) => tree.least(p, self.growth, self.largest, |i| asked(&self.sources[i as usize])),
            None => self.sources.iter().fold(self.largest, |h, source| h.min(asked(source))),
        }
    }

    /// Spacing where no feature asks for a smaller one [length].
    pub fn largest(&self) -> f64 {
        self.largest
    }

    /// Greatest slope of the spacing.
    pub fn growth(&self) -> f64 {
        self.growth
    }

    /// Asks for a spacing at a point.
    pub(super) fn add_point(&mut self, p: Vector2, spacing: f64) {
        self.add(Place::Point(p), spacing);
    }

    fn add(&mut self, place: Place, spacing: f64) {
        if spacing < self.largest {
            self.sources.push(Source { place, spacing });
        }
    }

    /// - `fraction`: spacing over the free radius of a tip, if none is `given`
    fn add_tips(&mut self, model: &Model, given: Option<f64>, fraction: f64) {
        let singular = model.tips().into_iter().filter(|t| model.cohesive_crack(t.0.crack).is_none());
        for (tip, frame) in singular {
            let spacing = given.unwrap_or_else(|| fraction * free_radius(model, tip.crack, frame.position));
            self.add(Place::Point(frame.position), spacing);
        }
    }

    /// Along what is tied of cohesive cracks, the process zone must be followed wherever it comes.
    ///
    /// - `factor`: on the spacing, if none is `given`
    fn add_ligaments(&mut self, model: &Model, given: Option<f64>, factor: f64) {
        let Some(cohesive) = &model.cohesive else { return };
        let zone = cohesive.law.characteristic_length(model.material.effective_young());
        for (index, crack) in model.cracks.iter().enumerate() {
            let Some(own) = cohesive.crack(index) else { continue };
            let tied = || crack.segments().filter(|(a, b)| !own.is_notch((a + b) * 0.5));
            let length: f64 = tied().map(|(a, b)| (b - a).norm()).sum();
            let automatic = (LIGAMENT_FRACTION * length).min(ZONE_FRACTION * zone) * factor;
            for (start, end) in tied() {
                self.add(Place::Curve(Curve::Line { start, end }), given.unwrap_or(automatic));
            }
        }
    }

    fn add_kinks(&mut self, model: &Model) {
        let singular = (0..model.cracks.len()).filter(|c| model.cohesive_crack(*c).is_none());
        for crack in singular.map(|c| &model.cracks[c]) {
            for w in crack.vertices.windows(3) {
                let (a, b) = (w[1] - w[0], w[2] - w[1]);
                if cross(a, b).abs().atan2(a.dot(&b)) > SMOOTH_TURN {
                    self.add(Place::Point(w[1]), KINK_FRACTION * a.norm().min(b.norm()));
                }
            }
        }
    }

    /// Where cracks meet, stress is singular if one of the sectors between them is wider than a half turn.
    fn add_junctions(&mut self, model: &Model) {
        let mouths: Vec<Vector2> = model.cracks.iter().flat_map(|c| c.mouths()).collect();
        let inside = shared_vertices(&model.cracks).into_iter().filter(|m| !mouths.contains(&m.place));
        for Meeting { place, cracks } in inside {
            let mut arms: Vec<Vector2> = vec![];
            for (a, b) in cracks.iter().flat_map(|c| model.cracks[*c].segments()) {
                arms.extend([(a, b), (b, a)].into_iter().filter(|s| s.0 == place).map(|s| s.1 - s.0));
            }
            let mut angles: Vec<f64> = arms.iter().map(|d| d.y.atan2(d.x)).collect();
            angles.sort_by(f64::total_cmp);
            let next = angles.iter().skip(1).copied().chain(angles.first().map(|a| a + TAU));
            let widest = angles.iter().zip(next).map(|(a, b)| b - a).fold(0.0, f64::max);
            if widest > PI + SMOOTH_TURN {
                let shortest = arms.iter().map(|d| d.norm()).fold(f64::INFINITY, f64::min);
                self.add(Place::Point(place), KINK_FRACTION * shortest);
            }
        }
    }

    fn add_edges(&mut self, model: &Model) {
        let domain = &model.domain;
        for range in &domain.loops {
            for edge in range.clone() {
                let curve = domain.edges[edge];
                if let Curve::Arc { radius, .. } = curve {
                    self.add(Place::Curve(curve), ARC_FRACTION * radius);
                }
                if curve.length() < 2.0 * self.largest {
                    self.add(Place::Curve(curve), 0.5 * curve.length());
                }
                let next = domain.edges[if edge + 1 == range.end { range.start } else { edge + 1 }];
                let (before, after) = (curve.tangent(1.0), next.tangent(0.0));
                // The body lies to the left, so a turn to the right is a re-entrant corner.
                if cross(before, after).atan2(before.dot(&after)) < -SMOOTH_TURN {
                    let spacing = SINGULAR_FRACTION * self.largest.min(curve.length()).min(next.length());
                    self.add(Place::Point(curve.point(1.0)), spacing);
                }
            }
        }
    }

    /// Stress is singular, or at least steep, where loads or supports begin and end.
    fn add_changes(&mut self, model: &Model) {
        let conditions = |edge: usize| -> Vec<(u8, usize)> {
            let on = |part: usize| model.domain.parts[part].edges.contains(&edge);
            let loads = model.loads.iter().map(|l| l.part.is_some_and(on));
            let supports = model.supports.iter().map(|s| on(s.part));
            let springs = model.springs.iter().map(|s| on(s.part));
            let hits =
                |kind: u8, flags: Vec<bool>| flags.into_iter().enumerate().filter(|f| f.1).map(move |f| (kind, f.0));
            hits(0, loads.collect()).chain(hits(1, supports.collect())).chain(hits(2, springs.collect())).collect()
        };
        let domain = &model.domain;
        for range in &domain.loops {
            for edge in range.clone() {
                let next = if edge + 1 == range.end { range.start } else { edge + 1 };
                let (a, b) = (domain.edges[edge], domain.edges[next]);
                let turns = cross(a.tangent(1.0), b.tangent(0.0)).abs() > SMOOTH_TURN;
                let (here, there) = (conditions(edge), conditions(next));
                let supported = here.iter().chain(&there).any(|c| c.0 > 0);
                // A free edge beside a loaded one at a corner carries no singularity.
                if here != there && (supported || !turns) {
                    let shorter = a.length().min(b.length());
                    let spacing = (CHANGE_FRACTIONS[0] * self.largest).min(CHANGE_FRACTIONS[1] * shorter);
                    self.add(Place::Point(a.point(1.0)), spacing);
                }
            }
        }
    }

    /// Where boundary lies opposite to boundary or a crack runs beside it, some nodes must fit between.
    fn add_thickness(&mut self, model: &Model) {
        let domain = &model.domain;
        let tolerance = 1e-3 * self.largest;
        let mut walls: Vec<(Vector2, Vector2)> = vec![];
        for edge in &domain.edges {
            walls.extend(edge.flattened(tolerance).windows(2).map(|w| (w[0], w[1])));
        }
        walls.extend(model.cracks.iter().flat_map(|c| c.segments().collect::<Vec<_>>()));
        for edge in &domain.edges {
            let n = ((edge.length() / self.largest).ceil() as usize).clamp(3, 40);
            for k in 0..n {
                let t = (k as f64 + 0.5) / n as f64;
                let (p, inward) = (edge.point(t), -edge.right_normal(t));
                if let Some(thickness) = ray_length(p + inward * (2.0 * tolerance), inward, &walls) {
                    self.add(Place::Point(p), THICKNESS_FRACTION * thickness);
                    self.add(Place::Point(p + inward * thickness), THICKNESS_FRACTION * thickness);
                }
            }
        }
    }
}

impl GivenNodes {
    /// The node nearest to a point; `mean` is a typical spacing.
    fn nearest(&self, p: Vector2, mean: f64) -> usize {
        // Dense clusters are asked first with a small box.
        let mut reach = mean / 16.0;
        loop {
            let mut best = (f64::INFINITY, u32::MAX);
            self.tree.visit(&Aabb::around(p, Vector2::repeat(reach)), |i| {
                let found = ((self.positions[i as usize] - p).norm(), i);
                if found < best {
                    best = found;
                }
            });
            if best.0 <= reach {
                return best.1 as usize;
            }
            reach *= 2.0;
        }
    }
}

/// Distance along a ray to the nearest wall.
fn ray_length(from: Vector2, along: Vector2, walls: &[(Vector2, Vector2)]) -> Option<f64> {
    let normal = turn_left(along);
    walls
        .iter()
        .filter_map(|&(a, b)| {
            let (p, q) = ((a - from).dot(&normal), (b - from).dot(&normal));
            if p * q > 0.0 || p == q {
                return None;
            }
            let x = (a + (b - a) * (p / (p - q)) - from).dot(&along);
            (x > 0.0).then_some(x)
        })
        .min_by(f64::total_cmp)
}

/// Radius of the largest disk around a tip whose only content is this crack's way to the tip:
/// no boundary, no other crack, and not the far end of the own crack.
pub fn free_radius(model: &Model, crack: usize, tip: Vector2) -> f64 {
    let path = &model.cracks[crack];
    let mut radius = f64::INFINITY;
    for (i, other) in model.cracks.iter().enumerate() {
        if i != crack {
            radius = other.segments().fold(radius, |r, (a, b)| r.min(distance_to_segment(tip, a, b)));
        }
    }
    let far =
        if (path.vertices[0] - tip).norm() == 0.0 { path.vertices[path.vertices.len() - 1] } else { path.vertices[0] };
    let far_is_tip = path.ends == [EndKind::Tip; 2];
    // Two tips of one crack share its length.
    radius = radius.min((far - tip).norm() * if far_is_tip { 0.5 } else { 1.0 });
    radius.min(model.domain.distance_to_boundary(tip))
}
