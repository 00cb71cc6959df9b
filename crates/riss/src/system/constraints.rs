//! Terms of the boundary: tractions, springs, point forces, and essential conditions by all methods
//! [EFG, section 3.1; Nitsche1971].

use super::block_matrix::LocalMatrix;
use super::discretization::{Discretization, NodeLists};
use super::galerkin::{Scratch, for_each_local};
use super::settings::{ConstraintMethod, NITSCHE_FACTOR};
use crate::approximation::ShapeFunctions;
use crate::approximation::moving_least_squares::Derivatives;
use crate::error::Result;
use crate::geometry::curve::Curve;
use crate::integration::{BoundaryElement, BoundaryPoint};
use crate::material::Elasticity;
use crate::math::Vector2;
use crate::model::{BoundaryLoad, BoundarySupport, EdgeId, Model, Spring};
use std::collections::BTreeMap;

/// What acts on each edge, and how supports enter the matrix.
#[derive(Clone, Debug)]
pub struct Supports<'a> {
    loads: Vec<Vec<&'a BoundaryLoad>>,
    supports: Vec<Vec<&'a BoundarySupport>>,
    springs: Vec<Vec<&'a Spring>>,
    is_curved: Vec<bool>,
    method: ConstraintMethod,
}

impl<'a> Supports<'a> {
    /// Sorts loads, supports and springs by edge.
    pub fn new(model: &'a Model, method: &ConstraintMethod) -> Self {
        let domain = &model.domain;
        let n = domain.edges.len();
        let (mut loads, mut supports, mut springs) = (vec![vec![]; n], vec![vec![]; n], vec![vec![]; n]);
        for load in &model.loads {
            match load.part {
                Some(part) => domain.parts[part].edges.iter().for_each(|&e| loads[e].push(load)),
                None => domain.outline().for_each(|e| loads[e].push(load)),
            }
        }
        for support in &model.supports {
            domain.parts[support.part].edges.iter().for_each(|&e| supports[e].push(support));
        }
        for spring in &model.springs {
            domain.parts[spring.part].edges.iter().for_each(|&e| springs[e].push(spring));
        }
        let is_curved = domain.edges.iter().map(|e| matches!(e, Curve::Arc { .. })).collect();
        Self { loads, supports, springs, is_curved, method: *method }
    }

    /// Supports alone.
    pub fn without_loads(self) -> Self {
        Self { loads: vec![vec![]; self.loads.len()], springs: vec![vec![]; self.springs.len()], ..self }
    }

    /// Supports on an edge.
    pub fn on(&self, edge: EdgeId) -> &[&'a BoundarySupport] {
        &self.supports[edge]
    }

    /// Whether boundary tractions of the solution enter, and the stabilization of an element [stress/length].
    pub fn terms(&self, material: &Elasticity, element: &BoundaryElement) -> (bool, f64) {
        let stiffness = (material.lame() + 2.0 * material.shear()) / element.length;
        match self.method {
            ConstraintMethod::Nitsche { factor } => (true, factor * stiffness),
            ConstraintMethod::Penalty { factor } => (false, factor * stiffness),
            ConstraintMethod::ModifiedVariational => (true, 0.0),
            ConstraintMethod::LagrangeMultipliers => (false, 0.0),
            // What is prescribed at nodes leaves a gap between a chord and its arc.
            ConstraintMethod::FiniteElementCoupled if self.is_curved[element.edge] => {
                (true, NITSCHE_FACTOR * stiffness)
            }
            ConstraintMethod::FiniteElementCoupled => (false, 0.0),
        }
    }
}

/// Traction along `direction` of each unit nodal parameter at a boundary point: `(σ(φ e_j) n) · d` for j = x, y.
fn unit_traction(material: &Elasticity, gradient: Vector2, normal: Vector2, direction: Vector2) -> Vector2 {
    let (lambda, mu) = (material.lame(), material.shear());
    gradient * (lambda * normal.dot(&direction))
        + direction * (mu * gradient.dot(&normal))
        + normal * (mu * gradient.dot(&direction))
}

/// Matrix and load of one boundary element.
pub fn boundary_matrix(
    model: &Model,
    discrete: &Discretization,
    on: &Supports,
    element: usize,
    scratch: &mut Scratch,
    local: &mut LocalMatrix,
) -> Result<()> {
    let boundary = &discrete.boundary[element];
    let edge = boundary.edge;
    if on.loads[edge].is_empty() && on.supports[edge].is_empty() && on.springs[edge].is_empty() {
        local.reset(&[]);
        return Ok(());
    }
    let nodes = discrete.boundary_nodes.get(element);
    local.reset(nodes);
    let material = &model.material;
    let (with_traction, stabilization) = on.terms(material, boundary);
    discrete.approximation.survey(&boundary.bounds(), &mut scratch.around);
    for point in &boundary.points {
        let shape = &mut scratch.shape;
        discrete.approximation.evaluate_surveyed(
            point.position,
            point.sight,
            Derivatives::First,
            &mut scratch.around,
            shape,
        )?;
        let at = point.field_point();
        let traction = on.loads[edge].iter().map(|l| l.value.traction(material, &at)).sum::<Vector2>() * point.weight;
        for_each_local(nodes, &shape.neighbors, |a, k| {
            local.load[2 * a] += shape.values[k] * traction.x;
            local.load[2 * a + 1] += shape.values[k] * traction.y;
        });
        for spring in &on.springs[edge] {
            let stiffness = spring.stiffness.value(&at) * point.weight;
            add_term(local, nodes, shape, spring.direction.vector(&at), stiffness, None, 0.0);
        }
        for support in &on.supports[edge] {
            if !with_traction && stabilization == 0.0 {
                continue;
            }
            let direction = support.direction.vector(&at);
            let value = support.value.value(material, support.direction, &at);
            let traction = with_traction.then_some((material, point));
            add_term(local, nodes, shape, direction, stabilization * point.weight, traction, value);
        }
    }
    Ok(())
}

/// Adds `∫ β (u·d - g) v·d`, and `-∫ (t(u)·d v·d + t(v)·d (u·d - g))` if tractions enter.
fn add_term(
    local: &mut LocalMatrix,
    nodes: &[u32],
    shape: &ShapeFunctions<2>,
    direction: Vector2,
    stabilization: f64,
    traction: Option<(&Elasticity, &BoundaryPoint)>,
    value: f64,
) {
    let unit = |k: usize| {
        traction.map_or(Vector2::zeros(), |(material, point)| {
            unit_traction(material, shape.gradients[k], point.normal, direction) * point.weight
        })
    };
    for_each_local(nodes, &shape.neighbors, |a, k| {
        let (phi_a, t_a) = (shape.values[k], unit(k));
        let row = direction * (stabilization * phi_a) - t_a;
        local.load[2 * a] += row.x * value;
        local.load[2 * a + 1] += row.y * value;
        for_each_local(nodes, &shape.neighbors[..=k], |b, l| {
            let (phi_b, t_b) = (shape.values[l], unit(l));
            let m = row * direction.transpose() * phi_b - direction * t_b.transpose() * phi_a;
            let block = local.block_mut(a, b);
            block[0] += m[(0, 0)];
            block[1] += m[(0, 1)];
            block[2] += m[(1, 0)];
            block[3] += m[(1, 1)];
        });
    });
}

/// An equation `Σ coefficient · dof = value`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConstraintRow {
    /// Dofs and coefficients, ascending.
    pub entries: Vec<(usize, f64)>,
    /// Right-hand side.
    pub value: f64,
}

/// Coefficients by dof, and the right-hand side.
type RowSum = (BTreeMap<usize, f64>, f64);

/// Equations of the Lagrange multipliers: linear between the boundary points of each edge [EFG, Eq. 26].
pub fn multiplier_rows(model: &Model, discrete: &Discretization, on: &Supports) -> Result<Vec<ConstraintRow>> {
    // Each edge has its own multipliers, because tractions jump at corners.
    let mut rows: BTreeMap<(EdgeId, usize, u32), RowSum> = BTreeMap::new();
    let mut scratch = Scratch::default();
    for element in &discrete.boundary {
        for (index, support) in on.supports[element.edge].iter().enumerate() {
            for point in &element.points {
                evaluate(discrete, point.position, point.sight, &mut scratch)?;
                let at = point.field_point();
                let direction = support.direction.vector(&at);
                let value = support.value.value(&model.material, support.direction, &at);
                for (end, share) in [(0, 1.0 - point.along), (1, point.along)] {
                    let row = rows.entry((element.edge, index, element.ends[end])).or_default();
                    let weight = share * point.weight;
                    row.1 += weight * value;
                    for (&i, &phi) in scratch.shape.neighbors.iter().zip(&scratch.shape.values) {
                        for d in 0..2 {
                            if direction[d] != 0.0 {
                                *row.0.entry(2 * i as usize + d).or_default() += weight * phi * direction[d];
                            }
                        }
                    }
                }
            }
        }
    }
    let finish =
        |(entries, value): (BTreeMap<usize, f64>, f64)| ConstraintRow { entries: entries.into_iter().collect(), value };
    Ok(rows.into_values().map(finish).collect())
}

fn evaluate(discrete: &Discretization, at: Vector2, sight: Vector2, scratch: &mut Scratch) -> Result<()> {
    discrete.approximation.evaluate(at, sight, Derivatives::First, &mut scratch.around, &mut scratch.shape)
}

/// Equations of the supports at points.
pub fn point_rows(model: &Model, discrete: &Discretization) -> Result<Vec<ConstraintRow>> {
    let mut scratch = Scratch::default();
    let mut rows = vec![];
    for support in &model.point_supports {
        evaluate(discrete, support.at, discrete.sight_at(model, support.at), &mut scratch)?;
        for d in 0..2 {
            if let Some(value) = support.displacement[d] {
                let pairs = scratch.shape.neighbors.iter().zip(&scratch.shape.values);
                rows.push(ConstraintRow { entries: pairs.map(|(&i, &v)| (2 * i as usize + d, v)).collect(), value });
            }
        }
    }
    Ok(rows)
}

/// Neighbors of each point support: they meet in the matrix.
pub fn point_lists(model: &Model, discrete: &Discretization) -> Result<NodeLists> {
    let mut scratch = Scratch::default();
    let mut lists = vec![];
    for support in &model.point_supports {
        evaluate(discrete, support.at, discrete.sight_at(model, support.at), &mut scratch)?;
        lists.push(scratch.shape.neighbors.clone());
    }
    Ok(NodeLists::from_lists(&lists))
}

/// Adds the point forces, per thickness.
pub fn add_point_loads(model: &Model, discrete: &Discretization, load: &mut [f64]) -> Result<()> {
    let mut scratch = Scratch::default();
    for point in &model.point_loads {
        evaluate(discrete, point.at, discrete.sight_at(model, point.at), &mut scratch)?;
        let force = point.force / model.thickness;
        for (&i, &phi) in scratch.shape.neighbors.iter().zip(&scratch.shape.values) {
            load[2 * i as usize] += phi * force.x;
            load[2 * i as usize + 1] += phi * force.y;
        }
    }
    Ok(())
}
