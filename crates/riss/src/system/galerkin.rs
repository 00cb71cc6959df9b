//! Stiffness matrix and load vector of the weak form [EFG, Eqs. 19-22].

use super::block_matrix::{BlockMatrix, LocalMatrix};
use super::constraints;
use super::crack_faces;
use super::discretization::Discretization;
use super::settings::ConstraintMethod;
use crate::approximation::moving_least_squares::Derivatives;
use crate::approximation::{ShapeFunctions, Surroundings};
use crate::error::Result;
use crate::integration::IntegrationPoint;
use crate::integration::cells::{Smoothing, as_usize};
use crate::math::{Matrix2, Vector2};
use crate::model::{FieldPoint, Model};
use rayon::prelude::*;

/// Cells whose matrices are computed in parallel before they are added in order.
const BATCH: usize = 2048;
/// Added to the diagonal of additional functions, over the diagonal.
const REGULARIZATION: f64 = 1e-11;

/// The assembled system, per unit thickness.
#[derive(Clone, Debug)]
pub struct LinearSystem {
    /// Stiffness, with the terms of supports that are not multipliers.
    pub matrix: BlockMatrix,
    /// Load vector, node-major.
    pub load: Vec<f64>,
}

/// Assembles cells, boundary and crack face loads, springs and supports.
pub fn assemble(model: &Model, discrete: &Discretization, method: &ConstraintMethod) -> Result<LinearSystem> {
    let n = discrete.n_functions();
    let extra = constraints::point_lists(model, discrete)?;
    let lists = [&discrete.cell_nodes, &discrete.boundary_nodes, &extra];
    let mut system = LinearSystem { matrix: BlockMatrix::of_pattern(n, &lists), load: vec![0.0; 2 * n] };
    let n_cells = discrete.cells.len();
    system.add(n_cells, |i, scratch, local| cell_matrix(model, discrete, i, scratch, local))?;
    let supports = constraints::Supports::new(model, method);
    system.add(discrete.boundary.len(), |i, scratch, local| {
        constraints::boundary_matrix(model, discrete, &supports, i, scratch, local)
    })?;
    constraints::add_point_loads(model, discrete, &mut system.load)?;
    crack_faces::add_face_loads(model, discrete, &mut system.load)?;
    if discrete.approximation.tied_tips().is_empty() {
        system.regularize(discrete.n_nodes());
    }
    Ok(system)
}

/// Buffers of one thread.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// Buffers of the approximation.
    pub around: Surroundings,
    /// Shape functions at a point.
    pub shape: ShapeFunctions<2>,
    /// Gradients at all points of a cell, point by point, x and y apart.
    gradients: [Vec<f64>; 2],
    /// Gradient corrections of the cell.
    correction: [Vec<f64>; 2],
    /// Products of gradients: xx, yy (lower triangle) and xy (full), row by row.
    products: [Vec<f64>; 3],
}

impl LinearSystem {
    /// Makes the parameters of additional functions, those from `first` on, unique.
    ///
    /// Where all nodes around are enriched, `Σ φ_I x_I F = x F`, and the functions of a tip are dependent by
    /// `y F_4 - x F_3 = y F_2` and `y F_3 + x F_4 = y F_1`. Such parts of the solution are nothing but zero, and a little
    /// stiffness keeps their parameters small.
    fn regularize(&mut self, first: usize) {
        for dof in 2 * first..self.load.len() {
            let diagonal = self.matrix.blocks[self.matrix.row_starts[dof / 2 + 1] - 1][3 * (dof % 2)];
            self.matrix.add_diagonal(dof, REGULARIZATION * diagonal);
        }
    }

    /// Computes `n` local matrices in parallel and adds them in order.
    pub(super) fn add(
        &mut self,
        n: usize,
        compute: impl Fn(usize, &mut Scratch, &mut LocalMatrix) -> Result<()> + Sync,
    ) -> Result<()> {
        let mut locals = vec![LocalMatrix::default(); BATCH.min(n)];
        for start in (0..n).step_by(BATCH.max(1)) {
            let batch = &mut locals[..BATCH.min(n - start)];
            batch
                .par_iter_mut()
                .enumerate()
                .with_min_len(16)
                .map_init(Scratch::default, |scratch, (k, local)| compute(start + k, scratch, local))
                .collect::<Result<Vec<()>>>()?;
            self.matrix.scatter(batch);
            for local in batch.iter() {
                for (k, &i) in local.nodes.iter().enumerate() {
                    self.load[2 * i as usize] += local.load[2 * k];
                    self.load[2 * i as usize + 1] += local.load[2 * k + 1];
                }
            }
        }
        Ok(())
    }
}

/// Sees a point of a cell and the shape functions there, without corrections.
pub type Visitor<'a> = &'a mut dyn FnMut(&IntegrationPoint<2>, &ShapeFunctions<2>);

/// Shape function gradients at all points of one cell, corrected or smoothed, into `scratch`.
pub fn cell_gradients(
    discrete: &Discretization,
    cell: usize,
    scratch: &mut Scratch,
    mut visit: Option<Visitor>,
) -> Result<()> {
    let nodes = discrete.cell_nodes.get(cell);
    let n = nodes.len();
    let points = &discrete.cells.points[as_usize(&discrete.cells.point_ranges[cell])];
    let Scratch { around, shape, gradients, correction, .. } = scratch;
    discrete.approximation.survey(&discrete.cells.bounds(cell), around);
    for g in gradients.iter_mut() {
        g.clear();
        g.resize(n * points.len(), 0.0);
    }
    let smoothing = discrete.cells.smoothing.as_ref();
    for (q, point) in points.iter().enumerate() {
        if smoothing.is_some() && visit.is_none() {
            break;
        }
        let at = point.position;
        discrete.approximation.evaluate_surveyed(at, at, Derivatives::First, around, shape)?;
        if let Some(visit) = &mut visit {
            visit(point, shape);
        }
        if smoothing.is_some() {
            continue;
        }
        for_each_local(nodes, &shape.neighbors, |a, k| {
            gradients[0][q * n + a] = shape.gradients[k].x;
            gradients[1][q * n + a] = shape.gradients[k].y;
        });
    }
    match smoothing {
        Some(smoothing) => smooth_gradients(discrete, smoothing, cell, around, shape, gradients),
        None => correct_gradients(discrete, cell, nodes, around, shape, gradients, correction),
    }
}

/// Makes the gradients at each point the mean over its part, `∮ φ n / A` [Chen2001], drawn towards the mean over the cell
/// where the stabilization is less than one [Puso2008].
fn smooth_gradients(
    discrete: &Discretization,
    smoothing: &Smoothing,
    cell: usize,
    around: &mut Surroundings,
    shape: &mut ShapeFunctions<2>,
    gradients: &mut [Vec<f64>; 2],
) -> Result<()> {
    let (cells, nodes) = (&discrete.cells, discrete.cell_nodes.get(cell));
    let points = &cells.points[as_usize(&cells.point_ranges[cell])];
    let outline = as_usize(&cells.edge_ranges[cell]);
    let n = nodes.len();
    for (point, between) in cells.edge_points[outline.clone()].iter().zip(&smoothing.between[outline]) {
        discrete.approximation.evaluate_surveyed(point.position, point.sight, Derivatives::First, around, shape)?;
        for (part, normal) in between.iter().zip([point.normal, -point.normal]) {
            let Some(part) = part else { continue };
            let start = *part as usize * n;
            for_each_local(nodes, &shape.neighbors, |a, k| {
                gradients[0][start + a] += shape.values[k] * normal.x;
                gradients[1][start + a] += shape.values[k] * normal.y;
            });
        }
    }
    let area: f64 = points.iter().map(|p| p.weight).sum();
    for g in gradients {
        for a in 0..n {
            let mean = (0..points.len()).map(|q| g[q * n + a]).sum::<f64>() / area;
            for (q, point) in points.iter().enumerate() {
                let own = g[q * n + a] / point.weight;
                g[q * n + a] = mean + smoothing.share * (own - mean);
            }
        }
    }
    Ok(())
}

/// Displacement gradient at point `q` of a cell whose gradients are in `scratch`.
pub fn cell_displacement_gradient(nodes: &[u32], q: usize, scratch: &Scratch, parameters: &[Vector2]) -> Matrix2 {
    let n = nodes.len();
    let [gx, gy] = &scratch.gradients;
    let terms = nodes.iter().zip(gx[q * n..].iter().zip(&gy[q * n..]));
    terms.fold(Matrix2::zeros(), |sum, (&i, (&x, &y))| sum + parameters[i as usize] * Vector2::new(x, y).transpose())
}

/// Stiffness and body force of one cell.
fn cell_matrix(
    model: &Model,
    discrete: &Discretization,
    cell: usize,
    scratch: &mut Scratch,
    local: &mut LocalMatrix,
) -> Result<()> {
    let nodes = discrete.cell_nodes.get(cell);
    let n = nodes.len();
    local.reset(nodes);
    let points = &discrete.cells.points[as_usize(&discrete.cells.point_ranges[cell])];
    let mut add_body_force = |point: &IntegrationPoint<2>, shape: &ShapeFunctions<2>| {
        let Some(body) = &model.body_force else { return };
        let at = FieldPoint { position: point.position, normal: Vector2::zeros() };
        let force = Vector2::new(body.0[0].value(&at), body.0[1].value(&at)) * point.weight;
        for_each_local(nodes, &shape.neighbors, |a, k| {
            local.load[2 * a] += shape.values[k] * force.x;
            local.load[2 * a + 1] += shape.values[k] * force.y;
        });
    };
    let visitor = model.body_force.as_ref().map(|_| &mut add_body_force as Visitor);
    cell_gradients(discrete, cell, scratch, visitor)?;
    let Scratch { gradients, products, .. } = scratch;
    for (k, product) in products.iter_mut().enumerate() {
        product.clear();
        product.resize(if k == 2 { n * n } else { n * (n + 1) / 2 }, 0.0);
    }
    for (q, point) in points.iter().enumerate() {
        accumulate(point.weight, &gradients[0][q * n..][..n], &gradients[1][q * n..][..n], products);
    }
    let (lambda, mu) = (model.material.lame(), model.material.shear());
    let [xx, yy, xy] = products;
    for a in 0..n {
        for b in 0..=a {
            let k = a * (a + 1) / 2 + b;
            // K = w [λ g gᵀ + μ g gᵀ transposed + μ g·g I].
            local.blocks[k] = [
                (lambda + 2.0 * mu) * xx[k] + mu * yy[k],
                lambda * xy[a * n + b] + mu * xy[b * n + a],
                lambda * xy[b * n + a] + mu * xy[a * n + b],
                (lambda + 2.0 * mu) * yy[k] + mu * xx[k],
            ];
        }
    }
    Ok(())
}

/// Adds the products of the gradients at one point.
#[inline]
fn accumulate(weight: f64, gx: &[f64], gy: &[f64], products: &mut [Vec<f64>; 3]) {
    let n = gx.len();
    let [xx, yy, xy] = products;
    let mut start = 0;
    for a in 0..n {
        let (wx, wy) = (weight * gx[a], weight * gy[a]);
        let rows = xx[start..start + a + 1].iter_mut().zip(&mut yy[start..start + a + 1]);
        for ((x, y), (&bx, &by)) in rows.zip(gx[..=a].iter().zip(&gy[..=a])) {
            *x += wx * bx;
            *y += wy * by;
        }
        for (v, &by) in xy[a * n..(a + 1) * n].iter_mut().zip(gy) {
            *v += wx * by;
        }
        start += a + 1;
    }
}

/// Makes each node's mean gradient over the cell equal to the flux of its shape function through the outline:
/// `g + (∮ φ n - Σ w g) / Σ w` [Duan2012]. Linear patch tests then hold to round-off.
fn correct_gradients(
    discrete: &Discretization,
    cell: usize,
    nodes: &[u32],
    around: &mut Surroundings,
    shape: &mut ShapeFunctions<2>,
    gradients: &mut [Vec<f64>; 2],
    correction: &mut [Vec<f64>; 2],
) -> Result<()> {
    let outline = &discrete.cells.edge_points[as_usize(&discrete.cells.edge_ranges[cell])];
    if outline.is_empty() {
        return Ok(());
    }
    let n = nodes.len();
    for c in correction.iter_mut() {
        c.clear();
        c.resize(n, 0.0);
    }
    for point in outline {
        discrete.approximation.evaluate_surveyed(point.position, point.sight, Derivatives::First, around, shape)?;
        for_each_local(nodes, &shape.neighbors, |a, k| {
            correction[0][a] += shape.values[k] * point.normal.x;
            correction[1][a] += shape.values[k] * point.normal.y;
        });
    }
    let points = &discrete.cells.points[as_usize(&discrete.cells.point_ranges[cell])];
    let area: f64 = points.iter().map(|p| p.weight).sum();
    for (c, g) in correction.iter_mut().zip(gradients) {
        for (q, point) in points.iter().enumerate() {
            for a in 0..n {
                c[a] -= point.weight * g[q * n + a];
            }
        }
        for v in c.iter_mut() {
            *v /= area;
        }
        for q in 0..points.len() {
            for a in 0..n {
                g[q * n + a] += c[a];
            }
        }
    }
    Ok(())
}

/// Calls `visit(local index, index in neighbors)` for each neighbor; both lists ascend and the first holds the second.
#[inline]
pub fn for_each_local(nodes: &[u32], neighbors: &[u32], mut visit: impl FnMut(usize, usize)) {
    let mut a = 0;
    for (k, &i) in neighbors.iter().enumerate() {
        while nodes[a] != i {
            a += 1;
        }
        visit(a, k);
    }
}
