//! Point collocation of elasticity: the strong form at the nodes [C3D, sections 2.2, 2.3].
//!
//! Equations 24 to 28 written with the shape functions of [`ConstrainedMls`], one vector equation for each node. Every
//! row is scaled so that it counts like a displacement: equilibrium with `-h²/E`, tractions with `h/E`, `h` the spacing
//! of nodes in the support. Diagonal blocks are then positive, which the solver needs.

use super::block_rows::{Block, BlockRows, CHUNK, RowChunk};
use super::collocation_settings::CollocationSettings;
use super::node_conditions::{NodeConditions, Strong, StrongTerm};
use super::support_ends::support_ends;
use super::tied_faces::Row;
use crate::approximation::visible_nodes::ball_radius;
use crate::approximation::{ConstrainedMls, EnrichedFront, FitBuffer, ShapeFunctions};
use crate::error::{Error, Result};
use crate::geometry::aabb::Aabb;
use crate::geometry::obstacles::Opaque;
use crate::material::PlaneState;
use crate::math::{Matrix, Vector};
use crate::model::{Solid, SurfacePoint};
use crate::nodes::cloud::{Cloud, Place};
use rayon::prelude::*;
use std::sync::Arc;

/// Largest Poisson's ratio: above it the preconditioner was seen to fail, and errors of the strong form grow.
pub const LARGEST_POISSON: f64 = 0.45;

/// A solid with nodes, ready to be assembled.
pub struct Collocation<const D: usize> {
    /// The problem.
    pub solid: Solid<D>,
    /// Shape functions, with the nodes in the order of the unknowns.
    pub approximation: ConstrainedMls<D>,
    /// Index of each node in the cloud that was given.
    pub origins: Vec<u32>,
    /// Choices.
    pub settings: CollocationSettings,
    /// Whether supports end at each node amid a surface.
    support_ends: Vec<bool>,
}

/// The equations of all nodes: residual `A u - f` and tangent `A` of Newton's method [C3D, Eqs. 19 to 22].
#[derive(Clone, Debug)]
pub struct CollocationSystem<const D: usize> {
    /// The tangent: one block row for each node.
    pub tangent: BlockRows<D>,
    /// `f`, node by node.
    pub load: Vec<f64>,
    /// What holds each node, as a projector on the directions with prescribed displacement.
    pub fixed: Vec<Matrix<D>>,
    /// What a traction on crack faces counts in the row of each node [length/stress]; zero where there is no such face.
    pub face_scales: Vec<f64>,
}

impl<const D: usize> CollocationSystem<D> {
    /// Residual of displacements, node by node [length].
    pub fn residual_into(&self, displacements: &[f64], residual: &mut [f64]) {
        self.tangent.multiply(displacements, residual);
        residual.par_iter_mut().zip(&self.load).for_each(|(r, f)| *r -= f);
    }
}

impl<const D: usize> Collocation<D> {
    /// Orders the nodes along a space-filling curve, so that neighbors are near in memory too, and leaves out those on
    /// fronts if the settings say so.
    pub fn new(
        solid: Solid<D>,
        cloud: &Cloud<D>,
        obstacles: Arc<dyn Opaque<D> + Send>,
        fronts: Vec<EnrichedFront<D>>,
        settings: CollocationSettings,
    ) -> Self {
        let mut origins = morton_order(&cloud.positions);
        if settings.front_nodes.are_omitted() {
            origins.retain(|&i| !matches!(cloud.places[i as usize], Place::Front { .. }));
        }
        let mut own = Cloud::default();
        for &i in &origins {
            let i = i as usize;
            own.push(cloud.positions[i], cloud.sights[i], cloud.spacings[i], cloud.places[i].clone());
        }
        let support_ends = support_ends(&solid, &own);
        let approximation = ConstrainedMls::new(own, obstacles, fronts, settings.approximation);
        Self { solid, approximation, origins, settings, support_ends }
    }

    /// The nodes in the order of the unknowns.
    pub fn cloud(&self) -> &Cloud<D> {
        self.approximation.cloud()
    }

    /// Whether supports end amid a surface.
    pub fn has_support_ends(&self) -> bool {
        self.support_ends.contains(&true)
    }

    /// Writes the equations of all nodes.
    ///
    /// # Errors
    /// [`Error::PoorStencil`] with the first node whose neighbors do not determine its derivatives, and
    /// [`Error::NearlyIncompressible`] above [`LARGEST_POISSON`] except in plane stress.
    pub fn assemble(&self) -> Result<CollocationSystem<D>> {
        let material = &self.solid.material;
        if material.plane == PlaneState::Strain && !(material.poisson <= LARGEST_POISSON) {
            return Err(Error::NearlyIncompressible { poisson: material.poisson, allowed: LARGEST_POISSON });
        }
        let n = self.cloud().len();
        let expected = self.approximation.support_size();
        let parts: Vec<Result<Part<D>>> = (0..n.div_ceil(CHUNK))
            .into_par_iter()
            .map_init(Scratch::default, |scratch, c| {
                let nodes = c * CHUNK..((c + 1) * CHUNK).min(n);
                let mut part = Part {
                    rows: RowChunk::with_capacity(nodes.len() * expected),
                    load: Vec::with_capacity(nodes.len() * D),
                    fixed: Vec::with_capacity(nodes.len()),
                    face_scales: Vec::with_capacity(nodes.len()),
                };
                for node in nodes {
                    self.add_row(node as u32, scratch, &mut part)?;
                }
                Ok(part)
            })
            .collect();
        let (mut rows, mut load, mut fixed) = (vec![], Vec::with_capacity(n * D), Vec::with_capacity(n));
        let mut face_scales = Vec::with_capacity(n);
        for part in parts {
            let part = part?;
            rows.push(part.rows);
            load.extend(part.load);
            fixed.extend(part.fixed);
            face_scales.extend(part.face_scales);
        }
        Ok(CollocationSystem { tangent: BlockRows::new(rows), load, fixed, face_scales })
    }

    /// Displacement gradients at all nodes, `[(i, j)] = ∂u_i/∂x_j`.
    ///
    /// # Errors
    /// Those of the shape functions.
    pub fn gradients(&self, displacements: &[Vector<D>]) -> Result<Vec<Matrix<D>>> {
        (0..self.cloud().len() as u32)
            .into_par_iter()
            .map_init(Scratch::<D>::default, |s, node| {
                self.approximation.at_node(node, self.cloud().sights[node as usize], &mut s.buffer, &mut s.shape)?;
                Ok(s.shape.gradient(displacements))
            })
            .collect()
    }

    /// Equilibrium of the layer of half a spacing on the crack face of a node, in its free directions and at the scale of
    /// its equation.
    pub(super) fn layer(&self, node: u32) -> Result<Row<D>> {
        let Scratch { mut buffer, mut shape, mut entries, mut conditions } = Scratch::default();
        self.look_up(node, &mut conditions);
        let (position, sight) = (self.cloud().positions[node as usize], self.cloud().sights[node as usize]);
        let radius = self.approximation.at_node(node, sight, &mut buffer, &mut shape)?;
        let h = radius / ball_radius::<D>(shape.neighbors.len());
        let factor =
            (Matrix::identity() - conditions.fixed) * (0.5 * h * h / self.solid.material.young * conditions.face_share);
        let load = self.solid.body_force.value(&SurfacePoint::inside(position));
        let term = StrongTerm { equation: Strong::Equilibrium, load, sight };
        self.add_term(&term, &factor, &shape, &mut entries);
        let (columns, blocks) = entries.into_iter().unzip();
        Ok(Row { columns, blocks, load: factor * load })
    }

    fn look_up(&self, node: u32, conditions: &mut NodeConditions<D>) {
        let node = node as usize;
        conditions.look_up(&self.solid, self.cloud(), node, &self.settings, self.support_ends[node]);
    }

    fn add_row(&self, node: u32, scratch: &mut Scratch<D>, part: &mut Part<D>) -> Result<()> {
        let Scratch { buffer, shape, entries, conditions } = scratch;
        self.look_up(node, conditions);
        let free = Matrix::identity() - conditions.fixed;
        entries.clear();
        entries.push((node, to_block(&conditions.fixed)));
        let mut load = conditions.displacement;
        let young = self.solid.material.young;
        // All terms of a row have one scale, or their weights would not be those of their angles.
        let (mut spacing, mut face_scale) = (None, 0.0);
        for term in &conditions.terms {
            let radius = match term.equation {
                Strong::Fit => self.approximation.at_front(node, term.sight, buffer, shape)?,
                Strong::Equilibrium | Strong::Traction { .. } => {
                    self.approximation.at_node(node, term.sight, buffer, shape)?
                }
            };
            let h = *spacing.get_or_insert(radius / ball_radius::<D>(shape.neighbors.len()));
            let scale = match term.equation {
                Strong::Equilibrium => h * h / young,
                Strong::Traction { .. } => {
                    face_scale = h / young * conditions.face_share;
                    h / young
                }
                Strong::Fit => {
                    entries.push((node, to_block(&free)));
                    1.0
                }
            };
            load += free * term.load * scale;
            self.add_term(term, &(free * scale), shape, entries);
        }
        entries.sort_unstable_by_key(|e| e.0);
        part.rows.push(entries);
        part.load.extend(load.iter());
        part.fixed.push(conditions.fixed);
        part.face_scales.push(face_scale);
        Ok(())
    }

    /// Adds the stencil of one equation, `factor` times.
    fn add_term(
        &self,
        term: &StrongTerm<D>,
        factor: &Matrix<D>,
        shape: &ShapeFunctions<D>,
        entries: &mut Vec<(u32, Block<D>)>,
    ) {
        let (lambda, mu) = (self.solid.material.lame(), self.solid.material.shear());
        for (k, &j) in shape.neighbors.iter().enumerate() {
            let block = match &term.equation {
                Strong::Equilibrium => {
                    let h = &shape.second_derivatives[k];
                    h * -(lambda + mu) - Matrix::from_diagonal_element(mu * h.trace())
                }
                Strong::Fit => Matrix::from_diagonal_element(-shape.values[k]),
                Strong::Traction { normal } => {
                    let g = &shape.gradients[k];
                    normal * g.transpose() * lambda
                        + g * normal.transpose() * mu
                        + Matrix::from_diagonal_element(mu * g.dot(normal))
                }
            };
            entries.push((j, to_block(&(factor * block))));
        }
    }
}

/// Rows of a chunk of nodes.
struct Part<const D: usize> {
    rows: RowChunk<D>,
    load: Vec<f64>,
    fixed: Vec<Matrix<D>>,
    face_scales: Vec<f64>,
}

/// Working memory of one thread.
#[derive(Default)]
struct Scratch<const D: usize> {
    buffer: FitBuffer<D>,
    shape: ShapeFunctions<D>,
    entries: Vec<(u32, Block<D>)>,
    conditions: NodeConditions<D>,
}

#[inline]
fn to_block<const D: usize>(m: &Matrix<D>) -> Block<D> {
    std::array::from_fn(|a| std::array::from_fn(|b| m[(a, b)]))
}

/// Indices of points along a Morton curve [Morton1966].
fn morton_order<const D: usize>(positions: &[Vector<D>]) -> Vec<u32> {
    const BITS: u32 = 16;
    let bounds = Aabb::of_points(positions.iter().copied());
    let scale = f64::from((1u32 << BITS) - 1) / bounds.size().max().max(f64::MIN_POSITIVE);
    let key = |p: &Vector<D>| {
        let cell = (p - bounds.lower) * scale;
        (0..BITS)
            .rev()
            .flat_map(|bit| (0..D).map(move |d| (bit, d)))
            .fold(0u64, |key, (bit, d)| key << 1 | (cell[d] as u64) >> bit & 1)
    };
    let mut order: Vec<(u64, u32)> = positions.iter().enumerate().map(|(i, p)| (key(p), i as u32)).collect();
    order.sort_unstable();
    order.into_iter().map(|o| o.1).collect()
}
