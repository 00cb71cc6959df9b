//! Points, curves, boxes and searches.
//!
//! Reading order: [`predicates`], [`aabb`], [`tree`], [`point_tree`], [`curve`], [`polygon`], [`obstacles`], [`geodesics`]; in space
//! [`triangle`], [`surface`]. Has never heard of cracks, nodes or loads.

pub mod aabb;
pub mod curve;
pub mod geodesics;
pub mod obstacles;
pub mod path_distance;
pub mod point_tree;
pub mod polygon;
pub mod predicates;
pub mod surface;
pub mod tree;
pub mod triangle;
