//! Strain energy between displacement fields, by the cells of the nodes.
//!
//! Strains are taken at the centroid of each cell, and their gradients with its second moments, which leaves no field
//! without stiffness that changes sign from node to node [Hillman2016].

use crate::approximation::{FitBuffer, ShapeFunctions};
use crate::error::Result;
use crate::integration::NodeCells;
use crate::math::{Matrix, Vector3};
use crate::model::SurfacePoint;
use crate::system::Collocation;
use nalgebra::DMatrix;
use rayon::prelude::*;

/// Terms of the strain energy at a point: the change of volume, what is left of three strains, three shears.
const TERMS: usize = 7;
/// Points of a cell: its centroid, and one for each axis of its moments.
const POINTS: usize = 4;
/// Nodes that are summed at once, and parts with a sum of their own.
const CHUNK: usize = 16;
const PARTS: usize = 8;

/// What fields do to one another.
pub(super) struct Energy {
    /// Twice the strain energy of each pair of fields [stress·length³].
    pub mutual: DMatrix<f64>,
    /// Integrals of the displacement gradients of each field [length³].
    pub gradients: Vec<Matrix<3>>,
    /// Work of body forces on each field [stress·length³].
    pub body_work: Vec<f64>,
}

impl Energy {
    /// Integrates over the body.
    ///
    /// - `fields`: one in each row, with the displacements of all nodes, node by node
    ///
    /// # Errors
    /// Those of the shape functions.
    pub fn new(collocation: &Collocation<3>, cells: &NodeCells, fields: &DMatrix<f64>) -> Result<Self> {
        let (n, m) = (cells.volumes.len(), fields.nrows());
        let parts: Vec<Result<Self>> = (0..PARTS)
            .into_par_iter()
            .map(|p| {
                let mut sum =
                    Self { mutual: DMatrix::zeros(m, m), gradients: vec![Matrix::zeros(); m], body_work: vec![0.0; m] };
                let mut scratch = Scratch {
                    rows: DMatrix::zeros(m, CHUNK * POINTS * TERMS),
                    columns: DMatrix::zeros(CHUNK * POINTS * TERMS, m),
                    gradients: DMatrix::zeros(m, 9 * POINTS),
                    around: DMatrix::zeros(m, 0),
                    derivatives: DMatrix::zeros(0, 3 * POINTS),
                    ..Scratch::default()
                };
                let nodes = p * n / PARTS..(p + 1) * n / PARTS;
                for start in nodes.clone().step_by(CHUNK) {
                    scratch.rows.fill(0.0);
                    for (k, node) in (start..(start + CHUNK).min(nodes.end)).enumerate() {
                        add_rows(collocation, cells, node, fields, k, &mut scratch, &mut sum)?;
                    }
                    scratch.rows.transpose_to(&mut scratch.columns);
                    sum.mutual.gemm(1.0, &scratch.rows, &scratch.columns, 1.0);
                }
                Ok(sum)
            })
            .collect();
        let mut parts = parts.into_iter();
        let mut total = parts.next().expect("there are parts")?;
        for part in parts {
            let part = part?;
            total.mutual += part.mutual;
            total.gradients.iter_mut().zip(part.gradients).for_each(|(a, b)| *a += b);
            total.body_work.iter_mut().zip(part.body_work).for_each(|(a, b)| *a += b);
        }
        Ok(total)
    }
}

/// Working memory of one thread.
#[derive(Default)]
struct Scratch {
    buffer: FitBuffer<3>,
    shape: ShapeFunctions<3>,
    /// Terms of the strain energy of each field, and the same transposed.
    rows: DMatrix<f64>,
    columns: DMatrix<f64>,
    /// Displacement gradients of each field: by component of the displacement, point and direction.
    gradients: DMatrix<f64>,
    /// Displacements of the neighbors, with room for the most so far.
    around: DMatrix<f64>,
    /// Derivatives of each neighbor's shape function at the points of the cell, with their weights.
    derivatives: DMatrix<f64>,
}

/// Adds the strains of all fields in the cell of a node.
fn add_rows(
    collocation: &Collocation<3>,
    cells: &NodeCells,
    node: usize,
    fields: &DMatrix<f64>,
    place: usize,
    scratch: &mut Scratch,
    sum: &mut Energy,
) -> Result<()> {
    let Scratch { buffer, shape, rows, gradients, around, derivatives, .. } = scratch;
    let cloud = collocation.cloud();
    if cells.volumes[node] == 0.0 {
        return Ok(());
    }
    collocation.approximation.at_node(node as u32, cloud.sights[node], buffer, shape)?;
    let (offset, root) = (cells.offsets[node], cells.volumes[node].sqrt());
    let material = &collocation.solid.material;
    let (mu, bulk) = (material.shear(), material.lame() + material.shear() * 2.0 / 3.0);
    let weights = [bulk.sqrt(), (2.0 * mu).sqrt(), mu.sqrt()];
    let place = place * POINTS * TERMS;
    let n_neighbors = shape.neighbors.len();
    if derivatives.nrows() < n_neighbors {
        around.resize_horizontally_mut(3 * n_neighbors, 0.0);
        derivatives.resize_vertically_mut(n_neighbors, 0.0);
    }
    let spreads = cells.spreads[node];
    for (k, j) in shape.neighbors.iter().enumerate() {
        around.columns_mut(3 * k, 3).copy_from(&fields.columns(3 * *j as usize, 3));
        let (g, h) = (shape.gradients[k], shape.second_derivatives[k]);
        let points = [(g + h * offset) * root, h * spreads[0], h * spreads[1], h * spreads[2]];
        derivatives.row_mut(k).iter_mut().zip(points.iter().flatten()).for_each(|(a, b)| *a = *b);
    }
    let of_neighbors = derivatives.rows(0, n_neighbors);
    for a in 0..3 {
        let component = around.columns_with_step(a, n_neighbors, 2);
        gradients.columns_mut(3 * POINTS * a, 3 * POINTS).gemm(1.0, &component, &of_neighbors, 0.0);
    }
    let force = collocation.solid.body_force.value(&SurfacePoint::inside(cloud.positions[node] + offset));
    for field in 0..fields.nrows() {
        for k in 0..POINTS {
            let g = Matrix::<3>::from_fn(|a, b| gradients[(field, 3 * POINTS * a + 3 * k + b)]);
            let third = g.trace() / 3.0;
            let at = place + k * TERMS;
            rows[(field, at)] = weights[0] * g.trace();
            for d in 0..3 {
                rows[(field, at + 1 + d)] = weights[1] * (g[(d, d)] - third);
                let (a, b) = (d, (d + 1) % 3);
                rows[(field, at + 4 + d)] = weights[2] * (g[(a, b)] + g[(b, a)]);
            }
            if k == 0 {
                let at_node = Vector3::from_fn(|d, _| fields[(field, 3 * node + d)]);
                sum.gradients[field] += g * root;
                sum.body_work[field] += force.dot(&(at_node * root + g * offset)) * root;
            }
        }
    }
    Ok(())
}
