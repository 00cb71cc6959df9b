//! Gmsh files as bodies: plates with two holes saved by Gmsh 4.15, small meshes by hand, and damaged files.

mod by_hand;
mod damaged;
mod two_holes;
