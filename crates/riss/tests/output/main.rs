//! Files of a run, read back.

mod exports;
mod pictures;
mod report;
mod results;
mod sample;
mod solids;
mod vtk;
