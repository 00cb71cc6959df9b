//! Finite elements joined to moving least squares [Belytschko1995; Krongauz1996].
//!
//! In an element `φ_I = (1 - R) N_I + R ψ_I`, with the shape functions `N_I` of the element, those of moving least squares
//! `ψ_I`, and the ramp `R`, the sum of the `N_J` of the corners that stand among meshfree nodes. Both parts reproduce linear
//! fields, and so does what is joined. Where no corner is meshfree, `φ_I = N_I`: fields are known by their values at nodes.

use super::ShapeFunctions;
use super::detour::Jet;
use super::moving_least_squares::Derivatives;
use crate::geometry::aabb::Aabb;
use crate::geometry::tree::BoxTree;
use crate::math::{Matrix2, Vector2, cross, turn_left};
use crate::model::Domain;
use crate::nodes::Triangulation;
use crate::nodes::elements::{Element, arcs};

/// A point is in an element if its local coordinates are at least minus this.
const ROUNDING: f64 = 1e-9;
/// The same beyond a chord: what lies between it and its arc belongs to the element.
const BEYOND_CHORD: f64 = 0.35;

/// Elements in which shape functions are not those of moving least squares alone.
#[derive(Clone, Debug)]
pub struct FiniteElements {
    elements: Vec<JoinedElement>,
    tree: BoxTree<2>,
}

/// An element, its nodes and its part of the ramp.
#[derive(Clone, Debug)]
pub struct JoinedElement {
    nodes: Vec<u32>,
    corners: Vec<Vector2>,
    /// Ramp at the corners: one at meshfree nodes, zero at others.
    shares: Vec<f64>,
    /// Whether the side from a corner to the next is a chord of the boundary.
    is_chord: Vec<bool>,
}

impl FiniteElements {
    /// Elements with a corner that is no meshfree node; none if there is no such corner.
    ///
    /// - `is_meshfree`: by copy of the triangulation
    /// - `node_of_copy`: every corner of an element that is used has a node
    pub fn new(
        elements: &[Element],
        triangulation: &Triangulation,
        domain: &Domain,
        is_meshfree: &[bool],
        node_of_copy: &[Option<u32>],
    ) -> Option<Self> {
        let arcs = arcs(triangulation, domain);
        let joined = |element: &Element| {
            let corners = element.corners();
            if corners.iter().all(|c| is_meshfree[*c as usize]) {
                return None;
            }
            let nodes: Option<Vec<u32>> = corners.iter().map(|c| node_of_copy[*c as usize]).collect();
            let is_chord = |k: usize| arcs.contains_key(&[corners[k], corners[(k + 1) % corners.len()]]);
            Some(JoinedElement {
                nodes: nodes?,
                corners: corners.iter().map(|c| triangulation.position(*c)).collect(),
                shares: corners.iter().map(|c| f64::from(u8::from(is_meshfree[*c as usize]))).collect(),
                is_chord: (0..corners.len()).map(is_chord).collect(),
            })
        };
        let elements: Vec<JoinedElement> = elements.iter().filter_map(joined).collect();
        let boxes: Vec<Aabb<2>> = elements.iter().map(JoinedElement::bounds).collect();
        (!elements.is_empty()).then(|| Self { elements, tree: BoxTree::new(&boxes) })
    }

    /// Looks up the elements that may hold a point of a box.
    pub(super) fn survey(&self, bounds: &Aabb<2>, near: &mut Vec<u32>) {
        near.clear();
        self.tree.visit(bounds, |i| near.push(i));
        near.sort_unstable();
    }

    /// The element around a point that was surveyed; `sight` tells the side of points on cracks.
    pub(super) fn find(&self, sight: Vector2, near: &[u32]) -> Option<&JoinedElement> {
        let elements = || near.iter().map(|i| &self.elements[*i as usize]);
        let inside = elements().find(|e| e.least_coordinate(sight, 0.0) >= -ROUNDING);
        inside.or_else(|| elements().find(|e| e.least_coordinate(sight, BEYOND_CHORD) >= -ROUNDING))
    }
}

impl JoinedElement {
    /// Nodes at the corners.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// Whether moving least squares have no part in it.
    pub fn is_plain(&self) -> bool {
        self.shares.iter().all(|s| *s == 0.0)
    }

    /// The least box around it, arcs included.
    fn bounds(&self) -> Aabb<2> {
        let own = Aabb::of_points(self.corners.iter().copied());
        match self.is_chord.contains(&true) {
            true => Aabb::around(own.center(), own.size() * (0.5 + BEYOND_CHORD)),
            false => own,
        }
    }

    /// Least of the local coordinates of a point, which are positive inside; those from chords are raised by `beyond`.
    fn least_coordinate(&self, at: Vector2, beyond: f64) -> f64 {
        let n = self.corners.len();
        let inward = |k: usize| {
            let (a, b) = (self.corners[k], self.corners[(k + 1) % n]);
            let height = cross(b - a, self.corners[(k + 2) % n] - a);
            cross(b - a, at - a) / height + if self.is_chord[k] { beyond } else { 0.0 }
        };
        (0..n).map(inward).fold(f64::INFINITY, f64::min)
    }

    /// Linear functions in a triangle, bilinear ones in a rectangle, corner by corner.
    fn local(&self, at: Vector2) -> [Jet; 4] {
        let mut result = [Jet::ZERO; 4];
        let p = &self.corners;
        if let [a, b, c] = p[..] {
            let twice = cross(b - a, c - a);
            for (k, [b, c]) in [[b, c], [c, a], [a, b]].into_iter().enumerate() {
                let value = cross(b - at, c - at) / twice;
                result[k] = Jet { value, gradient: turn_left(c - b) / twice, second: Matrix2::zeros() };
            }
            return result;
        }
        let (u, v) = (p[1] - p[0], p[3] - p[0]);
        let (ds, dt) = (u / u.norm_squared(), v / v.norm_squared());
        let (s, t) = ((at - p[0]).dot(&ds), (at - p[0]).dot(&dt));
        let mixed: Matrix2 = ds * dt.transpose() + dt * ds.transpose();
        for (k, (is_far, is_high)) in
            [(false, false), (true, false), (true, true), (false, true)].into_iter().enumerate()
        {
            let (f, fs) = if is_far { (s, 1.0) } else { (1.0 - s, -1.0) };
            let (g, gt) = if is_high { (t, 1.0) } else { (1.0 - t, -1.0) };
            result[k] = Jet { value: f * g, gradient: ds * (fs * g) + dt * (f * gt), second: mixed * (fs * gt) };
        }
        result
    }

    /// Shape functions where moving least squares have no part.
    pub(super) fn fill(&self, at: Vector2, derivatives: Derivatives, shape: &mut ShapeFunctions<2>) {
        let local = self.local(at);
        let mut order = [0, 1, 2, 3];
        let order = &mut order[..self.nodes.len()];
        order.sort_unstable_by_key(|k| self.nodes[*k]);
        shape.reset(&[]);
        for &mut k in order {
            shape.neighbors.push(self.nodes[k]);
            shape.values.push(local[k].value);
            shape.gradients.push(local[k].gradient);
            if derivatives == Derivatives::Second {
                shape.second_derivatives.push(local[k].second);
            }
        }
    }

    /// Joins the shape functions of moving least squares at a point with those of the element.
    pub(super) fn join(&self, at: Vector2, shape: &mut ShapeFunctions<2>) {
        let local = self.local(at);
        let mut ramp = Jet::ZERO;
        for (n, share) in local.iter().zip(&self.shares) {
            ramp.value += share * n.value;
            ramp.gradient += n.gradient * *share;
            ramp.second += n.second * *share;
        }
        let has_second = !shape.second_derivatives.is_empty();
        for k in 0..shape.neighbors.len() {
            let second = shape.second_derivatives.get(k).copied().unwrap_or_default();
            let own = Jet { value: shape.values[k], gradient: shape.gradients[k], second };
            let scaled = product(&ramp, &own);
            (shape.values[k], shape.gradients[k]) = (scaled.value, scaled.gradient);
            if has_second {
                shape.second_derivatives[k] = scaled.second;
            }
        }
        let rest = Jet { value: 1.0 - ramp.value, gradient: -ramp.gradient, second: -ramp.second };
        for (node, n) in self.nodes.iter().zip(&local) {
            let own = product(&rest, n);
            let k = shape.neighbors.binary_search(node).unwrap_or_else(|k| {
                shape.neighbors.insert(k, *node);
                shape.values.insert(k, 0.0);
                shape.gradients.insert(k, Vector2::zeros());
                if has_second {
                    shape.second_derivatives.insert(k, Matrix2::zeros());
                }
                k
            });
            shape.values[k] += own.value;
            shape.gradients[k] += own.gradient;
            if has_second {
                shape.second_derivatives[k] += own.second;
            }
        }
    }
}

/// Product of two functions with its derivatives.
fn product(f: &Jet, g: &Jet) -> Jet {
    let mixed: Matrix2 = f.gradient * g.gradient.transpose();
    Jet {
        value: f.value * g.value,
        gradient: g.gradient * f.value + f.gradient * g.value,
        second: g.second * f.value + mixed + mixed.transpose() + f.second * g.value,
    }
}
