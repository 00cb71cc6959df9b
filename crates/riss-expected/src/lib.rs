//! Reference values of a case and their comparison with a run.
//!
//! `expected.json` holds `source`, and any of `tips`, `fronts`, `largest_principal_stress`, `strain_energy`, `energy_error`, `reactions`, `paths`, `end` and
//! `cycles`. A reference is `{"value": 1.0, "tolerance": 0.01}` with a relative tolerance, or `"absolute"` in its place,
//! and may name its own `source`:
//!
//! ```json
//! {
//!   "source": "Wilson (1969)",
//!   "tips": [{ "crack": "crack-1", "end": "end", "K_I": { "value": 34.0, "tolerance": 0.01 } }],
//!   "reactions": { "bottom": { "x": { "value": 0.0, "absolute": 1e-6 } } }
//! }
//! ```
//!
//! Crack growth has more. Tips may name a `step` (0 if not given). `paths` compares the path at the end with the
//! vertices in a file of the case folder, with the greatest `distance` allowed; `within` limits the comparison. `end`
//! says why growth ends, what tips did last, and the part or crack that they met. `cycles` are those at the end, or
//! until a `crack` has a `length`. `"run": "verify"` keeps a long case out of the tests: only `cargo xtask verify` runs it.
//!
//! ```json
//! {
//!   "source": "finite elements",
//!   "run": "verify",
//!   "tips": [{ "crack": "left", "end": "end", "step": 5, "K_I": { "value": 34.0, "tolerance": 0.01 } }],
//!   "paths": [{ "crack": "left", "file": "left.csv", "distance": 0.02, "within": { "x": [0, 2.9] } }],
//!   "end": { "kind": "no-tip-grows", "tips": [
//!     { "crack": "left", "end": "end", "status": "reached-hole", "meets": "lower-hole" }
//!   ] },
//!   "cycles": [{ "crack": "left", "length": 2.5, "value": 1.2e5, "tolerance": 0.01 }]
//! }
//! ```
//!
//! Solids have `fronts`: without `take`, a reference holds along all fronts of the crack; `"take": "greatest"`, `"least"`
//! or `"mean"` picks one value, and `"at": [x, y, z]` that of the evaluated point there. `largest_principal_stress` is that at a node.
//! Where cracks grow, all this is of the last step, and so is `crack_area`. With cohesive cracks, `loading` has `peak_load`,
//! `displacement_at_peak`, `stiffness` up to the first crack, `dissipated_energy` in the end, and why that came (`end`).
//!
//! ```json
//! {
//!   "source": "Sneddon (1946)",
//!   "fronts": [{ "crack": "penny", "K_I": { "value": 1.128, "tolerance": 0.01 } }]
//! }
//! ```

mod path;
mod quantity;
mod read;
mod run;

pub use path::{Point, Window};
pub use quantity::{Along, Measured, Quantity};
pub use run::{CaseRun, run_case};

use serde_json::Value;

/// How far a computed value may lie from its reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    /// As a part of the reference.
    Relative(f64),
    /// In the unit of the reference.
    Absolute(f64),
}

/// What a quantity should be.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// A number, and what passes.
    Number(f64, Tolerance),
    /// This word.
    Word(String),
}

/// One reference value.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// What it is.
    pub quantity: Quantity,
    /// What it should be.
    pub target: Target,
    /// Where it comes from.
    pub source: String,
}

/// Who runs a case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RunBy {
    /// The tests and `cargo xtask verify`.
    #[default]
    Tests,
    /// `cargo xtask verify` only.
    Verify,
}

/// All reference values of a case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Expected {
    /// Who runs it.
    pub run_by: RunBy,
    /// In the order of tips, scalars, reactions, paths, end, cycles.
    pub references: Vec<Reference>,
}

impl Expected {
    /// Compares all references with the results of a run.
    pub fn compare(&self, results: &Value) -> Vec<Comparison> {
        let with_value = |r: &Reference| Comparison { computed: r.quantity.find_in(results), reference: r.clone() };
        self.references.iter().map(with_value).collect()
    }
}

/// A reference beside what was computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The reference.
    pub reference: Reference,
    /// What the run says, if it says anything.
    pub computed: Option<Measured>,
}

impl Comparison {
    /// The error of a number, in the same measure as the tolerance; signed.
    pub fn error(&self) -> Option<f64> {
        let (Target::Number(value, tolerance), Some(Measured::Number(computed))) =
            (&self.reference.target, &self.computed)
        else {
            return None;
        };
        Some(match tolerance {
            Tolerance::Relative(_) => (computed - value) / value.abs(),
            Tolerance::Absolute(_) => computed - value,
        })
    }

    /// Whether the computed value is there and near enough.
    pub fn passed(&self) -> bool {
        match &self.reference.target {
            Target::Number(_, Tolerance::Relative(most) | Tolerance::Absolute(most)) => {
                self.error().is_some_and(|e| e.abs() <= *most)
            }
            Target::Word(word) => self.computed == Some(Measured::Word(word.clone())),
        }
    }

    /// The cells of a table row: quantity, reference, computed, error, tolerance.
    pub fn cells(&self) -> [String; 5] {
        let computed = match &self.computed {
            None => "missing".into(),
            Some(Measured::Number(v)) => number(*v),
            Some(Measured::Word(word)) => word.clone(),
        };
        let name = self.reference.quantity.name();
        let (value, tolerance) = match &self.reference.target {
            Target::Word(word) => return [name, word.clone(), computed, String::new(), String::new()],
            Target::Number(value, tolerance) => (*value, *tolerance),
        };
        let measure = |v: f64| match tolerance {
            Tolerance::Relative(_) => format!("{:.2} %", 100.0 * v),
            Tolerance::Absolute(_) => number(v),
        };
        let (Tolerance::Relative(most) | Tolerance::Absolute(most)) = tolerance;
        let error = |e: f64| format!("{}{}", if e < 0.0 { "-" } else { "+" }, measure(e.abs()));
        [name, number(value), computed, self.error().map_or(String::new(), error), measure(most)]
    }
}

/// Five digits, with an exponent where that is shorter.
fn number(v: f64) -> String {
    if v == 0.0 || (1e-3..1e5).contains(&v.abs()) {
        let digits = if v == 0.0 { 1.0 } else { v.abs().log10().floor() };
        format!("{v:.*}", (4.0 - digits).clamp(0.0, 7.0) as usize)
    } else {
        format!("{v:.4e}")
    }
}

#[cfg(test)]
mod tests;
