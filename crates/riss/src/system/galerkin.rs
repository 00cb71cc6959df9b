//! Stiffness matrix and load vector of the weak form [EFG, Eqs. 19-22].

use super::block_matrix::{BlockMatrix, LocalMatrix, RowBuffer};
use super::cell_blocks::CellBlocks;
use super::constraints;
use super::crack_faces;
use super::discretization::Discretization;
use super::patches::{Patch, patches};
use super::settings::ConstraintMethod;
use crate::approximation::moving_least_squares::Derivatives;
use crate::approximation::point_batch::{PointBatch, Wanted};
use crate::approximation::{ShapeFunctions, Surroundings};
use crate::error::Result;
use crate::integration::cells::as_usize;
use crate::math::lanes::{Arch, GROUP};
use crate::math::{Matrix2, Vector2};
use crate::model::{FieldPoint, Model};
use rayon::prelude::*;
use std::ops::Range;

/// Patches of cells whose matrices are computed in parallel before they are added in order.
const PATCHES: usize = 64;
/// Boundary elements, or elements of crack faces, in the same way.
pub(super) const ELEMENTS: usize = 2048;
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
    let patches = patches(discrete);
    system
        .add(patches.len(), PATCHES, |i, scratch, local| patch_matrix(model, discrete, &patches[i], scratch, local))?;
    let supports = constraints::Supports::new(model, method);
    system.add(discrete.boundary.len(), ELEMENTS, |i, scratch, local| {
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
    /// Points of a plain cell.
    batch: PointBatch,
    /// Values at all points of a cell, where wanted: point by point, `stride` numbers each.
    values: Vec<f64>,
    /// Gradients in the same order, x and y apart; zero beyond the nodes.
    gradients: [Vec<f64>; 2],
    stride: usize,
    /// Flux of each function through the outline, then its correction.
    fluxes: [Vec<f64>; 2],
    weighted: Vec<[[f64; 2]; 2]>,
    /// Indices of the nodes of a cell among those of its patch.
    places: Vec<u32>,
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

    /// Computes `n` local matrices, `at_once` in parallel, and adds them in order.
    pub(super) fn add(
        &mut self,
        n: usize,
        at_once: usize,
        compute: impl Fn(usize, &mut Scratch, &mut LocalMatrix) -> Result<()> + Sync,
    ) -> Result<()> {
        let mut locals = vec![LocalMatrix::default(); at_once.min(n)];
        let mut rows = vec![RowBuffer::default(); 4 * rayon::current_num_threads()];
        for start in (0..n).step_by(at_once) {
            let batch = &mut locals[..at_once.min(n - start)];
            batch
                .par_iter_mut()
                .enumerate()
                .with_min_len(at_once.div_ceil(128))
                .map_init(Scratch::default, |scratch, (k, local)| compute(start + k, scratch, local))
                .collect::<Result<Vec<()>>>()?;
            self.matrix.scatter(batch, &mut rows);
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

/// What is wanted at the points of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fields {
    /// Gradients, corrected or smoothed.
    Gradients,
    /// Values too, as they are.
    ValuesToo,
}

/// Shape functions at all points of one cell, into `scratch`.
pub fn cell_functions(discrete: &Discretization, cell: usize, fields: Fields, scratch: &mut Scratch) -> Result<()> {
    let cells = &discrete.cells;
    let (n, n_points) = (discrete.cell_nodes.get(cell).len(), cells.point_ranges[cell].len());
    scratch.stride = n.next_multiple_of(GROUP);
    let buffers = scratch.gradients.iter_mut().chain((fields == Fields::ValuesToo).then_some(&mut scratch.values));
    for buffer in buffers {
        buffer.clear();
        buffer.resize(n_points * scratch.stride, 0.0);
    }
    if n_points == 0 {
        return Ok(());
    }
    let outline = as_usize(&cells.edge_ranges[cell]);
    let is_plain = discrete.plain_cells[cell];
    if cells.smoothing.is_some() {
        if fields == Fields::ValuesToo {
            point_functions(discrete, cell, fields, scratch)?;
        }
        return smooth_gradients(discrete, cell, scratch);
    }
    if !(is_plain && plain_functions(discrete, cell, outline.clone(), fields, scratch)) {
        point_functions(discrete, cell, fields, scratch)?;
        point_fluxes(discrete, cell, outline.clone(), scratch)?;
    }
    if !outline.is_empty() {
        correct_gradients(discrete, cell, scratch);
    }
    Ok(())
}

/// Functions and fluxes of a plain cell, all points at once; false if a fit is poor.
fn plain_functions(
    discrete: &Discretization,
    cell: usize,
    outline: Range<usize>,
    fields: Fields,
    scratch: &mut Scratch,
) -> bool {
    let (cells, approximation, nodes) = (&discrete.cells, &discrete.approximation, discrete.cell_nodes.get(cell));
    let Scratch { batch, values, gradients, fluxes, stride, .. } = scratch;
    approximation.fill_nodes(nodes.iter().copied(), batch);
    if !outline.is_empty() {
        batch.set_points(cells.edge_points[outline].iter().map(|p| (p.position, p.normal)));
        if !approximation.evaluate_batch(Wanted::Fluxes, batch) {
            return false;
        }
        std::mem::swap(fluxes, &mut batch.fluxes);
    }
    let points = &cells.points[as_usize(&cells.point_ranges[cell])];
    batch.set_points(points.iter().map(|p| (p.position, Vector2::zeros())));
    if !approximation.evaluate_batch(Wanted::Gradients, batch) {
        return false;
    }
    // From node by node to point by point.
    let transpose = |from: &[f64], to: &mut [f64]| {
        for a in 0..nodes.len() {
            for (q, number) in from[a * batch.stride()..][..points.len()].iter().enumerate() {
                to[q * *stride + a] = *number;
            }
        }
    };
    (0..2).for_each(|d| transpose(&batch.gradients[d], &mut gradients[d]));
    if fields == Fields::ValuesToo {
        transpose(&batch.values, values);
    }
    true
}

/// Functions of any cell, point by point.
fn point_functions(discrete: &Discretization, cell: usize, fields: Fields, scratch: &mut Scratch) -> Result<()> {
    let nodes = discrete.cell_nodes.get(cell);
    let Scratch { around, shape, values, gradients: [gx, gy], stride, .. } = scratch;
    discrete.approximation.survey(&discrete.cells.bounds(cell), around);
    for (q, point) in discrete.cells.points[as_usize(&discrete.cells.point_ranges[cell])].iter().enumerate() {
        let (at, start) = (point.position, q * *stride);
        discrete.approximation.evaluate_surveyed(at, at, Derivatives::First, around, shape)?;
        for_each_local(nodes, &shape.neighbors, |a, k| {
            (gx[start + a], gy[start + a]) = (shape.gradients[k].x, shape.gradients[k].y);
        });
        if fields == Fields::ValuesToo {
            for_each_local(nodes, &shape.neighbors, |a, k| values[start + a] = shape.values[k]);
        }
    }
    Ok(())
}

/// Fluxes `∮ φ n` through the outline of any cell that was surveyed, point by point.
fn point_fluxes(discrete: &Discretization, cell: usize, outline: Range<usize>, scratch: &mut Scratch) -> Result<()> {
    let nodes = discrete.cell_nodes.get(cell);
    let Scratch { around, shape, fluxes, .. } = scratch;
    for flux in fluxes.iter_mut() {
        flux.clear();
        flux.resize(nodes.len(), 0.0);
    }
    for point in &discrete.cells.edge_points[outline] {
        discrete.approximation.evaluate_surveyed(point.position, point.sight, Derivatives::First, around, shape)?;
        for_each_local(nodes, &shape.neighbors, |a, k| {
            (0..2).for_each(|d| fluxes[d][a] += shape.values[k] * point.normal[d]);
        });
    }
    Ok(())
}

/// Makes the gradients at each point the mean over its part, `∮ φ n / A` [Chen2001], drawn towards the mean over the cell
/// where the stabilization is less than one [Puso2008].
fn smooth_gradients(discrete: &Discretization, cell: usize, scratch: &mut Scratch) -> Result<()> {
    let (cells, nodes) = (&discrete.cells, discrete.cell_nodes.get(cell));
    let Some(smoothing) = &cells.smoothing else { return Ok(()) };
    let points = &cells.points[as_usize(&cells.point_ranges[cell])];
    let outline = as_usize(&cells.edge_ranges[cell]);
    let Scratch { around, shape, gradients, stride, .. } = scratch;
    discrete.approximation.survey(&cells.bounds(cell), around);
    gradients.iter_mut().for_each(|g| g.fill(0.0));
    for (point, between) in cells.edge_points[outline.clone()].iter().zip(&smoothing.between[outline]) {
        discrete.approximation.evaluate_surveyed(point.position, point.sight, Derivatives::First, around, shape)?;
        for (part, normal) in between.iter().zip([point.normal, -point.normal]) {
            let Some(part) = part else { continue };
            let start = *part as usize * *stride;
            for_each_local(nodes, &shape.neighbors, |a, k| {
                (0..2).for_each(|d| gradients[d][start + a] += shape.values[k] * normal[d]);
            });
        }
    }
    let area: f64 = points.iter().map(|p| p.weight).sum();
    for g in gradients {
        for a in 0..nodes.len() {
            let mean = (0..points.len()).map(|q| g[q * *stride + a]).sum::<f64>() / area;
            for (q, point) in points.iter().enumerate() {
                let own = g[q * *stride + a] / point.weight;
                g[q * *stride + a] = mean + smoothing.share * (own - mean);
            }
        }
    }
    Ok(())
}

/// Makes each node's mean gradient over the cell equal to the flux of its shape function through the outline:
/// `g + (∮ φ n - Σ w g) / Σ w` [Duan2012]. Linear patch tests then hold to round-off.
fn correct_gradients(discrete: &Discretization, cell: usize, scratch: &mut Scratch) {
    let n = discrete.cell_nodes.get(cell).len();
    let points = &discrete.cells.points[as_usize(&discrete.cells.point_ranges[cell])];
    let area: f64 = points.iter().map(|p| p.weight).sum();
    for (g, c) in scratch.gradients.iter_mut().zip(&mut scratch.fluxes) {
        let of_point = |q: usize| q * scratch.stride..q * scratch.stride + n;
        for (q, point) in points.iter().enumerate() {
            c.iter_mut().zip(&g[of_point(q)]).for_each(|(c, g)| *c -= point.weight * g);
        }
        c.iter_mut().for_each(|c| *c /= area);
        for q in 0..points.len() {
            g[of_point(q)].iter_mut().zip(&*c).for_each(|(g, c)| *g += c);
        }
    }
}

/// Displacement gradient at point `q` of a cell whose gradients are in `scratch`.
fn cell_displacement_gradient(nodes: &[u32], q: usize, scratch: &Scratch, parameters: &[Vector2]) -> Matrix2 {
    let [gx, gy] = &scratch.gradients;
    let start = q * scratch.stride;
    let terms = nodes.iter().zip(gx[start..].iter().zip(&gy[start..]));
    terms.fold(Matrix2::zeros(), |sum, (&i, (&x, &y))| sum + parameters[i as usize] * Vector2::new(x, y).transpose())
}

/// Cells whose gradients lie together before they are joined.
const CELLS_AT_ONCE: usize = 64;

/// Displacement gradients of a solution at all integration points, in their order.
///
/// # Errors
/// Those of the shape functions.
pub fn displacement_gradients(discrete: &Discretization, parameters: &[Vector2]) -> Result<Vec<Matrix2>> {
    let n_cells = discrete.cells.len();
    let blocks: Vec<Vec<Matrix2>> = (0..n_cells.div_ceil(CELLS_AT_ONCE))
        .into_par_iter()
        .map_init(Scratch::default, |scratch, block| {
            let mut gradients = vec![];
            for cell in block * CELLS_AT_ONCE..n_cells.min((block + 1) * CELLS_AT_ONCE) {
                cell_functions(discrete, cell, Fields::Gradients, scratch)?;
                let (nodes, n_points) = (discrete.cell_nodes.get(cell), discrete.cells.point_ranges[cell].len());
                let scratch = &*scratch;
                gradients.extend((0..n_points).map(|q| cell_displacement_gradient(nodes, q, scratch, parameters)));
            }
            Ok(gradients)
        })
        .collect::<Result<_>>()?;
    Ok(blocks.concat())
}

/// Stiffness and body force of the cells of a patch.
fn patch_matrix(
    model: &Model,
    discrete: &Discretization,
    patch: &Patch,
    scratch: &mut Scratch,
    local: &mut LocalMatrix,
) -> Result<()> {
    local.reset(&patch.nodes);
    let fields = if model.body_force.is_some() { Fields::ValuesToo } else { Fields::Gradients };
    let lame = [model.material.lame(), model.material.shear()];
    for &cell in &patch.cells {
        let cell = cell as usize;
        let points = &discrete.cells.points[as_usize(&discrete.cells.point_ranges[cell])];
        cell_functions(discrete, cell, fields, scratch)?;
        let Scratch { values, gradients: [gx, gy], stride, weighted, places, .. } = &mut *scratch;
        places.clear();
        for_each_local(&patch.nodes, discrete.cell_nodes.get(cell), |place, _| places.push(place as u32));
        if let Some(body) = &model.body_force {
            for (q, point) in points.iter().enumerate() {
                let at = FieldPoint { position: point.position, normal: Vector2::zeros() };
                let force = Vector2::new(body.0[0].value(&at), body.0[1].value(&at)) * point.weight;
                for (place, value) in places.iter().zip(&values[q * *stride..]) {
                    (0..2).for_each(|d| local.load[2 * *place as usize + d] += value * force[d]);
                }
            }
        }
        let gradients = [gx.as_slice(), gy.as_slice()];
        Arch::new().dispatch(CellBlocks { lame, points, gradients, stride: *stride, weighted, places, local });
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
