//! Cracks as plain geometry: in the plane a path with one or two tips.
//!
//! Knows no nodes, no materials and no loads.

pub mod path;
pub mod tip;

pub use path::{CrackPath, End, EndKind};
pub use tip::{TipFrame, TipId};
