//! Files of a run, read back.

mod pictures;
mod results;
mod sample;
mod vtk;
