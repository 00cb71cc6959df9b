//! Crack faces that touch: where they do, found by solving again until they stay the same.

use crate::error::Result;
use crate::model::Model;
use crate::system::crack_faces::{Parting, joined, opening_rows};
use crate::system::galerkin::LinearSystem;
use crate::system::{ConstraintMethod, Discretization, LinearSolver, Solution, solve};

/// More solutions are not made; without friction some five are enough.
const MAX_SOLUTIONS: usize = 30;

/// How the search for the closed part of the crack faces ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSearch {
    /// Solutions that were made.
    pub n_solutions: usize,
    /// Knots along cracks at which the faces touch.
    pub n_closed: usize,
    /// Knots that opened or closed in the last solution: zero if the search has settled.
    pub n_changed: usize,
}

/// Solves the system; with contact again and again, until no knot of a crack opens or closes any more.
///
/// # Errors
/// Those of [`solve()`].
pub fn solve_in_contact(
    model: &Model,
    discrete: &Discretization,
    system: LinearSystem,
    method: &ConstraintMethod,
    solver: LinearSolver,
) -> Result<(Solution, ContactSearch)> {
    let mut search = ContactSearch { n_solutions: 1, n_closed: 0, n_changed: 0 };
    let Some(contact) = model.contact else {
        return Ok((solve(model, discrete, system, method, solver)?, search));
    };
    let rows = opening_rows(model, discrete, Parting::Normal, contact.penalty)?;
    let mut closed = vec![false; rows.len()];
    let mut solution = solve(model, discrete, system.clone(), method, solver)?;
    loop {
        // With the penalty, faces under pressure overlap a little: the sign tells both ways.
        let pressures: Vec<f64> = rows.iter().map(|row| row.pressure(&solution.parameters)).collect();
        let now: Vec<bool> = pressures.iter().map(|p| *p > 0.0).collect();
        search.n_closed = now.iter().filter(|c| **c).count();
        search.n_changed = now.iter().zip(&closed).filter(|(a, b)| a != b).count();
        if search.n_changed == 0 || search.n_solutions == MAX_SOLUTIONS {
            // What acts is what the last solution was made with.
            let acting = pressures.iter().zip(&closed).map(|(p, closed)| if *closed { *p } else { 0.0 });
            solution.contact_pressures = acting.collect();
            return Ok((solution, search));
        }
        closed = now;
        let touching = rows.iter().zip(&closed).filter(|r| *r.1).map(|r| r.0);
        solution = solve(model, discrete, joined(&system, touching)?, method, solver)?;
        search.n_solutions += 1;
    }
}
