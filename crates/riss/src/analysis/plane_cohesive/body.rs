//! A body whose cohesive faces are joined by springs, and what it does without them.
//!
//! With springs the matrix is definite however far the cracks go. Tractions `t` at the knots pull the faces together; with the
//! openings `w` and the stiffness `k` of the springs, `s = t - k w` acts on the body with them, `w = λ w_0 - C s`. The tractions
//! that keep given openings are `t = C⁻¹ (λ w_0 - w) + k w`: that of the body without springs.

use super::super::cohesive::{Condensed, LoadMeasure, resultant};
use super::super::settings::Settings;
use crate::error::{Error, Result};
use crate::math::Vector2;
use crate::model::Model;
use crate::system::crack_faces::{OpeningRow, Parting, joined, opening_rows};
use crate::system::prescribed::Prescribed;
use crate::system::{Discretization, PreparedSystem, Solution, assemble};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Stiffness of the springs over Young's modulus and the length that belongs to a knot: about that of the body around it, so that no
/// digits are lost.
const SPRINGS: f64 = 1.0;

/// A body with joined faces, ready to be solved.
pub(super) struct JoinedBody<'a> {
    prepared: PreparedSystem<'a>,
    /// Two for each knot: along the normal and along the path.
    rows: Vec<OpeningRow>,
    /// Load vector without prescribed displacements.
    loads: Vec<f64>,
    prescribed: Prescribed,
    thickness: f64,
    resultant: f64,
}

impl<'a> JoinedBody<'a> {
    /// Assembles and factors; none if no face is cohesive.
    ///
    /// # Errors
    /// Those of the shape functions and of the factorization.
    pub fn new(model: &Model, settings: &Settings, discrete: &'a Discretization) -> Result<Option<Self>> {
        let method = &settings.constraints;
        let [normal, sliding] =
            [Parting::Normal, Parting::Sliding].map(|parting| opening_rows(model, discrete, parting, SPRINGS));
        let rows: Vec<OpeningRow> = normal?.into_iter().zip(sliding?).flat_map(|(n, s)| [n, s]).collect();
        if rows.is_empty() {
            return Ok(None);
        }
        let system = assemble(model, discrete, method)?;
        let prescribed = Prescribed::new(model, discrete, method)?;
        let loads: Vec<f64> = system.load.iter().zip(&prescribed.load).map(|(f, g)| f - g).collect();
        let system = joined(&system, rows.iter())?;
        let prepared = PreparedSystem::new(model, discrete, system, method, settings.solver)?;
        let resultant = resultant_of_loads(model, discrete);
        Ok(Some(Self { prepared, rows, loads, prescribed, thickness: model.thickness, resultant }))
    }

    /// What load and displacement are.
    pub fn measure(&self) -> LoadMeasure {
        LoadMeasure { resultant: self.resultant * self.thickness, prescribed: self.prescribed.largest }
    }

    /// Condenses the body onto the openings at the knots.
    ///
    /// # Errors
    /// Those of the solver.
    pub fn condense(&self) -> Result<Condensed> {
        let n = self.rows.len();
        let of_load = self.solve(1.0, &[])?;
        let responses: Vec<Response> = (0..n).into_par_iter().map(|k| self.response(k)).collect::<Result<_>>()?;
        let flexibility = DMatrix::from_fn(n, n, |i, j| 0.5 * (responses[j].forces[i] + responses[i].forces[j]));
        let stiffness = flexibility.cholesky().ok_or_else(|| Error::Factorization {
            reason: "the openings of cohesive cracks depend on one another: more nodes are needed along them".into(),
        })?;
        let lengths = DVector::from_fn(n, |i, _| self.rows[i].length);
        let open = DVector::from_fn(n, |i, _| self.rows[i].opening(&of_load.parameters));
        let by_load = stiffness.solve(&open.component_mul(&lengths));
        let by_opening = |j: usize| {
            let mut unit = DVector::zeros(n);
            unit[j] = -lengths[j];
            let mut column = stiffness.solve(&unit);
            column[j] += self.rows[j].stiffness;
            column.as_slice().to_vec()
        };
        let work = |of: fn(&Response) -> f64, alone: f64| {
            let own = DVector::from_fn(n, |i, _| of(&responses[i]));
            let by_openings = stiffness.solve(&own).component_mul(&lengths);
            let by_load = alone - own.dot(&by_load);
            by_openings.iter().chain([&by_load]).map(|w| w * self.thickness).collect()
        };
        let alone = self.functionals(&of_load, 1.0);
        Ok(Condensed {
            rows: (0..=n / 2).map(|k| 2 * k).collect(),
            columns: (0..=n / 2).map(|k| 2 * k).collect(),
            areas: self.areas(),
            of_loads: work(|r| r.functionals[0], alone[0]),
            of_reactions: work(|r| r.functionals[1], alone[1]),
            by_opening: (0..n).into_par_iter().map(by_opening).collect(),
            by_load: by_load.as_slice().to_vec(),
        })
    }

    /// Area of crack at each knot [area].
    pub fn areas(&self) -> Vec<f64> {
        self.rows.iter().step_by(2).map(|row| row.length * self.thickness).collect()
    }

    /// Solution for a load factor, with openings at the knots and the tractions that belong to them.
    ///
    /// # Errors
    /// Those of the solver.
    pub fn state(&self, load_factor: f64, openings: &[f64], tractions: &[f64]) -> Result<Solution> {
        let of_row = |((row, w), t): ((&OpeningRow, &f64), &f64)| t - row.stiffness * w;
        let pulls: Vec<f64> = self.rows.iter().zip(openings).zip(tractions).map(of_row).collect();
        self.solve(load_factor, &pulls)
    }

    /// - `pulls`: tractions that act beside the springs, by rows
    fn solve(&self, load_factor: f64, pulls: &[f64]) -> Result<Solution> {
        let of_loads = self.loads.iter().zip(&self.prescribed.load);
        let mut load: Vec<f64> = of_loads.map(|(f, g)| load_factor * (f + g)).collect();
        self.rows.iter().zip(pulls).for_each(|(row, s)| row.pull(*s, &mut load));
        self.prepared.solve_for(&load, load_factor)
    }

    /// What a unit traction that pushes the faces of a row apart does.
    fn response(&self, row: usize) -> Result<Response> {
        let mut load = vec![0.0; self.loads.len()];
        self.rows[row].pull(-1.0, &mut load);
        let solution = self.prepared.solve_for(&load, 0.0)?;
        let forces = self.rows.iter().map(|r| r.opening(&solution.parameters) * r.length).collect();
        Ok(Response { forces, functionals: self.functionals(&solution, 0.0) })
    }

    /// Work of unit loads, and of the reactions to a unit load factor, per thickness.
    fn functionals(&self, solution: &Solution, load_factor: f64) -> [f64; 2] {
        let on = |force: &[f64]| -> f64 {
            force.chunks_exact(2).zip(&solution.parameters).map(|(f, u)| f[0] * u.x + f[1] * u.y).sum()
        };
        let at_points: f64 =
            solution.point_forces.iter().zip(self.prepared.point_values()).map(|(force, value)| force * value).sum();
        [on(&self.loads), load_factor * self.prescribed.energy - on(&self.prescribed.load) + at_points]
    }
}

/// What a row does to all rows.
struct Response {
    /// Openings times lengths [area].
    forces: Vec<f64>,
    functionals: [f64; 2],
}

/// Resultant of the loads per thickness, or half of the sum of their sizes where they balance [stress·length].
fn resultant_of_loads(model: &Model, discrete: &Discretization) -> f64 {
    let (mut sum, mut sizes) = (Vector2::zeros(), 0.0);
    let mut add = |force: Vector2| {
        sum += force;
        sizes += force.norm();
    };
    for element in &discrete.boundary {
        for point in &element.points {
            let at = point.field_point();
            let traction =
                model.loads_on(element.edge).map(|l| l.value.traction(&model.material, &at)).sum::<Vector2>();
            add(traction * point.weight);
        }
    }
    for point in &discrete.cells.points {
        add(model.body_force_at(point.position) * point.weight);
    }
    model.point_loads.iter().for_each(|l| add(l.force / model.thickness));
    resultant(sum.norm(), sizes)
}
