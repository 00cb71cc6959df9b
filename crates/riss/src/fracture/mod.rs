//! Fracture quantities at crack tips. Moves no crack.
//!
//! [`tip_domain`] lays out domains around a tip, [`interaction_integral`] and [`configurational_force`] evaluate them, over a
//! [`remembered_field`];
//! [`growth_criterion`] tells which way the tip would grow, [`fatigue`] how far in a load cycle. In space,
//! [`front_integral`] evaluates points of a front, and [`rankine`] is the criterion of a strength.

pub mod configurational_force;
pub mod disc_cut;
pub mod fatigue;
pub mod front_integral;
pub mod growth_criterion;
pub mod interaction_integral;
pub mod rankine;
pub mod remembered_field;
pub mod settings;
pub mod tip_domain;

pub use configurational_force::{ConfigurationalForce, configurational_forces, force_of_factors};
pub use disc_cut::DiscCut;
pub use front_integral::{FrontFactors, FrontIntegrals, front_integrals};
pub use growth_criterion::{EquivalentFactor, GrowthCriterion, TipDriving, kinked_factors};
pub use interaction_integral::{
    FacePressure, ForceAt, GradientField, PressureAt, SolutionField, TipIntegrals, TipLoads, tip_integrals,
};
pub use rankine::LargestPrincipal;
pub use remembered_field::RememberedField;
pub use settings::{FaceTerm, FractureSettings, JIntegral, TipDomainShape};
pub use tip_domain::TipView;
