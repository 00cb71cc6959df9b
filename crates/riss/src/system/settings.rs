//! Choices for essential conditions and the linear solver.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Enforcement of prescribed displacements on boundary parts [EFG, section 3.1].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum ConstraintMethod {
    /// Nitsche's method: the modified variational principle, made stable.
    Nitsche {
        /// Stabilization times spacing over stiffness, positive; about 40. Below about 20 the matrix may become singular.
        #[serde(default = "default_nitsche_factor")]
        #[schemars(range(min = 0.0))]
        factor: f64,
    },
    /// Lagrange multipliers, linear between the boundary nodes (Eq. 26).
    LagrangeMultipliers,
    /// Penalty (Eq. 28).
    Penalty {
        /// Penalty times spacing over stiffness, positive; about 1e4.
        #[serde(default = "default_penalty_factor")]
        #[schemars(range(min = 0.0))]
        factor: f64,
    },
    /// Multipliers replaced by the boundary traction (Eq. 27); may lose definiteness.
    ModifiedVariational,
    /// A row of finite elements along the supports, joined to the nodes behind by a ramp: displacements are prescribed at the
    /// nodes, and linear between them [Krongauz1996; Belytschko1995]. Arcs are held by Nitsche's method besides, as straight elements
    /// leave a gap there.
    FiniteElementCoupled,
}

/// The least factor that is stable on irregular nodes lies between 5 and 10 for the linear basis, between 10 and 20 for
/// the quadratic one; up to 100 the error does not depend on it.
pub(super) const NITSCHE_FACTOR: f64 = 40.0;

fn default_nitsche_factor() -> f64 {
    NITSCHE_FACTOR
}

fn default_penalty_factor() -> f64 {
    1e4
}

impl Default for ConstraintMethod {
    fn default() -> Self {
        Self::Nitsche { factor: default_nitsche_factor() }
    }
}

/// Factorization of the stiffness matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum LinearSolver {
    /// Double precision; single precision with conjugate gradients for large systems.
    #[default]
    Automatic,
    /// Sparse Cholesky (or LBLᵀ with multipliers) in double precision.
    Direct,
    /// Single precision Cholesky as preconditioner of conjugate gradients in double precision.
    MixedPrecision,
}
