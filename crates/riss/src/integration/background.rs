//! Cells of a background grid, clipped by the boundary (cell quadrature [EFG, section 3.2, Fig. 3]).

use super::cells::IntegrationCells;
use super::settings::IntegrationSettings;
use crate::error::{Error, Result};
use crate::math::Vector2;
use crate::model::Model;

impl IntegrationCells {
    /// Cells of a square grid over the body.
    pub fn background(_model: &Model, _tips: &[Vector2], _size: f64, _settings: &IntegrationSettings) -> Result<Self> {
        Err(Error::NodeGeneration { reason: "background cells are not there yet".into() })
    }

    /// Forgets the points on the outlines.
    pub fn drop_outlines(&mut self) {
        self.edge_points.clear();
        self.edge_ranges.iter_mut().for_each(|r| *r = 0..0);
    }
}
