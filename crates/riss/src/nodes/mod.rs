//! Nodes: where they stand and how far they reach.

pub mod settings;

pub use settings::NodeSettings;
