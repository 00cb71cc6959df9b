//! Analyses: they join all the stages below and report to an [`Observer`].

pub mod contact;
pub mod convergence;
pub mod crack_growth;
pub mod energy;
mod error_bars;
pub mod fields;
mod guard_rails;
pub mod linear_static;
pub mod memory;
pub mod method;
pub mod node_function;
pub mod record;
pub mod refinement;
pub mod settings;
mod solid_boundary;
pub mod solid_cohesive;
pub mod solid_convergence;
mod solid_error_bars;
mod solid_front_discs;
pub mod solid_growth;
mod solid_guard_rails;
pub mod solid_record;
pub mod solid_static;
mod warnings;

pub use convergence::{ConvergenceStudy, Limit, converge};
pub use crack_growth::{GrowthSettings, GrowthState, crack_growth};
pub use linear_static::{discretize, linear_static};
pub use memory::RunSize;
pub use method::Method;
pub use node_function::{NodeFunction, nearest_node, sample_node_function};
pub use record::*;
pub use refinement::{Refined, solve_refined};
pub use settings::Settings;
pub use solid_boundary::BoundaryFields;
pub use solid_cohesive::{
    CohesiveSurfaces, GrownSurface, LoadPoint, LoadingRecord, LoadingSettings, LoadingStep, solid_loading,
};
pub use solid_convergence::{SolidConvergenceStudy, converge_solid};
pub use solid_growth::{FrontCriterion, SolidGrowthSettings, SolidGrowthState, SolidStep, solid_growth};
pub use solid_record::{FrontPointRecord, FrontRecord, OpenedCrack, SolidResult, principal_stresses};
pub use solid_static::{SolidSettings, solid_collocation, solid_nodes, solid_static};
pub use warnings::Warning;
