//! Functions of crack tips that belong to no node: extrinsic enrichment of moving least squares [EFG, section 5.1].
//!
//! `u = Σ φ_I u_I + Σ_j c_j (q_j - Σ φ_I q_j(x_I))` with one set of `q_j` for each tip, the tip functions times a ramp that
//! ends at the rim of the region [EFG, Eq. 44b]. Each bracket is listed like the shape function of one more node, behind
//! all nodes; the parameters `c_j` of a tip are the combinations of its K_I and K_II that [`TipField`] tells.

use super::ShapeFunctions;
use super::detour::Jet;
use super::enrichment::ramp_share;
use super::settings::Ramp;
use super::tip_functions::{MOST_FUNCTIONS, TipCoordinates, TipFunctions};
use crate::math::{Matrix2, Vector2};
use crate::nodes::Nodes;

/// Where a tip has functions.
#[derive(Clone, Debug)]
pub(super) struct GlobalRegion {
    /// Coordinates at the tip.
    pub coordinates: TipCoordinates,
    /// Radii between which the functions fade [length].
    pub radii: [f64; 2],
}

/// The functions of all tips, four of each.
#[derive(Clone, Debug)]
pub(super) struct GlobalFunctions {
    ramp: Ramp,
    regions: Vec<GlobalRegion>,
    n_nodes: usize,
    /// Values at the nodes, tip by tip; none at nodes that do not reach into the region.
    values: Vec<Vec<Option<[f64; MOST_FUNCTIONS]>>>,
}

impl GlobalFunctions {
    /// Computes the values at the nodes.
    pub fn new(ramp: Ramp, regions: Vec<GlobalRegion>, nodes: &Nodes<2>) -> Self {
        let of_region = |region: &GlobalRegion| {
            let at_node = |i: usize| {
                let (p, sight) = (nodes.positions[i], nodes.sights[i]);
                let distance = (p - region.coordinates.tip()).norm();
                (distance < region.radii[1] + nodes.support_radii[i].norm()).then(|| {
                    let share = ramp_share(ramp, region.radii, region.coordinates.tip(), p).map_or(0.0, |s| s.value);
                    region.coordinates.values(TipFunctions::Full, p, sight).map(|v| share * v)
                })
            };
            (0..nodes.len()).map(at_node).collect()
        };
        let values = regions.iter().map(of_region).collect();
        Self { ramp, regions, n_nodes: nodes.len(), values }
    }

    /// Number of all functions, those of the nodes included.
    pub fn n_functions(&self) -> usize {
        self.n_nodes + MOST_FUNCTIONS * self.regions.len()
    }

    /// Tip of each additional function.
    pub fn owners(&self) -> impl Iterator<Item = Vector2> + '_ {
        self.regions.iter().flat_map(|r| [r.coordinates.tip(); MOST_FUNCTIONS])
    }

    /// Axes of each tip: the direction ahead, in radians.
    pub fn angles(&self) -> impl Iterator<Item = f64> + '_ {
        self.regions.iter().map(|r| r.coordinates.angle())
    }

    /// Appends the functions that are not zero where the nodes in a list act.
    pub fn append_to(&self, list: &mut Vec<u32>) {
        let n = list.len();
        for (region, values) in self.values.iter().enumerate() {
            if list[..n].iter().any(|i| values[*i as usize].is_some()) {
                let first = self.first(region);
                list.extend(first..first + MOST_FUNCTIONS as u32);
            }
        }
    }

    /// Whether no function acts where the nodes in a list do.
    pub fn is_silent(&self, nodes: &[u32]) -> bool {
        self.values.iter().all(|of_tip| nodes.iter().all(|i| of_tip[*i as usize].is_none()))
    }

    fn first(&self, region: usize) -> u32 {
        (self.n_nodes + MOST_FUNCTIONS * region) as u32
    }

    /// Appends the functions at a point to the shape functions of its neighbors.
    pub fn append(&self, [at, sight]: [Vector2; 2], shape: &mut ShapeFunctions<2>) {
        let n = shape.neighbors.len();
        let has_second = !shape.second_derivatives.is_empty();
        for (index, (region, values)) in self.regions.iter().zip(&self.values).enumerate() {
            if !shape.neighbors[..n].iter().any(|i| values[*i as usize].is_some()) {
                continue;
            }
            let share = ramp_share(self.ramp, region.radii, region.coordinates.tip(), at);
            let mut functions = match share {
                Some(share) => faded(&region.coordinates, &share, [at, sight]),
                None => [Jet::ZERO; MOST_FUNCTIONS],
            };
            for k in 0..n {
                let Some(values) = values[shape.neighbors[k] as usize] else { continue };
                for (function, value) in functions.iter_mut().zip(values) {
                    function.value -= shape.values[k] * value;
                    function.gradient -= shape.gradients[k] * value;
                    if has_second {
                        function.second -= shape.second_derivatives[k] * value;
                    }
                }
            }
            for (f, function) in functions.into_iter().enumerate() {
                shape.neighbors.push(self.first(index) + f as u32);
                shape.values.push(function.value);
                shape.gradients.push(function.gradient);
                if has_second {
                    shape.second_derivatives.push(function.second);
                }
            }
        }
    }
}

/// The tip functions at a point times the ramp there.
fn faded(coordinates: &TipCoordinates, share: &Jet, [at, sight]: [Vector2; 2]) -> [Jet; MOST_FUNCTIONS] {
    let jet = coordinates.jet(TipFunctions::Full, at, sight);
    std::array::from_fn(|f| {
        let (value, gradient, second) = (jet.values[f], jet.gradients[f], jet.second_derivatives[f]);
        let mixed: Matrix2 = share.gradient * gradient.transpose();
        Jet {
            value: share.value * value,
            gradient: gradient * share.value + share.gradient * value,
            second: second * share.value + mixed + mixed.transpose() + share.second * value,
        }
    })
}
