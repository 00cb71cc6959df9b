//! A cracked solid: its surface, its cracks, and what acts on them.

use super::cohesive::{CohesiveCrack, CohesiveModel};
use super::solid::Solid;
use crate::crack::CrackSurface;
use crate::geometry::surface::Surface;

/// A linear elastic solid in space with cracks, loads and supports.
#[derive(Clone, Debug)]
pub struct SolidModel {
    /// Title of the case.
    pub title: String,
    /// Boundary of the body; conditions belong to its parts by index.
    pub body: Surface,
    /// Names of the cracks.
    pub crack_names: Vec<String>,
    /// The cracks.
    pub cracks: Vec<CrackSurface>,
    /// Yield stress, if the case says it [stress].
    pub yield_stress: Option<f64>,
    /// Material, loads and supports.
    pub solid: Solid<3>,
    /// Cohesive cracks, if there are some.
    pub cohesive: Option<CohesiveModel<3>>,
}

impl SolidModel {
    /// What a crack is before the load, if it is cohesive.
    pub fn cohesive_crack(&self, crack: usize) -> Option<&CohesiveCrack<3>> {
        self.cohesive.as_ref()?.crack(crack)
    }
}
