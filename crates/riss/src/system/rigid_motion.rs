//! Rigid motions: which are free, and how the mean ones are removed.

use super::block_matrix::BlockMatrix;
use super::discretization::Discretization;
use super::galerkin::Scratch;
use crate::approximation::moving_least_squares::Derivatives;
use crate::error::{Error, Result};
use crate::math::{Vector2, turn_left};
use crate::model::{Model, RigidMotion};
use nalgebra::{Matrix3, Vector3};

/// A motion counts as free if its share in the supports falls below this fraction of the largest.
const FREE: f64 = 1e-9;

/// The three rigid motions at a point: along x, along y, and the rotation around `center`, scaled by `size`.
fn motions(at: Vector2, center: Vector2, size: f64) -> [Vector2; 3] {
    [Vector2::x(), Vector2::y(), turn_left(at - center) / size]
}

/// Pieces of the body that share no node: a crack right through it makes two.
pub fn pieces(matrix: &BlockMatrix) -> Vec<u32> {
    let n = matrix.n_nodes();
    let mut root: Vec<u32> = (0..n as u32).collect();
    fn find(root: &mut [u32], mut i: u32) -> u32 {
        while root[i as usize] != i {
            root[i as usize] = root[root[i as usize] as usize];
            i = root[i as usize];
        }
        i
    }
    for i in 0..n {
        for &j in &matrix.columns[matrix.row_starts[i]..matrix.row_starts[i + 1]] {
            let (a, b) = (find(&mut root, i as u32), find(&mut root, j));
            // The smaller index leads, so that the answer does not depend on the order.
            root[a.max(b) as usize] = a.min(b);
        }
    }
    (0..n as u32).map(|i| find(&mut root, i)).collect()
}

/// Load on a piece below this fraction of the largest nodal load is none.
const UNLOADED: f64 = 1e-9;

/// Checks that supports and springs hold every piece of the body. Returns the nodes of pieces that cracks have cut out
/// and that nothing holds or loads: they stay where they are.
///
/// # Errors
/// [`Error::FreeRigidMotion`] names the motion and the piece.
pub fn check_held(model: &Model, discrete: &Discretization, matrix: &BlockMatrix, load: &[f64]) -> Result<Vec<usize>> {
    let mut loose = vec![];
    let force = |i: usize| Vector2::new(load[2 * i], load[2 * i + 1]).norm();
    let largest = (0..matrix.n_nodes()).map(force).fold(0.0, f64::max);
    let piece_of = pieces(matrix);
    let mut leaders: Vec<u32> = piece_of.clone();
    leaders.sort_unstable();
    leaders.dedup();
    let several = leaders.len() > 1;
    let positions = &discrete.approximation.nodes().positions;
    let rows = support_rows(model, discrete)?;
    let main = largest_piece(&piece_of);
    for leader in leaders {
        let members: Vec<Vector2> =
            positions.iter().zip(&piece_of).filter(|(_, p)| **p == leader).map(|(x, _)| *x).collect();
        let center = members.iter().sum::<Vector2>() / members.len() as f64;
        let size = members.iter().map(|x| (x - center).norm()).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
        let mut held = Matrix3::zeros();
        if model.rigid_motion == RigidMotion::MeanIsZero {
            if leader == main {
                continue;
            }
        } else {
            for (node, at, direction, weight) in &rows {
                if piece_of[*node as usize] == leader {
                    let row = Vector3::from(motions(*at, center, size).map(|m| m.dot(direction)));
                    held += row * row.transpose() * *weight;
                }
            }
        }
        let eigen = held.symmetric_eigen();
        let (index, least) = eigen.eigenvalues.argmin();
        if !(least > FREE * eigen.eigenvalues.max()) {
            let of_piece = || (0..piece_of.len()).filter(|i| piece_of[*i] == leader);
            if several && held == Matrix3::zeros() && of_piece().all(|i| force(i) <= UNLOADED * largest) {
                loose.extend(of_piece());
                continue;
            }
            let motion =
                describe(eigen.eigenvectors.column(index).into_owned(), center, size, held == Matrix3::zeros());
            return Err(Error::FreeRigidMotion { motion, component: several.then_some(center) });
        }
    }
    Ok(loose)
}

/// The piece with most nodes, the first of equals.
fn largest_piece(piece_of: &[u32]) -> u32 {
    let mut counts = vec![0u32; piece_of.len()];
    piece_of.iter().for_each(|p| counts[*p as usize] += 1);
    let most = counts.iter().copied().max().unwrap_or(0);
    counts.iter().position(|c| *c == most).unwrap_or(0) as u32
}

fn describe(motion: Vector3<f64>, center: Vector2, size: f64, nothing_held: bool) -> String {
    if nothing_held {
        return "every motion (two translations and the rotation)".into();
    }
    let [x, y, turn] = [motion[0], motion[1], motion[2]];
    if turn.abs() < 1e-6 {
        return match (x.abs() < 1e-6, y.abs() < 1e-6) {
            (false, true) => "the translation along x".into(),
            (true, false) => "the translation along y".into(),
            _ => format!("the translation along ({:.4}, {:.4})", x, y),
        };
    }
    // v(x) = (x, y) + turn (x - center)⊥ / size vanishes at the pole.
    let pole = center + Vector2::new(-y, x) * (size / turn);
    format!("the rotation around ({:.6}, {:.6})", pole.x, pole.y)
}

/// Supported directions: a node nearby, position, direction, weight.
fn support_rows(model: &Model, discrete: &Discretization) -> Result<Vec<(u32, Vector2, Vector2, f64)>> {
    let mut rows = vec![];
    for (i, element) in discrete.boundary.iter().enumerate() {
        let holds = |part: usize| model.domain.parts[part].edges.contains(&element.edge);
        let Some(&node) = discrete.boundary_nodes.get(i).first() else { continue };
        for point in &element.points {
            let at = point.field_point();
            for s in model.supports.iter().filter(|s| holds(s.part)) {
                rows.push((node, point.position, s.direction.vector(&at), point.weight));
            }
            for s in model.springs.iter().filter(|s| holds(s.part) && s.stiffness.value(&at) > 0.0) {
                rows.push((node, point.position, s.direction.vector(&at), point.weight));
            }
        }
    }
    let length = model.domain.area().sqrt();
    let mut scratch = Scratch::default();
    for support in &model.point_supports {
        let sight = discrete.sight_at(model, support.at);
        discrete.approximation.evaluate(
            support.at,
            sight,
            Derivatives::First,
            &mut scratch.around,
            &mut scratch.shape,
        )?;
        for d in 0..2 {
            if support.displacement[d].is_some() {
                rows.push((scratch.shape.neighbors[0], support.at, Vector2::ith(d, 1.0), length));
            }
        }
    }
    Ok(rows)
}

/// Body force that holds a body whose loads do not balance: `uniform + turning · (x - center)⊥` [stress/length].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BalancingForce {
    center: Vector2,
    uniform: Vector2,
    turning: f64,
}

impl BalancingForce {
    /// Force per volume at a point [stress/length].
    pub fn at(&self, p: Vector2) -> Vector2 {
        self.uniform + turn_left(p - self.center) * self.turning
    }
}

/// Mean rigid motion of the body, and the forces that balance its loads [CPM, section 4.2].
pub struct MeanMotion {
    center: Vector2,
    size: f64,
    /// `∫ r_i · r_j` over the body.
    mass: Matrix3<f64>,
    /// `∫ φ_I` and first moments, function by function: `∫ φ_I (x - center)`.
    moments: Vec<(f64, Vector2)>,
}

impl MeanMotion {
    /// Integrates the shape functions over the body.
    pub fn new(discrete: &Discretization) -> Result<Self> {
        let nodes = discrete.approximation.nodes();
        let center = nodes.positions.iter().sum::<Vector2>() / nodes.len() as f64;
        let size = nodes.positions.iter().map(|x| (x - center).norm()).fold(0.0, f64::max);
        let mut result = Self {
            center,
            size,
            mass: Matrix3::zeros(),
            moments: vec![(0.0, Vector2::zeros()); discrete.n_functions()],
        };
        let mut scratch = Scratch::default();
        for cell in 0..discrete.cells.len() {
            discrete.approximation.survey(&discrete.cells.bounds(cell), &mut scratch.around);
            for point in &discrete.cells.points[crate::integration::cells::as_usize(&discrete.cells.point_ranges[cell])]
            {
                let at = point.position;
                let Scratch { around, shape, .. } = &mut scratch;
                discrete.approximation.evaluate_surveyed(at, at, Derivatives::First, around, shape)?;
                let r = motions(at, center, size);
                result.mass += Matrix3::from_fn(|i, j| r[i].dot(&r[j]) * point.weight);
                for (&i, &phi) in shape.neighbors.iter().zip(&shape.values) {
                    let moment = &mut result.moments[i as usize];
                    moment.0 += phi * point.weight;
                    moment.1 += (at - center) * (phi * point.weight);
                }
            }
        }
        Ok(result)
    }

    /// Adds the body force (a combination of rigid motions) that balances a load vector; returns it, and how large
    /// the imbalance was, relative to the loads.
    pub fn balance(&self, positions: &[Vector2], load: &mut [f64]) -> (BalancingForce, f64) {
        let (mut resultant, mut total) = (Vector3::zeros(), 0.0);
        for (i, x) in positions.iter().enumerate() {
            let f = Vector2::new(load[2 * i], load[2 * i + 1]);
            resultant += Vector3::from(motions(*x, self.center, self.size).map(|m| m.dot(&f)));
            total += f.norm();
        }
        let Some(inverse) = self.mass.try_inverse() else { return (BalancingForce::default(), 0.0) };
        let factors = inverse * -resultant;
        let force = BalancingForce {
            center: self.center,
            uniform: Vector2::new(factors[0], factors[1]),
            turning: factors[2] / self.size,
        };
        for (i, (mass, moment)) in self.moments.iter().enumerate() {
            let f = force.uniform * *mass + turn_left(*moment) * force.turning;
            load[2 * i] += f.x;
            load[2 * i + 1] += f.y;
        }
        (force, if total > 0.0 { resultant.norm() / total } else { 0.0 })
    }

    /// Takes the mean displacement and rotation out of the nodal parameters.
    pub fn remove_mean(&self, positions: &[Vector2], parameters: &mut [Vector2]) {
        let mut mean = Vector3::zeros();
        for (u, (mass, moment)) in parameters.iter().zip(&self.moments) {
            mean += Vector3::new(u.x * mass, u.y * mass, u.dot(&turn_left(*moment)) / self.size);
        }
        let Some(inverse) = self.mass.try_inverse() else { return };
        let factors = inverse * mean;
        for (u, x) in parameters.iter_mut().zip(positions) {
            let r = motions(*x, self.center, self.size);
            *u -= r[0] * factors[0] + r[1] * factors[1] + r[2] * factors[2];
        }
    }
}
