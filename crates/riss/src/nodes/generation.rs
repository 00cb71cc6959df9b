//! From a model and the settings to points and triangles.

use super::budget;
use super::chains::{Chains, CrackNodes};
use super::crack_clearance::CrackClearance;
use super::fill::fill;
use super::settings::{Layout, NodeSettings, Star};
use super::spacing::SpacingField;
use super::triangulation::{Triangulation, inner_triangles};
use crate::crack::{CrackForm, CrackParticles};
use crate::error::Result;
use crate::math::{Vector2, direction};
use crate::model::Model;
use std::f64::consts::{PI, TAU};

/// No more nodes than this are generated; a finer spacing is refused with a clear error.
pub const MAX_NODES: usize = 2_000_000;
/// Rounds of smoothing of the irregular nodes.
const SMOOTHING_ROUNDS: usize = 4;
/// A grid node nearer to the boundary than this, over the spacing, gives way to the boundary's own nodes; to particles of
/// cracks, too.
pub(super) const BOUNDARY_CLEARANCE: f64 = 0.4;

/// Points of a layout and the triangles between them.
#[derive(Clone, Debug)]
pub struct Layered {
    /// Points, boundary and cracks.
    pub chains: Chains,
    /// Triangles with copies at crack faces.
    pub triangulation: Triangulation,
    /// Steps of the grid, if the nodes are regular.
    pub grid_step: Option<Vector2>,
    /// Particles of each crack; none where cracks are paths.
    pub particles: Vec<CrackParticles>,
}

/// Places irregular nodes at a given spacing.
///
/// # Errors
/// [`Error::NodeGeneration`](crate::error::Error::NodeGeneration).
pub fn generate_at(model: &Model, spacing: &SpacingField, star: Option<&Star>, form: CrackForm) -> Result<Layered> {
    budget::check(&model.domain, spacing)?;
    let mut chains = Chains::default();
    chains.add_boundary(model, &|p, _| spacing.at(p));
    let stars = add_stars(&mut chains, model, star);
    let known = chains.positions.len();
    chains.add_cracks(model, spacing, CrackNodes::AtSpacing, known);
    fill_irregular(&mut chains, model, spacing, &stars)?;
    layered(model, chains, None, form)
}

/// Places the nodes of a model.
///
/// # Errors
/// [`Error::NodeGeneration`](crate::error::Error::NodeGeneration).
pub fn generate(model: &Model, settings: &NodeSettings, form: CrackForm) -> Result<Layered> {
    // Irregular nodes are put along cracks anyway.
    let on_cracks = match form {
        CrackForm::Path => CrackNodes::WhereTheyStand,
        CrackForm::Particles => CrackNodes::AtSpacing,
    };
    let clearance = CrackClearance::new(model, form);
    let mut chains = Chains::default();
    let mut grid_step = None;
    match &settings.layout {
        Layout::Graded(graded) => {
            if let Some(largest) = graded.spacing {
                budget::check_everywhere(&model.domain, largest)?;
            }
            return generate_at(model, &SpacingField::of_model(model, graded), settings.star.as_ref(), form);
        }
        Layout::Structured(grid) => {
            let bounds = model.domain.aabb();
            let step = bounds.size().component_div(&Vector2::new((grid.nx - 1) as f64, (grid.ny - 1) as f64));
            grid_step = Some(step);
            chains.add_boundary(model, &|_, t| step.x * step.y / (t.x * step.y).hypot(t.y * step.x));
            let stars = add_stars(&mut chains, model, settings.star.as_ref());
            let positions = (0..grid.ny).flat_map(|j| {
                let y = bounds.lower.y + step.y * j as f64;
                (0..grid.nx).map(move |i| Vector2::new(bounds.lower.x + step.x * i as f64, y))
            });
            let spacing = SpacingField::uniform(step.min());
            add_free(&mut chains, model, &stars, positions, &spacing, &clearance);
            let known = chains.positions.len();
            chains.add_cracks(model, &spacing, on_cracks, known);
        }
        Layout::Listed(listed) => {
            let positions: Vec<Vector2> = listed.positions.iter().map(|p| Vector2::new(p[0], p[1])).collect();
            let mean = (model.domain.area() / positions.len().max(1) as f64).sqrt();
            let spacing = SpacingField::of_nodes(&positions, mean);
            chains.add_boundary(model, &|p, _| spacing.at(p));
            let stars = add_stars(&mut chains, model, settings.star.as_ref());
            add_free(&mut chains, model, &stars, positions.into_iter(), &spacing, &clearance);
            let known = chains.positions.len();
            chains.add_cracks(model, &spacing, on_cracks, known);
        }
    }
    layered(model, chains, grid_step, form)
}

fn layered(model: &Model, chains: Chains, grid_step: Option<Vector2>, form: CrackForm) -> Result<Layered> {
    let triangulation = Triangulation::new(&chains)?;
    let particles = match form {
        CrackForm::Path => vec![],
        CrackForm::Particles => (model.cracks.iter().enumerate())
            .map(|(index, crack)| CrackParticles::new(crack, &chains.positions_along(index)))
            .collect(),
    };
    Ok(Layered { chains, triangulation, grid_step, particles })
}

/// A disk in which only the star's own nodes stand.
type Disk = (Vector2, f64);

/// Tip nodes and rings around them [EFG, section 2.2; Terry1994]; the first node of a ring stands on the crack.
fn add_stars(chains: &mut Chains, model: &Model, star: Option<&Star>) -> Vec<Disk> {
    let Some(star) = star else { return vec![] };
    let mut disks = vec![];
    for (tip, frame) in model.tips() {
        let length = model.cracks[tip.crack].handbook_length();
        let mut inner = 0.0;
        chains.push(frame.position, true, star.radii[0] * length);
        for &radius in &star.radii {
            let radius = radius * length;
            let spacing = (radius - inner).min(TAU * radius / star.nodes_per_ring as f64);
            for k in 0..star.nodes_per_ring {
                let angle = frame.angle + PI + TAU * k as f64 / star.nodes_per_ring as f64;
                let p = frame.position + direction(angle) * radius;
                let room = model.domain.distance_to_boundary(p) > BOUNDARY_CLEARANCE * spacing;
                let free = chains.positions.iter().all(|q| (q - p).norm() > BOUNDARY_CLEARANCE * spacing);
                if room && free && model.domain.contains(p) {
                    chains.push(p, true, spacing);
                }
            }
            inner = radius;
        }
        disks.push((frame.position, inner * (1.0 + 1e-9)));
    }
    disks
}

/// Adds given nodes that lie inside, clear of the boundary, of the stars and of what else asks for room.
fn add_free(
    chains: &mut Chains,
    model: &Model,
    stars: &[Disk],
    positions: impl Iterator<Item = Vector2>,
    spacing: &SpacingField,
    clearance: &CrackClearance,
) {
    for p in positions {
        let h = spacing.at(p);
        let in_star = stars.iter().any(|(center, radius)| (p - center).norm() <= *radius);
        let is_clear = !in_star && clearance.admits(p, h);
        if is_clear && model.domain.distance_to_boundary(p) > BOUNDARY_CLEARANCE * h && model.domain.contains(p) {
            chains.push(p, true, h);
        }
    }
}

/// Fills the body with irregular nodes and smooths them.
fn fill_irregular(chains: &mut Chains, model: &Model, spacing: &SpacingField, stars: &[Disk]) -> Result<()> {
    let given: Vec<(Vector2, f64)> = chains.positions.iter().copied().zip(chains.spacing.iter().copied()).collect();
    let inside = |p: Vector2| model.domain.contains(p);
    let new = fill(&given, spacing, MAX_NODES, &inside);
    if given.len() + new.len() >= MAX_NODES {
        return Err(budget::too_many(None));
    }
    for (p, h) in new {
        if stars.iter().all(|(center, radius)| (p - center).norm() > *radius + 0.5 * h) {
            chains.push(p, true, h);
        }
    }
    for _ in 0..SMOOTHING_ROUNDS {
        smooth(chains, given.len())?;
    }
    Ok(())
}

/// Moves each free point to the mean of the triangles around it, each weighted by its number of nodes' worth of area.
fn smooth(chains: &mut Chains, n_fixed: usize) -> Result<()> {
    let triangles = inner_triangles(chains)?;
    let mut sums = vec![(Vector2::zeros(), 0.0); chains.positions.len()];
    for t in &triangles {
        let points = t.map(|p| p as usize);
        let [a, b, c] = points.map(|p| chains.positions[p]);
        let h = points.iter().map(|&p| chains.spacing[p]).sum::<f64>() / 3.0;
        let weight = crate::math::cross(b - a, c - a) / (h * h);
        for p in points {
            sums[p].0 += (a + b + c) * (weight / 3.0);
            sums[p].1 += weight;
        }
    }
    for (i, (sum, weight)) in sums.into_iter().enumerate().skip(n_fixed) {
        if weight > 0.0 {
            chains.positions[i] = sum / weight;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::geometry::predicates::distance_to_segment;

    fn check_particles(path: &str) {
        let text = format!(
            "rigid_motion = 'mean-is-zero'
            material = {{ young = 1, poisson = 0.3, plane = 'strain' }}
            geometry.rectangle = {{ lower = [0, 0], upper = [2, 2] }}
            crack = [{{ path = {path} }}]
            remote_stress.yy = 1
            nodes.layout.structured = {{ nx = 21, ny = 21 }}"
        );
        let case = Case::parse(&text, "case.toml".as_ref(), &[]).unwrap();
        let crack = &case.model.cracks[0];
        let found = generate(&case.model, &case.settings.nodes, CrackForm::Particles).unwrap();
        let [particles] = &found.particles[..] else { panic!("one crack") };
        assert_eq!(&particles.union(), crack, "{path}");
        let places: Vec<Vector2> = particles.particles.iter().map(|p| p.position).collect();
        for w in places.windows(2) {
            let h = (w[1] - w[0]).norm();
            assert!(h > 0.039 && h < 0.141, "{path}: {h}");
        }
        for (p, is_node) in found.chains.positions.iter().zip(&found.chains.is_node) {
            let off = crack.segments().map(|(a, b)| distance_to_segment(*p, a, b)).fold(f64::INFINITY, f64::min);
            let is_particle = places.contains(p);
            assert!(*is_node, "{path}: {p}");
            assert!(is_particle == (off < 1e-12), "{path}: {p} {off}");
            // Boundary nodes stay.
            let on_rim = case.model.domain.distance_to_boundary(*p) < 1e-12;
            assert!(is_particle || on_rim || off > 0.039, "{path}: {p} {off}");
        }
    }

    #[test]
    fn a_grid_gets_particles_along_cracks() {
        // On grid nodes with the tip on one and between two; askew; bent.
        check_particles("[[0, 1], [1, 1]]");
        check_particles("[[0, 1], [1.03, 1]]");
        check_particles("[[0, 0.73], [1.37, 1.11]]");
        check_particles("[[0.31, 0.4], [0.92, 1.33], [1.6, 1.3]]");
    }
}
