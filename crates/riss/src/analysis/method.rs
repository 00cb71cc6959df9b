//! The numerical method: which parts an analysis is put together from, and what they default to.

use super::crack_growth::GrowthSettings;
use super::crack_growth::settings::IncrementControl;
use super::settings::Settings;
use crate::approximation::EnrichmentKind;
use crate::crack::CrackForm;
use crate::fracture::{FractureSettings, GrowthCriterion, TipDomainShape};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Support radius over node spacing [CPM, section 2.1].
const PARTICLE_DILATION: f64 = 2.2;
/// A turn beyond which an increment is halved [CPM, section 3.2] [degrees].
const PARTICLE_TURN: f64 = 5.0;

/// Numerical method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Element-free Galerkin with moving least squares [EFG].
    #[default]
    ElementFreeGalerkin,
    /// Cracking particles [CPM]: cracks are segments of particles along them, on regular and given nodes too, which hide the
    /// two sides from each other. Where nothing else is said, `approximation.dilation` is 2.2 (linear basis),
    /// `fracture.domain` is `square`, `growth.criterion` is `configurational-force` and `growth.control` halves increments that
    /// turn by more than 5 degrees once.
    CrackingParticles,
}

impl Method {
    /// Name in case files and results.
    pub fn name(self) -> &'static str {
        match self {
            Self::ElementFreeGalerkin => "element-free-galerkin",
            Self::CrackingParticles => "cracking-particles",
        }
    }

    /// How shape functions meet cracks.
    pub fn crack_form(self) -> CrackForm {
        match self {
            Self::ElementFreeGalerkin => CrackForm::Path,
            Self::CrackingParticles => CrackForm::Particles,
        }
    }

    /// The settings of the method where nothing is said.
    ///
    /// Differs from [CPM, section 2.2]: displacements are prescribed by Nitsche's method, as with the other method.
    pub fn settings(self) -> Settings {
        let mut settings = Settings { method: self, ..Settings::default() };
        match self {
            Self::ElementFreeGalerkin => {}
            Self::CrackingParticles => {
                settings.approximation.dilation = Some(PARTICLE_DILATION);
                settings.approximation.enrichment.kind = EnrichmentKind::None;
                // Differs from [CPM, section 3.1]: with the faces, the force does not depend on the size of the domain.
                settings.fracture = FractureSettings { domain: TipDomainShape::Square, ..settings.fracture };
            }
        }
        settings
    }

    /// The growth settings of the method where nothing is said.
    pub fn growth(self) -> GrowthSettings {
        match self {
            Self::ElementFreeGalerkin => GrowthSettings::default(),
            Self::CrackingParticles => GrowthSettings {
                criterion: GrowthCriterion::ConfigurationalForce,
                control: IncrementControl::HalvedOnTurns { angle_deg: PARTICLE_TURN, least: 0.5 },
                ..GrowthSettings::default()
            },
        }
    }
}
