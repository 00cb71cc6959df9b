//! Which numbers and words of the results have references.

use crate::path::{self, Point, Window};
use serde_json::Value;

/// Which number or word of the results is meant.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// A number at a crack tip.
    Tip {
        /// Name of the crack.
        crack: String,
        /// `start` or `end`.
        end: String,
        /// `K_I`, `K_II`, `K_I_direct`, `K_II_direct`, `J`, `T` or `kink_angle_deg`.
        key: String,
        /// Step of the run; 0 without growth.
        step: usize,
    },
    /// A number along the front of a crack in a solid.
    Front {
        /// Name of the crack.
        crack: String,
        /// `K_I`, `K_II`, `K_III`, `T` or `J`.
        key: String,
        /// Which of the values.
        along: Along,
    },
    /// The largest principal stress at a node of a solid.
    LargestPrincipalStress,
    /// A number of the whole body, in the first step.
    Scalar(String),
    /// `peak_load`, `displacement_at_peak`, `dissipated_energy` or the initial `stiffness` of a solid with cohesive cracks.
    Loading(String),
    /// Why its loading ended.
    LoadingEnd,
    /// A component of the force on a supported part, in the first step.
    Reaction {
        /// Name of the part.
        part: String,
        /// `x` or `y`.
        axis: String,
    },
    /// Distance of the path at the end from a reference path.
    Path {
        /// Name of the crack.
        crack: String,
        /// The reference path.
        reference: Vec<Point>,
        /// Where they are compared.
        window: Window,
    },
    /// Why growth ended.
    EndKind,
    /// What a tip did last.
    TipStatus {
        /// Name of the crack.
        crack: String,
        /// `start` or `end`.
        end: String,
    },
    /// Name of the part or crack that the last increment of a tip meets.
    Meets {
        /// Name of the crack.
        crack: String,
        /// `start` or `end`.
        end: String,
    },
    /// Load cycles at the end, or until a crack has a length.
    Cycles {
        /// Name and length of the crack; half the length if both ends are tips.
        until: Option<(String, f64)>,
    },
}

/// Which value along the front of a crack is meant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Along {
    /// The least.
    Least,
    /// The greatest.
    Greatest,
    /// The mean.
    Mean,
    /// That at the evaluated point next to this place, no farther from it than a hundredth of the front.
    At([f64; 3]),
}

/// What a run says.
#[derive(Clone, Debug, PartialEq)]
pub enum Measured {
    /// A number.
    Number(f64),
    /// A word.
    Word(String),
}

impl Quantity {
    /// Name in tables.
    pub fn name(&self) -> String {
        match self {
            Self::Tip { crack, end, key, step: 0 } => format!("{key} at {crack}, {end}"),
            Self::Tip { crack, end, key, step } => format!("{key} at {crack}, {end}, step {step}"),
            Self::Front { crack, key, along } => {
                let which = match along {
                    Along::Least => "least",
                    Along::Greatest => "greatest",
                    Along::Mean => "mean",
                    Along::At([x, y, z]) => return format!("{key} of {crack} at ({x}, {y}, {z})"),
                };
                format!("{which} {key} of {crack}")
            }
            Self::LargestPrincipalStress => "largest principal stress".into(),
            Self::Scalar(key) => key.replace('_', " "),
            Self::Loading(key) => key.replace('_', " "),
            Self::LoadingEnd => "end of loading".into(),
            Self::Reaction { part, axis } => format!("reaction {axis} of {part}"),
            Self::Path { crack, .. } => format!("path of {crack}, distance"),
            Self::EndKind => "end of growth".into(),
            Self::TipStatus { crack, end } => format!("status of {crack}, {end}"),
            Self::Meets { crack, end } => format!("{crack}, {end} meets"),
            Self::Cycles { until: None } => "cycles".into(),
            Self::Cycles { until: Some((crack, length)) } => format!("cycles until {crack} is {length} long"),
        }
    }

    /// What the results of a run say.
    pub fn find_in(&self, results: &Value) -> Option<Measured> {
        let steps = results["steps"].as_array().map_or(&[][..], Vec::as_slice);
        let first = steps.first().unwrap_or(&Value::Null);
        let number = match self {
            Self::Tip { crack, end, key, step } => tip(steps.get(*step)?, crack, end)?[key].as_f64()?,
            Self::Front { crack, key, along } => along_front(results, crack, key, *along)?,
            Self::LargestPrincipalStress => results["stress"]["largest_principal"].as_f64()?,
            // A run with growth has a strain energy in every step, and the last one has none if the body came apart.
            Self::Scalar(key) => first[key].as_f64().or_else(|| results[key].as_f64())?,
            Self::Loading(key) => loading(results, key)?,
            Self::LoadingEnd => return word(&results["loading"]["end"]["kind"]),
            Self::Reaction { part, axis } => first["reactions"][part][usize::from(axis == "y")].as_f64()?,
            Self::Path { crack, reference, window } => {
                path::distance(&path_of(steps.last()?, crack)?, reference, window)?
            }
            Self::EndKind => return word(&results["growth_end"]["kind"]),
            Self::TipStatus { crack, end } => return word(&last_tip(steps, crack, end)?["status"]),
            Self::Meets { crack, end } => {
                let reason = last_tip(steps, crack, end)?["reason"].as_str()?;
                return reason.split('`').nth(1).map(|name| Measured::Word(name.into()));
            }
            Self::Cycles { until: None } => steps.last()?["cycles"].as_f64()?,
            Self::Cycles { until: Some((crack, length)) } => cycles_until(steps, crack, *length)?,
        };
        Some(Measured::Number(number))
    }
}

/// From the load curve of a solid with cohesive cracks.
fn loading(results: &Value, key: &str) -> Option<f64> {
    let (loading, first) = (&results["loading"], &results["load_curve"][1]);
    match key {
        "peak_load" => loading["peak"]["load"].as_f64(),
        "displacement_at_peak" => loading["peak"]["displacement"].as_f64(),
        "dissipated_energy" => loading["dissipated_energy"].as_f64(),
        // Up to the first crack the body is elastic.
        "stiffness" => Some(first["load"].as_f64()? / first["displacement"].as_f64()?),
        _ => None,
    }
}

/// From all fronts of a crack; nothing if a point of them lacks the number.
fn along_front(results: &Value, crack: &str, key: &str, along: Along) -> Option<f64> {
    let fronts = results["fronts"].as_array()?.iter().filter(|f| f["crack"] == *crack);
    if let Along::At(place) = along {
        return at_place(fronts, key, place);
    }
    let points = fronts.map(|f| f["points"].as_array()).collect::<Option<Vec<_>>>()?;
    let values: Vec<f64> = points.into_iter().flatten().map(|p| p[key].as_f64()).collect::<Option<_>>()?;
    match along {
        Along::Least => values.into_iter().reduce(f64::min),
        Along::Greatest => values.into_iter().reduce(f64::max),
        Along::Mean if values.is_empty() => None,
        Along::Mean => Some(values.iter().sum::<f64>() / values.len() as f64),
        Along::At(_) => None,
    }
}

/// The number at the point next to a place.
fn at_place<'a>(fronts: impl Iterator<Item = &'a Value>, key: &str, place: [f64; 3]) -> Option<f64> {
    let mut next: Option<(f64, f64)> = None;
    for front in fronts {
        let reach = 0.01 * front["length"].as_f64()?;
        for point in front["points"].as_array()? {
            let mut square = 0.0;
            for d in 0..3 {
                square += (point["position"][d].as_f64()? - place[d]).powi(2);
            }
            if square.sqrt() <= reach && next.is_none_or(|(least, _)| square < least) {
                next = Some((square, point[key].as_f64()?));
            }
        }
    }
    next.map(|(_, value)| value)
}

fn word(value: &Value) -> Option<Measured> {
    value.as_str().map(|w| Measured::Word(w.into()))
}

fn crack_of<'a>(step: &'a Value, name: &str) -> Option<&'a Value> {
    step["cracks"].as_array()?.iter().find(|c| c["name"] == *name)
}

fn tip<'a>(step: &'a Value, crack: &str, end: &str) -> Option<&'a Value> {
    crack_of(step, crack)?["tips"].as_array()?.iter().find(|t| t["end"] == *end)
}

/// The tip in the last step in which it is one.
fn last_tip<'a>(steps: &'a [Value], crack: &str, end: &str) -> Option<&'a Value> {
    steps.iter().rev().find_map(|s| tip(s, crack, end))
}

fn path_of(step: &Value, crack: &str) -> Option<Vec<Point>> {
    let point = |p: &Value| Some([p[0].as_f64()?, p[1].as_f64()?]);
    let path: Vec<Point> = crack_of(step, crack)?["path"].as_array()?.iter().map(point).collect::<Option<_>>()?;
    (path.len() >= 2).then_some(path)
}

/// Linear between the steps before and after.
fn cycles_until(steps: &[Value], crack: &str, length: f64) -> Option<f64> {
    let point = |s: &Value| Some((length_of(s, crack)?, s["cycles"].as_f64()?));
    let points: Vec<(f64, f64)> = steps.iter().map(point).collect::<Option<_>>()?;
    let i = points.windows(2).position(|w| w[0].0 <= length && length <= w[1].0 * (1.0 + 1e-12))?;
    let ((a, n), (b, m)) = (points[i], points[i + 1]);
    Some(n + (m - n) * ((length - a) / (b - a)).min(1.0))
}

/// Length of a crack; half of it if both ends are tips.
fn length_of(step: &Value, crack: &str) -> Option<f64> {
    let path = path_of(step, crack)?;
    let length: f64 = path.windows(2).map(|w| f64::hypot(w[1][0] - w[0][0], w[1][1] - w[0][1])).sum();
    let ends = crack_of(step, crack)?["ends"].as_array()?;
    Some(if ends.iter().all(|e| e == "tip") { 0.5 * length } else { length })
}
