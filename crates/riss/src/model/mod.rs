//! The problem to solve: domain, material, cracks, loads and supports.
//!
//! Has never heard of nodes. Valid by construction when it comes from `case::build`.

pub mod cohesive;
pub mod contact;
pub mod domain;
pub mod field;
pub mod load;
pub mod solid;
pub mod solid_model;
pub mod support;
pub mod units;

use crate::crack::{CrackPath, TipFrame, TipId};
use crate::exact::ExactField;
use crate::material::{Elasticity, PlaneState};
use crate::math::Vector2;
pub use cohesive::{CohesiveCrack, CohesiveModel};
pub use contact::Contact;
pub use domain::{BoundaryPart, Domain, EdgeId, PartId};
pub use field::{FieldPoint, ScalarField};
pub use load::{BodyForce, BoundaryLoad, CrackFaceLoad, PointLoad, TractionValue};
pub use solid::{
    DirectedDisplacement, SAME_DIRECTION, Solid, SolidDirection, SurfaceConditions, SurfacePoint, VectorField,
    VectorFunction,
};
pub use solid_model::SolidModel;
use std::sync::Arc;
pub use support::{BoundarySupport, Direction, PointSupport, PrescribedValue, RigidMotion, Spring};
pub use units::UnitNames;

/// A linear elastic body in the plane with cracks, loads and supports.
#[derive(Clone, Debug)]
pub struct Model {
    /// Title of the case.
    pub title: String,
    /// The body.
    pub domain: Domain,
    /// Elastic constants and plane state.
    pub material: Elasticity,
    /// Thickness [length]; stress intensity factors do not depend on it.
    pub thickness: f64,
    /// Whether the thickness is that of the part, not a unit of it.
    pub thickness_is_given: bool,
    /// Yield stress, to judge whether the body is linear elastic [stress].
    pub yield_stress: Option<f64>,
    /// Cracks; they may touch the boundary and one another.
    pub cracks: Vec<CrackPath>,
    /// Tractions on boundary parts.
    pub loads: Vec<BoundaryLoad>,
    /// Pressures on the faces of cracks.
    pub crack_face_loads: Vec<CrackFaceLoad>,
    /// Softening of cohesive cracks, if there are any.
    pub cohesive: Option<CohesiveModel<2>>,
    /// What keeps crack faces from overlapping; without it they may.
    pub contact: Option<Contact>,
    /// Force per volume.
    pub body_force: Option<BodyForce>,
    /// Forces at points.
    pub point_loads: Vec<PointLoad>,
    /// Prescribed displacements on boundary parts.
    pub supports: Vec<BoundarySupport>,
    /// Prescribed displacements at points.
    pub point_supports: Vec<PointSupport>,
    /// Elastic foundations of boundary parts.
    pub springs: Vec<Spring>,
    /// What holds the body as a whole.
    pub rigid_motion: RigidMotion,
    /// The solution, where it is known: the analysis then reports its energy error.
    pub exact: Option<Arc<dyn ExactField>>,
}

impl Model {
    /// A body of unit modulus in plane strain without cracks, loads or supports, to be filled in.
    pub fn plain(domain: Domain) -> Self {
        let material = Elasticity { young: 1.0, poisson: 0.3, plane: PlaneState::Strain };
        Self {
            title: String::new(),
            domain,
            material,
            thickness: 1.0,
            thickness_is_given: false,
            yield_stress: None,
            cracks: vec![],
            loads: vec![],
            crack_face_loads: vec![],
            cohesive: None,
            contact: None,
            body_force: None,
            point_loads: vec![],
            supports: vec![],
            point_supports: vec![],
            springs: vec![],
            rigid_motion: RigidMotion::Supported,
            exact: None,
        }
    }

    /// Pressure on the faces of a crack at a point of its path [stress]; positive pushes them apart.
    pub fn face_pressure(&self, crack: usize, position: Vector2) -> f64 {
        let at = FieldPoint { position, normal: Vector2::zeros() };
        self.crack_face_loads.iter().filter(|l| l.crack == crack).map(|l| l.pressure.value(&at)).sum()
    }

    /// Loads on an edge of the boundary.
    pub fn loads_on(&self, edge: EdgeId) -> impl Iterator<Item = &BoundaryLoad> {
        let acts = move |part: PartId| self.domain.parts[part].edges.contains(&edge);
        self.loads.iter().filter(move |l| l.part.map_or(self.domain.outline().contains(&edge), acts))
    }

    /// Force per volume at a point.
    pub fn body_force_at(&self, position: Vector2) -> Vector2 {
        let at = FieldPoint { position, normal: Vector2::zeros() };
        self.body_force.as_ref().map_or(Vector2::zeros(), |f| Vector2::new(f.0[0].value(&at), f.0[1].value(&at)))
    }

    /// Whether anything acts on the faces of a crack.
    pub fn loads_faces(&self, crack: usize) -> bool {
        self.contact.is_some()
            || self.crack_face_loads.iter().any(|l| l.crack == crack)
            || self.cohesive_crack(crack).is_some()
    }

    /// What of a crack is cohesive, if anything is.
    pub fn cohesive_crack(&self, crack: usize) -> Option<&CohesiveCrack<2>> {
        self.cohesive.as_ref()?.crack(crack)
    }

    /// All tips, in the order of cracks and ends.
    pub fn tips(&self) -> Vec<(TipId, TipFrame)> {
        let mut tips = vec![];
        for (crack, path) in self.cracks.iter().enumerate() {
            tips.extend(path.tip_ends().map(|end| (TipId { crack, end }, path.frame(end))));
        }
        tips
    }
}
