//! The moving least squares approximation over the nodes of a body in the plane, around cracks and holes.

mod surroundings;

use super::ShapeFunctions;
use super::detour::Jet;
use super::discontinuity::Barriers;
use super::enriched_fit::fit_enriched_into;
use super::enrichment::{Enrichment, Place};
use super::extra::Extra;
use super::finite_elements::{FiniteElements, JoinedElement};
use super::mls::{fit_into, quality};
use super::settings::{ApproximationSettings, SupportShape};
use super::sight::Sight;
use crate::error::{Error, Result};
use crate::geometry::aabb::Aabb;
use crate::geometry::obstacles::Obstacles;
use crate::geometry::tree::BoxTree;
use crate::math::Vector2;
use crate::nodes::Nodes;
pub use surroundings::Surroundings;

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
