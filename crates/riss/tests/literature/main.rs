//! Crack problems of the literature and of closed form, solved through the public interface.

mod arc_crack;
mod bodies;
mod closed_crack;
mod energy_release;
mod enrichment;
mod extrinsic;
mod junctions;
mod near_tip;
mod pressurized_crack;
mod robustness;
mod shear_edge_crack;
mod tip_quantities;
