//! A smoother stress from the stress at the nodes [CPM, Eq. A.2; Chung1998].

use crate::approximation::moving_least_squares::Derivatives;
use crate::approximation::tip_functions::{MOST_FUNCTIONS, TipCoordinates, TipFunctions};
use crate::approximation::{MovingLeastSquares, ShapeFunctions, Surroundings};
use crate::error::Result;
use crate::geometry::aabb::Aabb;
use crate::material::Elasticity;
use crate::math::{Matrix2, Vector2, direction};
use crate::model::Model;
use crate::system::tip_factors::unit_fields;
use crate::system::{Discretization, Solution};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Supports of the recovery over those of the solution.
const SUPPORT_SHARE: f64 = 0.75;

/// An enriched node this near to a tip, over its support radius, has no stress of its own.
const AT_TIP: f64 = 0.02;
/// Number of points around the tip whose mean it takes, and their distance over the support radius.
const RING: (usize, f64) = (8, 0.1);

/// The singular stress at a tip [Williams1957], which is not smoothed where the nodes hold it themselves.
#[derive(Clone, Debug)]
pub struct SingularStress {
    material: Elasticity,
    coordinates: TipCoordinates,
    parameters: [Vector2; MOST_FUNCTIONS],
}

impl SingularStress {
    /// Of given stress intensity factors [stress·√length].
    pub fn new(material: &Elasticity, coordinates: &TipCoordinates, [k1, k2]: [f64; 2]) -> Self {
        let units = unit_fields(material, coordinates.angle());
        let parameters = std::array::from_fn(|f| units[0][f] * k1 + units[1][f] * k2);
        Self { material: *material, coordinates: coordinates.clone(), parameters }
    }

    /// The stress at a point, seen from `sight` [stress].
    pub fn at(&self, at: Vector2, sight: Vector2) -> Matrix2 {
        let jet = self.coordinates.jet(TipFunctions::Full, at, sight);
        let pairs = self.parameters.iter().zip(&jet.gradients);
        self.material.stress(&pairs.fold(Matrix2::zeros(), |sum, (u, g)| sum + u * g.transpose()))
    }
}

/// Buffers of one thread.
#[derive(Clone, Debug, Default)]
pub struct Buffer {
    /// Around all points of the last survey.
    fine: Surroundings,
    /// Around one point.
    wide: Surroundings,
    shape: ShapeFunctions<2>,
}

/// The stress `Σ Ψ_k(x) σ(x_k)`: shape functions of smaller supports, the stress of the solution at the nodes.
#[derive(Clone, Debug)]
pub struct RecoveredStress<'a> {
    fine: MovingLeastSquares,
    wide: &'a MovingLeastSquares,
    nodal: Vec<Matrix2>,
    /// What `nodal` lacks.
    singular: Option<SingularStress>,
}

impl<'a> RecoveredStress<'a> {
    /// Evaluates the stress of a solution at all nodes.
    ///
    /// # Errors
    /// Those of the shape functions.
    pub fn new(model: &Model, discrete: &'a Discretization, solution: &Solution) -> Result<Self> {
        Self::of_nodes(model, discrete, solution, None, |_| true)
    }

    /// The same for use at the points of disks, each with its radius; the singular part is left as it is.
    ///
    /// # Errors
    /// Those of the shape functions.
    pub fn within(
        model: &Model,
        discrete: &'a Discretization,
        solution: &Solution,
        disks: &[(Vector2, f64)],
        singular: Option<SingularStress>,
    ) -> Result<Self> {
        let nodes = discrete.approximation.nodes();
        let reaches = |i: usize, disk: &(Vector2, f64)| {
            (nodes.positions[i] - disk.0).norm() < disk.1 + nodes.support_radii[i].norm()
        };
        Self::of_nodes(model, discrete, solution, singular, |i| disks.iter().any(|d| reaches(i, d)))
    }

    fn of_nodes(
        model: &Model,
        discrete: &'a Discretization,
        solution: &Solution,
        singular: Option<SingularStress>,
        is_used: impl Fn(usize) -> bool + Sync,
    ) -> Result<Self> {
        let wide = &discrete.approximation;
        let nodes = wide.nodes();
        let regular = |at: Vector2, sight: Vector2, Buffer { wide: around, shape, .. }: &mut Buffer| {
            wide.evaluate(at, sight, Derivatives::First, around, shape)?;
            let stress = model.material.stress(&shape.gradient(&solution.parameters));
            Ok(singular.as_ref().map_or(stress, |s| stress - s.at(at, sight)))
        };
        let nodal = (0..nodes.len())
            .into_par_iter()
            .with_min_len(64)
            .map_init(Buffer::default, |buffer, i| {
                if !is_used(i) {
                    return Ok(Matrix2::zeros());
                }
                let (at, radius) = (nodes.positions[i], nodes.support_radii[i].max());
                let is_at = |c: &&TipCoordinates| (c.tip() - at).norm() < AT_TIP * radius;
                match wide.enrichment().and_then(|e| e.coordinates().find(is_at)) {
                    None => regular(at, nodes.sights[i], buffer),
                    Some(tip) => {
                        let mut sum = Matrix2::zeros();
                        for k in 0..RING.0 {
                            let angle = tip.angle() + TAU * (k as f64 + 0.5) / RING.0 as f64;
                            let p = tip.tip() + direction(angle) * (RING.1 * radius);
                            sum += regular(p, p, buffer)?;
                        }
                        Ok(sum / RING.0 as f64)
                    }
                }
            })
            .collect::<Result<_>>()?;
        let mut smaller = nodes.clone();
        smaller.support_radii.iter_mut().for_each(|r| *r *= SUPPORT_SHARE);
        let fine = MovingLeastSquares::new(smaller, wide.obstacles().clone(), *wide.settings());
        Ok(Self { fine, wide, nodal, singular })
    }

    /// Looks up what may matter for points in a box.
    pub fn survey(&self, bounds: &Aabb<2>, buffer: &mut Buffer) {
        self.fine.survey(bounds, &mut buffer.fine);
    }

    /// The recovered stress at a point that was surveyed, seen from `sight` [stress].
    ///
    /// # Errors
    /// Those of the shape functions.
    pub fn at(&self, at: Vector2, sight: Vector2, buffer: &mut Buffer) -> Result<Matrix2> {
        let Buffer { fine, wide, shape } = buffer;
        // Where too few of the smaller supports reach, those of the solution do.
        if self.fine.evaluate_surveyed(at, sight, Derivatives::First, fine, shape).is_err() {
            self.wide.evaluate(at, sight, Derivatives::First, wide, shape)?;
        }
        // The plain shape functions alone are a mean.
        let pairs = shape.neighbors.iter().zip(&shape.values).filter(|(n, _)| (**n as usize) < self.nodal.len());
        let start = self.singular.as_ref().map_or(Matrix2::zeros(), |s| s.at(at, sight));
        Ok(pairs.fold(start, |sum, (&n, &v)| sum + self.nodal[n as usize] * v))
    }
}
