//! Fracture quantities at crack tips. Moves no crack.

pub mod settings;

pub use settings::{FractureSettings, TipDomainShape};
