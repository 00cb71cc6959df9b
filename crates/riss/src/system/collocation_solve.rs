//! Solution of the equations of collocation: direct for few nodes, two-level preconditioned IDR(4) for many.

use super::aggregates::Aggregates;
use super::coarse_level::CoarseLevel;
use super::collocation::{Collocation, CollocationSystem};
use super::collocation_settings::CollocationSolver;
use super::dissection::Dissection;
use super::incomplete_factor::IncompleteFactor;
use super::krylov::{self, Limits, LinearMap, Progress};
use super::sparse_lu::{ScalarRows, SparseLu};
use crate::error::{Error, Result};
use crate::math::symmetric_eigen::symmetric_eigen;
use crate::math::{Matrix, Vector, axis};
use crate::model::RigidMotion;
use crate::nodes::cloud::Place;
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Up to this many nodes the direct solver is faster.
const DIRECT_UP_TO: [usize; 2] = [12_000, 1_500];
/// Relative residual at which iterations stop.
const TARGET: f64 = 1e-9;
/// Relative residual that is accepted.
const ALLOWED: f64 = 1e-8;
/// Multiplications by the matrix after which a method gives up.
const MOST_ITERATIONS: usize = 400;
/// IDR starts again from where it stood, since its own residual drifts from the true one.
const STARTS: usize = 3;
/// Vectors of GMRES, the last resort.
const RESTART: usize = 80;
/// Least and greatest number of nodes in a group of the coarse level, and groups wanted in between.
const GROUP_SIZES: [usize; 2] = [150, 600];
const GROUPS: usize = 500;
/// Largest share of rows that the incomplete factors keep fuller.
const MOST_FULLER: f64 = 0.05;
/// Right-hand sides that are solved at once.
const TOGETHER: usize = 8;
/// Rigid motions are held if what fixes them is above this share of what fixes the firmest.
const HELD: f64 = 1e-10;

/// Displacements with what it took to find them.
#[derive(Clone, Debug)]
pub struct CollocationSolution<const D: usize> {
    /// Displacements of the nodes [length].
    pub displacements: Vec<Vector<D>>,
    /// How they were found.
    pub effort: SolverEffort,
}

/// What a solution took.
#[derive(Clone, Debug, PartialEq)]
pub struct SolverEffort {
    /// The method.
    pub method: &'static str,
    /// Multiplications by the matrix.
    pub iterations: usize,
    /// True relative residual.
    pub residual: f64,
    /// Blocks of the matrix.
    pub n_blocks: usize,
    /// Blocks of the preconditioner.
    pub n_factor_blocks: usize,
    /// Unknowns of the coarse level.
    pub n_coarse: usize,
}

impl<const D: usize> Collocation<D> {
    /// One step of Newton's method from rest, which is all that linear elasticity needs [C3D, Eqs. 41, 42].
    ///
    /// # Errors
    /// [`Error::FreeRigidMotion`] if the supports leave one and the model does not remove it,
    /// [`Error::NotConverged`] or [`Error::Factorization`] if the system cannot be solved.
    pub fn solve(&self, system: &CollocationSystem<D>) -> Result<CollocationSolution<D>> {
        let (x, effort) = self.prepare(system, self.free_motions(&system.fixed)?)?.solve(&system.load)?;
        let displacements = x.chunks_exact(D).map(Vector::from_column_slice).collect();
        Ok(CollocationSolution { displacements, effort })
    }

    /// Factors the system for any number of right-hand sides.
    ///
    /// - `border`: unit vectors of the motions that nothing holds
    ///
    /// # Errors
    /// [`Error::Factorization`] if the system is singular to the direct solver or on the coarse level.
    pub fn prepare<'a>(
        &self,
        system: &'a CollocationSystem<D>,
        border: Vec<Vec<f64>>,
    ) -> Result<PreparedSolver<'a, D>> {
        let n = self.cloud().len();
        let is_direct = match self.settings.solver {
            CollocationSolver::Automatic => n <= DIRECT_UP_TO[D - 2],
            CollocationSolver::Direct => true,
            CollocationSolver::Iterative => false,
        };
        let factors = if is_direct {
            Factors::Direct(Box::new(SparseLu::new(ScalarRows::bordered(&system.tangent, &border))?))
        } else {
            let size = (n / GROUPS).clamp(GROUP_SIZES[0], GROUP_SIZES[1]);
            let positions = &self.cloud().positions;
            let (fine, coarse) = rayon::join(
                || {
                    let dissection = Dissection::new(&system.tangent, positions);
                    IncompleteFactor::new(&system.tangent, dissection, &self.rows_at_fronts(system))
                },
                || {
                    let groups = Aggregates::new(positions, &system.tangent, &system.fixed, size);
                    CoarseLevel::new(&system.tangent, positions, &system.fixed, groups, &border)
                },
            );
            Factors::Iterative { fine, coarse: Box::new(coarse?) }
        };
        Ok(PreparedSolver { system, border, factors })
    }

    /// Nodes whose rows see a node of a front. Fields that are too singular there are held by the equations of few nodes;
    /// what factors leave out lets them go. None if these are many, since fuller rows would cost more than they save.
    fn rows_at_fronts(&self, system: &CollocationSystem<D>) -> Vec<bool> {
        let n = self.cloud().len();
        let is_front = |j: &u32| matches!(self.cloud().places[*j as usize], Place::Front { .. });
        let found: Vec<bool> = (0..n).into_par_iter().map(|i| system.tangent.row(i).0.iter().any(is_front)).collect();
        let n_found = found.iter().filter(|f| **f).count();
        if n_found as f64 > MOST_FULLER * n as f64 { vec![false; n] } else { found }
    }

    /// Unit vectors of the rigid motions that nothing holds.
    ///
    /// # Errors
    /// [`Error::FreeRigidMotion`] if there are some and the model does not remove them.
    pub fn free_motions(&self, fixed: &[Matrix<D>]) -> Result<Vec<Vec<f64>>> {
        let motions = rigid_motions(&self.cloud().positions);
        let held = |a: &Vec<f64>, b: &Vec<f64>| -> f64 {
            let pairs = a.chunks_exact(D).zip(b.chunks_exact(D)).zip(fixed);
            pairs
                .map(|((a, b), f)| (f * Vector::<D>::from_column_slice(b)).dot(&Vector::<D>::from_column_slice(a)))
                .sum()
        };
        let gram: Vec<Vec<f64>> = motions.iter().map(|a| motions.iter().map(|b| held(a, b)).collect()).collect();
        let (values, vectors) = symmetric_eigen(&gram);
        let firmest = values.iter().fold(0.0f64, |m, v| m.max(*v));
        let free: Vec<Vec<f64>> = values
            .iter()
            .zip(vectors)
            .filter(|(v, _)| **v <= HELD * firmest)
            .map(|(_, vector)| {
                let mut motion = vec![0.0; motions[0].len()];
                vector.iter().zip(&motions).for_each(|(c, m)| krylov::add(&mut motion, *c, m));
                motion
            })
            .collect();
        match self.solid.rigid_motion {
            RigidMotion::Supported if !free.is_empty() => {
                let motion = format!("{} of {} rigid motions", free.len(), motions.len());
                Err(Error::FreeRigidMotion { motion, component: None })
            }
            RigidMotion::Supported | RigidMotion::MeanIsZero => Ok(free),
        }
    }
}

/// A system with the factors that solve it.
pub struct PreparedSolver<'a, const D: usize> {
    system: &'a CollocationSystem<D>,
    border: Vec<Vec<f64>>,
    factors: Factors<D>,
}

/// What solves.
enum Factors<const D: usize> {
    Direct(Box<SparseLu>),
    Iterative { fine: IncompleteFactor<D>, coarse: Box<CoarseLevel<D>> },
}

impl<const D: usize> PreparedSolver<'_, D> {
    /// Solves for a right-hand side.
    ///
    /// # Errors
    /// [`Error::NotConverged`] or [`Error::Residual`] if the solution is not good enough.
    pub fn solve(&self, right: &[f64]) -> Result<(Vec<f64>, SolverEffort)> {
        match &self.factors {
            Factors::Direct(factor) => self.solve_directly(factor, right),
            Factors::Iterative { fine, coarse } => self.solve_iteratively(fine, coarse, right),
        }
    }

    /// Solves for many right-hand sides, [`TOGETHER`] at once; the factors are then read once for all of these.
    ///
    /// # Errors
    /// Those of [`Self::solve`].
    pub fn solve_all(&self, n: usize, right: impl Fn(usize) -> Vec<f64> + Sync) -> Result<Vec<Vec<f64>>> {
        const W: usize = TOGETHER;
        let of_group = |group: usize| {
            let members: Vec<Vec<f64>> = (group * W..((group + 1) * W).min(n)).map(&right).collect();
            let length = members[0].len();
            let mut rights = vec![0.0; length * W];
            for (l, right) in members.iter().enumerate() {
                right.iter().enumerate().for_each(|(i, v)| rights[i * W + l] = *v);
            }
            let mut x = vec![0.0; length * W];
            let matrix = |x: &[f64], y: &mut [f64]| self.multiply::<W>(x, y);
            let mut r = vec![0.0; length * W];
            match &self.factors {
                Factors::Direct(factor) => self.refine::<W>(factor, &rights, &mut x),
                Factors::Iterative { fine, coarse } => {
                    let preconditioner = TwoLevel::<D, W>::new(self, coarse, fine);
                    let limits = Limits { target: TARGET, iterations: MOST_ITERATIONS };
                    krylov::idr::<W>(&matrix, &preconditioner, &rights, &mut x, limits);
                }
            }
            krylov::residual(&matrix, &rights, &x, &mut r);
            let (left, sizes) = (krylov::norms::<W>(&r), krylov::norms::<W>(&rights));
            let solution = |(l, right): (usize, &Vec<f64>)| {
                if left[l] <= ALLOWED * sizes[l] {
                    return Ok((0..length).map(|i| x[i * W + l]).collect());
                }
                Ok(self.solve(right)?.0)
            };
            members.iter().enumerate().map(solution).collect::<Result<Vec<_>>>()
        };
        let groups: Vec<Vec<Vec<f64>>> = (0..n.div_ceil(W)).into_par_iter().map(of_group).collect::<Result<_>>()?;
        Ok(groups.into_iter().flatten().collect())
    }

    /// `y = (A + Σ b bᵀ) x`.
    fn multiply<const W: usize>(&self, x: &[f64], y: &mut [f64]) {
        self.system.tangent.multiply_lanes::<W>(x, y);
        self.add_border::<W>(1.0, x, y);
    }

    /// `y += factor Σ b bᵀ x`.
    fn add_border<const W: usize>(&self, factor: f64, x: &[f64], y: &mut [f64]) {
        for b in &self.border {
            let mut along = [0.0; W];
            for (x, b) in x.chunks_exact(W).zip(b) {
                (0..W).for_each(|l| along[l] += factor * x[l] * b);
            }
            for (y, b) in y.chunks_exact_mut(W).zip(b) {
                (0..W).for_each(|l| y[l] += along[l] * b);
            }
        }
    }

    fn solve_iteratively(
        &self,
        fine: &IncompleteFactor<D>,
        coarse: &CoarseLevel<D>,
        right: &[f64],
    ) -> Result<(Vec<f64>, SolverEffort)> {
        let matrix = |x: &[f64], y: &mut [f64]| self.multiply::<1>(x, y);
        let preconditioner = TwoLevel::<D, 1>::new(self, coarse, fine);
        // Affine solutions are met at once, and what is nothing but rounding is not given to the incomplete factors.
        let (mut x, mut rest) = (vec![0.0; right.len()], vec![0.0; right.len()]);
        coarse.correct::<1>(right, &mut x, &mut rest);
        let (method, progress) = iterate(&matrix, &preconditioner, right, &mut x);
        if !(progress.residual <= ALLOWED) {
            return Err(Error::NotConverged {
                method: method.into(),
                iterations: progress.iterations,
                n_unknowns: right.len(),
                residual: progress.residual,
                allowed: ALLOWED,
                hint: "; look for places where nodes are badly spread, or use fewer nodes with the direct solver"
                    .into(),
            });
        }
        let effort = SolverEffort {
            method,
            iterations: progress.iterations,
            residual: progress.residual,
            n_blocks: self.system.tangent.n_blocks(),
            n_factor_blocks: fine.n_blocks(),
            n_coarse: coarse.n_unknowns(),
        };
        Ok((x, effort))
    }

    /// Solves with two steps of refinement: the pivots are chosen for few entries too.
    fn refine<const W: usize>(&self, factor: &SparseLu, right: &[f64], x: &mut [f64]) {
        let matrix = |x: &[f64], y: &mut [f64]| self.multiply::<W>(x, y);
        let mut r = vec![0.0; right.len()];
        for _ in 0..3 {
            krylov::residual(&matrix, right, x, &mut r);
            let mut step = r.clone();
            step.resize(right.len() + self.border.len() * W, 0.0);
            factor.solve_in_place::<W>(&mut step);
            step.truncate(right.len());
            krylov::add(x, 1.0, &step);
        }
    }

    fn solve_directly(&self, factor: &SparseLu, right: &[f64]) -> Result<(Vec<f64>, SolverEffort)> {
        let (mut x, mut r) = (vec![0.0; right.len()], vec![0.0; right.len()]);
        self.refine::<1>(factor, right, &mut x);
        krylov::residual(&|x: &[f64], y: &mut [f64]| self.multiply::<1>(x, y), right, &x, &mut r);
        let residual = krylov::norm(&r) / krylov::norm(right).max(f64::MIN_POSITIVE);
        if !(residual <= ALLOWED) {
            return Err(Error::Residual { residual, allowed: ALLOWED });
        }
        let n_blocks = self.system.tangent.n_blocks();
        let effort =
            SolverEffort { method: "sparse LU", iterations: 3, residual, n_blocks, n_factor_blocks: 0, n_coarse: 0 };
        Ok((x, effort))
    }
}

/// IDR(4), and GMRES if it fails; the residual told is the true one.
fn iterate(
    matrix: &dyn LinearMap,
    preconditioner: &dyn LinearMap,
    right: &[f64],
    x: &mut [f64],
) -> (&'static str, Progress) {
    let mut r = vec![0.0; right.len()];
    let size = krylov::norm(right);
    let mut total = Progress { iterations: 0, residual: 0.0 };
    if size == 0.0 {
        return ("IDR(4)", total);
    }
    let mut check = |x: &[f64], total: &mut Progress, iterations: usize| {
        krylov::residual(matrix, right, x, &mut r);
        total.iterations += iterations;
        total.residual = krylov::norm(&r) / size;
        total.residual
    };
    let limits = Limits { target: TARGET, iterations: MOST_ITERATIONS };
    for _ in 0..STARTS {
        let found = krylov::idr::<1>(matrix, preconditioner, right, x, limits);
        let residual = check(x, &mut total, found.iterations);
        if residual <= ALLOWED {
            return ("IDR(4)", total);
        }
        if !residual.is_finite() || total.iterations >= MOST_ITERATIONS {
            break;
        }
    }
    if !total.residual.is_finite() || total.residual > 1.0 {
        x.fill(0.0);
    }
    let found = krylov::gmres(matrix, preconditioner, right, x, RESTART, limits);
    check(x, &mut total, found.iterations);
    ("GMRES", total)
}

/// Coarse correction first, then the incomplete factors on what is left.
struct TwoLevel<'a, const D: usize, const W: usize> {
    solver: &'a PreparedSolver<'a, D>,
    coarse: &'a CoarseLevel<D>,
    fine: &'a IncompleteFactor<D>,
    /// Working memory, of one thread at a time.
    memory: Mutex<[Vec<f64>; 3]>,
}

impl<'a, const D: usize, const W: usize> TwoLevel<'a, D, W> {
    fn new(solver: &'a PreparedSolver<'a, D>, coarse: &'a CoarseLevel<D>, fine: &'a IncompleteFactor<D>) -> Self {
        let n = solver.system.load.len() * W;
        Self { solver, coarse, fine, memory: Mutex::new(std::array::from_fn(|_| vec![0.0; n])) }
    }
}

impl<const D: usize, const W: usize> LinearMap for TwoLevel<'_, D, W> {
    fn apply(&self, r: &[f64], z: &mut [f64]) {
        let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        let [rest, fine, work] = &mut *memory;
        self.coarse.correct::<W>(r, z, rest);
        self.solver.add_border::<W>(-1.0, z, rest);
        self.fine.solve::<W>(rest, fine, work);
        krylov::add(z, 1.0, fine);
    }
}

/// Translations and rotations about the middle, as orthogonal unit vectors in the plane and nearly so in space.
fn rigid_motions<const D: usize>(positions: &[Vector<D>]) -> Vec<Vec<f64>> {
    let center = positions.iter().fold(Vector::<D>::zeros(), |s, p| s + p) / positions.len() as f64;
    let mut motions: Vec<Vec<f64>> = vec![];
    let mut add = |motion: &dyn Fn(&Vector<D>) -> Vector<D>| {
        let mut v: Vec<f64> =
            positions.iter().flat_map(|p| motion(&(p - center)).iter().copied().collect::<Vec<_>>()).collect();
        for m in &motions {
            let along = krylov::dot(m, &v);
            krylov::add(&mut v, -along, m);
        }
        let length = krylov::norm(&v);
        if length > 0.0 {
            v.iter_mut().for_each(|x| *x /= length);
            motions.push(v);
        }
    };
    for d in 0..D {
        add(&|_| axis(d));
    }
    for a in 0..D {
        for b in 0..a {
            add(&|p| axis::<D>(a) * p[b] - axis::<D>(b) * p[a]);
        }
    }
    motions
}
