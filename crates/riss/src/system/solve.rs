//! From the assembled system to nodal parameters.

use super::block_matrix::BlockMatrix;
use super::constraints::{ConstraintRow, Supports, multiplier_rows, point_rows};
use super::discretization::Discretization;
use super::galerkin::LinearSystem;
use super::linear_solver::{Factor, MIXED_FROM, solve_with_multipliers};
use super::ordering::nested_dissection;
use super::rigid_motion::{BalancingForce, MeanMotion, check_held};
use super::settings::{ConstraintMethod, LinearSolver};
use crate::error::{Error, Result};
use crate::math::Vector2;
use crate::model::{Model, RigidMotion};

/// Largest relative residual of an accepted solution.
pub const ALLOWED_RESIDUAL: f64 = 1e-8;
/// Loads that are out of balance by more than this fraction are worth a warning.
pub const UNBALANCED: f64 = 1e-6;

/// Nodal parameters and what belongs to them. Not nodal values: moving least squares do not interpolate.
#[derive(Clone, Debug, Default)]
pub struct Solution {
    /// Nodal parameters of the displacement, then those of additional functions [length].
    pub parameters: Vec<Vector2>,
    /// Multipliers of boundary supports, per thickness, row by row.
    pub multipliers: Vec<f64>,
    /// Forces of point supports, per thickness, row by row.
    pub point_forces: Vec<f64>,
    /// Contact pressure at the knots along cracks [stress]; empty without contact.
    pub contact_pressures: Vec<f64>,
    /// Relative residual of the linear system.
    pub residual: f64,
    /// Body force that balances the loads, where only mean rigid motion is removed.
    pub balancing_force: BalancingForce,
    /// Relative imbalance of the loads, where only mean rigid motion is removed.
    pub imbalance: f64,
    /// Unknowns of the system, multipliers included.
    pub n_unknowns: usize,
}

/// Solves the system.
///
/// # Errors
/// [`Error::FreeRigidMotion`], [`Error::Factorization`] or [`Error::Residual`].
pub fn solve(
    model: &Model,
    discrete: &Discretization,
    mut system: LinearSystem,
    method: &ConstraintMethod,
    solver: LinearSolver,
) -> Result<Solution> {
    let loose = check_held(model, discrete, &system.matrix, &system.load)?;
    let stiffness = system.matrix.largest_diagonal();
    for &node in &loose {
        system.matrix.add_diagonal(2 * node, stiffness);
        system.matrix.add_diagonal(2 * node + 1, stiffness);
    }
    let positions = &discrete.approximation.nodes().positions;
    let order = nested_dissection(&discrete.approximation.function_positions(), &system.matrix);
    let mean = match model.rigid_motion {
        RigidMotion::Supported => None,
        RigidMotion::MeanIsZero => Some(MeanMotion::new(discrete)?),
    };
    let mut result = Solution { n_unknowns: system.load.len(), ..Solution::default() };
    if let Some(mean) = &mean {
        (result.balancing_force, result.imbalance) = mean.balance(positions, &mut system.load);
        pin(&mut system.matrix, positions, &loose);
    }
    let points = point_rows(model, discrete)?;
    let rows = match method {
        ConstraintMethod::LagrangeMultipliers => multiplier_rows(model, discrete, &Supports::new(model, method))?,
        ConstraintMethod::ModifiedVariational => vec![],
        ConstraintMethod::Nitsche { .. } | ConstraintMethod::Penalty { .. } => vec![],
    };
    let indefinite = !rows.is_empty() || *method == ConstraintMethod::ModifiedVariational;
    let (u, augmentation) = if indefinite {
        let all: Vec<ConstraintRow> = rows.iter().chain(&points).cloned().collect();
        let (u, multipliers) = solve_with_multipliers(&system.matrix, &order, &all, &system.load)?;
        result.multipliers = multipliers[..rows.len()].to_vec();
        result.point_forces = multipliers[rows.len()..].iter().map(|v| -v).collect();
        (u, 0.0)
    } else {
        solve_definite(&mut system, &order, &points, solver, &mut result)?
    };
    result.n_unknowns += rows.len() + points.len();
    result.residual = residual(&system, &rows, &points, augmentation, &u, &result);
    if !(result.residual <= ALLOWED_RESIDUAL) {
        return Err(Error::Residual { residual: result.residual, allowed: ALLOWED_RESIDUAL });
    }
    result.parameters = u.chunks_exact(2).map(|c| Vector2::new(c[0], c[1])).collect();
    if let Some(mean) = &mean {
        mean.remove_mean(positions, &mut result.parameters);
    }
    Ok(result)
}

/// Holds three dofs so that the matrix is definite; balanced loads put no force on them. None is that of a `loose` node.
fn pin(matrix: &mut BlockMatrix, positions: &[Vector2], loose: &[usize]) {
    let stiffness = matrix.largest_diagonal();
    let is_loose: std::collections::BTreeSet<usize> = loose.iter().copied().collect();
    let nodes = || (0..positions.len()).filter(|i| !is_loose.contains(i));
    let first = nodes().next().expect("the largest piece is not loose");
    let far = nodes()
        .max_by(|&a, &b| (positions[a] - positions[first]).norm().total_cmp(&(positions[b] - positions[first]).norm()))
        .expect("there are nodes");
    let along = positions[far] - positions[first];
    matrix.add_diagonal(2 * first, stiffness);
    matrix.add_diagonal(2 * first + 1, stiffness);
    // The component across the line between the two resists the rotation.
    matrix.add_diagonal(2 * far + usize::from(along.x.abs() > along.y.abs()), stiffness);
}

/// Cholesky, with the supports at points by their Schur complement. Returns the dofs and the factor of the products
/// of constraint rows that were added to the matrix.
fn solve_definite(
    system: &mut LinearSystem,
    order: &[u32],
    points: &[ConstraintRow],
    solver: LinearSolver,
    result: &mut Solution,
) -> Result<(Vec<f64>, f64)> {
    // The matrix alone may be singular; c cᵀ of each row makes it definite and changes no solution.
    let stiffness = system.matrix.largest_diagonal();
    let mut augmented = system.load.clone();
    if !points.is_empty() {
        add_products(&mut system.matrix, points, stiffness);
        for row in points {
            row.entries.iter().for_each(|&(dof, c)| augmented[dof] += stiffness * c * row.value);
        }
    }
    let single = match solver {
        LinearSolver::Automatic => system.load.len() >= MIXED_FROM,
        LinearSolver::Direct => false,
        LinearSolver::MixedPrecision => true,
    };
    let factor = match single.then(|| Factor::single(&system.matrix, order)) {
        Some(Ok(factor)) => factor,
        // Too ill conditioned for single precision.
        Some(Err(_)) | None => Factor::double(&system.matrix, order)?,
    };
    let mut u = factor.solve(&system.matrix, &augmented)?;
    if !points.is_empty() {
        let columns: Vec<Vec<f64>> = points
            .iter()
            .map(|row| {
                let mut c = vec![0.0; u.len()];
                row.entries.iter().for_each(|&(dof, v)| c[dof] = v);
                factor.solve(&system.matrix, &c)
            })
            .collect::<Result<_>>()?;
        let apply = |row: &ConstraintRow, x: &[f64]| row.entries.iter().map(|&(dof, c)| c * x[dof]).sum::<f64>();
        let n = points.len();
        let schur = nalgebra::DMatrix::from_fn(n, n, |i, j| apply(&points[i], &columns[j]));
        let gap = nalgebra::DVector::from_fn(n, |i, _| apply(&points[i], &u) - points[i].value);
        let multipliers = schur
            .lu()
            .solve(&gap)
            .ok_or_else(|| Error::Factorization { reason: "supports at points contradict one another".into() })?;
        for (column, m) in columns.iter().zip(multipliers.iter()) {
            u.iter_mut().zip(column).for_each(|(u, c)| *u -= m * c);
        }
        result.point_forces = multipliers.iter().map(|m| -m).collect();
    }
    Ok((u, stiffness))
}

fn add_products(matrix: &mut BlockMatrix, rows: &[ConstraintRow], factor: f64) {
    for row in rows {
        for &(p, cp) in &row.entries {
            for &(q, cq) in row.entries.iter().filter(|e| e.0 / 2 <= p / 2) {
                let range = matrix.row_starts[p / 2]..matrix.row_starts[p / 2 + 1];
                let column =
                    matrix.columns[range.clone()].binary_search(&((q / 2) as u32)).expect("rows are in the pattern");
                matrix.blocks[range.start + column][2 * (p % 2) + q % 2] += factor * cp * cq;
            }
        }
    }
}

/// Relative residual of equilibrium.
fn residual(
    system: &LinearSystem,
    rows: &[ConstraintRow],
    points: &[ConstraintRow],
    augmentation: f64,
    u: &[f64],
    result: &Solution,
) -> f64 {
    let mut forces = vec![0.0; u.len()];
    system.matrix.multiply(u, &mut forces);
    let mut size = 0.0f64;
    for (row, m) in rows.iter().zip(&result.multipliers) {
        row.entries.iter().for_each(|&(dof, c)| forces[dof] += m * c);
    }
    for (row, f) in points.iter().zip(&result.point_forces) {
        row.entries.iter().for_each(|&(dof, c)| forces[dof] -= (f + augmentation * row.value) * c);
    }
    let mut error = 0.0f64;
    for (f, l) in forces.iter().zip(&system.load) {
        error += (f - l) * (f - l);
        size += f * f + l * l;
    }
    let mut scale = 0.0f64;
    for i in 0..system.matrix.n_nodes() {
        let b = system.matrix.blocks[system.matrix.row_starts[i + 1] - 1];
        scale += (b[0] * u[2 * i]).powi(2) + (b[3] * u[2 * i + 1]).powi(2);
    }
    // Large rigid parts of the solution cancel in the forces: measure against the terms that cancel.
    let size = size.sqrt().max(scale.sqrt() * 1e-3);
    if size == 0.0 { 0.0 } else { error.sqrt() / size }
}
