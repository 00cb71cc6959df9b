//! Choices for the extraction of fracture quantities.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Integration domains around crack tips.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FractureSettings {
    /// Shape of the domains.
    pub domain: TipDomainShape,
    /// How J and the configurational force are integrated; stress intensity factors always come from domains.
    pub j_integral: JIntegral,
    /// What the crack faces add to the configurational force.
    pub crack_faces: FaceTerm,
    /// Radii (half edges for squares) of the domains, at least three, ascending [length]; automatic if not given.
    pub radii: Option<Vec<f64>>,
}

/// Shape of the domain of interaction and J-integrals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TipDomainShape {
    /// A disk around the tip.
    #[default]
    Disc,
    /// A square around the tip, two sides along the crack.
    Square,
}

/// Integration of J and of the configurational force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum JIntegral {
    /// Over the domains: the smoother one.
    #[default]
    Domain,
    /// Along the outlines of the domains.
    Contour,
}

/// The part of the configurational force that the crack faces hold [CPM, Eq. 13].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FaceTerm {
    /// Included: the force does not depend on the domain.
    #[default]
    Included,
    /// Left out: with a T-stress and mode II, the part to the side depends on the size of the domain.
    LeftOut,
}
