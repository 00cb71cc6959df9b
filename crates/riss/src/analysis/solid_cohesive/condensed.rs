//! The body between its opened pairs: tractions and work as linear functions of load and openings.
//!
//! By the principle of virtual work: what the displacements of an opening do against the stresses of all others, over the
//! area that the pair stands for, is the traction at it. Forces and moments on both sides of a crack are then in balance
//! however few nodes the ligament has left, which tractions of the strong form, taken node by node, are not.

use super::areas::FaceArea;
use super::energy::Energy;
use super::free_faces::FreeFaces;
use super::reactions::{missed_work, virtual_field};
use super::work::Work;
use crate::analysis::cohesive::Condensed;
use crate::error::{Error, Result};
use crate::integration::NodeCells;
use crate::math::{Vector, Vector3};
use crate::system::{Collocation, CollocationSystem, PreparedSolver, SolverEffort, TiedFaces};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// No pair stands for less than this share of the area nearest to it.
const LEAST_AREA: f64 = 0.2;

/// Most that it takes to open a pair, over Young's modulus times the root of its area; usual are 0.1 to 15, and 10⁴ and more
/// where the equations are nearly singular.
const MOST_STIFFNESS: f64 = 1e3;

/// Which openings are unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Parting {
    /// Along the normal: faces do not slide.
    Normal,
    /// In all directions that supports leave free.
    Full,
}

/// A tied body, ready to be solved.
pub(super) struct TiedBody<'a> {
    pub tied: &'a TiedFaces<3>,
    pub solver: PreparedSolver<'a, 3>,
    pub work: Work,
    cells: NodeCells,
    /// What holds each node.
    system: &'a CollocationSystem<3>,
    /// Unit vectors of the motions of the whole body that nothing holds.
    free_motions: Vec<Vec<f64>>,
}

/// Displacements under the load and under openings of unit size, as far as they were asked for.
#[derive(Default)]
pub(super) struct UnitFields {
    of_load: Vec<f64>,
    /// By pair and direction.
    of_openings: Vec<Vec<Vec<f64>>>,
}

impl UnitFields {
    /// Solves for what is missing.
    fn complete(&mut self, body: &TiedBody<'_>, parting: Parting) -> Result<()> {
        if self.of_load.is_empty() {
            self.of_load = body.solve(1.0, &[])?.0;
            self.of_openings = vec![vec![]; body.tied.pairs.len()];
        }
        let missing: Vec<_> = (0..body.tied.pairs.len())
            .flat_map(|k| (self.of_openings[k].len()..body.n_columns(k, parting)).map(move |d| (k, d)))
            .collect();
        let opening = |m: usize| (missing[m].0, body.tied.pairs[missing[m].0].directions[missing[m].1]);
        let mut solved = body.solver.solve_all(missing.len(), |m| {
            let mut right = vec![0.0; self.of_load.len()];
            body.tied.open(opening(m).0, opening(m).1, &mut right);
            right
        })?;
        for (m, field) in solved.iter_mut().enumerate() {
            let (own, w) = opening(m);
            body.complete(field, |pair| if pair == own { w } else { Vector::zeros() });
        }
        missing.into_iter().zip(solved).for_each(|((k, _), field)| self.of_openings[k].push(field));
        Ok(())
    }
}

impl<'a> TiedBody<'a> {
    /// Factors the system of a body with tied faces.
    ///
    /// # Errors
    /// Those of the solver.
    pub fn new(
        collocation: &Collocation<3>,
        system: &'a CollocationSystem<3>,
        tied: &'a TiedFaces<3>,
        work: Work,
        cells: NodeCells,
    ) -> Result<Self> {
        let free_motions = collocation.free_motions(&system.fixed)?;
        let border = tied.tied_motions(free_motions.clone());
        Ok(Self { tied, solver: collocation.prepare(&tied.system, border)?, work, cells, system, free_motions })
    }

    /// Displacements of a load factor with openings.
    ///
    /// # Errors
    /// Those of the solver.
    pub fn solve(&self, load_factor: f64, openings: &[(usize, Vector3)]) -> Result<(Vec<f64>, SolverEffort)> {
        let mut right: Vec<f64> = self.tied.system.load.iter().map(|f| f * load_factor).collect();
        openings.iter().for_each(|(pair, w)| self.tied.open(*pair, *w, &mut right));
        let (mut displacements, effort) = self.solver.solve(&right)?;
        let mut of_pair = vec![Vector::zeros(); self.tied.pairs.len()];
        openings.iter().for_each(|(pair, w)| of_pair[*pair] += *w);
        self.complete(&mut displacements, |pair| of_pair[pair]);
        Ok((displacements, effort))
    }

    /// Puts the displacements of the first nodes in place, and takes out motions of the whole body: loads that are balanced up
    /// to errors of integration would do work on them.
    fn complete(&self, displacements: &mut [f64], openings: impl Fn(usize) -> Vector3) {
        self.tied.complete(displacements, openings);
        for motion in self.free_motions.iter().chain(&self.free_motions) {
            let along: f64 = motion.iter().zip(displacements.iter()).map(|(m, u)| m * u).sum();
            displacements.iter_mut().zip(motion).for_each(|(u, m)| *u -= along * m);
        }
    }

    fn n_columns(&self, pair: usize, parting: Parting) -> usize {
        match parting {
            Parting::Normal => 1,
            Parting::Full => self.tied.pairs[pair].directions.len(),
        }
    }

    /// Tractions of the strong form, of all pairs.
    fn tractions(&self, displacements: &[f64], load_factor: f64) -> Vec<f64> {
        let pairs = 0..self.tied.pairs.len();
        pairs.flat_map(|pair| self.tied.traction(pair, displacements, load_factor)).collect()
    }
}

/// Solves for the load and for each opening.
///
/// - `areas`: of each pair
/// - `free`: what of the cracks is no pair
/// - `known`: fields that were solved for; it gets the others
///
/// # Errors
/// Those of the solver and of the shape functions.
pub(super) fn condense(
    body: &TiedBody<'_>,
    collocation: &Collocation<3>,
    parting: Parting,
    areas: &[FaceArea],
    free: &FreeFaces,
    known: &mut UnitFields,
) -> Result<Condensed> {
    known.complete(body, parting)?;
    let (mut rows, mut columns, mut fields) = (vec![0], vec![0], vec![]);
    for (k, pair) in body.tied.pairs.iter().enumerate() {
        let n = body.n_columns(k, parting);
        rows.push(rows[k] + pair.directions.len());
        columns.push(columns[k] + n);
        fields.extend(&known.of_openings[k][..n]);
    }
    fields.push(&known.of_load);
    let last = fields.len() - 1;
    let virtual_field = virtual_field(collocation, body.system);
    fields.extend(&virtual_field);
    let supported = fields.len() - 1;
    let all = DMatrix::from_fn(fields.len(), known.of_load.len(), |field, dof| fields[field][dof]);
    let energy = Energy::new(collocation, &body.cells, &all)?;
    check_stiffness(collocation, &energy, &columns, areas)?;
    let of_field = |k: usize| body.work.of(fields[k]) + free.work(fields[k]) + energy.body_work[k];
    let mut of_loads: Vec<f64> = (0..fields.len()).into_par_iter().map(of_field).collect();
    let mut tractions: Vec<Vec<f64>> = fields[..=last]
        .par_iter()
        .enumerate()
        .map(|(k, field)| body.tractions(field, if k == last { 1.0 } else { 0.0 }))
        .collect();
    let mut own_areas = vec![];
    for (pair, area) in areas.iter().enumerate() {
        let (rows, directions) = (rows[pair]..rows[pair + 1], &body.tied.pairs[pair].directions);
        for (row, column) in rows.clone().zip(columns[pair]..columns[pair + 1]) {
            let (direction, normal) = (directions[row - rows.start], directions[0]);
            // What is left of the mean gradient, by Gauss' theorem, is the opening that the field has on the ligament.
            let opened = body.work.outside(fields[column]) - free.opened(fields[column]) - energy.gradients[column];
            let whole = direction.dot(&(opened * normal));
            let own = (whole - area.total + area.cohesive).max(LEAST_AREA * area.cohesive);
            for (k, of_field) in tractions.iter_mut().enumerate() {
                let by_loads = if k == last { of_loads[column] } else { 0.0 };
                of_field[row] = (by_loads - energy.mutual[(column, k)]) / own;
            }
            if row == rows.start {
                own_areas.push(own);
            }
        }
        // The strong form knows the mean over the area of the pair.
        for row in rows.skip(columns[pair + 1] - columns[pair]) {
            tractions.iter_mut().for_each(|t| t[row] /= area.share());
        }
    }
    let by_load = tractions.pop().unwrap_or_default();
    let mut of_reactions: Vec<f64> = (0..=last).map(|k| energy.mutual[(supported, k)]).collect();
    of_reactions[last] -= of_loads[supported];
    if let Some(field) = &virtual_field {
        let (material, volume) = (&collocation.solid.material, body.cells.volumes.iter().sum());
        for (k, work) in of_reactions.iter_mut().enumerate() {
            let gradients = [energy.gradients[k], energy.gradients[supported]];
            *work += missed_work(material, volume, &body.work, field, gradients);
        }
    }
    of_loads.truncate(last + 1);
    Ok(Condensed { rows, columns, areas: own_areas, by_load, by_opening: tractions, of_loads, of_reactions })
}

/// Looks for openings that move far more of the body than their surroundings.
fn check_stiffness(collocation: &Collocation<3>, energy: &Energy, columns: &[usize], areas: &[FaceArea]) -> Result<()> {
    let stiffness = |(pair, area): (usize, &FaceArea)| {
        let own = (columns[pair]..columns[pair + 1]).map(|c| energy.mutual[(c, c)]).fold(0.0, f64::max);
        own / (collocation.solid.material.young * area.total.sqrt())
    };
    let largest = areas.iter().enumerate().map(stiffness).fold(0.0, f64::max);
    if largest <= MOST_STIFFNESS {
        return Ok(());
    }
    let reason =
        "the body nearly falls apart at its cohesive cracks although they are closed: their nodes are spread badly; \
                  use another spacing, or nodes that are closer around the cracks"
            .into();
    Err(Error::Factorization { reason })
}
