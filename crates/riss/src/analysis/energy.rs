//! Energies and reactions of a solution.

use crate::approximation::moving_least_squares::Derivatives;
use crate::approximation::{ShapeFunctions, Surroundings};
use crate::error::Result;
use crate::integration::cells::as_usize;
use crate::math::{Matrix2, Vector2};
use crate::model::Model;
use crate::system::constraints::Supports;
use crate::system::{ConstraintMethod, Discretization, Solution};

/// Energies per thickness.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// Strain energy [stress·length²].
    pub strain_energy: f64,
    /// Energy norm of the error over that of the exact field.
    pub relative_error: Option<f64>,
}

/// Integrates the strain energy of the discrete gradients, and the error if the exact field is known [EFG, Eq. 36].
///
/// - `gradients`: of the displacement at all integration points
pub fn strain_energy(model: &Model, discrete: &Discretization, gradients: &[Matrix2]) -> Energies {
    let material = &model.material;
    let mut sums = [0.0; 3];
    // Cell by cell, so that round-off stays small.
    for range in &discrete.cells.point_ranges {
        let mut of_cell = [0.0; 3];
        let range = as_usize(range);
        for (point, gradient) in discrete.cells.points[range.clone()].iter().zip(&gradients[range]) {
            of_cell[0] += 0.5 * point.weight * material.stress(gradient).dot(gradient);
            if let Some(exact) = &model.exact {
                let exact = exact.gradient(material, point.position);
                let error = gradient - exact;
                of_cell[1] += 0.5 * point.weight * material.stress(&error).dot(&error);
                of_cell[2] += 0.5 * point.weight * material.stress(&exact).dot(&exact);
            }
        }
        sums.iter_mut().zip(of_cell).for_each(|(sum, part)| *sum += part);
    }
    let relative_error = model.exact.as_ref().map(|_| (sums[1] / sums[2]).sqrt());
    Energies { strain_energy: sums[0], relative_error }
}

type Buffer = (Surroundings, ShapeFunctions<2>);

/// Force of each supported or sprung part on the body over the thickness, in the order of the parts; then the points.
///
/// - `load_factor`: on prescribed displacements
///
/// # Errors
/// Those of the shape functions.
pub fn reactions(
    model: &Model,
    discrete: &Discretization,
    solution: &Solution,
    method: &ConstraintMethod,
    load_factor: f64,
) -> Result<Vec<(String, Vector2)>> {
    let on = Supports::new(model, method);
    let (mut around, mut shape) = Buffer::default();
    let mut sums: Vec<Option<Vector2>> = vec![None; model.domain.parts.len()];
    let mut multiplier = MultiplierForces::new(model, discrete, solution, &on);
    for (index, element) in discrete.boundary.iter().enumerate() {
        let here = |part: usize| model.domain.parts[part].edges.contains(&element.edge);
        let supports = on.on(element.edge);
        let sprung = model.springs.iter().any(|s| here(s.part));
        if supports.is_empty() && !sprung {
            continue;
        }
        let (with_traction, stabilization) = on.terms(&model.material, element);
        for point in &element.points {
            discrete.approximation.evaluate(
                point.position,
                point.sight,
                Derivatives::First,
                &mut around,
                &mut shape,
            )?;
            let at = point.field_point();
            let u = shape.value(&solution.parameters);
            let traction = model.material.stress(&shape.gradient(&solution.parameters)) * point.normal;
            for (k, support) in supports.iter().enumerate() {
                let direction = support.direction.vector(&at);
                let value = support.value.value(&model.material, support.direction, &at);
                let gap = u.dot(&direction) - load_factor * value;
                let mut force = -stabilization * gap;
                if with_traction {
                    force += traction.dot(&direction);
                }
                if *method == ConstraintMethod::LagrangeMultipliers {
                    force = multiplier.at(index, k, point.along);
                }
                *sums[support.part].get_or_insert_default() += direction * (force * point.weight);
            }
            for spring in model.springs.iter().filter(|s| here(s.part)) {
                let direction = spring.direction.vector(&at);
                let force = -spring.stiffness.value(&at) * u.dot(&direction);
                *sums[spring.part].get_or_insert_default() += direction * (force * point.weight);
            }
        }
    }
    for (part, force) in &solution.support_forces {
        *sums[*part].get_or_insert_default() += *force;
    }
    let parts = model.domain.parts.iter().zip(sums).filter_map(|(p, s)| Some((p.name.clone(), s? * model.thickness)));
    let mut result: Vec<(String, Vector2)> = parts.collect();
    let mut forces = solution.point_forces.iter();
    for (i, support) in model.point_supports.iter().enumerate() {
        let force = [0, 1].map(|d| support.displacement[d].map_or(0.0, |_| *forces.next().expect("one for each row")));
        result.push((format!("point-support-{}", i + 1), Vector2::from(force) * model.thickness));
    }
    Ok(result)
}

/// Multipliers as tractions along the boundary.
struct MultiplierForces<'a> {
    /// Row of each (edge, support on it, end).
    rows: std::collections::BTreeMap<(usize, usize, u32), f64>,
    discrete: &'a Discretization,
}

impl<'a> MultiplierForces<'a> {
    fn new(_model: &Model, discrete: &'a Discretization, solution: &Solution, on: &Supports) -> Self {
        let mut rows = std::collections::BTreeMap::new();
        for element in &discrete.boundary {
            for k in 0..on.on(element.edge).len() {
                for end in element.ends {
                    rows.insert((element.edge, k, end), 0.0);
                }
            }
        }
        // The rows of the system come in this very order; a multiplier is minus the traction on the body.
        for (row, m) in rows.values_mut().zip(&solution.multipliers) {
            *row = -m;
        }
        Self { rows, discrete }
    }

    fn at(&mut self, element: usize, support: usize, along: f64) -> f64 {
        let element = &self.discrete.boundary[element];
        let end = |k: usize| self.rows[&(element.edge, support, element.ends[k])];
        end(0) * (1.0 - along) + end(1) * along
    }
}
