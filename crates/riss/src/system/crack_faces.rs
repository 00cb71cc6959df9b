//! What acts on crack faces: given pressures, and what joins both faces, in contact or by cohesion.
//!
//! What joins them is linear between knots along a crack, as Lagrange multipliers would be: each knot carries a
//! pressure in proportion to the mean overlap around it. A pressure in proportion to the overlap at each integration
//! point asks for more than the shape functions on both sides can follow, and oscillates.

use super::block_matrix::LocalMatrix;
use super::discretization::Discretization;
use super::galerkin::{ELEMENTS, LinearSystem, Scratch};
use crate::approximation::moving_least_squares::Derivatives;
use crate::error::Result;
use crate::geometry::predicates::distance_to_segment;
use crate::integration::CrackFaceElement;
use crate::math::{Vector2, turn_left};
use crate::model::Model;
use std::collections::BTreeMap;

/// Adds the pressures on crack faces, per thickness: equal and opposite forces on both.
///
/// # Errors
/// Those of the shape functions.
pub fn add_face_loads(model: &Model, discrete: &Discretization, load: &mut [f64]) -> Result<()> {
    if model.crack_face_loads.is_empty() {
        return Ok(());
    }
    let mut scratch = Scratch::default();
    for element in &discrete.crack_faces {
        visit_faces(discrete, element, &mut scratch, |point, node, jump| {
            let force = point.normal * (model.face_pressure(element.crack, point.position) * point.weight * jump);
            load[2 * node as usize] += force.x;
            load[2 * node as usize + 1] += force.y;
        })?;
    }
    Ok(())
}

/// Calls `visit(point, node, share of the node in the jump from the right to the left face)`.
fn visit_faces(
    discrete: &Discretization,
    element: &CrackFaceElement,
    scratch: &mut Scratch,
    mut visit: impl FnMut(&crate::integration::CrackFacePoint, u32, f64),
) -> Result<()> {
    let Scratch { around, shape, .. } = scratch;
    discrete.approximation.survey(&element.bounds(), around);
    for point in &element.points {
        for (sight, sign) in point.sights.into_iter().zip([1.0, -1.0]) {
            discrete.approximation.evaluate_surveyed(point.position, sight, Derivatives::First, around, shape)?;
            shape.neighbors.iter().zip(&shape.values).for_each(|(&i, &phi)| visit(point, i, sign * phi));
        }
    }
    Ok(())
}

/// Along what the faces part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parting {
    /// The normal to the left of the path.
    Normal,
    /// The direction of the path.
    Sliding,
}

impl Parting {
    fn direction(self, normal: Vector2) -> Vector2 {
        match self {
            Self::Normal => normal,
            Self::Sliding => -turn_left(normal),
        }
    }
}

/// Mean opening around a knot of a crack, as a sum over nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OpeningRow {
    /// Nodes, ascending.
    nodes: Vec<u32>,
    /// `∫ N [φ] n ds` of each node, `N` the hat function of the knot, `n` along what the faces part.
    jumps: Vec<Vector2>,
    /// `∫ N ds` [length].
    pub length: f64,
    /// Pressure per overlap [stress/length].
    pub stiffness: f64,
}

impl OpeningRow {
    /// Mean opening [length].
    pub fn opening(&self, parameters: &[Vector2]) -> f64 {
        let terms = self.nodes.iter().zip(&self.jumps);
        terms.map(|(&i, jump)| jump.dot(&parameters[i as usize])).sum::<f64>() / self.length
    }

    /// Contact pressure of nodal parameters [stress]: negative where the faces are apart.
    pub fn pressure(&self, parameters: &[Vector2]) -> f64 {
        -self.stiffness * self.opening(parameters)
    }

    /// Adds the forces of a traction that pulls the faces together, linear around the knot [stress].
    pub fn pull(&self, traction: f64, load: &mut [f64]) {
        for (&i, jump) in self.nodes.iter().zip(&self.jumps) {
            load[2 * i as usize] -= traction * jump.x;
            load[2 * i as usize + 1] -= traction * jump.y;
        }
    }
}

/// A row for each knot.
///
/// - `penalty`: pressure per overlap over Young's modulus and the length that belongs to a knot
///
/// # Errors
/// Those of the shape functions.
pub fn opening_rows(
    model: &Model,
    discrete: &Discretization,
    parting: Parting,
    penalty: f64,
) -> Result<Vec<OpeningRow>> {
    let n_knots = discrete.crack_faces.last().map_or(0, |e| e.stretch + 2);
    let mut rows = vec![OpeningRow::default(); n_knots];
    let mut jumps: Vec<BTreeMap<u32, Vector2>> = vec![BTreeMap::new(); n_knots];
    let mut scratch = Scratch::default();
    for element in &discrete.crack_faces {
        let shares = |along: f64| [(element.stretch, 1.0 - along), (element.stretch + 1, along)];
        visit_faces(discrete, element, &mut scratch, |point, node, jump| {
            for (knot, share) in shares(point.along) {
                let direction = parting.direction(point.normal);
                *jumps[knot].entry(node).or_default() += direction * (jump * share * point.weight);
            }
        })?;
        for point in &element.points {
            shares(point.along).into_iter().for_each(|(knot, share)| rows[knot].length += share * point.weight);
        }
    }
    for (row, jumps) in rows.iter_mut().zip(jumps) {
        row.stiffness = penalty * model.material.young / row.length;
        (row.nodes, row.jumps) = jumps.into_iter().unzip();
    }
    Ok(rows)
}

/// The system with faces that are joined by the pressure of rows.
///
/// # Errors
/// None: the sums of rows cannot fail.
pub fn joined<'a>(system: &LinearSystem, active: impl Iterator<Item = &'a OpeningRow>) -> Result<LinearSystem> {
    let active: Vec<&OpeningRow> = active.collect();
    let matrix = system.matrix.widened(active.iter().map(|r| r.nodes.as_slice()));
    let mut result = LinearSystem { matrix, load: system.load.clone() };
    result.add(active.len(), ELEMENTS, |i, _, local| {
        add_products(local, active[i]);
        Ok(())
    })?;
    Ok(result)
}

/// `k/L (jump_a) (jump_b)ᵀ` for every pair of nodes: the virtual work of the pressure of a row.
fn add_products(local: &mut LocalMatrix, row: &OpeningRow) {
    local.reset(&row.nodes);
    let factor = row.stiffness / row.length;
    for (a, ja) in row.jumps.iter().enumerate() {
        for (b, jb) in row.jumps[..=a].iter().enumerate() {
            let m = ja * jb.transpose() * factor;
            *local.block_mut(a, b) = [m[(0, 0)], m[(0, 1)], m[(1, 0)], m[(1, 1)]];
        }
    }
}

/// What joins the faces at a point of a crack path [stress], linear between knots.
///
/// - `pressures`: at each knot; none if nothing does
pub fn joining_pressure(discrete: &Discretization, pressures: &[f64], crack: usize, position: Vector2) -> f64 {
    if pressures.is_empty() {
        return 0.0;
    }
    let elements = discrete.crack_faces.iter().filter(|e| e.crack == crack);
    let distance = |e: &&CrackFaceElement| distance_to_segment(position, e.ends[0], e.ends[1]);
    let Some(element) = elements.min_by(|a, b| distance(a).total_cmp(&distance(b))) else { return 0.0 };
    let e = element.ends[1] - element.ends[0];
    let t = ((position - element.ends[0]).dot(&e) / e.norm_squared()).clamp(0.0, 1.0);
    let along = element.range[0] + (element.range[1] - element.range[0]) * t;
    pressures[element.stretch] * (1.0 - along) + pressures[element.stretch + 1] * along
}
