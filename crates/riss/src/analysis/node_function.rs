//! Weight and shape function of one node, sampled for pictures.

use crate::approximation::moving_least_squares::Derivatives;
use crate::approximation::{ShapeFunctions, Surroundings};
use crate::geometry::aabb::Aabb;
use crate::math::Vector2;
use crate::nodes::triangulation::SIGHT_SHIFT;
use crate::system::Discretization;
use rustc_hash::FxHashMap;

/// Triangles of the body are divided into about so many in all.
const TRIANGLES: usize = 3500;
/// Half size of the picture over the support radius.
const REACH: f64 = 1.1;

/// Weight and shape function of a node around it.
#[derive(Clone, Debug, Default)]
pub struct NodeFunction {
    /// Index of the node.
    pub node: usize,
    /// Its position.
    pub position: Vector2,
    /// Its support radius, the larger one if it is a rectangle [length].
    pub support_radius: f64,
    /// Sampled points; those on crack faces once for each side.
    pub points: Vec<Vector2>,
    /// Triangles between the points, counterclockwise.
    pub triangles: Vec<[u32; 3]>,
    /// Weight function at each point; not a number where there is no fit.
    pub weight: Vec<f64>,
    /// Shape function at each point; not a number where there is no fit.
    pub shape: Vec<f64>,
    /// Positions of all nodes around.
    pub nodes: Vec<Vector2>,
}

/// The node whose place of view is nearest to a point: beside a crack that of the point's own side.
pub fn nearest_node(discrete: &Discretization, at: Vector2) -> usize {
    let sights = &discrete.approximation.nodes().sights;
    let away = |i: &usize| (sights[*i] - at).norm();
    (0..sights.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap_or(0)
}

/// Samples the functions of a node on the triangles around it, each divided evenly.
pub fn sample_node_function(discrete: &Discretization, node: usize) -> NodeFunction {
    let nodes = discrete.approximation.nodes();
    let (position, support_radius) = (nodes.positions[node], nodes.support_radii[node].max());
    let view = Aabb::around(position, nodes.support_radii[node] * REACH);
    let triangulation = &discrete.triangulation;
    let touches = |t: &&[u32; 3]| {
        let bounds = Aabb::of_points(t.map(|c| triangulation.position(c)));
        (0..2).all(|d| bounds.lower[d] < view.upper[d] && bounds.upper[d] > view.lower[d])
    };
    let coarse: Vec<[u32; 3]> = triangulation.triangles.iter().filter(touches).copied().collect();
    let n = ((TRIANGLES as f64 / coarse.len().max(1) as f64).sqrt().ceil() as u32).clamp(2, 24);
    let mut sampler =
        Sampler { discrete, n, known: FxHashMap::default(), sights: vec![], function: NodeFunction::default() };
    coarse.iter().enumerate().for_each(|(k, t)| sampler.divide(k as u32, *t));
    let Sampler { sights, mut function, .. } = sampler;
    let (mut around, mut shape) = <(Surroundings, ShapeFunctions<2>)>::default();
    for (at, sight) in function.points.iter().zip(sights) {
        let fits = discrete.approximation.evaluate(*at, sight, Derivatives::First, &mut around, &mut shape).is_ok();
        let find = |list: &[u32], values: &[f64]| {
            let found = list.iter().position(|i| *i as usize == node).map_or(0.0, |k| values[k]);
            if fits { found } else { f64::NAN }
        };
        function.shape.push(find(&shape.neighbors, &shape.values));
        function.weight.push(find(&around.near.nodes, &around.near.weights));
    }
    let is_near = |p: &&Vector2| (0..2).all(|d| (view.lower[d]..=view.upper[d]).contains(&p[d]));
    function.nodes = nodes.positions.iter().filter(is_near).copied().collect();
    NodeFunction { node, position, support_radius, ..function }
}

/// Points that triangles share: at a corner, on an edge, or inside one triangle.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Place {
    Corner(u32),
    Edge { ends: [u32; 2], step: u32 },
    Inside { triangle: u32, steps: [u32; 2] },
}

struct Sampler<'a> {
    discrete: &'a Discretization,
    /// Pieces of each edge.
    n: u32,
    known: FxHashMap<Place, u32>,
    sights: Vec<Vector2>,
    function: NodeFunction,
}

impl Sampler<'_> {
    fn divide(&mut self, index: u32, copies: [u32; 3]) {
        let n = self.n;
        let mut at = |i: u32, j: u32| self.point(index, copies, [n - i - j, i, j]);
        let rows: Vec<Vec<u32>> = (0..=n).map(|j| (0..=n - j).map(|i| at(i, j)).collect()).collect();
        for j in 0..n as usize {
            for i in 0..n as usize - j {
                self.function.triangles.push([rows[j][i], rows[j][i + 1], rows[j + 1][i]]);
                if i + j + 1 < n as usize {
                    self.function.triangles.push([rows[j][i + 1], rows[j + 1][i + 1], rows[j + 1][i]]);
                }
            }
        }
    }

    /// The point with so many steps from the edges opposite to the corners.
    fn point(&mut self, triangle: u32, copies: [u32; 3], steps: [u32; 3]) -> u32 {
        let triangulation = &self.discrete.triangulation;
        let present: Vec<usize> = (0..3).filter(|k| steps[*k] > 0).collect();
        let is_tip = |k: usize| {
            let copy = &triangulation.copies[copies[k] as usize];
            copy.middle != Vector2::zeros() && copy.sight == triangulation.position(copies[k])
        };
        let place = match present[..] {
            [k] => Place::Corner(copies[k]),
            // Between two tips both faces have the same ends.
            [a, b] if !(is_tip(a) && is_tip(b)) => {
                let (a, b) = if copies[a] < copies[b] { (a, b) } else { (b, a) };
                Place::Edge { ends: [copies[a], copies[b]], step: steps[a] }
            }
            _ => Place::Inside { triangle, steps: [steps[0], steps[1]] },
        };
        if let Some(known) = self.known.get(&place) {
            return *known;
        }
        let corners = copies.map(|c| triangulation.position(c));
        let share = |k: usize| f64::from(steps[k]) / f64::from(self.n);
        let p = corners[0] * share(0) + corners[1] * share(1) + corners[2] * share(2);
        let center = (corners[0] + corners[1] + corners[2]) / 3.0;
        self.sights.push(match place {
            Place::Corner(copy) => triangulation.copies[copy as usize].sight,
            Place::Edge { .. } | Place::Inside { .. } => p + (center - p) * SIGHT_SHIFT,
        });
        self.function.points.push(p);
        let index = self.function.points.len() as u32 - 1;
        self.known.insert(place, index);
        index
    }
}
