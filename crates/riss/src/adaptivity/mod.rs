//! Where a solution is poor, and squares that say how fine the nodes shall be there.
//!
//! [`recovery`] smooths the stress, [`error_estimate`] measures what smoothing changes, [`marking`] says which squares of
//! a [`quadtree`] are too coarse or finer than needed. Knows no steps: the loop is in `analysis`.

pub mod error_estimate;
pub mod marking;
pub mod quadtree;
pub mod recovery;
pub mod settings;

pub use error_estimate::{ErrorEstimate, TipDisk, estimate_error, estimate_error_within};
pub use marking::{Marks, mark};
pub use quadtree::{Quadtree, Square};
pub use recovery::SingularStress;
pub use settings::AccuracySettings;
