//! Crack propagation in solids with meshfree methods.
//!
//! The pipeline is the architecture: each folder makes one plain value that the next one reads.
//!
//! ```text
//! case -> Model -> Nodes -> ShapeFunctions -> IntegrationPoint -> LinearSystem -> Solution -> TipState -> output
//! ```

#![deny(missing_docs)]

pub mod error;

pub mod math;

pub mod geometry;

pub mod material;

pub mod exact;

pub mod crack;

pub mod model;

pub mod nodes;

pub mod approximation;

pub mod integration;

pub mod system;

pub mod fracture;

pub mod adaptivity;

pub mod analysis;

pub mod case;

pub mod output;

pub use error::{Error, Result};
