//! Growth of a crack in one load cycle as a function of its stress intensity factors.

use super::nasgro::Nasgro;
use super::{FieldProblem, Problems};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Growth per load cycle, da/dN [length per cycle], from the stress intensity factors of the cycle [stress·√length].
///
/// All numbers belong to one system of units, that of lengths and stresses of the case. ΔK is the range over which the
/// crack is open: K_max − K_min, or K_max if the cycle reaches into compression (R = K_min/K_max < 0)
/// [ASTME647]; only `nasgro` uses the whole range and a closure function of R. Below a threshold the
/// crack stands still; it is unstable as soon as K_max reaches a toughness.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum GrowthLaw {
    /// da/dN = C ΔK^m, the same for every stress ratio [Paris1963].
    Paris {
        /// C, positive [length per cycle / (stress·√length)^m].
        coefficient: f64,
        /// m, positive.
        exponent: f64,
        /// Least ΔK that makes the crack grow [stress·√length]; none if not given.
        threshold: Option<f64>,
        /// K_max at which the crack is unstable [stress·√length]; never if not given.
        toughness: Option<f64>,
    },
    /// da/dN = C ΔK_eq^m with ΔK_eq = ΔK / (1 − R)^(1 − γ), and R = 0 for cycles into compression [Walker1970].
    Walker {
        /// C at R = 0, positive [length per cycle / (stress·√length)^m].
        coefficient: f64,
        /// m, positive.
        exponent: f64,
        /// γ from 0 (K_max alone drives the crack) to 1 (ΔK alone does, as in `paris`).
        gamma: f64,
        /// Least ΔK_eq, thus least ΔK at R = 0, that makes the crack grow [stress·√length]; none if not given.
        threshold: Option<f64>,
        /// K_max at which the crack is unstable [stress·√length]; never if not given.
        toughness: Option<f64>,
    },
    /// da/dN = C ΔK^m / ((1 − R) K_c − ΔK), and R = 0 for cycles into compression [Forman1967].
    Forman {
        /// C, positive [length per cycle / (stress·√length)^(m − 1)].
        coefficient: f64,
        /// m, positive.
        exponent: f64,
        /// K_c, positive [stress·√length]: K_max at which the crack is unstable.
        toughness: f64,
        /// Least ΔK that makes the crack grow [stress·√length]; none if not given.
        threshold: Option<f64>,
    },
    /// The NASGRO equation, with closure, a threshold that depends on R, and toughness [NASGRO].
    Nasgro(Nasgro),
    /// Measured points, straight lines between them on logarithmic axes, the same for every stress ratio.
    Tabulated {
        /// At least two points, both values ascending. Below the first the crack stands still, beyond the last the line
        /// through the last two continues.
        points: Vec<TablePoint>,
        /// K_max at which the crack is unstable [stress·√length]; never if not given.
        toughness: Option<f64>,
    },
}

/// A point of a measured growth curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TablePoint {
    /// ΔK, positive [stress·√length].
    pub stress_intensity_range: f64,
    /// da/dN, positive [length per cycle].
    pub rate: f64,
}

/// What a load cycle does to a crack.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rate {
    /// The crack stands still.
    Arrested,
    /// It grows by this much, positive [length per cycle].
    Growing(f64),
    /// It runs: the largest stress intensity factor reaches the toughness.
    Unstable,
}

impl Rate {
    /// Growth by `rate` [length per cycle]; arrest unless that is positive.
    pub(super) fn from_growth(rate: f64) -> Self {
        if rate > 0.0 { Self::Growing(rate) } else { Self::Arrested }
    }
}

impl GrowthLaw {
    /// Growth in a cycle between two stress intensity factors.
    ///
    /// - `minimum`, `maximum`: over the cycle, negative where the load would press the crack faces together
    ///   [stress·√length]
    pub fn rate(&self, minimum: f64, maximum: f64) -> Rate {
        if self.toughness().is_some_and(|toughness| maximum >= toughness) {
            return Rate::Unstable;
        }
        if !(maximum > 0.0 && maximum > minimum) {
            return Rate::Arrested;
        }
        let range = maximum - minimum.max(0.0);
        match self {
            Self::Paris { coefficient, exponent, threshold, .. } => {
                above(range, *threshold, || coefficient * range.powf(*exponent))
            }
            Self::Walker { coefficient, exponent, gamma, threshold, .. } => {
                // 1 − R is ΔK/K_max.
                let equivalent = range.powf(*gamma) * maximum.powf(1.0 - gamma);
                above(equivalent, *threshold, || coefficient * equivalent.powf(*exponent))
            }
            Self::Forman { coefficient, exponent, toughness, threshold } => above(range, *threshold, || {
                coefficient * range.powf(*exponent) / (range / maximum * (toughness - maximum))
            }),
            Self::Nasgro(law) => law.rate_below_toughness(minimum, maximum),
            Self::Tabulated { points, .. } => interpolated(points, range),
        }
    }

    /// K_max at which the crack is unstable [stress·√length], if the law knows one.
    pub fn toughness(&self) -> Option<f64> {
        match self {
            Self::Paris { toughness, .. } | Self::Walker { toughness, .. } | Self::Tabulated { toughness, .. } => {
                *toughness
            }
            Self::Forman { toughness, .. } | Self::Nasgro(Nasgro { toughness, .. }) => Some(*toughness),
        }
    }

    /// Number of the piece of the law that a cycle lies on: within a piece the rate is smooth, and it only rises with
    /// the stress intensity factors of a given ratio.
    pub(super) fn piece(&self, minimum: f64, maximum: f64) -> usize {
        match self.rate(minimum, maximum) {
            Rate::Arrested => 0,
            Rate::Growing(_) => match self {
                Self::Tabulated { points, .. } => 1 + segment(points, maximum - minimum.max(0.0)).unwrap_or(0),
                Self::Paris { .. } | Self::Walker { .. } | Self::Forman { .. } | Self::Nasgro(_) => 1,
            },
            Rate::Unstable => usize::MAX,
        }
    }

    /// Whether a crack that slows down on the way to the threshold gets there in a finite number of cycles.
    ///
    /// The rate of the NASGRO equation falls as a power p of the distance; from p = 1 on the cycles have no bound.
    pub(super) fn reaches_threshold(&self) -> bool {
        match self {
            Self::Nasgro(law) => law.p < 1.0,
            Self::Paris { .. } | Self::Walker { .. } | Self::Forman { .. } | Self::Tabulated { .. } => true,
        }
    }

    /// Everything that keeps the law from being used, empty if it is sound.
    pub fn problems(&self) -> Vec<FieldProblem> {
        match self {
            Self::Paris { coefficient, exponent, threshold, toughness } => {
                power_law_problems("paris", *coefficient, *exponent, *threshold, *toughness).found
            }
            Self::Walker { coefficient, exponent, gamma, threshold, toughness } => {
                let mut problems = power_law_problems("walker", *coefficient, *exponent, *threshold, *toughness);
                problems.demand("gamma", *gamma, "0 to 1", |v| (0.0..=1.0).contains(&v));
                problems.found
            }
            Self::Forman { coefficient, exponent, toughness, threshold } => {
                power_law_problems("forman", *coefficient, *exponent, *threshold, Some(*toughness)).found
            }
            Self::Nasgro(law) => law.problems(),
            Self::Tabulated { points, toughness } => table_problems(points, *toughness),
        }
    }
}

fn above(driving: f64, threshold: Option<f64>, rate: impl FnOnce() -> f64) -> Rate {
    if threshold.is_some_and(|threshold| driving < threshold) { Rate::Arrested } else { Rate::from_growth(rate()) }
}

fn interpolated(points: &[TablePoint], range: f64) -> Rate {
    let Some(segment) = segment(points, range) else { return Rate::Arrested };
    let (from, to) = (points[segment], points[segment + 1]);
    let slope = (to.rate / from.rate).ln() / (to.stress_intensity_range / from.stress_intensity_range).ln();
    Rate::from_growth(from.rate * (range / from.stress_intensity_range).powf(slope))
}

/// The line of a table that holds for `range`, none below the first point; the last one has no end.
fn segment(points: &[TablePoint], range: f64) -> Option<usize> {
    let n_below = points.partition_point(|p| p.stress_intensity_range <= range);
    (n_below > 0 && points.len() > 1).then(|| (n_below - 1).min(points.len() - 2))
}

fn power_law_problems(
    variant: &'static str,
    coefficient: f64,
    exponent: f64,
    threshold: Option<f64>,
    toughness: Option<f64>,
) -> Problems {
    let mut problems = Problems::of(variant);
    problems.positive("coefficient", coefficient);
    problems.positive("exponent", exponent);
    if let Some(toughness) = toughness {
        problems.positive("toughness", toughness);
    }
    if let Some(threshold) = threshold {
        problems.positive("threshold", threshold);
        if toughness.is_some_and(|toughness| threshold >= toughness) {
            problems.report("threshold", format!("is {threshold}"), "below `toughness`");
        }
    }
    problems
}

fn table_problems(points: &[TablePoint], toughness: Option<f64>) -> Vec<FieldProblem> {
    let mut problems = Problems::of("tabulated");
    if points.len() < 2 {
        problems.report("points", format!("holds {}", points.len()), "at least two points");
    }
    for (i, point) in points.iter().enumerate() {
        problems.positive(format!("points[{i}].stress_intensity_range"), point.stress_intensity_range);
        problems.positive(format!("points[{i}].rate"), point.rate);
    }
    for (i, pair) in points.windows(2).enumerate() {
        let columns = [
            ("stress_intensity_range", pair[0].stress_intensity_range, pair[1].stress_intensity_range),
            ("rate", pair[0].rate, pair[1].rate),
        ];
        for (name, before, after) in columns {
            if after <= before {
                let message = format!("is {after}, not above the {before} before it");
                problems.report(format!("points[{}].{name}", i + 1), message, "ascending");
            }
        }
    }
    if let Some(toughness) = toughness {
        problems.positive("toughness", toughness);
    }
    problems.found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_rate(law: &GrowthLaw, minimum: f64, maximum: f64, expected: f64) {
        let Rate::Growing(rate) = law.rate(minimum, maximum) else { panic!("{law:?} at {minimum}, {maximum}") };
        assert!((rate / expected - 1.0).abs() < 1e-13, "{law:?} at {minimum}, {maximum}: {rate}, not {expected}");
    }

    fn paris() -> GrowthLaw {
        GrowthLaw::Paris { coefficient: 1e-11, exponent: 3.0, threshold: Some(5.0), toughness: Some(50.0) }
    }

    fn walker(gamma: f64) -> GrowthLaw {
        GrowthLaw::Walker { coefficient: 1e-11, exponent: 3.0, gamma, threshold: Some(5.0), toughness: None }
    }

    fn forman() -> GrowthLaw {
        GrowthLaw::Forman { coefficient: 1e-9, exponent: 3.0, toughness: 60.0, threshold: None }
    }

    fn table() -> GrowthLaw {
        let point = |stress_intensity_range, rate| TablePoint { stress_intensity_range, rate };
        GrowthLaw::Tabulated { points: vec![point(4.0, 1e-9), point(8.0, 4e-9), point(16.0, 32e-9)], toughness: None }
    }

    #[test]
    fn power_laws_have_the_values_of_their_formulas() {
        check_rate(&paris(), 0.0, 10.0, 1e-8);
        check_rate(&paris(), 10.0, 20.0, 1e-8);
        check_rate(&paris(), -30.0, 10.0, 1e-8);
        // ΔK_eq = 10 / 0.5^0.5, its cube is 1000 · 2^1.5.
        check_rate(&walker(0.5), 10.0, 20.0, 1e-8 * 2_f64.powf(1.5));
        check_rate(&walker(0.5), -10.0, 10.0, 1e-8);
        // 1000 / (0.5 · 60 − 10) and 1000 / (60 − 10).
        check_rate(&forman(), 10.0, 20.0, 1e-9 * 50.0);
        check_rate(&forman(), -10.0, 10.0, 1e-9 * 20.0);
    }

    /// Lines of slope 2 and 3 on logarithmic axes.
    #[test]
    fn tables_are_lines_on_logarithmic_axes() {
        check_rate(&table(), 0.0, 4.0, 1e-9);
        check_rate(&table(), 6.0, 12.0, 2.25e-9);
        check_rate(&table(), 0.0, 8.0, 4e-9);
        check_rate(&table(), -9.0, 12.0, 13.5e-9);
        check_rate(&table(), 0.0, 32.0, 256e-9);
        assert_eq!(table().rate(0.0, 3.999), Rate::Arrested);
    }

    #[test]
    fn cracks_stand_still_below_the_threshold_and_run_above_the_toughness() {
        assert_eq!(paris().rate(0.0, 4.999), Rate::Arrested);
        check_rate(&paris(), 0.0, 5.0, 1.25e-9);
        assert_eq!(paris().rate(45.001, 50.0), Rate::Unstable);
        assert_eq!(paris().rate(45.001, 49.999), Rate::Arrested);
        assert_eq!(forman().rate(0.0, 60.0), Rate::Unstable);
        // The threshold of Walker's law falls as (1 − R)^(1 − γ): 5 √0.5 at R = 0.5.
        assert_eq!(walker(0.5).rate(3.53, 7.06), Rate::Arrested);
        assert!(matches!(walker(0.5).rate(3.54, 7.08), Rate::Growing(_)));
        for law in [paris(), walker(0.5), forman(), table()] {
            for (minimum, maximum) in [(-20.0, 0.0), (-20.0, -10.0), (10.0, 10.0), (0.0, f64::NAN)] {
                assert_eq!(law.rate(minimum, maximum), Rate::Arrested, "{law:?} at {minimum}, {maximum}");
            }
        }
    }

    fn check_problems(law: &str, fields: &[&str]) {
        let law: GrowthLaw = toml::from_str(law).expect(law);
        let problems = law.problems();
        let found: Vec<_> = problems.iter().map(|p| p.field.as_str()).collect();
        assert_eq!(found, fields, "{law:?}");
    }

    #[test]
    fn all_bad_fields_are_reported() {
        check_problems("[paris]\ncoefficient = 1e-11\nexponent = 3", &[]);
        let all = ["paris.coefficient", "paris.exponent", "paris.toughness", "paris.threshold", "paris.threshold"];
        check_problems("[paris]\ncoefficient = 0\nexponent = nan\nthreshold = -1\ntoughness = -2", &all);
        let gamma = "[walker]\ncoefficient = 1\nexponent = 3\ngamma = 1.5\nthreshold = inf";
        check_problems(gamma, &["walker.threshold", "walker.gamma"]);
        let forman = "[forman]\ncoefficient = 1\nexponent = 3\ntoughness = 4\nthreshold = 4";
        check_problems(forman, &["forman.threshold"]);
        let nasgro = "[nasgro]\ncoefficient = 1\nexponent = 3\np = -1\nq = -0.1\ntoughness = 50\nthreshold = 2\n";
        let fields = ["nasgro.p", "nasgro.q", "nasgro.alpha", "nasgro.stress_level"];
        check_problems(&format!("{nasgro}alpha = 0.5\nstress_level = 1"), &fields);
        let points = "[[tabulated.points]]\nstress_intensity_range = 2\nrate = 1e-8\n";
        check_problems(points, &["tabulated.points"]);
        let fields = ["tabulated.points[1].stress_intensity_range", "tabulated.points[1].rate"];
        check_problems(&points.repeat(2), &fields);
    }
}
