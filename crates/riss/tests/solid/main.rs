//! Point collocation of elastic solids against closed forms.

mod bent;
mod boxes;
mod cavity;
mod cohesive;
mod convergence;
mod front_conditions;
mod front_integral;
mod near_tip;
mod node_cells;
mod patch;
mod penny;
mod solver;
