//! How much memory a run will take, told before it starts: nodes that the case asks for, times what a node takes.
//!
//! What a node takes was measured (`theory/verification` of the book says how): it grows slowly with the number of nodes,
//! and the values here are those of large runs.

use super::crack_growth::GrowthSettings;
use super::settings::Settings;
use super::solid_static::SolidSettings;
use crate::model::{Model, SolidModel};
use crate::nodes::estimated_layout;
use crate::nodes::solid::estimated_solid_nodes;

/// Memory of a static run by Galerkin's method [bytes per node].
const STATIC: f64 = 35e3;
/// The same where cracks grow: the last step is kept while the next is solved.
const GROWTH: f64 = 57e3;
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
