//! How much memory a run will take, told before it starts: nodes that the case asks for, times what a node takes.
//!
//! What a node takes was measured with default settings, as peak memory less [`BASE`]: 17 to 22 kB in static runs of a
//! cracked strip (160,000 to 20,000 nodes), 26 to 28 kB where its crack grows (20,000 and 56,000), 22 kB around a
//! penny-shaped crack in a solid (21,000 and 29,000). Richer bases and wider supports take more.

use super::crack_growth::GrowthSettings;
use super::settings::Settings;
use super::solid_static::SolidSettings;
use crate::model::{Model, SolidModel};
use crate::nodes::estimated_layout;
use crate::nodes::solid::estimated_solid_nodes;

/// Memory of a static run by Galerkin's method [bytes per node].
const STATIC: f64 = 24e3;
/// The same where cracks grow: the last step is kept while the next is solved.
const GROWTH: f64 = 32e3;
/// Memory of a run by point collocation [bytes per node].
const COLLOCATION: f64 = 22e3;
/// What any run takes [bytes].
const BASE: f64 = 30e6;

/// How large a run will be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunSize {
    /// About how many nodes there will be; with an accuracy to meet, those of the first solution.
    pub n_nodes: f64,
    /// About how much memory is needed [bytes].
    pub bytes: f64,
}

impl RunSize {
    fn new(n_nodes: f64, per_node: f64) -> Self {
        Self { n_nodes, bytes: BASE + n_nodes * per_node }
    }

    /// Of a body in the plane.
    pub fn of_plane(model: &Model, settings: &Settings, growth: Option<&GrowthSettings>) -> Self {
        let per_node = if growth.is_some() { GROWTH } else { STATIC };
        Self::new(estimated_layout(model, &settings.nodes), per_node)
    }

    /// Of a solid.
    pub fn of_solid(model: &SolidModel, settings: &SolidSettings) -> Self {
        Self::new(estimated_solid_nodes(&model.body, &settings.spacing), COLLOCATION)
    }
}
