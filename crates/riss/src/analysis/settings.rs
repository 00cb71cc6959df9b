//! All numerical choices of an analysis.

use super::method::Method;
use crate::adaptivity::AccuracySettings;
use crate::approximation::ApproximationSettings;
use crate::fracture::FractureSettings;
use crate::integration::IntegrationSettings;
use crate::nodes::NodeSettings;
use crate::system::{ConstraintMethod, LinearSolver};

/// Numerical choices; the default gives stress intensity factors to better than 1 % on ordinary problems.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Settings {
    /// Numerical method.
    pub method: Method,
    /// Placement of nodes.
    pub nodes: NodeSettings,
    /// Shape functions.
    pub approximation: ApproximationSettings,
    /// Numerical integration.
    pub integration: IntegrationSettings,
    /// Essential conditions.
    pub constraints: ConstraintMethod,
    /// Linear solver.
    pub solver: LinearSolver,
    /// Fracture quantities.
    pub fracture: FractureSettings,
    /// Accuracy to refine for; without it, the nodes are as placed.
    pub accuracy: Option<AccuracySettings>,
}
