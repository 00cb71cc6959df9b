//! Cracks as plain geometry: in the plane a path with one or two tips, in space a surface with fronts.
//!
//! Reading order: [`path`], [`tip`], [`meetings`]; in space [`shape`], [`surface`], [`front`], [`growing`].
//! Knows no nodes, no materials and no loads.

pub mod front;
pub mod growing;
pub mod meetings;
pub mod particles;
pub mod path;
pub mod shape;
pub mod surface;
pub mod tip;

pub use front::{CrackFront, FrontPoint};
pub use growing::{EdgeLimits, FrontStep, GrowingCrack, GrowingFront};
pub use meetings::Meeting;
pub use particles::{CrackForm, CrackParticle, CrackParticles};
pub use path::{CrackPath, End, EndKind};
pub use shape::{CrackDefect, CrackShape};
pub use surface::{CrackSurface, MouthPiece, Mouths};
pub use tip::{TipFrame, TipId};
