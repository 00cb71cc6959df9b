//! How the results of two runs of solids differ: factors along fronts, steps of growth, load curves.

use super::loading_comparison::{LoadingComparison, Tolerances, relative};
use super::solid_results::{FrontPointResults, FrontResults, SolidResults};
use crate::math::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Pieces into which a front is divided between two of its points.
const PIECES: usize = 16;
/// Points as far past the end of an open front, over its length, still belong to it.
const SLACK: f64 = 1e-6;

/// Differences of a second run of a solid from a first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolidComparison {
    /// Steps that belong together; one if no cracks grow.
    pub steps: Vec<StepComparison>,
    /// Numbers of steps of growth that only the first has.
    pub only_in_first: Vec<usize>,
    /// Numbers of steps of growth that only the second has.
    pub only_in_second: Vec<usize>,
    /// Load curves, if both have one.
    pub loading: Option<LoadingComparison>,
    /// Largest principal stresses [stress].
    pub largest_principal: [Option<f64>; 2],
    /// What only one of them has, in words.
    pub unlike: Vec<String>,
}

/// Differences of two steps.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StepComparison {
    /// Their numbers.
    pub steps: [usize; 2],
    /// Area of all cracks [area], where they grow.
    pub crack_areas: [Option<f64>; 2],
    /// Factors on the loads at which fronts grow, where they grow by the strength.
    pub load_factors: [Option<f64>; 2],
    /// Fronts that both have.
    pub fronts: Vec<FrontComparison>,
}

/// Differences along one front.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrontComparison {
    /// Name of its crack.
    pub crack: String,
    /// Its number among the fronts of that crack, from 0.
    pub front: usize,
    /// Lengths of both [length].
    pub lengths: [Option<f64>; 2],
    /// Greatest distance of a point of the first front from the second one, as far as both go [length].
    pub front_distance: Option<f64>,
    /// The same over the length of the first front.
    pub front_distance_relative: Option<f64>,
    /// Points of the first front that were compared; the second is interpolated between its points.
    pub points: usize,
    /// Greatest difference of a factor over the largest magnitude of all three along the first front.
    #[serde(rename = "K_difference")]
    pub k_difference: Option<f64>,
    /// Length along the first front where it is [length].
    pub s: Option<f64>,
    /// Mean of that difference over the points.
    #[serde(rename = "K_difference_mean")]
    pub k_difference_mean: Option<f64>,
    /// The larger error bar of both runs where the difference is greatest, over the same magnitude.
    #[serde(rename = "K_uncertainty")]
    pub k_uncertainty: Option<f64>,
}

impl SolidComparison {
    /// Compares two runs. Cracks belong together by name, steps of growth by the area of all cracks.
    pub fn new(first: &SolidResults, second: &SolidResults) -> Self {
        let mut unlike = vec![];
        let mut tell = |[a, b]: [bool; 2], what: &str| {
            if a != b {
                unlike.push(format!("{what} only in {}", if a { "A" } else { "B" }));
            }
        };
        let (a, b) = (moments(first), moments(second));
        tell([!first.steps.is_empty(), !second.steps.is_empty()], "growth");
        tell([!first.load_curve.is_empty(), !second.load_curve.is_empty()], "a load curve");
        let fronts = |r: &SolidResults| r.fronts.iter().map(|f| f.crack.clone()).collect::<Vec<_>>();
        let names = |of: &[String], other: &[String]| {
            let mut names: Vec<String> = of.iter().filter(|n| !other.contains(n)).cloned().collect();
            names.dedup();
            names
        };
        let (fronts_a, fronts_b) = (fronts(first), fronts(second));
        names(&fronts_a, &fronts_b).iter().for_each(|n| tell([true, false], &format!("a front of crack {n}")));
        names(&fronts_b, &fronts_a).iter().for_each(|n| tell([false, true], &format!("a front of crack {n}")));
        let pairs = paired(&a, &b);
        let missing = |all: &[Moment], side: usize| {
            let is_paired = |k: &usize| pairs.iter().any(|p| p[side] == *k);
            (0..all.len()).filter(|k| !is_paired(k)).map(|k| all[k].step).collect()
        };
        Self {
            steps: pairs.iter().map(|[i, k]| compare_step(&a[*i], &b[*k])).collect(),
            only_in_first: missing(&a, 0),
            only_in_second: missing(&b, 1),
            loading: LoadingComparison::new(first.loading_with_curve(), second.loading_with_curve()),
            largest_principal: [first, second].map(|r| r.stress.largest_principal),
            unlike,
        }
    }

    /// Whether both have the same fronts, steps and load curves, within tolerances. Of bodies with neither, the stress counts.
    pub fn agrees(&self, allowed: &Tolerances) -> bool {
        let fronts = || self.steps.iter().flat_map(|s| &s.fronts);
        let near = |f: &FrontComparison| {
            f.k_difference.is_some_and(|d| d <= allowed.k)
                && f.front_distance_relative.is_some_and(|d| d <= allowed.path)
        };
        let loads = self.loading.as_ref().is_none_or(|l| l.agrees(allowed.load));
        let is_bare = self.loading.is_none() && fronts().next().is_none();
        let stress = relative(self.largest_principal).is_some_and(|d| d.abs() <= allowed.load);
        self.unlike.is_empty()
            && self.only_in_first.is_empty()
            && self.only_in_second.is_empty()
            && fronts().all(near)
            && loads
            && (!is_bare || stress)
    }
}

/// What is known of cracks at one time.
struct Moment<'a> {
    step: usize,
    area: Option<f64>,
    load_factor: Option<f64>,
    fronts: &'a [FrontResults],
}

fn moments(results: &SolidResults) -> Vec<Moment<'_>> {
    if results.steps.is_empty() {
        return vec![Moment { step: 0, area: None, load_factor: None, fronts: &results.fronts }];
    }
    let moment = |s: &'_ _| {
        let s: &super::solid_results::SolidStepResults = s;
        (s.step, s.cracks.iter().map(|c| c.area).sum::<Option<f64>>(), s.load_factor)
    };
    let of = results.steps.iter().map(|s| (moment(s), &s.fronts));
    of.map(|((step, area, load_factor), fronts)| Moment { step, area, load_factor, fronts }).collect()
}

/// Steps whose areas are nearest to each other, both ways.
fn paired(a: &[Moment], b: &[Moment]) -> Vec<[usize; 2]> {
    let nearest = |of: &Moment, among: &[Moment]| {
        let Some(area) = of.area else { return Some(0) };
        let distance = |m: &Moment| m.area.map_or(f64::INFINITY, |v| (v - area).abs());
        (0..among.len()).min_by(|i, k| distance(&among[*i]).total_cmp(&distance(&among[*k])))
    };
    let pair = |i: usize| nearest(&a[i], b).filter(|k| nearest(&b[*k], a) == Some(i)).map(|k| [i, k]);
    (0..a.len()).filter_map(pair).collect()
}

fn compare_step(a: &Moment, b: &Moment) -> StepComparison {
    let mut fronts = vec![];
    for (k, front) in a.fronts.iter().enumerate() {
        let number = a.fronts[..k].iter().filter(|f| f.crack == front.crack).count();
        if let Some(other) = b.fronts.iter().filter(|f| f.crack == front.crack).nth(number) {
            fronts.push(compare_front(number, front, other));
        }
    }
    StepComparison {
        steps: [a.step, b.step],
        crack_areas: [a.area, b.area],
        load_factors: [a.load_factor, b.load_factor],
        fronts,
    }
}

/// A place on a front with what is known there.
#[derive(Clone, Copy)]
struct Station {
    position: Vector3,
    factors: Option<Vector3>,
    uncertainty: f64,
}

fn station(p: &FrontPointResults) -> Option<Station> {
    let factors = match (p.k1, p.k2, p.k3) {
        (Some(k1), Some(k2), Some(k3)) => Some(Vector3::new(k1, k2, k3)),
        _ => None,
    };
    Some(Station { position: triple(p.position)?, factors, uncertainty: p.k_uncertainty.unwrap_or(0.0) })
}

fn triple(v: [Option<f64>; 3]) -> Option<Vector3> {
    Some(Vector3::new(v[0]?, v[1]?, v[2]?))
}

fn compare_front(number: usize, a: &FrontResults, b: &FrontResults) -> FrontComparison {
    let curve = fine(b);
    let size = a.points.iter().filter_map(|p| station(p)?.factors).map(|k| k.norm()).fold(0.0, f64::max);
    let mut distance: Option<f64> = None;
    let mut worst: Option<(f64, Option<f64>, f64)> = None;
    let (mut sum, mut points) = (0.0, 0);
    for p in &a.points {
        let Some((here, (there, apart))) = station(p).and_then(|s| Some((s, nearest(&s, b, &curve)?))) else {
            continue;
        };
        distance = Some(distance.unwrap_or(0.0).max(apart));
        let (Some(k), Some(l)) = (here.factors, there.factors) else { continue };
        if size > 0.0 {
            let difference = (k - l).amax() / size;
            (sum, points) = (sum + difference, points + 1);
            if worst.is_none_or(|w| difference > w.0) {
                worst = Some((difference, p.s, here.uncertainty.max(there.uncertainty) / size));
            }
        }
    }
    FrontComparison {
        crack: a.crack.clone(),
        front: number,
        lengths: [a.length, b.length],
        front_distance: distance,
        front_distance_relative: distance.zip(a.length).filter(|(_, l)| *l > 0.0).map(|(d, l)| d / l),
        points,
        k_difference: worst.map(|w| w.0),
        s: worst.and_then(|w| w.1),
        k_difference_mean: worst.map(|_| sum / points as f64),
        k_uncertainty: worst.map(|w| w.2),
    }
}

/// Points close together along a front: cubic pieces with the tangents of its axes.
fn fine(front: &FrontResults) -> Vec<Station> {
    let with_tangent = |p: &FrontPointResults| {
        let tangent = triple(p.ahead)?.cross(&triple(p.normal)?);
        Some((station(p)?, tangent, p.s?))
    };
    let known: Vec<(Station, Vector3, f64)> = front.points.iter().filter_map(with_tangent).collect();
    let n = known.len();
    let last = if front.closed { n } else { n.saturating_sub(1) };
    let mut all = vec![];
    for k in 0..last {
        let ((p, t, s), (q, u, r)) = (known[k], known[(k + 1) % n]);
        let around = if k + 1 == n { front.length.unwrap_or(0.0) } else { 0.0 };
        let length = r + around - s;
        let to = if k + 1 == last { PIECES + 1 } else { PIECES };
        for piece in 0..to {
            let x = piece as f64 / PIECES as f64;
            let (x2, x3) = (x * x, x * x * x);
            let position = p.position * (2.0 * x3 - 3.0 * x2 + 1.0)
                + t * (length * (x3 - 2.0 * x2 + x))
                + q.position * (3.0 * x2 - 2.0 * x3)
                + u * (length * (x3 - x2));
            let factors = p.factors.zip(q.factors).map(|(a, b)| a + (b - a) * x);
            all.push(Station { position, factors, uncertainty: p.uncertainty.max(q.uncertainty) });
        }
    }
    if all.is_empty() { known.into_iter().map(|k| k.0).collect() } else { all }
}

/// The place of a front next to a station, and how far away; none past the ends of an open front.
fn nearest(from: &Station, front: &FrontResults, curve: &[Station]) -> Option<(Station, f64)> {
    let mut best: Option<(f64, Station)> = None;
    for w in curve.windows(2) {
        let (d, r) = (w[1].position - w[0].position, from.position - w[0].position);
        let t = (r.dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        let distance = (r - d * t).norm();
        if best.is_none_or(|b| distance < b.0) {
            let factors = w[0].factors.zip(w[1].factors).map(|(a, b)| a + (b - a) * t);
            let place = Station { position: w[0].position + d * t, factors, uncertainty: w[0].uncertainty };
            best = Some((distance, place));
        }
    }
    let (distance, place) = best?;
    if !front.closed {
        let past = |end: &Station, inner: &Station| {
            let out = (end.position - inner.position).normalize();
            (from.position - end.position).dot(&out) > SLACK * front.length.unwrap_or(0.0)
        };
        let n = curve.len();
        let at = |end: &Station| (place.position - end.position).norm() <= f64::EPSILON * end.position.norm();
        if at(&curve[0]) && past(&curve[0], &curve[1]) || at(&curve[n - 1]) && past(&curve[n - 1], &curve[n - 2]) {
            return None;
        }
    }
    Some((place, distance))
}

#[cfg(test)]
mod tests;
