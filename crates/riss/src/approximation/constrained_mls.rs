//! Constrained moving least squares: Taylor polynomials through the value at their center [C3D, section 2.1].
//!
//! All derivatives at the center are coefficients of the fit, so nothing is differentiated, and the shape functions
//! take the value one at their own node and zero at the others. Near crack fronts the basis also holds the four
//! functions of [EFG, Eq. 50] with their exact derivatives, and in space these times the length along the front. Between nodes the constraint is dropped.

use super::ShapeFunctions;
use super::front_functions::FrontFrame;
use super::front_sheets::EnrichedFront;
use super::least_squares::{Column, LeastSquares};
use super::settings::{CollocationWeight, ConstrainedMlsSettings};
use super::taylor_basis::TaylorBasis;
use super::tip_functions::MOST_FUNCTIONS;
use super::visible_nodes::VisibleNodes;
use crate::error::{Error, Result};
use crate::geometry::obstacles::Opaque;
use crate::math::{Matrix, Vector};
use crate::nodes::cloud::Cloud;
use std::sync::Arc;

/// Rounds in which the support of a poor fit grows before terms of its basis are given up.
const ROUNDS: usize = 4;
/// Growth of the number of neighbors in each round.
const GROWTH: f64 = 1.3;
/// A function of the basis counts as dependent on those before it if it keeps less than this share of its length.
///
/// Irregular nodes in general position keep 0.02 and more for cubic terms.
const DEPENDENT: f64 = 1e-3;
/// The same for the functions of a front, which far from it resemble polynomials.
const DEPENDENT_FRONT: f64 = 1e-6;
/// Nearer to a front than this share of the support, its functions have no derivatives that could be used.
const CORE: f64 = 1e-6;
/// Farther from a front than this many support radii its functions are left out: so far away they are polynomials of the
/// fourth order but for a part in 10⁵, and fits that must reproduce some of these give equations that no iteration solves.
const FAR: f64 = 4.0;
/// Constrained moving least squares over a cloud.
#[derive(Clone)]
pub struct ConstrainedMls<const D: usize> {
    nodes: VisibleNodes<D>,
    fronts: Vec<EnrichedFront<D>>,
    /// Angles of the nodes at each front [rad].
    angles: Vec<Vec<f64>>,
    /// Unit vectors at half of these.
    half_angles: Vec<Vec<[f64; 2]>>,
    basis: TaylorBasis<D>,
    columns: Vec<Column<D>>,
    settings: ConstrainedMlsSettings,
}

/// Working memory of one thread.
#[derive(Clone, Debug, Default)]
pub struct FitBuffer<const D: usize> {
    candidates: Vec<(f64, u32)>,
    fit: LeastSquares<D>,
}

/// Where a fit is made.
#[derive(Clone, Copy)]
enum Center<const D: usize> {
    /// At a node, whose value it takes.
    Node(u32),
    /// At a node, from the others alone.
    Without(u32),
    /// Anywhere.
    Point(Vector<D>),
}

impl<const D: usize> Center<D> {
    /// The node that is no neighbor.
    fn own(self) -> Option<u32> {
        match self {
            Self::Node(i) | Self::Without(i) => Some(i),
            Self::Point(_) => None,
        }
    }

    /// Whether the fit takes the value of its node.
    fn is_constrained(self) -> bool {
        match self {
            Self::Node(_) => true,
            Self::Without(_) | Self::Point(_) => false,
        }
    }
}

impl<const D: usize> ConstrainedMls<D> {
    /// Prepares the search for neighbors.
    pub fn new(
        cloud: Cloud<D>,
        obstacles: Arc<dyn Opaque<D> + Send>,
        fronts: Vec<EnrichedFront<D>>,
        settings: ConstrainedMlsSettings,
    ) -> Self {
        let basis = TaylorBasis::new(settings.order);
        let columns = (0..basis.len())
            .map(|k| {
                let (gradient, second_derivatives) = basis.derivatives_at_origin(k);
                Column { value: 0.0, gradient, second_derivatives }
            })
            .collect();
        let angles: Vec<Vec<f64>> = fronts.iter().map(|f| f.angles(&cloud)).collect();
        let half = |angle: &f64| (0.5 * angle).sin_cos();
        let halves = |angles: &Vec<f64>| angles.iter().map(half).map(|(s, c)| [c, s]).collect();
        let half_angles = angles.iter().map(halves).collect();
        Self { nodes: VisibleNodes::new(cloud, obstacles), fronts, angles, half_angles, basis, columns, settings }
    }

    /// The nodes.
    pub fn cloud(&self) -> &Cloud<D> {
        self.nodes.cloud()
    }

    /// The nearest node that sees a point, with working memory; none if no node does.
    pub fn nearest(&self, at: Vector<D>, found: &mut Vec<(f64, u32)>) -> Option<u32> {
        self.nodes.nearest(at, found)
    }

    /// Number of nodes of a support, its center included.
    pub fn support_size(&self) -> usize {
        self.settings.neighbors.unwrap_or_else(|| default_neighbors::<D>(self.basis.len()))
    }

    /// Shape functions and derivatives at a node, seen from `sight`; the node comes first. Returns the support radius.
    ///
    /// # Errors
    /// [`Error::PoorStencil`] if its neighbors do not determine second derivatives.
    pub fn at_node(
        &self,
        node: u32,
        sight: Vector<D>,
        buffer: &mut FitBuffer<D>,
        shape: &mut ShapeFunctions<D>,
    ) -> Result<f64> {
        self.evaluate(Center::Node(node), self.cloud().positions[node as usize], sight, buffer, shape)
    }

    /// Shape functions at a node of a front by the other nodes: what the field takes there if it is regular.
    ///
    /// Only the values mean anything where the basis is enriched. Returns the support radius.
    ///
    /// # Errors
    /// [`Error::PoorStencil`] if the neighbors do not determine second derivatives.
    pub fn at_front(
        &self,
        node: u32,
        sight: Vector<D>,
        buffer: &mut FitBuffer<D>,
        shape: &mut ShapeFunctions<D>,
    ) -> Result<f64> {
        self.evaluate(Center::Without(node), self.cloud().positions[node as usize], sight, buffer, shape)
    }

    /// Shape functions and derivatives anywhere, seen from `sight`. Returns the support radius.
    ///
    /// # Errors
    /// [`Error::PoorStencil`] if the neighbors do not determine second derivatives.
    pub fn at_point(
        &self,
        at: Vector<D>,
        sight: Vector<D>,
        buffer: &mut FitBuffer<D>,
        shape: &mut ShapeFunctions<D>,
    ) -> Result<f64> {
        self.evaluate(Center::Point(at), at, sight, buffer, shape)
    }

    fn evaluate(
        &self,
        center: Center<D>,
        at: Vector<D>,
        sight: Vector<D>,
        buffer: &mut FitBuffer<D>,
        shape: &mut ShapeFunctions<D>,
    ) -> Result<f64> {
        let mut wanted = self.support_size();
        let FitBuffer { candidates, fit } = buffer;
        for round in 0..=ROUNDS {
            let radius = self.nodes.nearest_into(center.own(), at, sight, wanted, candidates);
            let rank = self.fit(center, at, sight, radius, candidates, fit);
            // In the last round higher terms may go, such as the third power across a body of three layers.
            let complete = if round < ROUNDS { rank.is_complete } else { rank.n_leading == self.n_needed() };
            if complete {
                self.write(center, candidates, fit, shape);
                return Ok(radius);
            }
            wanted = (wanted as f64 * GROWTH).ceil() as usize;
        }
        Err(self.poor(center, at, candidates.len()))
    }

    /// Number of terms up to second order.
    fn n_needed(&self) -> usize {
        self.basis.len().min(super::taylor_basis::n_derivatives::<D>())
    }

    #[cold]
    fn poor(&self, center: Center<D>, at: Vector<D>, n_neighbors: usize) -> Error {
        let node = center.own().map(|i| i as usize);
        Error::PoorStencil { node, position: at.iter().copied().collect(), n_neighbors, needed: self.basis.len() }
    }

    /// The front whose functions are in the basis at a point, with its frame there.
    fn frame(&self, center: Center<D>, at: Vector<D>, radius: f64) -> Option<(usize, FrontFrame<D>)> {
        let core = match center {
            Center::Node(_) | Center::Point(_) => CORE * radius,
            Center::Without(_) => -1.0,
        };
        let near = self.fronts.iter().enumerate().filter_map(|(f, front)| {
            let (distance, frame) = front.within_reach(at, front.reach)?;
            let [x, y] = frame.plane(at);
            let r = x.hypot(y);
            (r > core && r < FAR * radius).then_some((distance, f, frame))
        });
        near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, f, frame)| (f, frame))
    }

    /// Fits the basis to unit values of the neighbors.
    fn fit(
        &self,
        center: Center<D>,
        at: Vector<D>,
        sight: Vector<D>,
        radius: f64,
        neighbors: &[(f64, u32)],
        fit: &mut LeastSquares<D>,
    ) -> Rank {
        let (has_constant, front) = (!center.is_constrained(), self.frame(center, at, radius));
        let n_columns = self.basis.len() + usize::from(has_constant) + front.map_or(0, |_| n_front_functions::<D>());
        let scale = 1.0 / (radius * radius);
        fit.start(radius, self.settings.weight, neighbors.iter().map(|n| n.0 * scale), n_columns);
        if has_constant {
            fit.add_constant();
        }
        let inverse = 1.0 / radius;
        let offset = |n: &(f64, u32)| (self.cloud().positions[n.1 as usize] - at) * inverse;
        fit.add_monomials(self.basis.factors(), &self.columns, neighbors.iter().map(offset));
        let n_leading = self.n_needed();
        let kept_constant = !has_constant || fit.orthogonalize(1, DEPENDENT) == 1;
        let kept = fit.orthogonalize(n_leading, DEPENDENT);
        let rest = self.basis.len() - n_leading;
        let is_complete = fit.orthogonalize(rest, DEPENDENT) == rest && kept == n_leading && kept_constant;
        if let Some((front, frame)) = front.filter(|_| is_complete) {
            let angle = match center.own() {
                Some(i) => self.angles[front][i as usize],
                None => self.fronts[front].angle(&frame, sight),
            };
            self.enrich((front, &frame), at, angle, radius, neighbors, fit);
        }
        Rank { is_complete, n_leading: if kept_constant { kept } else { 0 } }
    }

    /// Adds the functions of a front; in space also their products with the length along it, since the factors and the
    /// axes of a front change along it.
    fn enrich(
        &self,
        (front, frame): (usize, &FrontFrame<D>),
        at: Vector<D>,
        angle: f64,
        radius: f64,
        neighbors: &[(f64, u32)],
        fit: &mut LeastSquares<D>,
    ) {
        let jets = frame.jets(at, angle);
        let (scale, tangent) = (1.0 / radius.sqrt(), frame.tangent());
        // On the front itself only the value counts.
        let slope = if frame.polar(at, angle)[0] > CORE * radius { scale * radius } else { 0.0 };
        let columns: [Column<D>; 2 * MOST_FUNCTIONS] = std::array::from_fn(|k| {
            if slope == 0.0 {
                return Column::zero();
            }
            let jet = &jets[k % MOST_FUNCTIONS];
            if k < MOST_FUNCTIONS {
                let second_derivatives = jet.second_derivatives * (slope * radius);
                return Column { value: 0.0, gradient: jet.gradient * slope, second_derivatives };
            }
            let mixed = tangent * jet.gradient.transpose();
            let second_derivatives = (mixed + mixed.transpose()) * slope;
            Column { value: 0.0, gradient: tangent * (jet.value * scale), second_derivatives }
        });
        let count = n_front_functions::<D>();
        fit.add_columns(&columns[..count], neighbors, |j, values| {
            let place = self.cloud().positions[j as usize];
            let f = frame.values(place, self.half_angles[front][j as usize]);
            let along = (place - at).dot(&tangent) / radius;
            for (k, value) in values.iter_mut().enumerate() {
                *value = match k.checked_sub(MOST_FUNCTIONS) {
                    None => (f[k] - jets[k].value) * scale,
                    Some(k) => f[k] * scale * along,
                };
            }
        });
        fit.orthogonalize_twice(count, DEPENDENT_FRONT);
    }

    /// Solves for the derivatives and writes them.
    fn write(
        &self,
        center: Center<D>,
        neighbors: &[(f64, u32)],
        fit: &mut LeastSquares<D>,
        shape: &mut ShapeFunctions<D>,
    ) {
        let is_node = center.is_constrained();
        let first = usize::from(is_node);
        let n = first + neighbors.len();
        shape.neighbors.clear();
        shape.neighbors.extend(center.own().filter(|_| is_node));
        shape.neighbors.extend(neighbors.iter().map(|n| n.1));
        shape.values.clear();
        shape.values.resize(n, 0.0);
        shape.gradients.resize(n, Vector::zeros());
        shape.second_derivatives.resize(n, Matrix::zeros());
        fit.solve(!is_node);
        let mut lines = fit.lines();
        // The center takes part through the differences u_I - u_y [C3D, Eq. 10].
        for d in 0..D {
            let line = lines.next().unwrap_or_default();
            for (gradient, v) in shape.gradients[first..].iter_mut().zip(line) {
                gradient[d] = *v;
            }
            if is_node {
                shape.gradients[0][d] = -sum(line);
            }
        }
        for (a, b) in (0..D).flat_map(|a| (a..D).map(move |b| (a, b))) {
            let line = lines.next().unwrap_or_default();
            for (second, v) in shape.second_derivatives[first..].iter_mut().zip(line) {
                (second[(a, b)], second[(b, a)]) = (*v, *v);
            }
            if is_node {
                let own = -sum(line);
                (shape.second_derivatives[0][(a, b)], shape.second_derivatives[0][(b, a)]) = (own, own);
            }
        }
        if is_node {
            shape.values[0] = 1.0;
        } else {
            shape.values.copy_from_slice(lines.next().unwrap_or_default());
        }
    }
}

/// Sum of a list, in several parts so that additions need not wait for one another.
fn sum(list: &[f64]) -> f64 {
    let (chunks, rest) = list.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for chunk in chunks {
        for (sum, v) in sums.iter_mut().zip(chunk) {
            *sum += v;
        }
    }
    sums.iter().chain(rest).sum()
}

/// How much of a basis the neighbors determine.
struct Rank {
    is_complete: bool,
    /// Terms up to second order.
    n_leading: usize,
}

/// Number of functions of a front in the basis.
const fn n_front_functions<const D: usize>() -> usize {
    if D == 3 { 2 * MOST_FUNCTIONS } else { MOST_FUNCTIONS }
}

/// Nodes of a support for `l` terms: 7.89 L in space [C3D, after Eq. 12]; in the plane 4.44 L reach as far.
fn default_neighbors<const D: usize>(l: usize) -> usize {
    let ratio = if D == 2 { 4.44 } else { 7.89 };
    (ratio * l as f64).floor() as usize
}

impl CollocationWeight {
    /// Replaces squared relative distances, from 0 to 1, by square roots of the weights.
    pub fn to_roots(self, numbers: &mut [f64]) {
        match self {
            Self::NonSmooth => numbers.iter_mut().for_each(|s2| *s2 = 1.0 - s2.sqrt().sqrt()),
            Self::Smooth(function) => {
                numbers.iter_mut().for_each(|s2| *s2 = function.value_and_slope(*s2).0.max(0.0).sqrt());
            }
        }
    }
}

#[cfg(test)]
mod tests;
