//! What can go wrong once a case is valid.

use crate::math::Vector2;

/// Result of a library call.
pub type Result<T> = std::result::Result<T, Error>;

/// An analysis that could not be carried out; each variant holds what a user needs to mend it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The moving least squares fit has too few or badly placed neighbors.
    #[error(
        "the moment matrix is singular at ({}, {}): {n_neighbors} visible neighbors, {needed} or more in general position are needed; add nodes there or enlarge the dilation",
        point.x, point.y
    )]
    SingularMomentMatrix {
        /// Where the fit failed.
        point: Vector2,
        /// Visible nodes whose support covers the point.
        n_neighbors: usize,
        /// Least number of neighbors for the basis.
        needed: usize,
    },
    /// The fit of point collocation has too few or badly placed neighbors.
    #[error(
        "the fit{} at {} has {n_neighbors} visible neighbors that do not determine second derivatives: {needed} or more in general position are needed; add nodes there",
        node.map_or(String::new(), |i| format!(" of node {i}")), coordinates(position)
    )]
    PoorStencil {
        /// The node, if the fit is at one.
        node: Option<usize>,
        /// Where the fit failed.
        position: Vec<f64>,
        /// Visible nodes in its support.
        n_neighbors: usize,
        /// Least number of neighbors for the basis.
        needed: usize,
    },
    /// An iterative solver did not converge.
    #[error(
        "{method} reached a relative residual of {residual:.1e} in {iterations} iterations for {n_unknowns} unknowns, {allowed:.1e} is allowed{hint}"
    )]
    NotConverged {
        /// What was tried.
        method: String,
        /// Multiplications by the matrix.
        iterations: usize,
        /// Size of the system.
        n_unknowns: usize,
        /// True relative residual reached.
        residual: f64,
        /// Relative residual that is allowed.
        allowed: f64,
        /// What may help, with a leading separator; may be empty.
        hint: String,
    },
    /// The material is too near to incompressible for point collocation.
    #[error("Poisson's ratio {poisson} is above {allowed}, the most that point collocation is made for")]
    NearlyIncompressible {
        /// Poisson's ratio.
        poisson: f64,
        /// The largest allowed.
        allowed: f64,
    },
    /// A part of the body can move without deforming.
    #[error("the body is not held: {motion} is free{}", component_text(*.component))]
    FreeRigidMotion {
        /// The free motion in words.
        motion: String,
        /// A point of the piece that is free, if the body falls into several.
        component: Option<Vector2>,
    },
    /// The factorization met a pivot that is not positive.
    #[error("the stiffness matrix cannot be factored: {reason}")]
    Factorization {
        /// What the solver says.
        reason: String,
    },
    /// The solution does not satisfy the equations.
    #[error("the linear solver reached a relative residual of {residual:.1e}, {allowed:.1e} is allowed")]
    Residual {
        /// Relative residual reached.
        residual: f64,
        /// Relative residual that is allowed.
        allowed: f64,
    },
    /// The nodes or cells could not be made.
    #[error("node generation failed: {reason}")]
    NodeGeneration {
        /// What is wrong with the geometry or the request.
        reason: String,
    },
    /// A load curve has no end.
    #[error("the load curve breaks off: {reason}")]
    LoadCurve {
        /// Why.
        reason: String,
    },
    /// No integration domain fits around a tip.
    #[error("no integration domain fits around the crack tip at ({}, {}): {reason}", tip.x, tip.y)]
    NoTipDomain {
        /// The crack tip.
        tip: Vector2,
        /// Why.
        reason: String,
    },
}

fn coordinates(position: &[f64]) -> String {
    let text: Vec<String> = position.iter().map(|v| v.to_string()).collect();
    format!("({})", text.join(", "))
}

fn component_text(component: Option<Vector2>) -> String {
    component.map_or(String::new(), |p| format!(", for the piece of the body around ({:.6}, {:.6})", p.x, p.y))
}
