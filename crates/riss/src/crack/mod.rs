//! Cracks as plain geometry: in the plane a path with one or two tips.
//!
//! Knows no nodes, no materials and no loads.

pub mod meetings;
pub mod particles;
pub mod path;
pub mod tip;

pub use meetings::Meeting;
pub use particles::{CrackForm, CrackParticle, CrackParticles};
pub use path::{CrackPath, End, EndKind};
pub use tip::{TipFrame, TipId};
