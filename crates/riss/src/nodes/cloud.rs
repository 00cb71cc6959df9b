//! A cloud: nodes of point collocation, each with what it stands on and so which equation is written at it.
//!
//! Nodes on the faces of a crack come in pairs at one position, one for each side; a node of a crack front is single.

use crate::math::Vector;

/// Nodes of a cloud, as arrays.
#[derive(Clone, Debug, Default)]
pub struct Cloud<const D: usize> {
    /// Positions [length].
    pub positions: Vec<Vector<D>>,
    /// Where visibility is asked from: the position, moved slightly into the material for nodes on surfaces and faces.
    pub sights: Vec<Vector<D>>,
    /// Distance to the nearest neighbors as it was wanted [length].
    pub spacings: Vec<f64>,
    /// What the nodes stand on.
    pub places: Vec<Place<D>>,
}

/// What a node stands on.
#[derive(Clone, Debug, PartialEq)]
pub enum Place<const D: usize> {
    /// The inside of the body.
    Inside,
    /// The boundary or a crack face: one facet where it is smooth, several at edges and corners.
    Surface(Vec<Facet<D>>),
    /// The front of a crack, with the facets of both faces around it.
    Front {
        /// Index of the crack.
        crack: u32,
        /// Facets of both faces, and of the boundary where the front ends at it.
        facets: Vec<Facet<D>>,
    },
}

/// A smooth piece of surface at a node.
#[derive(Clone, Debug, PartialEq)]
pub struct Facet<const D: usize> {
    /// What it belongs to.
    pub surface: SurfaceId,
    /// Unit normal, out of the material.
    pub normal: Vector<D>,
    /// Where one-sided shape functions of this piece look from: the node, moved slightly into the material behind it.
    pub sight: Vector<D>,
    /// Share of this piece in an average over all at the node [C3D, Eq. 45]: angle at the node [rad], 1 in the plane.
    pub angle: f64,
}

/// A named part of the boundary, or a face of a crack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SurfaceId {
    /// Index of a part of the boundary.
    Part(u32),
    /// A face of a crack.
    Face {
        /// Index of the crack.
        crack: u32,
        /// Which of its two faces.
        side: Side,
    },
}

/// Side of a crack surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The side that the normal of the crack surface points to.
    Positive,
    /// The other one.
    Negative,
}

impl<const D: usize> Cloud<D> {
    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Adds a node.
    pub fn push(&mut self, position: Vector<D>, sight: Vector<D>, spacing: f64, place: Place<D>) {
        self.positions.push(position);
        self.sights.push(sight);
        self.spacings.push(spacing);
        self.places.push(place);
    }
}
