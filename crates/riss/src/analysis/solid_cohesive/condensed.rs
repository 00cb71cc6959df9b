//! The body between its opened pairs: tractions and work as linear functions of load and openings.

use super::work::Work;
use crate::error::Result;
use crate::math::{Vector, Vector3};
use crate::system::{Collocation, CollocationSystem, PreparedSolver, TiedFaces};
use rayon::prelude::*;

/// Which openings are unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Parting {
    /// Along the normal: faces do not slide.
    Normal,
    /// In all directions that supports leave free.
    Full,
}

/// The linear relations, from one solution for each opening of unit size.
///
/// A row is a component of the traction of a pair, a column a component of its opening.
pub(super) struct Condensed {
    /// First row of each pair, and the end of the last.
    pub rows: Vec<usize>,
    /// First column of each pair, and the end of the last.
    pub columns: Vec<usize>,
    /// Traction of the load [stress].
    by_load: Vec<f64>,
    /// Traction of each opening of unit size [stress/length]: column by column.
    by_opening: Vec<Vec<f64>>,
    /// Work conjugates of the load: what loads and reactions do [stress·length³] for a unit load factor and unit openings.
    work_by_load: [f64; 2],
    work_by_opening: Vec<[f64; 2]>,
}

/// A tied body, ready to be solved.
pub(super) struct TiedBody<'a> {
    pub tied: &'a TiedFaces<3>,
    pub solver: PreparedSolver<'a, 3>,
    pub work: Work,
}

impl<'a> TiedBody<'a> {
    /// Factors the system of a body with tied faces.
    ///
    /// # Errors
    /// Those of the solver.
    pub fn new(
        collocation: &Collocation<3>,
        system: &CollocationSystem<3>,
        tied: &'a TiedFaces<3>,
        work: Work,
    ) -> Result<Self> {
        let border = tied.tied_motions(collocation.free_motions(&system.fixed)?);
        Ok(Self { tied, solver: collocation.prepare(&tied.system, border)?, work })
    }

    /// Displacements of a load factor with openings.
    ///
    /// # Errors
    /// Those of the solver.
    pub fn solve(
        &self,
        load_factor: f64,
        openings: &[(usize, Vector3)],
    ) -> Result<(Vec<f64>, crate::system::SolverEffort)> {
        let mut right: Vec<f64> = self.tied.system.load.iter().map(|f| f * load_factor).collect();
        openings.iter().for_each(|(pair, w)| self.tied.open(*pair, *w, &mut right));
        let (mut displacements, effort) = self.solver.solve(&right)?;
        let mut of_pair = vec![Vector::zeros(); self.tied.pairs.len()];
        openings.iter().for_each(|(pair, w)| of_pair[*pair] += *w);
        self.tied.complete(&mut displacements, |pair| of_pair[pair]);
        Ok((displacements, effort))
    }

    fn tractions(&self, displacements: &[f64], load_factor: f64) -> Vec<f64> {
        let pairs = 0..self.tied.pairs.len();
        pairs.flat_map(|pair| self.tied.traction(pair, displacements, load_factor)).collect()
    }
}

impl Condensed {
    /// Solves for the load and for each opening.
    ///
    /// # Errors
    /// Those of the solver.
    pub fn new(body: &TiedBody<'_>, parting: Parting) -> Result<Self> {
        let (mut rows, mut columns, mut unit) = (vec![0], vec![0], vec![]);
        for (k, pair) in body.tied.pairs.iter().enumerate() {
            let n = match parting {
                Parting::Normal => 1,
                Parting::Full => pair.directions.len(),
            };
            rows.push(rows[k] + pair.directions.len());
            columns.push(columns[k] + n);
            unit.extend(pair.directions[..n].iter().map(|e| (k, *e)));
        }
        let (displacements, _) = body.solve(1.0, &[])?;
        let by_load = body.tractions(&displacements, 1.0);
        let work_by_load = body.work.of(&displacements);
        let one = |opening: &(usize, Vector3)| {
            let (displacements, _) = body.solve(0.0, &[*opening])?;
            Ok((body.tractions(&displacements, 0.0), body.work.of(&displacements)))
        };
        let solved = unit.par_iter().map(one).collect::<Result<Vec<_>>>()?;
        let (by_opening, work_by_opening) = solved.into_iter().unzip();
        Ok(Self { rows, columns, by_load, by_opening, work_by_load, work_by_opening })
    }

    /// Number of pairs.
    pub fn n_pairs(&self) -> usize {
        self.rows.len() - 1
    }

    /// Traction in a row by the opening of a column [stress/length].
    pub fn by_opening(&self, row: usize, column: usize) -> f64 {
        self.by_opening[column][row]
    }

    /// Traction in a row by the load [stress].
    pub fn by_load(&self, row: usize) -> f64 {
        self.by_load[row]
    }

    /// Tractions of all pairs [stress]; also their rates from the rates of load factor and openings.
    pub fn tractions(&self, load_factor: f64, openings: &[f64]) -> Vec<f64> {
        let mut tractions: Vec<f64> = self.by_load.iter().map(|t| t * load_factor).collect();
        for (column, w) in self.by_opening.iter().zip(openings).filter(|(_, w)| **w != 0.0) {
            tractions.iter_mut().zip(column).for_each(|(t, s)| *t += s * w);
        }
        tractions
    }

    /// Work conjugates of the load factor [stress·length³].
    pub fn work(&self, load_factor: f64, openings: &[f64]) -> [f64; 2] {
        let mut work = self.work_by_load.map(|v| v * load_factor);
        for (own, w) in self.work_by_opening.iter().zip(openings) {
            work[0] += own[0] * w;
            work[1] += own[1] * w;
        }
        work
    }

    /// Components of a pair in a vector of all rows, zero where the pair has fewer.
    pub fn of_pair(&self, pair: usize, rows: &[f64]) -> [f64; 3] {
        components(&rows[self.rows[pair]..self.rows[pair + 1]])
    }

    /// The same in a vector of all columns.
    pub fn opening_of(&self, pair: usize, columns: &[f64]) -> [f64; 3] {
        components(&columns[self.columns[pair]..self.columns[pair + 1]])
    }
}

fn components(values: &[f64]) -> [f64; 3] {
    std::array::from_fn(|k| values.get(k).copied().unwrap_or(0.0))
}
