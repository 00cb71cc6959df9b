//! Point collocation of elastic solids against closed forms.

mod boxes;
mod cavity;
mod convergence;
mod near_tip;
mod patch;
mod penny;
mod solver;
