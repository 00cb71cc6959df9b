//! What is around a point: the nodes that may reach it, those that do, and their weights.

use super::{Derivatives, MovingLeastSquares};
use crate::approximation::ShapeFunctions;
use crate::approximation::enrichment::{EnrichmentBuffer, TipPoint};
use crate::approximation::mls::Neighborhood;
use crate::approximation::point_batch::{PointBatch, Wanted};
use crate::approximation::settings::{SupportShape, WeightFunction};
use crate::approximation::sight::{Candidate, SightBuffer, View};
use crate::geometry::aabb::Aabb;
use crate::math::Vector2;

/// What may matter around a point or a cell: nodes that may reach it, and obstacles that may hide them. A buffer.
#[derive(Clone, Debug, Default)]
pub struct Surroundings {
    /// Nodes that may reach.
    pub candidates: Vec<u32>,
    /// Obstacles that may hide, and ways around them.
    sight: SightBuffer,
    /// Positions of the candidates, axis by axis.
    positions: [Vec<f64>; 2],
    /// Inverse squared support radii of the candidates, where supports are circular.
    inverse: Vec<f64>,
    /// Buffer of the fit.
    pub near: Neighborhood<2>,
    /// Regions around tips.
    pub(super) enrichment: EnrichmentBuffer,
    pub(super) tip: TipPoint,
    /// Finite elements that may hold a point.
    pub(super) elements: Vec<u32>,
    /// Plain shape functions, where they are joined to enriched ones.
    pub(super) plain: ShapeFunctions<2>,
}

impl MovingLeastSquares {
    /// Looks up what may matter for points in a box.
    pub fn survey(&self, bounds: &Aabb<2>, around: &mut Surroundings) {
        around.candidates.clear();
        self.supports.visit(bounds, |i| around.candidates.push(i));
        around.candidates.sort_unstable();
        let mut reach = *bounds;
        for &i in &around.candidates {
            reach = reach.including(self.nodes.sights[i as usize]);
        }
        self.sight.survey(&reach, &around.candidates, &mut around.sight);
        if let Some(enrichment) = &self.enrichment {
            enrichment.survey(bounds, &mut around.enrichment);
        }
        if let Some(elements) = &self.elements {
            elements.survey(bounds, &mut around.elements);
        }
        let [xs, ys] = &mut around.positions;
        xs.clear();
        ys.clear();
        around.inverse.clear();
        for &i in &around.candidates {
            let (p, r) = (self.nodes.positions[i as usize], self.nodes.support_radii[i as usize].x);
            xs.push(p.x);
            ys.push(p.y);
            around.inverse.push(1.0 / (r * r));
        }
    }

    /// Whether what was surveyed hides no node and enriches none, so that its points can stand in a [`PointBatch`].
    pub fn is_plain(&self, around: &Surroundings) -> bool {
        self.settings.support == SupportShape::Circular
            && around.sight.is_open()
            && (self.elements.is_none() || around.elements.is_empty())
            && (self.enrichment.is_none() || around.enrichment.is_empty())
            && self.extra.as_ref().is_none_or(|extra| extra.is_silent(&around.candidates))
    }

    /// Makes the given nodes those of a batch.
    pub fn fill_nodes(&self, nodes: impl Iterator<Item = u32>, batch: &mut PointBatch) {
        batch.set_nodes(nodes.map(|i| {
            let (p, r) = (self.nodes.positions[i as usize], self.nodes.support_radii[i as usize].x);
            [p.x, p.y, 1.0 / (r * r)]
        }));
    }

    /// Whether the support of a node meets a box, but for round-off.
    pub fn may_reach(&self, node: u32, bounds: &Aabb<2>) -> bool {
        let (p, r) = (self.nodes.positions[node as usize], self.nodes.support_radii[node as usize].max());
        let nearest = Vector2::from_fn(|d, _| p[d].clamp(bounds.lower[d], bounds.upper[d]));
        (p - nearest).norm_squared() <= r * r * (1.0 + 1e-12)
    }

    /// Computes what is wanted of the points of a batch; false if the fit at one of them is singular.
    pub fn evaluate_batch(&self, wanted: Wanted, batch: &mut PointBatch) -> bool {
        batch.evaluate(self.settings.basis, self.settings.weight_function, wanted)
    }

    /// Gathers the neighbors of a point that was surveyed.
    #[inline]
    pub fn gather(&self, at: Vector2, sight: Vector2, derivatives: Derivatives, around: &mut Surroundings) {
        around.sight.start_point();
        let view = View { at, sight };
        let relative = |c: &Candidate, buffer: &mut SightBuffer| self.sight.relative(&view, &self.nodes, c, buffer);
        match self.settings.support {
            SupportShape::Circular if around.sight.is_open() => self.gather_circular(at, around, |c, _| c.relative),
            SupportShape::Circular => self.gather_circular(at, around, relative),
            SupportShape::Rectangular => self.gather_rectangular(at, around, relative),
        }
        if derivatives == Derivatives::Second {
            let (function, shape) = (self.settings.weight_function, self.settings.support);
            let near = &mut around.near;
            for (k, &i) in near.nodes.iter().enumerate() {
                let offset = near.offset(k);
                let second = function.second_derivatives(shape, &offset, &self.nodes.support_radii[i as usize]);
                near.weight_second_derivatives.push(second);
            }
            around.sight.mend_second(function, &near.inverse, &mut near.weight_second_derivatives);
        }
    }

    /// Disks: distances of all candidates at once, then the weights of those in reach.
    ///
    /// - `relative`: squared argument of the weight function of a candidate whose disk holds the point
    #[inline]
    fn gather_circular(
        &self,
        at: Vector2,
        around: &mut Surroundings,
        mut relative: impl FnMut(&Candidate, &mut SightBuffer) -> f64,
    ) {
        let Surroundings { candidates, sight, positions, inverse, near, .. } = around;
        let n = candidates.len();
        near.resize(n);
        let [xs, ys] = positions;
        let [ox, oy] = &mut near.offsets;
        let mut m = 0;
        // Every candidate is written, and overwritten by the next if it is out of reach: no branch to guess.
        for (index, (((&node, &px), &py), &inverse2)) in
            candidates.iter().zip(&*xs).zip(&*ys).zip(&*inverse).enumerate()
        {
            let (x, y) = (px - at.x, py - at.y);
            let mut s2 = (x * x + y * y) * inverse2;
            if s2 < 1.0 {
                s2 = relative(&Candidate { index, neighbor: m, node, relative: s2, inverse: inverse2 }, sight);
            }
            near.nodes[m] = node;
            ox[m] = x;
            oy[m] = y;
            near.relative[m] = s2;
            near.inverse[m] = inverse2;
            m += (s2 < 1.0) as usize;
        }
        near.resize(m);
        let [gx, gy] = &mut near.weight_gradients;
        self.settings.weight_function.values_and_slopes(&near.relative, &mut near.weights, gx);
        sight.keep_slopes(gx);
        let [ox, oy] = &near.offsets;
        for k in 0..m {
            let factor = -gx[k] * near.inverse[k];
            gx[k] = factor * ox[k];
            gy[k] = factor * oy[k];
        }
        sight.mend_gradients(&near.inverse, &mut near.weight_gradients);
    }

    /// Rectangles, which know visibility only.
    #[inline(never)]
    fn gather_rectangular(
        &self,
        at: Vector2,
        around: &mut Surroundings,
        mut relative: impl FnMut(&Candidate, &mut SightBuffer) -> f64,
    ) {
        let Surroundings { candidates, sight, near, .. } = around;
        near.resize(candidates.len());
        let mut m = 0;
        for (index, &i) in candidates.iter().enumerate() {
            let (offset, radii) = (self.nodes.positions[i as usize] - at, &self.nodes.support_radii[i as usize]);
            let candidate = Candidate { index, neighbor: m, node: i, relative: 0.0, inverse: 0.0 };
            if WeightFunction::reaches(SupportShape::Rectangular, &offset, radii) && relative(&candidate, sight) < 1.0 {
                let (weight, gradient) =
                    self.settings.weight_function.weight(SupportShape::Rectangular, &offset, radii);
                near.nodes[m] = i;
                near.weights[m] = weight;
                for d in 0..2 {
                    near.offsets[d][m] = offset[d];
                    near.weight_gradients[d][m] = gradient[d];
                }
                m += 1;
            }
        }
        near.resize(m);
    }
}
