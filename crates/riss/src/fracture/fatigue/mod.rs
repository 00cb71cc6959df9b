//! Fatigue: growth of a crack per load cycle, load spectra, and the cycles that an increment takes. Knows no crack.
//!
//! [`growth_law`] gives the rate of one cycle ([`nasgro`] holds the largest law), [`spectrum`] the cycles of a load
//! history ([`rainflow`] counts them), [`mean_rate`](mod@mean_rate) joins both and [`life`] integrates.

pub mod growth_law;
pub mod life;
pub mod mean_rate;
pub mod nasgro;
pub mod rainflow;
pub mod spectrum;

pub use growth_law::{GrowthLaw, Rate, TablePoint};
pub use life::{Ending, Increment, LifeOverIncrement, cycles_over};
pub use mean_rate::{cycles_per_repetition, mean_rate};
pub use nasgro::Nasgro;
pub use spectrum::{Block, LoadCycle, LoadSpectrum};

/// A value that a growth law or a spectrum cannot work with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldProblem {
    /// Keys below the option, such as `paris.exponent` or `blocks.blocks[1].cycles`.
    pub field: String,
    /// What is wrong.
    pub message: String,
    /// What is allowed.
    pub allowed: String,
}

/// Collects the problems of one variant.
struct Problems {
    variant: &'static str,
    found: Vec<FieldProblem>,
}

impl Problems {
    fn of(variant: &'static str) -> Self {
        Self { variant, found: vec![] }
    }

    /// Reports `field` unless the condition `holds`; comparisons with NaN do not hold.
    fn demand(&mut self, field: impl std::fmt::Display, value: f64, allowed: &str, holds: fn(f64) -> bool) {
        if !(value.is_finite() && holds(value)) {
            self.report(field, "out of range".to_string(), allowed);
        }
    }

    fn positive(&mut self, field: impl std::fmt::Display, value: f64) {
        self.demand(field, value, "positive and finite", |v| v > 0.0);
    }

    fn finite(&mut self, field: impl std::fmt::Display, value: f64) {
        self.demand(field, value, "finite", |_| true);
    }

    fn report(&mut self, field: impl std::fmt::Display, message: impl Into<String>, allowed: impl Into<String>) {
        let field = format!("{}.{field}", self.variant);
        self.found.push(FieldProblem { field, message: message.into(), allowed: allowed.into() });
    }
}
