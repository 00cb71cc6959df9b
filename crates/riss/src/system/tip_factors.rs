//! Stress intensity factors as unknowns [EFG, section 5.1]: a border of the system, two rows and columns for each tip.
//!
//! The functions of a tip act on all nodes around it, and their rows would fill the factor. They are taken out:
//! `A u + g k = f`, `gᵀ u + h k = p` is solved by `A u_0 = f`, `A z = g` and `(h - gᵀ z) k = p - gᵀ u_0`.

use super::block_matrix::BlockMatrix;
use super::constraints::ConstraintRow;
use super::discretization::Discretization;
use super::galerkin::LinearSystem;
use super::node_solver::Part;
use crate::approximation::tip_functions::MOST_FUNCTIONS;
use crate::error::{Error, Result};
use crate::material::Elasticity;
use crate::math::{Vector2, direction, turn_left};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

/// Parameters of the functions of a tip per unit of K_I and of K_II: the displacement at a tip [Williams1957] in the
/// functions of [EFG, Eq. 50].
pub fn unit_fields(material: &Elasticity, angle: f64) -> [[Vector2; MOST_FUNCTIONS]; 2] {
    let (ahead, kappa) = (direction(angle), material.kolosov());
    let factor = 1.0 / (2.0 * material.shear() * (2.0 * PI).sqrt());
    let vector = |x: f64, y: f64| (ahead * x + turn_left(ahead) * y) * factor;
    [
        [vector(kappa - 1.0, 0.0), vector(0.0, kappa + 1.0), vector(1.0, 0.0), vector(0.0, -1.0)],
        [vector(0.0, 1.0 - kappa), vector(kappa + 1.0, 0.0), vector(0.0, 1.0), vector(1.0, 0.0)],
    ]
}

/// The part of a system that belongs to the stress intensity factors.
#[derive(Clone, Debug)]
pub(super) struct Border {
    /// Unknowns of nodes, before those of tips.
    n: usize,
    /// Dofs and values of the displacement of each unit factor.
    units: Vec<Vec<(usize, f64)>>,
    /// Force of each unit factor on the nodes.
    columns: Vec<Vec<f64>>,
    /// Force of each unit factor on each factor.
    corner: DMatrix<f64>,
    /// Loads on the functions of tips.
    tail: Vec<f64>,
    /// Factors in each constraint row, row by row.
    in_rows: Vec<Vec<f64>>,
}

impl Part {
    /// Subtracts a multiple of another part.
    fn subtract(&mut self, other: &Self, factor: f64) {
        self.u.iter_mut().zip(&other.u).for_each(|(a, b)| *a -= factor * b);
        self.multipliers.iter_mut().zip(&other.multipliers).for_each(|(a, b)| *a -= factor * b);
    }
}

impl Border {
    /// Takes the functions of tips out of a system; none if there are none.
    pub fn take(material: &Elasticity, discrete: &Discretization, system: &mut LinearSystem) -> Option<Self> {
        let angles = discrete.approximation.tied_tips();
        if angles.is_empty() {
            return None;
        }
        let n = 2 * discrete.n_nodes();
        let unit = |tip: usize, vectors: [Vector2; MOST_FUNCTIONS]| {
            let first = n + 2 * MOST_FUNCTIONS * tip;
            vectors.into_iter().enumerate().flat_map(move |(f, v)| [(first + 2 * f, v.x), (first + 2 * f + 1, v.y)])
        };
        let of_tip = |(tip, angle): (usize, f64)| unit_fields(material, angle).map(|v| unit(tip, v).collect());
        let units: Vec<Vec<(usize, f64)>> = angles.into_iter().enumerate().flat_map(of_tip).collect();
        let forces: Vec<Vec<f64>> = units.iter().map(|unit| product(&system.matrix, unit)).collect();
        let corner = DMatrix::from_fn(units.len(), units.len(), |i, j| apply(&units[i], &forces[j]));
        let columns = forces.into_iter().map(|f| f[..n].to_vec()).collect();
        let tail = system.load.split_off(n);
        system.matrix.truncate(n / 2);
        Some(Self { n, units, columns, corner, tail, in_rows: vec![] })
    }

    /// The load on all functions, for what needs it whole.
    pub fn with_whole_load(&mut self, load: &mut Vec<f64>, change: impl FnOnce(&mut Vec<f64>)) {
        load.append(&mut self.tail);
        change(load);
        self.tail = load.split_off(self.n);
    }

    /// Takes the functions of tips out of constraint rows.
    pub fn take_from_rows(&mut self, rows: &mut [ConstraintRow]) {
        for row in rows {
            let of_nodes = row.entries.partition_point(|e| e.0 < self.n);
            let of_tips = row.entries.split_off(of_nodes);
            let share = |unit: &Vec<(usize, f64)>| {
                let value = |dof: usize| unit.iter().find(|e| e.0 == dof).map_or(0.0, |e| e.1);
                of_tips.iter().map(|&(dof, c)| c * value(dof)).sum()
            };
            self.in_rows.push(self.units.iter().map(share).collect());
        }
    }

    /// Solves for nodes and factors, given how to solve for nodes with a load and the values of the rows. Changes both to
    /// what the nodes bear without the factors, and returns the factors.
    ///
    /// # Errors
    /// [`Error::Factorization`] if the factors are not determined.
    pub fn solve(
        &self,
        load: &mut [f64],
        values: &mut [f64],
        mut nodes: impl FnMut(&[f64], &[f64]) -> Result<Part>,
    ) -> Result<(Part, Vec<f64>)> {
        let mut part = nodes(load, values)?;
        let in_rows = |k: usize| self.in_rows.iter().map(|row| row[k]).collect::<Vec<f64>>();
        let responses = (0..self.units.len()).map(|k| nodes(&self.columns[k], &in_rows(k)));
        let responses: Vec<Part> = responses.collect::<Result<_>>()?;
        let force = |k: usize, part: &Part| {
            let of_rows = self.in_rows.iter().zip(&part.multipliers).map(|(row, m)| row[k] * m).sum::<f64>();
            self.columns[k].iter().zip(&part.u).map(|(g, u)| g * u).sum::<f64>() + of_rows
        };
        let n = self.units.len();
        let schur = DMatrix::from_fn(n, n, |i, j| self.corner[(i, j)] - force(i, &responses[j]));
        let tail = |k: usize| self.units[k].iter().map(|&(dof, v)| self.tail[dof - self.n] * v).sum::<f64>();
        let right = DVector::from_fn(n, |k, _| tail(k) - force(k, &part));
        let undetermined = || Error::Factorization { reason: "a stress intensity factor is not determined".into() };
        let factors: Vec<f64> = schur.lu().solve(&right).ok_or_else(undetermined)?.iter().copied().collect();
        for (k, factor) in factors.iter().enumerate() {
            part.subtract(&responses[k], *factor);
            load.iter_mut().zip(&self.columns[k]).for_each(|(f, g)| *f -= factor * g);
            values.iter_mut().zip(&self.in_rows).for_each(|(v, row)| *v -= factor * row[k]);
        }
        Ok((part, factors))
    }

    /// Parameters of the functions of tips.
    pub fn parameters(&self, factors: &[f64]) -> Vec<f64> {
        let mut result = vec![0.0; self.tail.len()];
        for (unit, factor) in self.units.iter().zip(factors) {
            unit.iter().for_each(|&(dof, v)| result[dof - self.n] += factor * v);
        }
        result
    }
}

fn apply(unit: &[(usize, f64)], forces: &[f64]) -> f64 {
    unit.iter().map(|&(dof, v)| v * forces[dof]).sum()
}

fn product(matrix: &BlockMatrix, unit: &[(usize, f64)]) -> Vec<f64> {
    let mut x = vec![0.0; 2 * matrix.n_nodes()];
    unit.iter().for_each(|&(dof, v)| x[dof] = v);
    let mut y = vec![0.0; x.len()];
    matrix.multiply(&x, &mut y);
    y
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::approximation::tip_functions::{TipCoordinates, TipFunctions};
    use crate::crack::{CrackPath, End, EndKind};
    use crate::exact::{CrackTipField, ExactField};
    use crate::material::PlaneState;

    #[test]
    fn unit_fields_are_the_exact_displacements() {
        let (tip, angle) = (Vector2::new(0.3, -0.2), 0.7);
        let vertices = vec![tip - direction(angle), tip];
        let path = CrackPath { name: "c".into(), vertices, ends: [EndKind::Mouth, EndKind::Tip] };
        let coordinates = TipCoordinates::new(&path, End::End, f64::INFINITY, 0.0);
        for plane in [PlaneState::Strain, PlaneState::Stress] {
            let material = Elasticity { young: 1000.0, poisson: 0.3, plane };
            let units = unit_fields(&material, angle);
            for (unit, [k1, k2]) in units.iter().zip([[1.0, 0.0], [0.0, 1.0]]) {
                let exact = CrackTipField { tip, angle, k1, k2, t_stress: 0.0 };
                for k in 0..20 {
                    let at = tip + direction(0.31 * k as f64) * (0.05 + 0.1 * k as f64);
                    let values = coordinates.values(TipFunctions::Full, at, at);
                    let found: Vector2 = unit.iter().zip(values).map(|(v, q)| v * q).sum();
                    let expected = exact.displacement(&material, at);
                    assert!((found - expected).norm() < 1e-14 * expected.norm(), "{at}: {found} {expected}");
                }
            }
        }
    }
}
