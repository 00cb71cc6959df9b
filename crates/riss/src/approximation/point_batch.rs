//! Shape functions at many points at once, one point in each lane of the vector registers.
//!
//! For points that see all nodes in reach and whose basis is plain polynomials, with circular supports: the same fit as in
//! [`super::mls`], over one list of nodes for all points. A node out of reach of a point has weight zero there, so that
//! nothing branches. Points do not mix: a point has the same functions in whatever batch it stands. Where a fit is poor,
//! the path for single points must decide.

use super::lane_fit::{self, LaneBasis};
use super::moving_least_squares::POOR_PIVOT;
use super::settings::{Basis, WeightFunction};
use crate::math::Vector2;
use crate::math::lanes::{Arch, GROUP, Lanes, Simd, WithSimd};

/// What is wanted of the points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// Smallest scaled pivot of the moment matrix, and which nodes are in reach.
    Quality,
    /// Values, and their sums times given normals.
    Fluxes,
    /// Values and gradients.
    Gradients,
}

/// Nodes, points and the functions of the nodes at the points, node by node. A buffer.
#[derive(Clone, Debug, Default)]
pub struct PointBatch {
    /// Position of each node, and its inverse squared support radius.
    pub(super) nodes: Vec<[f64; 3]>,
    /// Positions of the points axis by axis, then normals; the last point is repeated, with no normal, to fill the lanes.
    pub(super) points: [Vec<f64>; 4],
    n_points: usize,
    /// Values and the two parts of the gradients: `stride` numbers for each node.
    pub values: Vec<f64>,
    /// See `values`.
    pub gradients: [Vec<f64>; 2],
    /// `Σ φ n` of each node over the points, x and y apart, where fluxes are wanted.
    pub fluxes: [Vec<f64>; 2],
    /// Whether each node reaches a point, where the quality is wanted.
    pub is_reached: Vec<bool>,
    /// Of each point: smallest pivot over its diagonal entry, and number of nodes in reach, where the quality is wanted.
    pub quality: [Vec<f64>; 2],
    /// Weight and slope of each node at the points in the registers.
    pub(super) weights: Vec<[[f64; GROUP]; 2]>,
    /// Of each node: fluxes in each lane, or the number of points in reach.
    pub(super) sums: Vec<[[f64; GROUP]; 2]>,
    is_regular: bool,
}

impl PointBatch {
    /// Starts with nodes: position and inverse squared support radius of each.
    pub fn set_nodes(&mut self, nodes: impl Iterator<Item = [f64; 3]>) {
        self.nodes.clear();
        self.nodes.extend(nodes);
    }

    /// Takes points, with normals if there are any.
    pub fn set_points(&mut self, points: impl Iterator<Item = (Vector2, Vector2)>) {
        self.points.iter_mut().for_each(Vec::clear);
        for (at, normal) in points {
            for (list, number) in self.points.iter_mut().zip([at.x, at.y, normal.x, normal.y]) {
                list.push(number);
            }
        }
        self.n_points = self.points[0].len();
        let stride = self.n_points.next_multiple_of(GROUP);
        for (k, list) in self.points.iter_mut().enumerate() {
            let fill = if k < 2 { list.last().copied().unwrap_or(0.0) } else { 0.0 };
            list.resize(stride, fill);
        }
    }

    /// Numbers from one node to the next; those beyond the points mean nothing.
    pub fn stride(&self) -> usize {
        self.points[0].len()
    }

    /// Number of nodes.
    pub fn n_nodes(&self) -> usize {
        self.nodes.len()
    }

    /// Computes what is wanted; false if the moment matrix of a point is poor.
    pub fn evaluate(&mut self, basis: Basis, function: WeightFunction, wanted: Wanted) -> bool {
        let (n, stride) = (self.nodes.len(), self.stride());
        self.is_regular = true;
        self.weights.resize(n, [[0.0; GROUP]; 2]);
        self.sums.clear();
        self.sums.resize(n, [[0.0; GROUP]; 2]);
        match wanted {
            Wanted::Gradients => {
                self.values.resize(n * stride, 0.0);
                self.gradients.iter_mut().for_each(|g| g.resize(n * stride, 0.0));
            }
            Wanted::Fluxes => self.fluxes.iter_mut().for_each(|f| f.resize(n, 0.0)),
            Wanted::Quality => {
                self.is_reached.resize(n, false);
                self.quality.iter_mut().for_each(|q| q.resize(stride, 0.0));
            }
        }
        Arch::new().dispatch(Job { batch: self, basis, function, wanted });
        self.is_regular
    }
}

struct Job<'a> {
    batch: &'a mut PointBatch,
    basis: Basis,
    function: WeightFunction,
    wanted: Wanted,
}

impl WithSimd for Job<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        match self.basis {
            Basis::Linear => run::<S, 3>(simd, self),
            Basis::Quadratic => run::<S, 6>(simd, self),
        }
    }
}

#[inline(always)]
fn run<S: Simd, const M: usize>(simd: S, job: Job)
where
    [(); M]: LaneBasis<S, M>,
{
    let Job { batch, function, wanted, .. } = job;
    for group in 0..batch.n_points.div_ceil(S::F64_LANES) {
        let (moments, reached) = lane_fit::moments::<S, M>(simd, batch, group, function, wanted);
        let (factor, quality) = lane_fit::factor(simd, &moments);
        batch.is_regular &= lane_fit::none_below(simd, quality, POOR_PIVOT);
        match wanted {
            Wanted::Quality => {
                let [qualities, counts] = &mut batch.quality;
                quality.store(qualities, group);
                reached.store(counts, group);
            }
            Wanted::Fluxes => lane_fit::fluxes(simd, batch, group, &factor),
            Wanted::Gradients => lane_fit::gradients(simd, batch, group, &factor),
        }
    }
    match wanted {
        Wanted::Quality => {
            for (is_reached, [n, _]) in batch.is_reached.iter_mut().zip(&batch.sums) {
                *is_reached = Lanes::load(simd, n, 0).sum() > 0.0;
            }
        }
        Wanted::Fluxes => {
            let [x, y] = &mut batch.fluxes;
            for ((x, y), sums) in x.iter_mut().zip(y).zip(&batch.sums) {
                *x = Lanes::load(simd, &sums[0], 0).sum();
                *y = Lanes::load(simd, &sums[1], 0).sum();
            }
        }
        Wanted::Gradients => {}
    }
}
