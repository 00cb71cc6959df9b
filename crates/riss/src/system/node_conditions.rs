//! The equations of a node: what the surfaces that meet at it ask for.
//!
//! Where conditions meet, displacements win: each fixes its direction, and what is left free takes the tractions of the
//! surfaces without prescribed displacements, averaged by their angles at the node [C3D, Eqs. 44, 45].

use super::collocation_settings::{CollocationSettings, ConcaveCorners, FrontNodes};
use super::support_ends::ends_at;
use crate::math::{Matrix, Vector};
use crate::model::{SAME_DIRECTION, Solid, SurfaceConditions, SurfacePoint, VectorField};
use crate::nodes::cloud::{Cloud, Facet, Place, SurfaceId};

/// A corner is concave if the material behind one facet rises above another by more than this sine.
const CONCAVE: f64 = 0.05;

/// The equations of one node.
pub struct NodeConditions<const D: usize> {
    /// Projector on the directions with prescribed displacement.
    pub fixed: Matrix<D>,
    /// Prescribed displacement [length].
    pub displacement: Vector<D>,
    /// What holds in the directions that are left: a sum of terms.
    pub terms: Vec<StrongTerm<D>>,
    /// Share of crack faces in the tractions.
    pub face_share: f64,
}

/// A term of the strong form at a node.
pub struct StrongTerm<const D: usize> {
    /// Which equation.
    pub equation: Strong<D>,
    /// Its right-hand side: body force or traction.
    pub load: Vector<D>,
    /// Where its shape functions look from.
    pub sight: Vector<D>,
}

/// An equation of the strong form.
pub enum Strong<const D: usize> {
    /// `-div σ = b` [C3D, Eq. 24].
    Equilibrium,
    /// The value is that of a fit without the node.
    Fit,
    /// `σ n = t` [C3D, Eqs. 25, 27, 28]; the normal may be a mean of normals.
    Traction {
        /// Outward normal.
        normal: Vector<D>,
    },
}

impl<const D: usize> Default for NodeConditions<D> {
    fn default() -> Self {
        Self { fixed: Matrix::zeros(), displacement: Vector::zeros(), terms: vec![], face_share: 0.0 }
    }
}

impl<const D: usize> NodeConditions<D> {
    /// Looks up what holds at a node, in place of what is there.
    ///
    /// - `is_support_end`: whether it takes no part in supports that end there amid a surface
    pub fn look_up(
        &mut self,
        solid: &Solid<D>,
        cloud: &Cloud<D>,
        node: usize,
        settings: &CollocationSettings,
        is_support_end: bool,
    ) {
        (self.fixed, self.displacement) = (Matrix::zeros(), Vector::zeros());
        self.terms.clear();
        self.face_share = 0.0;
        let (position, sight) = (cloud.positions[node], cloud.sights[node]);
        let facets: &[Facet<D>] = match &cloud.places[node] {
            Place::Inside => &[],
            Place::Surface(facets) | Place::Front { facets, .. } => facets,
        };
        let ends = |facet: &&Facet<D>| is_support_end && ends_at(solid, position, facet, facets);
        for facet in facets.iter().filter(|f| !ends(f)) {
            self.prescribe(solid, position, facet);
        }
        if is_support_end {
            self.terms.push(StrongTerm { equation: Strong::Fit, load: Vector::zeros(), sight });
            return;
        }
        if self.fixed.trace() > D as f64 - 0.5 {
            return;
        }
        let is_front = matches!(cloud.places[node], Place::Front { .. });
        if facets.is_empty() || (is_front && settings.front_nodes == FrontNodes::Equilibrium) {
            let load = solid.body_force.value(&SurfacePoint::inside(position));
            self.terms.push(StrongTerm { equation: Strong::Equilibrium, load, sight });
            return;
        }
        let is_fitted = if is_front {
            settings.front_nodes == FrontNodes::Fitted
        } else {
            settings.concave_corners == ConcaveCorners::Averaged && is_fold(position, facets)
        };
        if is_fitted {
            self.terms.push(StrongTerm { equation: Strong::Fit, load: Vector::zeros(), sight });
            return;
        }
        let one_sided =
            is_front || (settings.concave_corners == ConcaveCorners::Averaged && is_concave(position, facets));
        self.add_tractions(solid, position, sight, facets, one_sided);
    }

    /// Fixes the directions of a facet that are not fixed yet.
    fn prescribe(&mut self, solid: &Solid<D>, position: Vector<D>, facet: &Facet<D>) {
        let Some(conditions) = part(solid, facet) else { return };
        let at = SurfacePoint { position, normal: facet.normal, sight: facet.sight };
        for prescribed in &conditions.displacements {
            let direction = prescribed.unit(facet.normal);
            let rest = direction - self.fixed * direction;
            let length = rest.norm();
            if length > SAME_DIRECTION {
                let unit = rest / length;
                // The component along what is new, from that along the direction and that along what is known.
                let value = prescribed.value.value(&at).dot(&direction);
                let known = self.displacement.dot(&direction);
                self.displacement += unit * ((value - known) / length);
                self.fixed += unit * unit.transpose();
            }
        }
    }

    fn add_tractions(
        &mut self,
        solid: &Solid<D>,
        position: Vector<D>,
        sight: Vector<D>,
        facets: &[Facet<D>],
        one_sided: bool,
    ) {
        let is_natural = |f: &&Facet<D>| part(solid, f).is_none_or(|c| c.displacements.is_empty());
        let has_natural = facets.iter().any(|f| is_natural(&f));
        let acting = || facets.iter().filter(|f| !has_natural || is_natural(f));
        let total: f64 = acting().map(|f| f.angle).sum();
        let mut mean =
            StrongTerm { equation: Strong::Traction { normal: Vector::zeros() }, load: Vector::zeros(), sight };
        for facet in acting() {
            let share = facet.angle / total;
            let load =
                traction(solid, facet).value(&SurfacePoint { position, normal: facet.normal, sight: facet.sight })
                    * share;
            let own = facet.normal * share;
            if matches!(facet.surface, SurfaceId::Face { .. }) {
                self.face_share += share;
            }
            if one_sided {
                let equation = Strong::Traction { normal: own };
                self.terms.push(StrongTerm { equation, load, sight: facet.sight });
            } else if let Strong::Traction { normal } = &mut mean.equation {
                *normal += own;
                mean.load += load;
            }
        }
        if !one_sided {
            self.terms.push(mean);
        }
    }
}

/// Conditions of a facet on the boundary.
pub(super) fn part<'a, const D: usize>(solid: &'a Solid<D>, facet: &Facet<D>) -> Option<&'a SurfaceConditions<D>> {
    match facet.surface {
        SurfaceId::Part(i) => Some(&solid.parts[i as usize]),
        SurfaceId::Face { .. } => None,
    }
}

/// Traction on a facet.
fn traction<'a, const D: usize>(solid: &'a Solid<D>, facet: &Facet<D>) -> &'a VectorField<D> {
    match facet.surface {
        SurfaceId::Part(i) => &solid.parts[i as usize].traction,
        SurfaceId::Face { crack, .. } => &solid.faces[crack as usize],
    }
}

/// Whether a node stands on a fold of a crack, on the side where the material turns by more than half a circle.
///
/// Equations away from the fold hold for fields that are more singular than that of the corner too; what shuts them out at
/// fronts does so here.
fn is_fold<const D: usize>(position: Vector<D>, facets: &[Facet<D>]) -> bool {
    let is_face = |f: &Facet<D>| matches!(f.surface, SurfaceId::Face { .. });
    facets.len() > 1 && facets.iter().all(is_face) && is_concave(position, facets)
}

/// Whether the material behind one facet rises above another.
fn is_concave<const D: usize>(position: Vector<D>, facets: &[Facet<D>]) -> bool {
    facets.iter().any(|a| {
        facets.iter().any(|b| {
            let inward = b.sight - position;
            inward.dot(&a.normal) > CONCAVE * inward.norm()
        })
    })
}
