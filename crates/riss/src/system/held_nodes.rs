//! Displacements prescribed at the nodes themselves, where finite elements stand along the supports
//! [EFG, section 3.1; Krongauz1996].

use super::constraints::{ConstraintRow, Supports};
use super::discretization::Discretization;
use super::galerkin::LinearSystem;
use super::solve::Solution;
use crate::math::{Matrix2, Vector2, cross, turn_left};
use crate::model::{FieldPoint, Model, PartId};
use std::collections::BTreeMap;

/// Directions at a node that differ by less than this sine count as one.
const SAME_DIRECTION: f64 = 0.05;

/// A prescribed component of a displacement.
#[derive(Clone, Copy, Debug)]
struct Component {
    direction: Vector2,
    value: f64,
    part: PartId,
}

/// A node with prescribed components, one or two.
#[derive(Clone, Debug)]
struct HeldNode {
    node: usize,
    components: Vec<Component>,
    /// Axes in which the node is solved for: columns.
    axes: Matrix2,
    /// Prescribed displacement along each axis [length].
    values: [Option<f64>; 2],
}

/// All held nodes, and the system before they were held.
#[derive(Clone, Debug)]
pub(super) struct HeldNodes {
    nodes: Vec<HeldNode>,
    free: LinearSystem,
}

impl HeldNode {
    fn new(node: usize, components: Vec<Component>) -> Self {
        let first = &components[0];
        if let Some(second) = components.get(1) {
            let rows = Matrix2::from_rows(&[first.direction.transpose(), second.direction.transpose()]);
            let inverse = rows.try_inverse().expect("the directions differ");
            let u = inverse * Vector2::new(first.value, second.value);
            return Self { node, components, axes: Matrix2::identity(), values: [Some(u.x), Some(u.y)] };
        }
        let axes = Matrix2::from_columns(&[first.direction, turn_left(first.direction)]);
        let values = [Some(first.value), None];
        Self { node, components, axes, values }
    }

    /// Parts of the force on the node: each component's share.
    fn shares(&self, force: Vector2) -> Vec<(PartId, Vector2)> {
        match &self.components[..] {
            [a, b] => {
                let columns = Matrix2::from_columns(&[a.direction, b.direction]);
                let shares = columns.try_inverse().expect("the directions differ") * force;
                vec![(a.part, a.direction * shares.x), (b.part, b.direction * shares.y)]
            }
            one => one.iter().map(|c| (c.part, c.direction * c.direction.dot(&force))).collect(),
        }
    }
}

/// Prescribed components at each node, in the order of the boundary.
fn components(model: &Model, discrete: &Discretization, on: &Supports) -> BTreeMap<usize, Vec<Component>> {
    let mut result: BTreeMap<usize, Vec<Component>> = BTreeMap::new();
    for segment in &discrete.triangulation.boundary {
        let curve = &model.domain.edges[segment.edge];
        for support in on.on(segment.edge) {
            for (copy, parameter) in segment.points.into_iter().zip(segment.range) {
                let Some(node) = discrete.node_of_copy[copy as usize] else { continue };
                let position = discrete.triangulation.position(copy);
                let at = FieldPoint { position, normal: curve.right_normal(parameter) };
                let direction = support.direction.vector(&at);
                let value = support.value.value(&model.material, support.direction, &at);
                let known = result.entry(node as usize).or_default();
                // Where parts meet, the first one counts, and no more than two directions are free to be prescribed.
                if known.len() < 2 && known.iter().all(|c| cross(c.direction, direction).abs() > SAME_DIRECTION) {
                    known.push(Component { direction, value, part: support.part });
                }
            }
        }
    }
    result
}

impl HeldNodes {
    /// Takes the prescribed displacements out of a system: their equations say them, and all others bear their forces.
    pub fn hold(model: &Model, discrete: &Discretization, on: &Supports, system: &mut LinearSystem) -> Self {
        let held = components(model, discrete, on).into_iter().map(|(node, c)| HeldNode::new(node, c));
        let result = Self { nodes: held.collect(), free: system.clone() };
        result.turn(system);
        result.eliminate(system);
        result
    }

    /// Axes of each node that has its own.
    fn axes(&self, n_nodes: usize) -> Vec<Option<Matrix2>> {
        let mut axes = vec![None; n_nodes];
        for held in self.nodes.iter().filter(|h| h.axes != Matrix2::identity()) {
            axes[held.node] = Some(held.axes);
        }
        axes
    }

    /// Writes the system in the axes of the nodes: `Qᵀ A Q u' = Qᵀ f`.
    fn turn(&self, system: &mut LinearSystem) {
        let n = system.matrix.n_nodes();
        let axes = self.axes(n);
        for i in 0..n {
            for k in system.matrix.row_starts[i]..system.matrix.row_starts[i + 1] {
                let (of_row, of_column) = (axes[i], axes[system.matrix.columns[k] as usize]);
                if of_row.is_none() && of_column.is_none() {
                    continue;
                }
                let [xx, xy, yx, yy] = system.matrix.blocks[k];
                let [row, column] = [of_row, of_column].map(|q| q.unwrap_or(Matrix2::identity()));
                let b = row.transpose() * Matrix2::new(xx, xy, yx, yy) * column;
                system.matrix.blocks[k] = [b[(0, 0)], b[(0, 1)], b[(1, 0)], b[(1, 1)]];
            }
            if let Some(q) = axes[i] {
                let f = q.transpose() * Vector2::new(system.load[2 * i], system.load[2 * i + 1]);
                (system.load[2 * i], system.load[2 * i + 1]) = (f.x, f.y);
            }
        }
    }

    fn eliminate(&self, system: &mut LinearSystem) {
        let mut values: Vec<Option<f64>> = vec![None; system.load.len()];
        for held in &self.nodes {
            [values[2 * held.node], values[2 * held.node + 1]] = held.values;
        }
        let LinearSystem { matrix, load } = system;
        for i in 0..matrix.row_starts.len() - 1 {
            for k in matrix.row_starts[i]..matrix.row_starts[i + 1] {
                let j = matrix.columns[k] as usize;
                for entry in 0..4 {
                    let (p, q) = (2 * i + entry / 2, 2 * j + entry % 2);
                    if p == q || (values[p].is_none() && values[q].is_none()) {
                        continue;
                    }
                    let coefficient = std::mem::take(&mut matrix.blocks[k][entry]);
                    match (values[p], values[q]) {
                        (None, Some(value)) => load[p] -= coefficient * value,
                        // Both halves of a block on the diagonal are stored.
                        (Some(value), None) if i != j => load[q] -= coefficient * value,
                        _ => {}
                    }
                }
            }
        }
        for (dof, value) in values.iter().enumerate() {
            if let Some(value) = value {
                let last = matrix.row_starts[dof / 2 + 1] - 1;
                load[dof] = matrix.blocks[last][3 * (dof % 2)] * value;
            }
        }
    }

    /// Writes equations in the axes of the nodes.
    pub fn turn_rows(&self, rows: &mut [ConstraintRow], n_nodes: usize) {
        let axes = self.axes(n_nodes);
        for row in rows {
            let mut turned: BTreeMap<usize, f64> = BTreeMap::new();
            for &(dof, c) in &row.entries {
                match axes.get(dof / 2).copied().flatten() {
                    Some(q) => {
                        for d in 0..2 {
                            *turned.entry(dof / 2 * 2 + d).or_default() += q[(dof % 2, d)] * c;
                        }
                    }
                    None => *turned.entry(dof).or_default() += c,
                }
            }
            row.entries = turned.into_iter().collect();
        }
    }

    /// Turns the parameters of a solution back, and computes the forces of the supports.
    pub fn finish(&self, solution: &mut Solution) {
        for held in &self.nodes {
            solution.parameters[held.node] = held.axes * solution.parameters[held.node];
        }
        let u: Vec<f64> = solution.parameters.iter().flat_map(|p| [p.x, p.y]).collect();
        let mut forces = vec![0.0; u.len()];
        self.free.matrix.multiply(&u, &mut forces);
        for held in &self.nodes {
            let [x, y] = [0, 1].map(|d| forces[2 * held.node + d] - self.free.load[2 * held.node + d]);
            solution.support_forces.extend(held.shares(Vector2::new(x, y)));
        }
    }
}
