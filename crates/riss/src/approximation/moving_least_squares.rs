//! The moving least squares approximation over the nodes of a body in the plane, with the visibility criterion.

use super::ShapeFunctions;
use super::mls::{Neighborhood, fit_into, quality};
use super::settings::{ApproximationSettings, SupportShape, WeightFunction};
use crate::error::{Error, Result};
use crate::geometry::aabb::Aabb;
use crate::geometry::obstacles::Obstacles;
use crate::geometry::tree::BoxTree;
use crate::math::Vector2;
use crate::nodes::Nodes;

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
    /// Obstacles that may hide.
    pub obstacles: Vec<u32>,
    /// Buffer of the fit.
    pub near: Neighborhood<2>,
}

/// Moving least squares over nodes, blind across obstacles [EFG, sections 2.1, 2.2, 4.1].
#[derive(Clone, Debug)]
pub struct MovingLeastSquares {
    nodes: Nodes<2>,
    obstacles: Obstacles,
    settings: ApproximationSettings,
    supports: BoxTree<2>,
}

impl MovingLeastSquares {
    /// Joins nodes (with supports), obstacles and settings.
    pub fn new(nodes: Nodes<2>, obstacles: Obstacles, settings: ApproximationSettings) -> Self {
        let boxes: Vec<_> =
            nodes.positions.iter().zip(&nodes.support_radii).map(|(p, r)| Aabb::around(*p, *r)).collect();
        Self { supports: BoxTree::new(&boxes), nodes, obstacles, settings }
    }

    /// The nodes.
    pub fn nodes(&self) -> &Nodes<2> {
        &self.nodes
    }

    /// The obstacles.
    pub fn obstacles(&self) -> &Obstacles {
        &self.obstacles
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
        self.obstacles.near_into(&reach, &mut around.obstacles);
    }

    /// Gathers the visible neighbors of a point that was surveyed.
    #[inline]
    pub fn gather(&self, at: Vector2, sight: Vector2, derivatives: Derivatives, around: &mut Surroundings) {
        let Surroundings { candidates, obstacles, near } = around;
        let (shape, function) = (self.settings.support, self.settings.weight_function);
        near.clear();
        for &i in candidates.iter() {
            let index = i as usize;
            let (offset, radii) = (self.nodes.positions[index] - at, &self.nodes.support_radii[index]);
            if !WeightFunction::reaches(shape, &offset, radii) {
                continue;
            }
            if !obstacles.is_empty() && !self.obstacles.visible_past(obstacles, sight, self.nodes.sights[index]) {
                continue;
            }
            let (weight, gradient) = function.weight(shape, &offset, radii);
            near.nodes.push(i);
            near.offsets.push(offset);
            near.weights.push(weight);
            near.weight_gradients.push(gradient);
            if derivatives == Derivatives::Second {
                near.weight_second_derivatives.push(function.second_derivatives(shape, &offset, radii));
            }
        }
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
        self.gather(at, sight, derivatives, around);
        if fit_into(self.settings.basis, &mut around.near, shape) {
            return Ok(());
        }
        Err(self.singular(at, around.near.nodes.len()))
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

    /// Quality of the moment matrix at the point gathered last.
    pub fn quality(&self, around: &mut Surroundings) -> f64 {
        quality(self.settings.basis, &mut around.near)
    }

    /// Least number of neighbors of a fit.
    pub fn n_needed(&self) -> usize {
        match self.settings.basis {
            super::Basis::Linear => 3,
            super::Basis::Quadratic => 6,
        }
    }

    #[cold]
    fn singular(&self, point: Vector2, n_neighbors: usize) -> Error {
        Error::SingularMomentMatrix { point, n_neighbors, needed: self.n_needed() }
    }
}

/// Half sizes of a support from spacings along the axes.
pub fn support_radii(shape: SupportShape, dilation: f64, spacing: Vector2) -> Vector2 {
    match shape {
        SupportShape::Circular => Vector2::repeat(dilation * spacing.max()),
        SupportShape::Rectangular => spacing * dilation,
    }
}
