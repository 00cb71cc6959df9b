//! What nodes are to a point that may not see them: how far away, along which way, and how that changes.

use super::detour::{Jet, lengthened};
use super::discontinuity::Barriers;
use super::fade::Fade;
use super::settings::WeightFunction;
use super::ways::{NodeWays, WaysBuffer};
use crate::geometry::aabb::Aabb;
use crate::geometry::geodesics::Within;
use crate::geometry::obstacles::Obstacles;
use crate::geometry::predicates::segment_is_cut;
use crate::math::{Matrix2, Vector2};
use crate::nodes::Nodes;

/// Obstacles between nodes and points, and the ways around them.
#[derive(Clone, Debug)]
pub(super) struct Sight {
    ways: NodeWays,
    /// All obstacles, where some of them are seen through if a line inside the support leads around.
    links: Option<NodeWays>,
    /// For each obstacle, where it is transparent; empty if none is.
    fades: Vec<Option<Fade>>,
    lambda: f64,
}

/// Buffers of [`Sight`].
#[derive(Clone, Debug, Default)]
pub(super) struct SightBuffer {
    ways: WaysBuffer,
    links: WaysBuffer,
    detours: Vec<Detour>,
}

/// A neighbor that is reached by a detour.
#[derive(Clone, Debug)]
struct Detour {
    neighbor: usize,
    argument: Jet,
    /// Of the weight function there, `w'/s`.
    slope: f64,
}

/// A point and from where it sees.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub at: Vector2,
    pub sight: Vector2,
}

/// A node that may be a neighbor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// Index among the candidates, the neighbor that it would be, and the node.
    pub index: usize,
    pub neighbor: usize,
    pub node: u32,
    /// Squared distance over the support radius; inverse squared support radius.
    pub relative: f64,
    pub inverse: f64,
}

impl Sight {
    /// Finds the ways of all nodes; none where supports are not disks.
    pub fn new(barriers: Barriers, nodes: &Nodes<2>) -> Self {
        let Barriers { obstacles, corners, links, fades, lambda } = barriers;
        let ways = NodeWays::new(nodes, obstacles.clone(), corners, Within::Length, |radius, near, a, b| {
            let [length, shade] = leg(&obstacles, &fades, near, a, b);
            length.is_finite().then_some(length + radius * shade)
        });
        let links = links.map(|(all, corners)| {
            NodeWays::new(nodes, all.clone(), corners, Within::Disk, |_, near, a, b| {
                all.visible_past(near, a, b).then(|| (b - a).norm())
            })
        });
        Self { ways, links, fades, lambda }
    }

    pub fn obstacles(&self) -> &Obstacles {
        &self.ways.obstacles
    }

    pub fn survey(&self, reach: &Aabb<2>, candidates: &[u32], buffer: &mut SightBuffer) {
        self.ways.survey(reach, candidates, &mut buffer.ways);
        if let Some(links) = &self.links {
            links.survey(reach, candidates, &mut buffer.links);
        }
    }

    /// Squared argument of the weight function for a node in reach; infinite if the node does not act on the point.
    #[inline]
    pub fn relative(&self, view: &View, nodes: &Nodes<2>, candidate: &Candidate, buffer: &mut SightBuffer) -> f64 {
        let i = candidate.node as usize;
        let (near, to) = (&buffer.ways.near, nodes.sights[i]);
        let is_clear = near.is_empty() || self.ways.obstacles.visible_past(near, view.sight, to);
        if self.links.is_some() && !self.is_linked(view, to, candidate, &mut buffer.links) {
            return f64::INFINITY;
        }
        if is_clear { candidate.relative } else { self.detour(view, nodes, candidate, buffer) }
    }

    /// Whether a line inside the support joins node and point.
    fn is_linked(&self, view: &View, to: Vector2, candidate: &Candidate, buffer: &mut WaysBuffer) -> bool {
        let Some(links) = &self.links else { return true };
        if buffer.is_open() || links.obstacles.visible_past(&buffer.near, view.sight, to) {
            return true;
        }
        buffer.reaches(candidate.index, |near, corner| {
            if links.obstacles.visible_past(near, view.sight, corner) { [0.0; 2] } else { [f64::INFINITY, 0.0] }
        })
    }

    #[inline(never)]
    fn detour(&self, view: &View, nodes: &Nodes<2>, candidate: &Candidate, buffer: &mut SightBuffer) -> f64 {
        let i = candidate.node as usize;
        let (origin, radius) = (nodes.positions[i], nodes.support_radii[i].x);
        let straight = Jet::distance(view.at, origin);
        let mut way: Option<Jet> = None;
        if !self.fades.is_empty()
            && let Some(shade) = self.shade(&buffer.ways.near, nodes.sights[i], view.sight)
        {
            way = Some(straight.plus(shade, radius)).filter(|w| w.value < radius);
        }
        let last = buffer.ways.shortest(candidate.index, view.at, radius, |near, corner| {
            let [length, shade] = leg(&self.ways.obstacles, &self.fades, near, corner, view.sight);
            [if length.is_finite() { (view.at - corner).norm() } else { length }, shade]
        });
        if let Some(last) = last.filter(|l| way.is_none_or(|w| l.length < w.value)) {
            let mut jet = Jet::distance(view.at, last.corner);
            if !self.fades.is_empty()
                && let Some(shade) = self.shade(&buffer.ways.near, last.corner, view.sight)
            {
                jet = jet.plus(shade, radius);
            }
            way = Some(Jet { value: last.length, ..jet });
        }
        let Some(way) = way else { return f64::INFINITY };
        let argument = lengthened(way, straight, self.lambda);
        if argument.value < radius {
            buffer.detours.push(Detour { neighbor: candidate.neighbor, argument, slope: 0.0 });
        }
        argument.value * argument.value * candidate.inverse
    }

    /// Sum of the shades of all obstacles on a line from `node` to `point`; nothing if one is opaque.
    fn shade(&self, near: &[u32], node: Vector2, point: Vector2) -> Option<Jet> {
        shade(&self.ways.obstacles, &self.fades, near, node, point)
    }
}

/// Length and shade of a straight leg; infinite if it is blocked.
fn leg(obstacles: &Obstacles, fades: &[Option<Fade>], near: &[u32], a: Vector2, b: Vector2) -> [f64; 2] {
    let length = (b - a).norm();
    match fades.is_empty() {
        true if obstacles.visible_past(near, a, b) => [length, 0.0],
        true => [f64::INFINITY, 0.0],
        false => shade(obstacles, fades, near, a, b).map_or([f64::INFINITY, 0.0], |s| [length, s.value]),
    }
}

fn shade(obstacles: &Obstacles, fades: &[Option<Fade>], near: &[u32], node: Vector2, point: Vector2) -> Option<Jet> {
    let mut sum = Jet::ZERO;
    for &k in near {
        let [c, d] = obstacles.segments()[k as usize];
        if segment_is_cut(node, point, c, d) {
            sum = sum.plus(fades[k as usize].as_ref()?.shade(node, point)?, 1.0);
        }
    }
    Some(sum)
}

impl SightBuffer {
    /// Whether nothing can hide.
    #[inline]
    pub fn is_open(&self) -> bool {
        self.ways.is_open() && self.links.is_open()
    }

    #[inline]
    pub fn start_point(&mut self) {
        self.ways.start_point();
        self.links.start_point();
        self.detours.clear();
    }

    /// Keeps the slopes of neighbors that are reached by a detour.
    #[inline]
    pub fn keep_slopes(&mut self, slopes: &[f64]) {
        self.detours.iter_mut().for_each(|d| d.slope = slopes[d.neighbor]);
    }

    /// Gradients of the weights by the point, for neighbors that are reached by a detour.
    #[inline]
    pub fn mend_gradients(&self, inverse: &[f64], [gx, gy]: &mut [Vec<f64>; 2]) {
        for d in &self.detours {
            // w' ∇r with w' = slope r/R².
            let g = d.argument.gradient * (d.slope * d.argument.value * inverse[d.neighbor]);
            (gx[d.neighbor], gy[d.neighbor]) = (g.x, g.y);
        }
    }

    /// The same for second derivatives.
    pub fn mend_second(&self, function: WeightFunction, inverse: &[f64], second: &mut [Matrix2]) {
        for d in &self.detours {
            let (r, inverse) = (&d.argument, inverse[d.neighbor]);
            let s2 = r.value * r.value * inverse;
            let curvature = d.slope + s2 * function.slope_of_slope(s2);
            let square = r.gradient * r.gradient.transpose();
            second[d.neighbor] = (square * curvature + r.second * (d.slope * r.value)) * inverse;
        }
    }
}
