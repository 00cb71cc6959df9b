//! Fracture quantities at crack tips. Moves no crack.
//!
//! [`tip_domain`] lays out domains around a tip, [`interaction_integral`] evaluates them.

pub mod interaction_integral;
pub mod settings;
pub mod tip_domain;

pub use interaction_integral::{GradientField, SolutionField, TipIntegrals, contour_j, tip_integrals};
pub use settings::{FractureSettings, TipDomainShape};
pub use tip_domain::TipView;
