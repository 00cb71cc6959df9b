//! Clouds of nodes in solids: on corners, edges, boundary and crack faces, then irregular ones inside.
//!
//! Each stage advances from the points that are there [SlakKosec2019]: [`curves`] along edges and mouths of cracks,
//! [`faces`] over surfaces, [`inside`] through the body; [`facets`] then splits what stands on cracks and says what
//! meets at each node. Every two nodes keep [`CLOSENESS`] of their spacing apart, save pairs on faces and what narrow
//! geometry forces together.

mod bends;
mod bins;
mod curves;
mod faces;
mod facets;
mod inside;
mod loads;
mod sites;
pub mod spacing;
mod spread_load;
mod supports;
#[cfg(test)]
mod tests;
mod walls;

use super::cloud::Cloud;
use crate::crack::CrackSurface;
use crate::error::{Error, Result};
use crate::geometry::obstacles::{OpaqueTriangles, opaque_part};
use crate::geometry::surface::Surface;
pub use bends::bend_regions;
pub use loads::load_regions;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sites::Sites;
pub use spacing::{Region, SolidSpacing, SpacingPlan};
pub use spread_load::spread_load;
pub use supports::support_regions;
pub use walls::{thinnest_wall, wall_regions};

/// Least distance of two nodes over the mean of their spacings.
pub const CLOSENESS: f64 = 0.8;
/// Least distance of nodes from surfaces that they do not stand on, and from crack fronts, over their spacing.
pub const CLEARANCE: f64 = 0.5;
/// Angle of an edge of a crack from which its sides are two faces, between whose nodes the edge passes [rad]: normals
/// smoothed over less of a bend are as good.
const FOLD: f64 = 0.15;
/// More nodes than this are refused.
pub const MAX_SOLID_NODES: usize = 3_000_000;

/// Whether nodes stand on crack fronts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum NodesOnFronts {
    /// The front passes between nodes, at half their spacing.
    #[default]
    None,
    /// Single nodes on the front, as in [C3D, Eqs. 44, 45].
    Single,
}

/// A cloud with its pairs of nodes on crack faces.
#[derive(Clone, Debug, Default)]
pub struct SolidCloud {
    /// The nodes: on the boundary, on crack faces, on fronts, then inside.
    pub cloud: Cloud<3>,
    /// Pairs at one position.
    pub pairs: Vec<FacePair>,
}

/// Two nodes at one position on both faces of a crack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FacePair {
    /// Index of the crack.
    pub crack: u32,
    /// Node on the positive side, node on the negative side.
    pub nodes: [u32; 2],
}

/// Places nodes.
///
/// # Errors
/// [`Error::NodeGeneration`] if the spacing asks for too many nodes.
pub fn generate_solid(
    body: &Surface,
    cracks: &[CrackSurface],
    spacing: &SolidSpacing,
    fronts: NodesOnFronts,
) -> Result<SolidCloud> {
    let n = estimated_solid_nodes(body, spacing);
    if !(n <= MAX_SOLID_NODES as f64) {
        let reason = format!("the spacing asks for about {n:.1e} nodes, at most {MAX_SOLID_NODES} are made");
        return Err(Error::NodeGeneration { reason });
    }
    let mut sites = Sites::new(body, cracks, spacing);
    curves::place(&mut sites, fronts);
    faces::place(&mut sites);
    let on_surfaces = sites.list.len();
    inside::place(&mut sites, MAX_SOLID_NODES);
    Ok(facets::split(&sites, on_surfaces))
}

/// What sight lines between nodes cannot pass: cracks, and boundaries that are not convex.
pub fn solid_obstacles(body: &Surface, cracks: &[CrackSurface]) -> OpaqueTriangles {
    let mut triangles = opaque_part(body);
    cracks.iter().for_each(|c| triangles.extend(&c.barrier));
    OpaqueTriangles::new(triangles)
}

/// About how many nodes a spacing asks for: volume over its cube, plus half a layer on the boundary.
pub fn estimated_solid_nodes(body: &Surface, spacing: &SolidSpacing) -> f64 {
    inside::estimate(body, spacing)
}
