//! Files of a run, read back.

mod results;
mod sample;
mod vtk;
