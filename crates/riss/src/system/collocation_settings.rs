//! Choices of point collocation.

use crate::approximation::ConstrainedMlsSettings;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Reach of the functions of a front over the spacing there. Beyond it polynomials have to follow the field, on nodes that
/// become coarser: with 12, edge cracks in slabs lose 2 to 10 %, with 40 some tenths of a percent.
const REACH: f64 = 40.0;

/// Point collocation: shape functions, corners, fronts and solver.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct CollocationSettings {
    /// Constrained moving least squares.
    pub approximation: ConstrainedMlsSettings,
    /// Distance from crack fronts up to which their functions are in the basis, over the spacing of nodes there; 0 for
    /// none. Where a front bends it is less, down to eight spacings, to stay away from the center of the bend.
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub front_reach: f64,
    /// Nodes on crack fronts.
    pub front_nodes: FrontNodes,
    /// Nodes at concave edges and corners.
    pub concave_corners: ConcaveCorners,
    /// Linear solver.
    pub solver: CollocationSolver,
}

impl Default for CollocationSettings {
    fn default() -> Self {
        Self {
            approximation: ConstrainedMlsSettings::default(),
            front_reach: REACH,
            front_nodes: FrontNodes::default(),
            concave_corners: ConcaveCorners::default(),
            solver: CollocationSolver::default(),
        }
    }
}

/// What holds at nodes on crack fronts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FrontNodes {
    /// The displacement is that which the other nodes around give there. Rules out fields that are more singular than
    /// that of a crack.
    #[default]
    Fitted,
    /// There are none: fronts have no nodes.
    Omitted,
    /// The mean of the tractions of all faces that meet at the node, each with its own shape functions (Eqs. 44, 45).
    Averaged,
    /// Equilibrium as inside the body.
    Equilibrium,
}

impl FrontNodes {
    /// Whether nodes on fronts are left out.
    pub fn are_omitted(self) -> bool {
        match self {
            Self::Omitted => true,
            Self::Averaged | Self::Equilibrium | Self::Fitted => false,
        }
    }
}

/// Shape functions for the tractions at concave edges and corners.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ConcaveCorners {
    /// One set for each surface, from what is visible from it (Eqs. 44, 45).
    #[default]
    Averaged,
    /// One set for all, from what is visible from the node.
    Single,
}

/// Solution of the equations of collocation, which are not symmetric.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CollocationSolver {
    /// Direct for few nodes, iterative for many.
    #[default]
    Automatic,
    /// Sparse LU factorization.
    Direct,
    /// IDR(4) with an incomplete factorization and a coarse grid of affine motions.
    Iterative,
}
