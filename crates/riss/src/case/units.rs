//! Units: what stands behind a number ("200 GPa"), and the system of a case ("mm, N, MPa").
//!
//! A small table instead of a crate: stress intensity factors need half powers of a length and coefficients of growth
//! laws any power, which `uom` (units fixed at compile time), `dyn_quantity` (whole powers) and the interpreters `rink`
//! and `numbat` (megabytes of language around it) do not offer.

use crate::model::UnitNames;

/// Longer texts are no units.
const MAX_LENGTH: usize = 100;
/// Parentheses inside each other.
const MAX_DEPTH: usize = 8;
/// Two units with a ratio this close to 1 are the same: products of a few rounded factors.
const SAME: f64 = 1e-12;

/// Powers of length and force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Dimension {
    pub length: f64,
    pub force: f64,
}

/// Dimensions as the descriptions of keys name them in brackets.
const NAMED: [(&str, &str, Dimension); 8] = [
    ("length", "a length", Dimension::new(1.0, 0.0)),
    ("stress", "a stress", Dimension::new(-2.0, 1.0)),
    ("force", "a force", Dimension::new(0.0, 1.0)),
    ("stress/length", "a force per volume", Dimension::new(-3.0, 1.0)),
    ("stress·length", "a force per length", Dimension::new(-1.0, 1.0)),
    ("stress·√length", "a stress intensity factor", Dimension::new(-1.5, 1.0)),
    ("length per cycle", "a length per cycle", Dimension::new(1.0, 0.0)),
    ("force·length", "an energy", Dimension::new(1.0, 1.0)),
];

impl Dimension {
    const fn new(length: f64, force: f64) -> Self {
        Self { length, force }
    }

    /// The dimension with a name such as `stress/length`.
    pub fn named(name: &str) -> Option<Self> {
        NAMED.iter().find(|n| n.0 == name).map(|n| n.2)
    }

    pub fn is_same(self, other: Self) -> bool {
        (self.length - other.length).abs() < 1e-9 && (self.force - other.force).abs() < 1e-9
    }

    /// In words, for messages.
    pub fn words(self) -> String {
        match NAMED.iter().find(|n| n.2.is_same(self)) {
            Some(named) => named.1.into(),
            None if self.is_same(Self::new(0.0, 0.0)) => "a plain number".into(),
            None => format!("length^{} force^{}", self.length, self.force),
        }
    }
}

/// `mantissa · 10^exponent` in N and m. Powers of ten apart, so that 200 GPa are exactly 200000 N/mm².
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unit {
    mantissa: f64,
    exponent: f64,
    pub dimension: Dimension,
}

/// Newtons in a pound-force: 0.45359237 kg times 9.80665 m/s², both exact by definition.
const POUND: f64 = 4.4482216152605;

const fn unit(mantissa: f64, exponent: f64, length: f64, force: f64) -> Unit {
    Unit { mantissa, exponent, dimension: Dimension::new(length, force) }
}

/// Units that take prefixes.
const PREFIXED: [(&str, Unit); 5] = [
    ("m", unit(1.0, 0.0, 1.0, 0.0)),
    ("N", unit(1.0, 0.0, 0.0, 1.0)),
    ("Pa", unit(1.0, 0.0, -2.0, 1.0)),
    ("J", unit(1.0, 0.0, 1.0, 1.0)),
    ("bar", unit(1.0, 5.0, -2.0, 1.0)),
];
/// Units that take none. An inch is 2.54 cm, a foot 12 inches.
const PLAIN: [(&str, Unit); 10] = [
    ("in", unit(2.54, -2.0, 1.0, 0.0)),
    ("ft", unit(3.048, -1.0, 1.0, 0.0)),
    ("lbf", unit(POUND, 0.0, 0.0, 1.0)),
    ("kip", unit(POUND, 3.0, 0.0, 1.0)),
    ("kgf", unit(9.80665, 0.0, 0.0, 1.0)),
    ("dyn", unit(1.0, -5.0, 0.0, 1.0)),
    ("psi", unit(POUND / (2.54 * 2.54), 4.0, -2.0, 1.0)),
    ("ksi", unit(POUND / (2.54 * 2.54), 7.0, -2.0, 1.0)),
    ("Msi", unit(POUND / (2.54 * 2.54), 10.0, -2.0, 1.0)),
    ("cycle", unit(1.0, 0.0, 0.0, 0.0)),
];
const PREFIXES: [(&str, f64); 11] = [
    ("n", -9.0),
    ("u", -6.0),
    ("µ", -6.0),
    ("μ", -6.0),
    ("m", -3.0),
    ("c", -2.0),
    ("d", -1.0),
    ("da", 1.0),
    ("k", 3.0),
    ("M", 6.0),
    ("G", 9.0),
];
/// Names that a derived unit may get.
const FORCES: [&str; 6] = ["N", "kN", "MN", "lbf", "kip", "kgf"];
const STRESSES: [&str; 6] = ["Pa", "kPa", "MPa", "GPa", "psi", "ksi"];

/// What may stand in a unit, for messages.
pub(super) const ALLOWED: &str =
    "m, N, Pa, J, bar with n µ m c d k M G before them, in, ft, lbf, kip, kgf, psi, ksi; * / ^ sqrt( )";

impl Unit {
    /// Reads a unit such as `kN/m^2` or `MPa√m`.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(text: &str) -> Result<Self, String> {
        if text.len() > MAX_LENGTH {
            return Err(format!("a unit has at most {MAX_LENGTH} characters"));
        }
        let mut reader = Reader { rest: text.trim(), depth: 0 };
        let unit = reader.product()?;
        if reader.rest.is_empty() { Ok(unit) } else { Err(format!("unexpected `{}` in a unit", reader.rest)) }
    }

    fn symbol(name: &str) -> Option<Self> {
        if let Some((_, unit)) = PLAIN.iter().chain(&PREFIXED).find(|u| u.0 == name) {
            return Some(*unit);
        }
        PREFIXED.iter().find_map(|(symbol, unit)| {
            let prefix = name.strip_suffix(symbol)?;
            let power = PREFIXES.iter().find(|p| p.0 == prefix)?.1;
            Some(Self { exponent: unit.exponent + power, ..*unit })
        })
    }

    fn times(self, other: Self, power: f64) -> Self {
        let other = other.power(power);
        Self {
            mantissa: self.mantissa * other.mantissa,
            exponent: self.exponent + other.exponent,
            dimension: Dimension::new(
                self.dimension.length + other.dimension.length,
                self.dimension.force + other.dimension.force,
            ),
        }
    }

    fn power(self, power: f64) -> Self {
        Self {
            mantissa: if self.mantissa == 1.0 { 1.0 } else { self.mantissa.powf(power) },
            exponent: self.exponent * power,
            dimension: Dimension::new(self.dimension.length * power, self.dimension.force * power),
        }
    }

    /// `value` of this unit in N and m.
    pub fn in_si(self, value: f64) -> f64 {
        scaled(value, self.mantissa, self.exponent)
    }
}

/// `value · mantissa · 10^exponent`, rounded once where the mantissa is 1 and the exponent whole.
fn scaled(value: f64, mantissa: f64, exponent: f64) -> f64 {
    let value = if mantissa == 1.0 { value } else { value * mantissa };
    // Powers of ten up to 22 are exact.
    let whole = exponent.abs() <= 22.0 && exponent.fract() == 0.0;
    match (whole, exponent >= 0.0) {
        (true, true) => value * 10f64.powi(exponent as i32),
        (true, false) => value / 10f64.powi(-exponent as i32),
        (false, _) => value * 10f64.powf(exponent),
    }
}

struct Reader<'t> {
    rest: &'t str,
    depth: usize,
}

impl<'t> Reader<'t> {
    fn take(&mut self, texts: &[&str]) -> bool {
        let found = texts.iter().find_map(|t| self.rest.strip_prefix(t));
        self.rest = found.unwrap_or(self.rest);
        found.is_some()
    }

    fn skip_blanks(&mut self) {
        self.rest = self.rest.trim_start();
    }

    fn product(&mut self) -> Result<Unit, String> {
        let mut unit = self.factor()?;
        loop {
            self.skip_blanks();
            if self.rest.is_empty() || self.rest.starts_with(')') {
                return Ok(unit);
            }
            let power = if self.take(&["/"]) { -1.0 } else { 1.0 };
            if power > 0.0 {
                self.take(&["*", "·", "⋅"]);
            }
            self.skip_blanks();
            unit = unit.times(self.factor()?, power);
        }
    }

    /// A symbol, a root or a product in parentheses, with its power. `MPa√m` is one factor: `1/MPa√m` divides by all of it.
    fn factor(&mut self) -> Result<Unit, String> {
        let (unit, is_root) = self.primary()?;
        let unit = if is_root { unit } else { unit.power(self.exponent()?) };
        if !self.rest.starts_with('√') {
            return Ok(unit);
        }
        let root = self.primary()?.0;
        if self.rest.starts_with(['^', '²', '³']) {
            return Err("put the factor before this power into parentheses, such as (MPa√m)^3".into());
        }
        Ok(unit.times(root, 1.0))
    }

    fn primary(&mut self) -> Result<(Unit, bool), String> {
        if self.take(&["√", "sqrt"]) {
            let inside = if self.rest.starts_with('(') { self.group()? } else { self.symbol()? };
            return Ok((inside.power(0.5), true));
        }
        let unit = if self.rest.starts_with('(') { self.group()? } else { self.symbol()? };
        Ok((unit, false))
    }

    fn group(&mut self) -> Result<Unit, String> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err("too many parentheses in a unit".into());
        }
        self.take(&["("]);
        self.skip_blanks();
        let unit = self.product()?;
        self.depth -= 1;
        if self.take(&[")"]) { Ok(unit) } else { Err("a parenthesis is not closed in a unit".into()) }
    }

    fn symbol(&mut self) -> Result<Unit, String> {
        let end = self.rest.find(|c: char| !c.is_alphabetic()).unwrap_or(self.rest.len());
        let (name, rest) = self.rest.split_at(end);
        self.rest = rest;
        match name {
            "" => Err("a unit is missing".into()),
            _ => Unit::symbol(name).ok_or_else(|| format!("unknown unit `{name}`")),
        }
    }

    fn exponent(&mut self) -> Result<f64, String> {
        for (sign, power) in [("²", 2.0), ("³", 3.0), ("⁴", 4.0)] {
            if self.take(&[sign]) {
                return Ok(power);
            }
        }
        if !self.take(&["^", "**"]) {
            return Ok(1.0);
        }
        let is_group = self.take(&["("]);
        let end = self.rest.find(|c: char| !c.is_ascii_digit() && !"+-.".contains(c)).unwrap_or(self.rest.len());
        let (text, rest) = self.rest.split_at(end);
        self.rest = rest;
        let power = text.parse::<f64>().ok().filter(|p| p.abs() <= 20.0);
        match power {
            Some(power) if !is_group || self.take(&[")"]) => Ok(power),
            _ => Err("a power in a unit is a number, such as m^2 or m^0.5".into()),
        }
    }
}

/// Consistent units of a case.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct UnitSystem {
    pub names: UnitNames,
    length: Unit,
    force: Unit,
}

impl UnitSystem {
    /// Reads a list such as `mm, N, MPa`; one of force and stress may be left out.
    ///
    /// # Errors
    /// What is wrong with it, and what to do about it.
    pub fn parse(text: &str) -> Result<Self, (String, String)> {
        let example = || "write the units of length, force and stress, such as \"mm, N, MPa\"".to_string();
        let mut found: [Option<(String, Unit)>; 3] = [None, None, None];
        for name in text.split(',').map(str::trim) {
            let unit = Unit::parse(name).map_err(|message| (message, example()))?;
            let kinds = ["length", "force", "stress"];
            let of = |k: &&str| Dimension::named(k).is_some_and(|d| d.is_same(unit.dimension));
            let Some(kind) = kinds.iter().position(of) else {
                return Err((format!("`{name}` is {}", unit.dimension.words()), example()));
            };
            if found[kind].replace((name.into(), unit)).is_some() {
                return Err((format!("there are two units of {}", kinds[kind]), example()));
            }
        }
        let [length, force, stress] = found;
        let Some((length_name, length)) = length else { return Err(("no unit of length".into(), example())) };
        let area = length.power(2.0);
        let (force_name, force) = match (force, &stress) {
            (Some(force), _) => force,
            (None, Some((name, stress))) => {
                let force = stress.times(area, 1.0);
                (known(&FORCES, force).unwrap_or_else(|| format!("{name}·{length_name}²")), force)
            }
            (None, None) => return Err(("no unit of force or stress".into(), example())),
        };
        let derived = force.times(area, -1.0);
        let derived_name = known(&STRESSES, derived).unwrap_or_else(|| format!("{force_name}/{length_name}²"));
        let stress_name = match stress {
            None => derived_name,
            Some((name, stress)) if is_same(stress, derived) => name,
            Some((name, _)) => {
                let message = format!("{length_name} and {force_name} do not go with {name}");
                let hint = format!(
                    "{force_name} per {length_name}² is {derived_name}: write \"{length_name}, {force_name}, {derived_name}\""
                );
                return Err((message, hint));
            }
        };
        let names = UnitNames { length: length_name, force: force_name, stress: stress_name };
        Ok(Self { names, length, force })
    }

    /// `value` of `unit` in the units of the case.
    pub fn convert(&self, value: f64, unit: Unit) -> f64 {
        let Dimension { length, force } = unit.dimension;
        let ratio = unit.times(self.length, -length).times(self.force, -force);
        // Powers of roots and of 2.54 cancel up to roundoff.
        let mantissa = if (ratio.mantissa - 1.0).abs() < SAME { 1.0 } else { ratio.mantissa };
        scaled(value, mantissa, ratio.exponent)
    }

    /// `value` in the units of the case, with dimension `dimension`, in N and m.
    pub fn in_si(&self, value: f64, dimension: Dimension) -> f64 {
        let unit = self.length.power(dimension.length).times(self.force, dimension.force);
        unit.in_si(value)
    }
}

fn is_same(a: Unit, b: Unit) -> bool {
    (a.in_si(1.0) / b.in_si(1.0) - 1.0).abs() < SAME
}

/// The name in a list that means this unit.
fn known(names: &[&str], unit: Unit) -> Option<String> {
    let means = |name: &&&str| Unit::symbol(name).is_some_and(|u| is_same(u, unit));
    names.iter().find(means).map(|n| n.to_string())
}

#[cfg(test)]
mod tests;
