//! Analyses: they join all the stages below and report to an [`Observer`].

pub mod record;
pub mod settings;

pub use record::*;
pub use settings::Settings;

use crate::error::Result;
use crate::model::Model;

/// Solves the linear elastic problem once and evaluates every tip.
pub fn linear_static(model: &Model, settings: &Settings, observer: &mut dyn Observer) -> Result<StaticResult> {
    let _ = (model, settings, observer);
    Err(crate::error::Error::NodeGeneration { reason: "the analysis is not there yet".into() })
}
