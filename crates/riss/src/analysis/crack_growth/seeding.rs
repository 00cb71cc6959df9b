//! New cracks where the boundary is stretched most [EFG, section 6.5].

use super::settings::{Seeding, SeedingTime};
use crate::analysis::Settings;
use crate::analysis::linear_static::{discretize, solve_once};
use crate::analysis::record::{Observer, Warnings};
use crate::approximation::moving_least_squares::Derivatives;
use crate::approximation::{ShapeFunctions, Surroundings};
use crate::crack::{CrackPath, EndKind};
use crate::error::Result;
use crate::geometry::predicates::distance_to_segment;
use crate::math::Vector2;
use crate::model::{EdgeId, Model};
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
    let mut result = vec![];
    for range in &domain.loops {
        let pieces: Vec<_> = discrete.triangulation.boundary.iter().filter(|s| range.contains(&s.edge)).collect();
        // At the middle of each piece: corners and mouths have no tangent.
        let places: Vec<Option<Place>> = pieces
            .par_iter()
            .map_init(<(Surroundings, ShapeFunctions<2>)>::default, |(around, shape), piece| {
                if !is_allowed(piece.edge) {
                    return Ok(None);
                }
                let curve = &domain.edges[piece.edge];
                let t = 0.5 * (piece.range[0] + piece.range[1]);
                let (position, tangent, inward) = (curve.point(t), curve.tangent(t), -curve.right_normal(t));
                let step = 1e-6 * curve.length() * (piece.range[1] - piece.range[0]);
                let sight = position + inward * step;
                discrete.approximation.evaluate(position, sight, Derivatives::First, around, shape)?;
                let stress = model.material.stress(&shape.gradient(&solution.parameters));
                Ok(Some(Place { position, inward, edge: piece.edge, stress: tangent.dot(&(stress * tangent)) }))
            })
            .collect::<Result<_>>()?;
        let n = places.len();
        let at = |k: usize| places[k % n].map_or(f64::NEG_INFINITY, |p| p.stress);
        for (k, place) in places.iter().enumerate() {
            // Where all are allowed the loop is closed; elsewhere its ends are no maxima of their own.
            if let Some(place) = place
                && place.stress >= at(k + 1)
                && place.stress >= at(k + n - 1)
            {
                result.push(Place { position: domain.on_edge(place.edge, place.position), ..*place });
            }
        }
    }
    Ok(result)
}

/// Whether cracks start again in a step after some have reached holes.
pub(super) fn starts_again(seeding: Option<&Seeding>) -> Option<&Seeding> {
    seeding.filter(|s| match s.when {
        SeedingTime::Once => false,
        SeedingTime::AtReachedHoles => true,
    })
}
