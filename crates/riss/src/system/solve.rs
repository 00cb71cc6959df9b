//! From the assembled system to nodal parameters.

use super::block_matrix::BlockMatrix;
use super::constraints::{ConstraintRow, Supports, multiplier_rows, point_rows};
use super::discretization::Discretization;
use super::galerkin::LinearSystem;
use super::held_nodes::HeldNodes;
use super::multifrontal::EliminationTree;
use super::node_solver::{NodeSolver, Part};
use super::rigid_motion::{BalancingForce, MeanMotion, check_held};
use super::settings::{ConstraintMethod, LinearSolver};
use super::tip_factors::Border;
use crate::error::{Error, Result};
use crate::math::Vector2;
use crate::model::{Model, PartId, RigidMotion};
use std::sync::Arc;

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
    /// Forces of held nodes on the body, per thickness, with the part that each belongs to; with finite elements along the
    /// supports.
    pub support_forces: Vec<(PartId, Vector2)>,
    /// K_I and K_II of each tip, where they are unknowns themselves [stress·√length]; in the order of [`Model::tips`].
    pub tip_factors: Vec<[f64; 2]>,
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
    system: LinearSystem,
    method: &ConstraintMethod,
    solver: LinearSolver,
) -> Result<Solution> {
    PreparedSystem::new(model, discrete, system, method, solver)?.into_solution()
}

/// A factored system, for its own load or several others.
pub struct PreparedSystem<'a> {
    discrete: &'a Discretization,
    system: LinearSystem,
    /// Of supports by multipliers, then of points.
    rows: Vec<ConstraintRow>,
    n_supports: usize,
    nodes: NodeSolver,
    held: Option<HeldNodes>,
    border: Option<Border>,
    mean: Option<MeanMotion>,
    /// What the load is balanced by.
    balance: (BalancingForce, f64),
}

impl<'a> PreparedSystem<'a> {
    /// Factors a system.
    ///
    /// # Errors
    /// [`Error::FreeRigidMotion`] or [`Error::Factorization`].
    pub fn new(
        model: &Model,
        discrete: &'a Discretization,
        mut system: LinearSystem,
        method: &ConstraintMethod,
        solver: LinearSolver,
    ) -> Result<Self> {
        let on = Supports::new(model, method);
        let held = match method {
            ConstraintMethod::FiniteElementCoupled => Some(HeldNodes::hold(model, discrete, &on, &mut system)),
            ConstraintMethod::LagrangeMultipliers | ConstraintMethod::ModifiedVariational => None,
            ConstraintMethod::Nitsche { .. } | ConstraintMethod::Penalty { .. } => None,
        };
        let mut border = Border::take(&model.material, discrete, &mut system);
        let loose = check_held(model, discrete, &system.matrix, &system.load)?;
        let stiffness = system.matrix.largest_diagonal();
        for &node in &loose {
            system.matrix.add_diagonal(2 * node, stiffness);
            system.matrix.add_diagonal(2 * node + 1, stiffness);
        }
        let positions = &discrete.approximation.nodes().positions;
        let places = discrete.approximation.function_positions();
        let tree = Arc::new(EliminationTree::new(&places[..system.matrix.n_nodes()], &system.matrix));
        let mean = match model.rigid_motion {
            RigidMotion::Supported => None,
            RigidMotion::MeanIsZero => Some(MeanMotion::new(discrete)?),
        };
        let mut balance = Default::default();
        if let Some(mean) = &mean {
            let mut balanced = |load: &mut Vec<f64>| balance = mean.balance(positions, load);
            match &mut border {
                Some(border) => border.with_whole_load(&mut system.load, balanced),
                None => balanced(&mut system.load),
            }
            pin(&mut system.matrix, positions, &loose);
        }
        let mut rows = match method {
            ConstraintMethod::LagrangeMultipliers => multiplier_rows(model, discrete, &on)?,
            ConstraintMethod::ModifiedVariational | ConstraintMethod::FiniteElementCoupled => vec![],
            ConstraintMethod::Nitsche { .. } | ConstraintMethod::Penalty { .. } => vec![],
        };
        let n_supports = rows.len();
        rows.extend(point_rows(model, discrete)?);
        if let Some(held) = &held {
            held.turn_rows(&mut rows, discrete.n_nodes());
        }
        if let Some(border) = &mut border {
            border.take_from_rows(&mut rows);
        }
        let is_indefinite = n_supports > 0 || *method == ConstraintMethod::ModifiedVariational;
        let nodes = match is_indefinite {
            true => NodeSolver::indefinite(&system.matrix, &tree.order, &rows)?,
            false => NodeSolver::definite(&mut system.matrix, &tree, &rows, solver)?,
        };
        Ok(Self { discrete, system, rows, n_supports, nodes, held, border, mean, balance })
    }

    /// Solves for the load of the system.
    ///
    /// # Errors
    /// [`Error::Factorization`] or [`Error::Residual`].
    fn into_solution(mut self) -> Result<Solution> {
        let (part, factors, extra) = self.solve_with_border()?;
        let values = self.rows.iter().map(|row| row.value).collect::<Vec<_>>();
        let mut result = self.solution(part, &self.system.load, &values)?;
        result.tip_factors = factors.chunks_exact(2).map(|k| [k[0], k[1]]).collect();
        result.n_unknowns += factors.len();
        result.parameters.extend(pairs(&extra));
        (result.balancing_force, result.imbalance) = self.balance;
        self.finish(&mut result);
        Ok(result)
    }

    /// Solves for nodes, multipliers of all rows and stress intensity factors; the last are parameters of the functions of
    /// tips.
    fn solve_with_border(&mut self) -> Result<(Part, Vec<f64>, Vec<f64>)> {
        let mut values: Vec<f64> = self.rows.iter().map(|row| row.value).collect();
        let Self { system, nodes, rows, border, .. } = self;
        let part_of = |load: &[f64], values: &[f64]| nodes.solve(&system.matrix, rows, load, values);
        let Some(border) = border else { return Ok((part_of(&system.load, &values)?, vec![], vec![])) };
        let (part, factors) = border.solve(&mut system.load, &mut values, part_of)?;
        rows.iter_mut().zip(values).for_each(|(row, value)| row.value = value);
        let extra = border.parameters(&factors);
        Ok((part, factors, extra))
    }

    /// Solves for another load; not where nodes are held or stress intensity factors are unknowns, which take part of the load
    /// of the system.
    ///
    /// - `prescribed`: factor on prescribed displacements of rows
    ///
    /// # Errors
    /// [`Error::Factorization`] or [`Error::Residual`].
    pub fn solve_for(&self, load: &[f64], prescribed: f64) -> Result<Solution> {
        let mut load = load.to_vec();
        if let Some(mean) = &self.mean {
            mean.balance(&self.discrete.approximation.nodes().positions, &mut load);
        }
        let values: Vec<f64> = self.rows.iter().map(|row| row.value * prescribed).collect();
        let part = self.nodes.solve(&self.system.matrix, &self.rows, &load, &values)?;
        let mut result = self.solution(part, &load, &values)?;
        self.finish(&mut result);
        Ok(result)
    }

    /// Values of the rows of points.
    pub fn point_values(&self) -> impl Iterator<Item = f64> + '_ {
        self.rows[self.n_supports..].iter().map(|row| row.value)
    }

    fn solution(&self, part: Part, load: &[f64], values: &[f64]) -> Result<Solution> {
        let residual = self.residual(load, values, &part);
        if !(residual <= ALLOWED_RESIDUAL) {
            return Err(Error::Residual { residual, allowed: ALLOWED_RESIDUAL });
        }
        let mut multipliers = part.multipliers;
        let point_forces = multipliers.split_off(self.n_supports).iter().map(|m| -m).collect();
        let parameters = pairs(&part.u);
        let n_unknowns = load.len() + self.rows.len();
        Ok(Solution { parameters, multipliers, point_forces, residual, n_unknowns, ..Solution::default() })
    }

    fn finish(&self, result: &mut Solution) {
        if let Some(held) = &self.held {
            held.finish(result);
        }
        if let Some(mean) = &self.mean {
            mean.remove_mean(&self.discrete.approximation.nodes().positions, &mut result.parameters);
        }
    }

    /// Relative residual of equilibrium.
    fn residual(&self, load: &[f64], values: &[f64], part: &Part) -> f64 {
        let (u, matrix) = (&part.u, &self.system.matrix);
        let mut forces = vec![0.0; u.len()];
        matrix.multiply(u, &mut forces);
        let mut size = 0.0f64;
        for ((row, m), value) in self.rows.iter().zip(&part.multipliers).zip(values) {
            row.entries.iter().for_each(|&(dof, c)| forces[dof] += (m - self.nodes.augmentation * value) * c);
        }
        let mut error = 0.0f64;
        for (f, l) in forces.iter().zip(load) {
            error += (f - l) * (f - l);
            size += f * f + l * l;
        }
        let mut scale = 0.0f64;
        for i in 0..matrix.n_nodes() {
            let b = matrix.blocks[matrix.row_starts[i + 1] - 1];
            scale += (b[0] * u[2 * i]).powi(2) + (b[3] * u[2 * i + 1]).powi(2);
        }
        // Large rigid parts of the solution cancel in the forces: measure against the terms that cancel.
        let size = size.sqrt().max(scale.sqrt() * 1e-3);
        if size == 0.0 { 0.0 } else { error.sqrt() / size }
    }
}

fn pairs(dofs: &[f64]) -> Vec<Vector2> {
    dofs.chunks_exact(2).map(|c| Vector2::new(c[0], c[1])).collect()
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
