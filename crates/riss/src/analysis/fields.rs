//! Fields sampled for output: displacement, stress, strain and an error indicator at the corners of triangles.

use super::record::{CrackFaces, Fields};
use crate::approximation::moving_least_squares::Derivatives;
use crate::approximation::{ShapeFunctions, Surroundings};
use crate::crack::meetings::shared_vertices;
use crate::error::Result;
use crate::math::{Matrix2, Vector2, turn_left};
use crate::model::Model;
use crate::nodes::Triangulation;
use crate::nodes::triangulation::SIGHT_SHIFT;
use crate::system::{Discretization, Solution};
use rayon::prelude::*;

/// How far beside a path its sides see from where it meets something, over how far along it.
const NARROW: f64 = 0.05;

/// Samples every copy of the triangulation, so that both faces of cracks have their own values.
///
/// The error indicator compares the stress with its mean over neighboring points, weighted by the shape functions
/// [Chung1998].
///
/// # Errors
/// Those of the shape functions.
pub fn sample_fields(model: &Model, discrete: &Discretization, solution: &Solution) -> Result<Fields> {
    let material = &model.material;
    let triangulation = &discrete.triangulation;
    let samples: Vec<Sample> = (0..triangulation.copies.len())
        .into_par_iter()
        .with_min_len(64)
        .map_init(<(Surroundings, ShapeFunctions<2>)>::default, |(around, shape), i| {
            let (at, sight) = (triangulation.position(i as u32), triangulation.copies[i].sight);
            discrete.approximation.evaluate(at, sight, Derivatives::First, around, shape)?;
            let stress = material.stress(&shape.gradient(&solution.parameters));
            let pairs = shape.neighbors.iter().copied().zip(shape.values.iter().copied()).collect();
            Ok(Sample { displacement: shape.value(&solution.parameters), stress, pairs })
        })
        .collect::<Result<_>>()?;
    let stress: Vec<Matrix2> = samples.iter().map(|s| s.stress).collect();
    // Additional functions add nothing to the mean.
    let mut nodal = vec![Matrix2::zeros(); discrete.n_functions()];
    for (copy, node) in discrete.node_of_copy.iter().enumerate() {
        if let Some(node) = node {
            nodal[*node as usize] = stress[copy];
        }
    }
    let indicator = |Sample { stress, pairs, .. }: &Sample| {
        let smoothed = pairs.iter().fold(Matrix2::zeros(), |s, (n, v)| s + nodal[*n as usize] * *v);
        let difference = smoothed - stress;
        difference.dot(&material.strain(&difference)).max(0.0).sqrt()
    };
    let error_indicator = samples.par_iter().with_min_len(64).map(indicator).collect();
    Ok(Fields {
        positions: (0..samples.len()).map(|i| triangulation.position(i as u32)).collect(),
        triangles: triangulation.triangles.clone(),
        displacement: samples.iter().map(|s| s.displacement).collect(),
        strain: stress.iter().map(|s| material.strain(s)).collect(),
        out_of_plane_strain: stress.iter().map(|s| material.out_of_plane_strain(s)).collect(),
        out_of_plane_stress: stress.iter().map(|s| material.out_of_plane_stress(s)).collect(),
        von_mises: stress.iter().map(|s| material.von_mises(s)).collect(),
        stress,
        error_indicator,
        crack_faces: sample_faces(model, discrete, solution)?,
    })
}

/// The solution at a point.
struct Sample {
    displacement: Vector2,
    stress: Matrix2,
    /// Neighbors and values of their functions, which are needed again.
    pairs: Vec<(u32, f64)>,
}

/// Displacement of both faces at every point of the triangulation on each crack.
fn sample_faces(model: &Model, discrete: &Discretization, solution: &Solution) -> Result<Vec<CrackFaces>> {
    let (mut around, mut shape) = <(Surroundings, ShapeFunctions<2>)>::default();
    let mut result = vec![];
    let shared: Vec<Vector2> = shared_vertices(&model.cracks).into_iter().map(|m| m.place).collect();
    for crack in &model.cracks {
        let mut faces = CrackFaces::default();
        let meets = |p: Vector2| shared.contains(&p) || crack.mouths().any(|m| m == p);
        for (at, [left, right]) in points_along(&discrete.triangulation, &crack.vertices, meets) {
            for (sight, list) in [(left, &mut faces.left), (right, &mut faces.right)] {
                discrete.approximation.evaluate(at, sight, Derivatives::First, &mut around, &mut shape)?;
                list.push(shape.value(&solution.parameters));
            }
            faces.positions.push(at);
        }
        result.push(faces);
    }
    Ok(result)
}

/// Points of the triangulation on a path, in order, with from where their left and right side see.
///
/// - `meets`: whether the path meets the boundary or another crack at a vertex
fn points_along(
    triangulation: &Triangulation,
    path: &[Vector2],
    meets: impl Fn(Vector2) -> bool,
) -> Vec<(Vector2, [Vector2; 2])> {
    let beside = |p: Vector2, left: Vector2| (p, [p + left, p - left]);
    // Close to the path, for what it meets there may be slanted.
    let along = |p: Vector2, step: Vector2, left: Vector2| (p, [p + step + left * NARROW, p + step - left * NARROW]);
    let mut found = vec![];
    for (k, w) in path.windows(2).enumerate() {
        let e = w[1] - w[0];
        let left = turn_left(e.normalize());
        let mut on: Vec<(f64, Vector2)> = vec![];
        for (i, &p) in triangulation.positions.iter().enumerate() {
            let t = (p - w[0]).dot(&e) / e.norm_squared();
            let near = 1e-9 * e.norm();
            let inside = t * e.norm() > near && (1.0 - t) * e.norm() > near;
            if inside && (p - w[0]).dot(&left).abs() < near {
                on.push((t, left * (SIGHT_SHIFT * triangulation.edge_length[i])));
            }
        }
        on.sort_by(|a, b| a.0.total_cmp(&b.0));
        // A kink sees from both sides along its bisector, an end straight off its segment.
        let before = if k == 0 { e } else { w[0] - path[k - 1] };
        let size = SIGHT_SHIFT * e.norm().min(before.norm());
        found.push(match (meets(w[0]), k) {
            (true, 0) => along(w[0], e.normalize() * size, left * size),
            (true, _) => along(w[0], -before.normalize() * size, turn_left(before.normalize()) * size),
            (false, _) => beside(w[0], turn_left(before.normalize() + e.normalize()).normalize() * size),
        });
        found.extend(on.into_iter().map(|(t, left)| beside(w[0] + e * t, left)));
    }
    let last = path[path.len() - 1];
    let e = (last - path[path.len() - 2]) * SIGHT_SHIFT;
    found.push(if meets(last) { along(last, -e, turn_left(e)) } else { beside(last, turn_left(e)) });
    found
}
