//! Functions of crack tips times shape functions of nodes: enrichment by a partition of unity
//! [EFG, section 5.2; Melenk1996].
//!
//! `u = Σ φ_I (u_I + Σ_m b_Im ψ_Im)` over the nodes near a tip. The `ψ_Im` of a node span its tip functions and the
//! constant: they have no mean over the support and are orthonormal there, since the functions themselves are nearly
//! polynomials of one another away from the tip. Each product `φ_I ψ_Im` is listed like the shape function of one more
//! node, behind all nodes.

use super::ShapeFunctions;
use super::tip_functions::{MOST_FUNCTIONS, TipCoordinates, TipFunctions, TipJet};
use crate::math::{Matrix2, Vector2, direction};
use crate::nodes::Nodes;
use std::f64::consts::TAU;
use std::ops::Range;

/// Stands for the functions of a node that has none.
const NONE: u32 = u32::MAX;
/// A function is left out at a node if it is a combination of those before it but for this part: it then is for the
/// stiffness matrix, too.
const LEAST_PART: f64 = 1e-6;
/// Radii over the support radius and number of angles of the places where the functions of a node are compared.
const RINGS: [f64; 3] = [0.25, 0.5, 0.75];
const ANGLES: usize = 12;
const SAMPLES: usize = RINGS.len() * ANGLES;

/// Where a tip adds functions.
#[derive(Clone, Debug)]
pub(super) struct ExtraRegion {
    /// Coordinates at the tip.
    pub coordinates: TipCoordinates,
    /// Nodes nearer to the tip than this are enriched [length].
    pub outer: f64,
    /// Their supports must end before this distance, beyond which functions jump where no crack is [length].
    pub clear: f64,
}

/// The additional functions of all nodes.
#[derive(Clone, Debug)]
pub(super) struct ExtraFunctions {
    functions: TipFunctions,
    regions: Vec<ExtraRegion>,
    /// Index in `owns`, by node.
    own_of: Vec<u32>,
    owns: Vec<Own>,
    n_functions: usize,
}

/// The functions of one node.
#[derive(Clone, Debug)]
struct Own {
    node: u32,
    region: u32,
    /// Index of the first function, and their number.
    first: u32,
    count: u32,
    /// Mean of each tip function over the support.
    means: [f64; MOST_FUNCTIONS],
    /// `ψ_m = Σ_k mix[m][k] (F_k - mean_k)`.
    mix: [[f64; MOST_FUNCTIONS]; MOST_FUNCTIONS],
}

impl ExtraFunctions {
    /// Lists the functions of the nodes in the regions.
    pub fn new(functions: TipFunctions, regions: Vec<ExtraRegion>, nodes: &Nodes<2>) -> Self {
        let mut result =
            Self { functions, regions, own_of: vec![NONE; nodes.len()], owns: vec![], n_functions: nodes.len() };
        for (i, p) in nodes.positions.iter().enumerate() {
            let reach = nodes.support_radii[i].max();
            let holds = |r: &ExtraRegion| {
                let distance = (p - r.coordinates.tip()).norm();
                distance < r.outer && distance + reach < r.clear
            };
            let Some(region) = result.regions.iter().position(holds) else { continue };
            let coordinates = &result.regions[region].coordinates;
            let own = Own::new(functions, coordinates, nodes, i, [region as u32, result.n_functions as u32]);
            result.n_functions += own.count as usize;
            result.own_of[i] = result.owns.len() as u32;
            result.owns.push(own);
        }
        result
    }

    /// Number of all functions, those of the plain nodes included.
    pub fn n_functions(&self) -> usize {
        self.n_functions
    }

    /// Node of each additional function.
    pub fn owners(&self) -> impl Iterator<Item = u32> + '_ {
        self.owns.iter().flat_map(|own| (0..own.count).map(|_| own.node))
    }

    /// Indices of the functions of a node.
    pub fn of_node(&self, node: u32) -> Range<u32> {
        match self.own_of[node as usize] {
            NONE => 0..0,
            own => {
                let own = &self.owns[own as usize];
                own.first..own.first + own.count
            }
        }
    }

    /// Appends the products with the shape functions of the neighbors that are enriched.
    #[inline]
    pub fn append(&self, view: [Vector2; 2], shape: &mut ShapeFunctions<2>) {
        let n = shape.neighbors.len();
        let mut last: Option<(u32, TipJet)> = None;
        for k in 0..n {
            let own = self.own_of[shape.neighbors[k] as usize];
            if own != NONE {
                self.append_node(&self.owns[own as usize], k, view, &mut last, shape);
            }
        }
    }

    /// - `k`: place of the node among the neighbors
    /// - `last`: the tip functions at the point, kept from node to node
    fn append_node(
        &self,
        own: &Own,
        k: usize,
        [at, sight]: [Vector2; 2],
        last: &mut Option<(u32, TipJet)>,
        shape: &mut ShapeFunctions<2>,
    ) {
        let jet = match last {
            Some((region, jet)) if *region == own.region => *jet,
            Some(_) | None => {
                let jet = self.regions[own.region as usize].coordinates.jet(self.functions, at, sight);
                *last = Some((own.region, jet));
                jet
            }
        };
        let (value, gradient) = (shape.values[k], shape.gradients[k]);
        let second = shape.second_derivatives.get(k).copied();
        for m in 0..own.count as usize {
            let (mut psi, mut slope, mut bend) = (0.0, Vector2::zeros(), Matrix2::zeros());
            for f in 0..self.functions.count() {
                psi += own.mix[m][f] * (jet.values[f] - own.means[f]);
                slope += jet.gradients[f] * own.mix[m][f];
                bend += jet.second_derivatives[f] * own.mix[m][f];
            }
            shape.neighbors.push(own.first + m as u32);
            shape.values.push(value * psi);
            shape.gradients.push(gradient * psi + slope * value);
            if let Some(second) = second {
                let mixed = gradient * slope.transpose();
                shape.second_derivatives.push(second * psi + mixed + mixed.transpose() + bend * value);
            }
        }
    }
}

impl Own {
    /// Combinations of the tip functions without mean, orthonormal over the support of a node (modified Gram-Schmidt
    /// [Bjorck1967]). The functions are continued around the tip from the side of the node, as it sees them.
    fn new(
        functions: TipFunctions,
        coordinates: &TipCoordinates,
        nodes: &Nodes<2>,
        node: usize,
        [region, first]: [u32; 2],
    ) -> Self {
        let (position, radii) = (nodes.positions[node], nodes.support_radii[node]);
        let samples: [[f64; MOST_FUNCTIONS]; SAMPLES] = std::array::from_fn(|s| {
            let turn = direction(TAU * (s % ANGLES) as f64 / ANGLES as f64);
            let at = position + turn.component_mul(&radii) * RINGS[s / ANGLES];
            coordinates.values(functions, at, nodes.sights[node])
        });
        // Rings stand for area, and for the decay of the shape function.
        let raw = |s: usize| RINGS[s / ANGLES] * (1.0 - RINGS[s / ANGLES].powi(2)).powi(4);
        let total: f64 = (0..SAMPLES).map(raw).sum();
        let weight = |s: usize| raw(s) / total;
        let means = std::array::from_fn(|f| (0..SAMPLES).map(|s| weight(s) * samples[s][f]).sum());
        let product = |a: &[f64; SAMPLES], b: &[f64; SAMPLES]| (0..SAMPLES).map(|s| weight(s) * a[s] * b[s]).sum();
        let mut own = Self { node: node as u32, region, first, count: 0, means, mix: [[0.0; MOST_FUNCTIONS]; 4] };
        let mut kept: Vec<[f64; SAMPLES]> = vec![];
        for f in 0..functions.count() {
            let mut v: [f64; SAMPLES] = std::array::from_fn(|s| samples[s][f] - means[f]);
            let mut mix = [0.0; MOST_FUNCTIONS];
            mix[f] = 1.0;
            let size: f64 = product(&v, &v);
            for (k, other) in kept.iter().enumerate() {
                let share: f64 = product(&v, other);
                (0..SAMPLES).for_each(|s| v[s] -= share * other[s]);
                (0..MOST_FUNCTIONS).for_each(|j| mix[j] -= share * own.mix[k][j]);
            }
            let rest: f64 = product(&v, &v);
            if rest > LEAST_PART * LEAST_PART * size {
                let inverse = rest.sqrt().recip();
                own.mix[kept.len()] = mix.map(|m| m * inverse);
                kept.push(v.map(|v| v * inverse));
            }
        }
        own.count = kept.len() as u32;
        own
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::approximation::moving_least_squares::Derivatives;
    use crate::approximation::{ApproximationSettings, MovingLeastSquares, Surroundings};
    use crate::crack::{CrackPath, End, EndKind};
    use crate::geometry::obstacles::Obstacles;

    fn kinked() -> CrackPath {
        let vertices = [(-1.2, -0.1), (-0.4, -0.1), (0.02, 0.03)].map(|p| Vector2::new(p.0, p.1)).to_vec();
        CrackPath { name: "c".into(), vertices, ends: [EndKind::Mouth, EndKind::Tip] }
    }

    /// An uneven grid around the tip, without nodes on the crack.
    fn nodes() -> Nodes<2> {
        let place = |k: usize| {
            let (i, j) = ((k % 15) as f64, (k / 15) as f64);
            Vector2::new(i / 7.0 - 1.0 + 0.02 * (3.0 * j).sin(), j / 7.0 - 1.0 + 0.02 * (5.0 * i).cos())
        };
        let positions: Vec<Vector2> = (0..225).map(place).collect();
        Nodes { sights: positions.clone(), support_radii: vec![Vector2::repeat(0.4); positions.len()], positions }
    }

    /// Parameters of the additional functions of a node that make tip function `f` less its mean: `F - mean = Σ c ψ`,
    /// from the triangular mix.
    fn parameters(own: &Own, f: usize, n: usize) -> Vec<f64> {
        let mut wanted = [0.0; MOST_FUNCTIONS];
        wanted[f] = 1.0;
        let mut c = vec![0.0; n];
        for m in (0..n).rev() {
            c[m] = wanted[m] / own.mix[m][m];
            (0..n).for_each(|k| wanted[k] -= c[m] * own.mix[m][k]);
        }
        c
    }

    #[test]
    fn fields_of_the_tip_are_reproduced_where_all_nodes_are_enriched() {
        let (path, nodes) = (kinked(), nodes());
        let coordinates = TipCoordinates::new(&path, End::End, f64::INFINITY, 0.0);
        let obstacles = Obstacles::new(path.segments().map(|(a, b)| [a, b]).collect());
        let plain = MovingLeastSquares::new(nodes.clone(), obstacles, ApproximationSettings::default());
        for functions in [TipFunctions::Full, TipFunctions::Radial] {
            let region = ExtraRegion { coordinates: coordinates.clone(), outer: 10.0, clear: f64::INFINITY };
            let extra = ExtraFunctions::new(functions, vec![region], &nodes);
            let n = functions.count();
            assert_eq!(extra.n_functions(), (1 + n) * nodes.len());
            let (mut around, mut shape) = <(Surroundings, ShapeFunctions<2>)>::default();
            for k in 0..60 {
                let at = coordinates.tip() + direction(0.7 * k as f64) * (0.001 + 0.012 * k as f64);
                plain.evaluate(at, at, Derivatives::Second, &mut around, &mut shape).unwrap();
                extra.append([at, at], &mut shape);
                let exact = coordinates.jet(functions, at, at);
                for f in 0..n {
                    let parameter = |i: u32| match (i as usize).checked_sub(nodes.len()) {
                        None => extra.owns[i as usize].means[f],
                        Some(j) => parameters(&extra.owns[j / n], f, n)[j % n],
                    };
                    let (mut found, mut sizes) = ((0.0, Vector2::zeros(), Matrix2::zeros()), [0.0; 3]);
                    for (j, &i) in shape.neighbors.iter().enumerate() {
                        let u = parameter(i);
                        found.0 += shape.values[j] * u;
                        found.1 += shape.gradients[j] * u;
                        found.2 += shape.second_derivatives[j] * u;
                        sizes[0] += (shape.values[j] * u).abs();
                        sizes[1] += shape.gradients[j].norm() * u.abs();
                        sizes[2] += shape.second_derivatives[j].norm() * u.abs();
                    }
                    let rounding = 1e-12;
                    assert!((found.0 - exact.values[f]).abs() < rounding * sizes[0], "{f} {at}: {found:?} {exact:?}");
                    assert!(
                        (found.1 - exact.gradients[f]).norm() < rounding * sizes[1],
                        "{f} {at}: {found:?} {exact:?}"
                    );
                    let second = exact.second_derivatives[f];
                    assert!((found.2 - second).norm() < rounding * sizes[2], "{f} {at}: {found:?} {exact:?}");
                }
            }
        }
    }

    #[test]
    fn nodes_whose_supports_leave_the_clear_disk_have_no_functions() {
        let nodes = nodes();
        let coordinates = TipCoordinates::new(&kinked(), End::End, f64::INFINITY, 0.0);
        let tip = coordinates.tip();
        let region = ExtraRegion { coordinates, outer: 0.5, clear: 0.9 };
        let extra = ExtraFunctions::new(TipFunctions::Full, vec![region], &nodes);
        for (i, p) in nodes.positions.iter().enumerate() {
            // Supports are disks of radius 0.4.
            let expected = (p - tip).norm() < 0.5 && (p - tip).norm() + 0.4 < 0.9;
            assert_eq!(extra.of_node(i as u32).len(), if expected { 4 } else { 0 }, "{p}");
        }
    }
}
