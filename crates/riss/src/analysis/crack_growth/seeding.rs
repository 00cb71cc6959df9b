//! New cracks where the boundary is stretched most [EFG, section 6.5].

use super::settings::{Seeding, SeedingTime};
use crate::analysis::Settings;
use crate::analysis::linear_static::{discretize, solve_once};
use crate::analysis::record::Observer;
use crate::analysis::warnings::Warnings;
use crate::approximation::moving_least_squares::Derivatives;
use crate::approximation::{ShapeFunctions, Surroundings};
use crate::crack::{CrackPath, EndKind};
use crate::error::Result;
use crate::geometry::predicates::distance_to_segment;
use crate::math::Vector2;
use crate::model::{EdgeId, Model};
use crate::nodes::triangulation::SIGHT_SHIFT;
use crate::system::{Discretization, Solution};
use rayon::prelude::*;

/// Default distance between new cracks, over their length.
const SEPARATION: f64 = 4.0;
/// A new crack keeps this distance from cracks that are there, over its length.
const CLEARANCE: f64 = 1.0;

/// A place on the boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    position: Vector2,
    inward: Vector2,
    edge: EdgeId,
    /// Tangential stress [stress].
    stress: f64,
}

/// Solves the model as it is and starts cracks on it; returns how many.
///
/// - `loops`: loops of the domain on which cracks may start; all if not given
///
/// # Errors
/// Those of a static analysis.
pub(super) fn seed(
    model: &mut Model,
    settings: &Settings,
    seeding: &Seeding,
    loops: Option<&[usize]>,
    observer: &mut dyn Observer,
) -> Result<usize> {
    let mut warnings = Warnings::new(observer);
    let discrete = discretize(model, settings, warnings.observer)?;
    let (solution, _) = solve_once(model, settings, &discrete, &mut warnings)?;
    let mut places = stressed_places(model, &discrete, &solution, seeding, loops)?;
    places.sort_by(|a, b| b.stress.total_cmp(&a.stress));
    let limit = seeding.stress.unwrap_or(0.0);
    let separation = seeding.separation.unwrap_or(SEPARATION * seeding.length);
    let mut chosen: Vec<Place> = vec![];
    for place in places {
        let is_full = loops.is_none() && seeding.number.is_some_and(|n| chosen.len() >= n);
        if is_full || !(place.stress > limit) {
            break;
        }
        let apart = |c: &Place| (c.position - place.position).norm() >= separation;
        if chosen.iter().all(apart) && has_room(model, &place, seeding.length) {
            chosen.push(place);
        }
    }
    let known = model.cracks.iter().filter(|c| c.name.starts_with("seed-")).count();
    for (k, place) in chosen.iter().enumerate() {
        model.cracks.push(CrackPath {
            name: format!("seed-{}", known + k + 1),
            vertices: vec![place.position, place.position + place.inward * seeding.length],
            ends: [EndKind::Mouth, EndKind::Tip],
        });
    }
    Ok(chosen.len())
}

/// Whether a new crack stays inside the body and clear of other cracks.
fn has_room(model: &Model, place: &Place, length: f64) -> bool {
    let tip = place.position + place.inward * length;
    let reach = CLEARANCE * length;
    let clear =
        model.cracks.iter().flat_map(|c| c.segments()).all(|(a, b)| {
            distance_to_segment(tip, a, b) >= reach && distance_to_segment(place.position, a, b) >= reach
        });
    clear && model.domain.contains(tip) && model.domain.distance_to_boundary(tip) > 0.5 * length
}

/// Local maxima of the tangential stress along every edge where cracks may start.
fn stressed_places(
    model: &Model,
    discrete: &Discretization,
    solution: &Solution,
    seeding: &Seeding,
    loops: Option<&[usize]>,
) -> Result<Vec<Place>> {
    let domain = &model.domain;
    let is_allowed = |edge: EdgeId| {
        let on_part = seeding.on.is_empty()
            || domain.parts.iter().any(|p| seeding.on.contains(&p.name) && p.edges.contains(&edge));
        let on_loop = loops.is_none_or(|l| l.iter().any(|k| domain.loops[*k].contains(&edge)));
        on_part && on_loop
    };
    let field = BoundaryStress { model, discrete, solution };
    let mut result = vec![];
    for range in &domain.loops {
        let pieces: Vec<_> = discrete.triangulation.boundary.iter().filter(|s| range.contains(&s.edge)).collect();
        // At the middle of each piece: corners and mouths have no tangent.
        let middle = |k: usize| 0.5 * (pieces[k].range[0] + pieces[k].range[1]);
        let places: Vec<Option<Place>> = (0..pieces.len())
            .into_par_iter()
            .map_init(Buffer::default, |buffer, k| match is_allowed(pieces[k].edge) {
                true => field.at(pieces[k].edge, middle(k), buffer).map(Some),
                false => Ok(None),
            })
            .collect::<Result<_>>()?;
        let n = places.len();
        let mut buffer = Buffer::default();
        for (k, place) in places.iter().enumerate() {
            let (before, after) = ((k + n - 1) % n, (k + 1) % n);
            // Beyond the ends of what is allowed nothing is greater.
            let is_less = |j: usize| places[j].is_none_or(|p| place.is_some_and(|q| p.stress <= q.stress));
            if let Some(place) = place
                && is_less(before)
                && is_less(after)
            {
                // Between corners the maximum lies at the vertex of a parabola through three pieces.
                let neighbor = |j: usize, turn: f64| {
                    let near = places[j].filter(|p| p.edge == place.edge)?;
                    let offset = middle(j) - middle(k);
                    // The ends of a circle are one point.
                    let offset = if offset * turn < 0.0 { offset + turn } else { offset };
                    Some((offset, near.stress - place.stress))
                };
                let offset = match (neighbor(before, -1.0), neighbor(after, 1.0)) {
                    (Some(a), Some(b)) => vertex(a, b),
                    (Some(_), None) | (None, Some(_)) | (None, None) => 0.0,
                };
                result.push(field.at(place.edge, middle(k) + offset, &mut buffer)?);
            }
        }
    }
    Ok(result)
}

/// Where a parabola through the origin and two points `(x, y)` on either side of it, `y <= 0`, is greatest.
fn vertex(a: (f64, f64), b: (f64, f64)) -> f64 {
    let curvature = (b.1 / b.0 - a.1 / a.0) / (b.0 - a.0);
    let slope = b.1 / b.0 - curvature * b.0;
    if curvature < 0.0 { (-0.5 * slope / curvature).clamp(0.5 * a.0, 0.5 * b.0) } else { 0.0 }
}

type Buffer = (Surroundings, ShapeFunctions<2>);

/// The tangential stress along the boundary.
struct BoundaryStress<'a> {
    model: &'a Model,
    discrete: &'a Discretization,
    solution: &'a Solution,
}

impl BoundaryStress<'_> {
    /// At a parameter of an edge.
    fn at(&self, edge: EdgeId, t: f64, (around, shape): &mut Buffer) -> Result<Place> {
        let curve = &self.model.domain.edges[edge];
        let (tangent, inward) = (curve.tangent(t), -curve.right_normal(t));
        let position = self.model.domain.on_edge(edge, curve.point(t));
        let sight = position + inward * (SIGHT_SHIFT * self.model.domain.area().sqrt());
        self.discrete.approximation.evaluate(position, sight, Derivatives::First, around, shape)?;
        let stress = self.model.material.stress(&shape.gradient(&self.solution.parameters));
        Ok(Place { position, inward, edge, stress: tangent.dot(&(stress * tangent)) })
    }
}

/// Whether cracks start again in a step after some have reached holes.
pub(super) fn starts_again(seeding: Option<&Seeding>) -> Option<&Seeding> {
    seeding.filter(|s| match s.when {
        SeedingTime::Once => false,
        SeedingTime::AtReachedHoles => true,
    })
}

#[cfg(test)]
mod tests {
    use super::vertex;

    #[test]
    fn parabolas_have_their_vertex_found() {
        // y = -(x - 0.3)² + 0.09.
        let y = |x: f64| 0.09 - (x - 0.3f64).powi(2);
        assert!((vertex((-1.0, y(-1.0)), (0.8, y(0.8))) - 0.3).abs() < 1e-14);
        assert_eq!(vertex((-1.0, 0.0), (1.0, 0.0)), 0.0);
        assert_eq!(vertex((-1.0, 0.0), (1.0, -1.0)), -0.5);
    }
}
