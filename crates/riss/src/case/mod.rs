//! case
pub mod gmsh;
