//! Integration points.

pub mod settings;

pub use settings::{GradientCorrection, IntegrationSettings, Scheme};
