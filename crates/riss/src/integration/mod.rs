//! Integration points: every scheme is lowered to flat lists of them.
//!
//! [`cells`] makes them from the triangles between the nodes, [`nodal`] around the nodes, [`background`] from a grid that
//! the boundary clips, [`boundary`] along the edges of the body, [`crack_faces`] along cracks. In solids [`node_cells`] samples
//! what belongs to each node.

pub mod background;
pub mod boundary;
pub mod cells;
pub mod crack_faces;
pub mod nodal;
pub mod node_cells;
pub mod rules;
pub mod settings;

use crate::math::Vector;
pub use boundary::{BoundaryElement, BoundaryPoint, boundary_elements};
pub use cells::{EdgePoint, IntegrationCells};
pub use crack_faces::{CrackFaceElement, CrackFacePoint, crack_face_elements};
pub use node_cells::NodeCells;
pub use settings::{GradientCorrection, IntegrationSettings, Scheme, TipRule};

/// A position with its integration weight [length^D].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegrationPoint<const D: usize> {
    /// Position.
    pub position: Vector<D>,
    /// Integration weight.
    pub weight: f64,
}
