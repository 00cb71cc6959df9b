//! The moving least squares approximation over the nodes of a body in the plane, around cracks and holes.

use super::ShapeFunctions;
use super::detour::Jet;
use super::discontinuity::Barriers;
use super::enriched_fit::fit_enriched_into;
use super::enrichment::{Enrichment, EnrichmentBuffer, Place, TipPoint};
use super::extra::Extra;
use super::finite_elements::{FiniteElements, JoinedElement};
use super::mls::{Neighborhood, fit_into, quality};
use super::settings::{ApproximationSettings, SupportShape, WeightFunction};
use super::sight::{Candidate, Sight, SightBuffer, View};
use crate::error::{Error, Result};
use crate::geometry::aabb::Aabb;
use crate::geometry::obstacles::Obstacles;
use crate::geometry::tree::BoxTree;
use crate::math::Vector2;
use crate::nodes::Nodes;

/// Moment matrices with a smaller scaled pivot than this are poor.
pub const POOR_PIVOT: f64 = 0.02;
/// Enriched shape functions whose magnitudes sum to more than this are poor.
const LARGE_SUM: f64 = 3.5;

/// Which derivatives are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Derivatives {
    /// Values and gradients.
    First,
    /// Second derivatives too.
    Second,
}

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
    enrichment: EnrichmentBuffer,
    tip: TipPoint,
    /// Finite elements that may hold a point.
    elements: Vec<u32>,
    /// Plain shape functions, where they are joined to enriched ones.
    plain: ShapeFunctions<2>,
}

/// Moving least squares over nodes that do not act across obstacles [EFG, sections 2.1, 2.2, 4].
#[derive(Clone, Debug)]
pub struct MovingLeastSquares {
    nodes: Nodes<2>,
    sight: Sight,
    settings: ApproximationSettings,
    supports: BoxTree<2>,
    enrichment: Option<Enrichment>,
    extra: Option<Extra>,
    elements: Option<FiniteElements>,
}

impl MovingLeastSquares {
    /// Joins nodes (with supports), obstacles and settings.
    pub fn new(nodes: Nodes<2>, barriers: impl Into<Barriers>, settings: ApproximationSettings) -> Self {
        let boxes: Vec<_> =
            nodes.positions.iter().zip(&nodes.support_radii).map(|(p, r)| Aabb::around(*p, *r)).collect();
        let (supports, sight) = (BoxTree::new(&boxes), Sight::new(barriers.into(), &nodes));
        Self { supports, sight, nodes, settings, enrichment: None, extra: None, elements: None }
    }

    /// Adds the functions of tips, to the basis around them or to the nodes there.
    pub fn enriched(mut self, enrichment: Option<Enrichment>) -> Self {
        self.enrichment = enrichment;
        self.extra = self.enrichment.as_mut().and_then(|enrichment| {
            enrichment.visit_nodes(&self.nodes);
            enrichment.extra_functions(&self.nodes)
        });
        self
    }

    /// Joins finite elements to the nodes.
    pub fn coupled(self, elements: Option<FiniteElements>) -> Self {
        Self { elements, ..self }
    }

    /// The finite elements, if there are any.
    pub fn elements(&self) -> Option<&FiniteElements> {
        self.elements.as_ref()
    }

    /// The finite element around a point that was surveyed.
    pub fn element_at(&self, sight: Vector2, around: &Surroundings) -> Option<&JoinedElement> {
        self.elements.as_ref()?.find(sight, &around.elements)
    }

    /// Number of functions: one of each node, and the additional ones of enriched nodes.
    pub fn n_functions(&self) -> usize {
        self.extra.as_ref().map_or(self.nodes.len(), Extra::n_functions)
    }

    /// Angle of each tip with functions of its own, whose parameters are tied to K_I and K_II [rad]; in the order of the tips.
    pub fn tied_tips(&self) -> Vec<f64> {
        self.extra.as_ref().map_or(vec![], Extra::tied_tips)
    }

    /// Position of the node or tip of each function.
    pub fn function_positions(&self) -> Vec<Vector2> {
        let mut positions = self.nodes.positions.clone();
        positions.extend(self.extra.iter().flat_map(|extra| extra.positions(&self.nodes.positions)));
        positions
    }

    /// Appends the additional functions that are not zero where the nodes in an ascending list act.
    pub fn append_functions(&self, list: &mut Vec<u32>) {
        if let Some(extra) = &self.extra {
            extra.append_to(list);
        }
    }

    /// The enriched regions, if there are any.
    pub fn enrichment(&self) -> Option<&Enrichment> {
        self.enrichment.as_ref()
    }

    /// The nodes.
    pub fn nodes(&self) -> &Nodes<2> {
        &self.nodes
    }

    /// The obstacles.
    pub fn obstacles(&self) -> &Obstacles {
        self.sight.obstacles()
    }

    /// The settings.
    pub fn settings(&self) -> &ApproximationSettings {
        &self.settings
    }

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

    /// Shape functions at a point that was surveyed, seen from `sight` (the point itself inside the body, a point
    /// slightly inside the material on boundary and crack faces).
    #[inline]
    pub fn evaluate_surveyed(
        &self,
        at: Vector2,
        sight: Vector2,
        derivatives: Derivatives,
        around: &mut Surroundings,
        shape: &mut ShapeFunctions<2>,
    ) -> Result<()> {
        let element = self.element_at(sight, around);
        if let Some(element) = element.filter(|e| e.is_plain()) {
            element.fill(at, derivatives, shape);
            return Ok(());
        }
        self.gather(at, sight, derivatives, around);
        let fits = match self.place(at, around) {
            Some(place) => self.fit_in_region(&place, [at, sight], around, shape),
            None => fit_into(self.settings.basis, &mut around.near, shape),
        };
        if !fits {
            return Err(self.singular(at, around));
        }
        if let Some(extra) = &self.extra {
            extra.append([at, sight], shape);
        }
        if let Some(element) = element {
            element.join(at, shape);
        }
        Ok(())
    }

    /// The enriched region around a point that was surveyed.
    #[inline]
    fn place(&self, at: Vector2, around: &Surroundings) -> Option<(Place, &Enrichment)> {
        let enrichment = self.enrichment.as_ref()?;
        Some((enrichment.place(at, &around.enrichment)?, enrichment))
    }

    /// Shape functions at a point whose neighbors are gathered, enriched by the share that the place has.
    fn fit_in_region(
        &self,
        (place, enrichment): &(Place, &Enrichment),
        view: [Vector2; 2],
        around: &mut Surroundings,
        shape: &mut ShapeFunctions<2>,
    ) -> bool {
        let Surroundings { candidates, near, enrichment: buffer, tip, plain, .. } = around;
        enrichment.fill(place, view, candidates, &near.nodes, buffer, tip);
        if !fit_enriched_into(self.settings.basis, enrichment.functions(), near, tip, shape) {
            return false;
        }
        if place.share.value < 1.0 {
            if !fit_into(self.settings.basis, near, plain) {
                return false;
            }
            join(shape, plain, &place.share);
        }
        true
    }

    /// Shape functions at any point.
    pub fn evaluate(
        &self,
        at: Vector2,
        sight: Vector2,
        derivatives: Derivatives,
        around: &mut Surroundings,
        shape: &mut ShapeFunctions<2>,
    ) -> Result<()> {
        self.survey(&Aabb::of_points([at, sight]), around);
        self.evaluate_surveyed(at, sight, derivatives, around, shape)
    }

    /// How well the neighbors that were gathered last determine the fit, seen from `sight`: the smallest scaled pivot
    /// of the moment matrix of polynomials, and in enriched regions a measure of the size of the shape functions. 0 if
    /// there is no fit.
    pub fn quality(
        &self,
        at: Vector2,
        sight: Vector2,
        around: &mut Surroundings,
        shape: &mut ShapeFunctions<2>,
    ) -> f64 {
        if around.near.nodes.len() < self.n_needed(at, around) {
            return 0.0;
        }
        match self.place(at, around) {
            Some(place) if self.fit_in_region(&place, [at, sight], around, shape) => {
                LARGE_SUM * POOR_PIVOT / shape.values.iter().map(|v| v.abs()).sum::<f64>()
            }
            Some(_) => 0.0,
            None => quality(self.settings.basis, &mut around.near),
        }
    }

    /// Least number of neighbors of a fit at a point that was surveyed.
    pub fn n_needed(&self, at: Vector2, around: &Surroundings) -> usize {
        let polynomials = match self.settings.basis {
            super::Basis::Linear => 3,
            super::Basis::Quadratic => 6,
        };
        polynomials + self.place(at, around).map_or(0, |(_, enrichment)| enrichment.functions().count())
    }

    /// Whether a point that was surveyed lies in an enriched region.
    pub fn is_enriched(&self, at: Vector2, around: &Surroundings) -> bool {
        self.place(at, around).is_some()
    }

    #[cold]
    fn singular(&self, point: Vector2, around: &Surroundings) -> Error {
        let (n_neighbors, needed) = (around.near.nodes.len(), self.n_needed(point, around));
        Error::SingularMomentMatrix { point, n_neighbors, needed }
    }
}

/// `R φ + (1 - R) ψ` for enriched `φ` and plain `ψ` of the same neighbors [EFG, Eq. 56].
fn join(shape: &mut ShapeFunctions<2>, plain: &ShapeFunctions<2>, share: &Jet) {
    for k in 0..shape.neighbors.len() {
        let (value, gradient) = (shape.values[k] - plain.values[k], shape.gradients[k] - plain.gradients[k]);
        if let Some(second) = shape.second_derivatives.get_mut(k) {
            let own = plain.second_derivatives[k];
            let mixed = share.gradient * gradient.transpose();
            *second = own + (*second - own) * share.value + mixed + mixed.transpose() + share.second * value;
        }
        shape.gradients[k] = plain.gradients[k] + gradient * share.value + share.gradient * value;
        shape.values[k] = plain.values[k] + value * share.value;
    }
}

/// Half sizes of a support from spacings along the axes.
pub fn support_radii(shape: SupportShape, dilation: f64, spacing: Vector2) -> Vector2 {
    match shape {
        SupportShape::Circular => Vector2::repeat(dilation * spacing.max()),
        SupportShape::Rectangular => spacing * dilation,
    }
}
