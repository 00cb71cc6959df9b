//! Fracture quantities at crack tips. Moves no crack.
//!
//! [`tip_domain`] lays out domains around a tip, [`interaction_integral`] evaluates them.

pub mod interaction_integral;
pub mod settings;
pub mod tip_domain;

pub use interaction_integral::{
    FacePressure, ForceAt, GradientField, PressureAt, SolutionField, TipIntegrals, TipLoads, tip_integrals,
};
pub use settings::{FractureSettings, JIntegral, TipDomainShape};
pub use tip_domain::TipView;
