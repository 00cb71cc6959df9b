//! Nodes: where they stand and how far they reach.
//!
//! [`generation`] places points, if their [`budget`] allows, along [`chains`] of boundary and cracks, [`fill`]s the body at the spacing of a
//! [`spacing::SpacingField`] and joins them to a [`triangulation`]; every sector of material around a point with a
//! node gets one: nodes on a crack are split [EFG, section 2.2].

mod budget;
pub mod chains;
pub mod cloud;
mod crack_clearance;
pub mod elements;
pub mod fill;
pub mod generation;
mod ligaments;
mod scaling;
pub mod settings;
pub mod solid;
mod source_tree;
pub mod spacing;
pub mod support;
pub mod triangulation;

use crate::math::Vector;
pub use budget::{estimated_layout, estimated_nodes};
pub use chains::BoundarySegment;
pub use generation::{Layered, generate, generate_at};
pub use settings::NodeSettings;
pub use triangulation::Triangulation;

/// Nodes with their supports, as arrays.
#[derive(Clone, Debug, Default)]
pub struct Nodes<const D: usize> {
    /// Positions.
    pub positions: Vec<Vector<D>>,
    /// Where visibility is asked from: the position, moved slightly into the material for nodes on faces and boundary.
    pub sights: Vec<Vector<D>>,
    /// Half sizes of the supports along the axes (all equal for balls) [length].
    pub support_radii: Vec<Vector<D>>,
}

impl<const D: usize> Nodes<D> {
    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }
}
