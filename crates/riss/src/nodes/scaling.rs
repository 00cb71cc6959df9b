//! The same nodes, coarser or finer everywhere.

use super::settings::{Graded, Layout, NodeSettings, Structured};
use super::spacing::{GROWTH, SpacingField};
use crate::model::Model;

/// Spacing does not grow faster than this with distance, however coarse.
const MOST_GROWTH: f64 = 0.6;

impl NodeSettings {
    /// Settings whose nodes stand `factor` times as far apart, at tips and elsewhere; none if positions are listed.
    pub fn scaled(&self, model: &Model, factor: f64) -> Option<Self> {
        let layout = match &self.layout {
            Layout::Graded(graded) => {
                let field = SpacingField::of_model(model, graded);
                let tips = model.tips().into_iter().map(|(_, frame)| field.at(frame.position));
                Layout::Graded(Graded {
                    spacing: Some(factor * field.largest()),
                    tip_spacing: tips.reduce(f64::min).map(|s| factor * s),
                    growth: Some((factor * graded.growth.unwrap_or(GROWTH)).min(MOST_GROWTH)),
                })
            }
            Layout::Structured(grid) => {
                let n = |n: usize| ((n - 1) as f64 / factor).round().max(1.0) as usize + 1;
                Layout::Structured(Structured { nx: n(grid.nx), ny: n(grid.ny) })
            }
            Layout::Listed(_) => return None,
        };
        Some(Self { layout, star: self.star.clone() })
    }
}
