//! How each vertex of each front moves, from a solution.

use super::super::solid_record::{FrontRecord, SolidResult};
use super::super::solid_static::Solved;
use crate::crack::{CrackFront, FrontPoint, FrontStep, GrowingCrack};
use crate::error::Result;
use crate::fracture::{EquivalentFactor, GrowthCriterion, LargestPrincipal, TipDriving};
use crate::math::{Matrix, Vector3};
use crate::model::SolidModel;

/// Radii and angles of the places ahead of a front, over the increment and in radians, whose mean stress counts.
///
/// The stress of the elastic solid at a front is infinite, and at a single place near it is as good as the nodes there:
/// the mean over half a disc as large as the increment is finite, steady, and that of what the step is to break.
const RADII: [f64; 4] = [0.25, 0.5, 0.75, 1.0];
const ANGLES: [f64; 7] = [-1.2, -0.8, -0.4, 0.0, 0.4, 0.8, 1.2];
/// From this far ahead, over the increment, places are looked at.
const EYE: f64 = 0.02;

/// Turns smaller than this are noise of the nodes: the front goes straight on, and plane cracks stay plane [rad].
const STEADY: f64 = 0.01;
/// Ends of fronts look from this far inside the body, over the increment.
const INSIDE: f64 = 0.1;

/// The steps of all fronts.
#[derive(Clone, Debug, Default)]
pub(in crate::analysis) struct Drive {
    /// For each crack, each front, each vertex.
    pub steps: Vec<Vec<Vec<FrontStep>>>,
    /// Largest principal stress ahead over the strength, in the same order; zero where it is not known.
    pub ratios: Vec<Vec<Vec<f64>>>,
    /// Largest stress over the strength, or largest equivalent factor; none if it is known nowhere.
    pub largest: Option<f64>,
}

impl Drive {
    /// Number of vertices that move.
    pub fn n_moving(&self) -> usize {
        self.steps.iter().flatten().flatten().filter(|s| s.length > 0.0).count()
    }

    /// Moves the vertices whose stress is at least this share of the strength.
    pub fn move_from(&mut self, ratio: f64, increment: f64) {
        for (step, own) in self.steps.iter_mut().flatten().flatten().zip(self.ratios.iter().flatten().flatten()) {
            step.length = if *own > 0.0 && *own >= ratio { increment } else { 0.0 };
        }
    }
}

/// By the largest principal stress. Where some cracks are cohesive, the others stay.
pub(in crate::analysis) fn by_strength(
    model: &SolidModel,
    solved: &Solved,
    cracks: &[GrowingCrack],
    increment: f64,
    tensile_strength: f64,
) -> Result<Drive> {
    let mut drive = Drive::default();
    for (c, crack) in cracks.iter().enumerate() {
        let (mut of_crack, mut ratios) = (vec![], vec![]);
        let stays = model.cohesive.is_some() && model.cohesive_crack(c).is_none();
        for front in crack.fronts() {
            if stays {
                of_crack.push(vec![FrontStep::none(); front.line.points.len()]);
                ratios.push(vec![0.0; front.line.points.len()]);
                continue;
            }
            let (mut of_front, mut of_points) = (vec![], vec![]);
            let n = front.line.points.len();
            for (k, point) in front.line.points.iter().enumerate() {
                let inward = match (front.line.is_closed, k) {
                    (false, 0) => INSIDE * increment,
                    (false, k) if k + 1 == n => -INSIDE * increment,
                    _ => 0.0,
                };
                let from = FrontPoint { position: point.position + point.tangent * inward, ..*point };
                let mean = mean_ahead(model, solved, &from, increment)?;
                of_points.push(0.0);
                let step = mean.map_or_else(FrontStep::none, |stress| {
                    let principal = LargestPrincipal::of(&stress);
                    let ratio = principal.ratio(tensile_strength);
                    of_points[k] = ratio;
                    drive.largest = Some(drive.largest.map_or(ratio, |l| l.max(ratio)));
                    let length = if ratio >= 1.0 { increment } else { 0.0 };
                    FrontStep { direction: steady(point, principal.growth_direction(point)), length }
                });
                of_front.push(step);
            }
            of_crack.push(of_front);
            ratios.push(of_points);
        }
        drive.steps.push(of_crack);
        drive.ratios.push(ratios);
    }
    Ok(drive)
}

/// The direction, or straight ahead if it is not clearly another.
fn steady(point: &FrontPoint, direction: Vector3) -> Vector3 {
    let turn = point.ahead.cross(&direction).norm().atan2(point.ahead.dot(&direction));
    if turn < STEADY { point.ahead } else { direction }
}

/// Mean stress over half a disc ahead of a front point, as far as it is in sight; none if nothing is.
fn mean_ahead(model: &SolidModel, solved: &Solved, p: &FrontPoint, increment: f64) -> Result<Option<Matrix<3>>> {
    let eye = p.position + p.ahead * (EYE * increment);
    let (mut places, mut weights) = (vec![], vec![]);
    for r in RADII {
        for angle in ANGLES {
            let at = p.position + (p.ahead * angle.cos() + p.normal * angle.sin()) * (r * increment);
            if model.body.contains(at) && solved.visible(eye, at) {
                places.push(at);
                weights.push(r);
            }
        }
    }
    let stresses = solved.stresses_at(&places)?;
    let total: f64 = weights.iter().sum();
    let sum: Matrix<3> = stresses.iter().zip(&weights).map(|(s, w)| s * *w).sum();
    Ok((total > 0.0).then(|| sum / total))
}

/// By the stress intensity factors.
pub(super) fn by_factors(
    model: &SolidModel,
    result: &SolidResult,
    cracks: &[GrowingCrack],
    increment: f64,
    exponent: f64,
    direction: &GrowthCriterion,
) -> Drive {
    let driving = |crack: usize, point: &FrontPoint| {
        let records: Vec<&FrontRecord> = result.fronts.iter().filter(|f| f.crack == crack).collect();
        let nearest = model.cracks[crack].fronts.iter().zip(records).map(|(front, record)| {
            let (distance, s) = place_on(front, point.position);
            (distance, s, record)
        });
        let (_, s, record) = nearest.min_by(|a, b| a.0.total_cmp(&b.0))?;
        interpolated(record, s)
    };
    let known: Vec<Vec<Vec<Option<TipDriving>>>> = (cracks.iter().enumerate())
        .map(|(c, crack)| {
            crack.fronts().iter().map(|f| f.line.points.iter().map(|p| driving(c, p)).collect()).collect()
        })
        .collect();
    let equivalent = |d: &TipDriving| EquivalentFactor::MaximumCircumferentialStress.value(d.k1, d.k2).max(0.0);
    let largest = known.iter().flatten().flatten().flatten().map(equivalent).reduce(f64::max);
    let step = |point: &FrontPoint, driving: &Option<TipDriving>| match (driving, largest) {
        (Some(d), Some(largest)) if largest > 0.0 => {
            let angle = direction.kink_angle(d, &model.solid.material);
            FrontStep {
                direction: steady(point, point.ahead * angle.cos() + point.normal * angle.sin()),
                length: increment * (equivalent(d) / largest).powf(exponent),
            }
        }
        _ => FrontStep::none(),
    };
    let steps = cracks.iter().zip(&known).map(|(crack, known)| {
        let of_front = |(front, known): (&crate::crack::GrowingFront, &Vec<Option<TipDriving>>)| {
            front.line.points.iter().zip(known).map(|(p, d)| step(p, d)).collect()
        };
        crack.fronts().iter().zip(known).map(of_front).collect()
    });
    Drive { steps: steps.collect(), largest, ..Drive::default() }
}

/// Distance to a front, and the length along it of the nearest point.
pub(in crate::analysis) fn place_on(front: &CrackFront, p: Vector3) -> (f64, f64) {
    let to_segment = |(k, [a, b]): (usize, [Vector3; 2])| {
        let e = b - a;
        let t = ((p - a).dot(&e) / e.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        ((p - a - e * t).norm(), front.points[k].s + t * e.norm())
    };
    let nearest = front.segments().enumerate().map(to_segment).min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.unwrap_or((f64::INFINITY, 0.0))
}

/// What drives a front at a length along it, between the points where it is known; beyond the last of an open front that
/// of the last.
fn interpolated(record: &FrontRecord, s: f64) -> Option<TipDriving> {
    let driving = |p: &super::super::solid_record::FrontPointRecord| {
        let f = p.factors?;
        let [k1, k2, _] = f.factors;
        Some((p.point.s, TipDriving { k1, k2, t_stress: f.t_stress, force: None }))
    };
    let known: Vec<(f64, TipDriving)> = record.points.iter().filter_map(driving).collect();
    let (first, last) = (known.first()?, known.last()?);
    let after = known.partition_point(|k| k.0 <= s);
    let (a, b, t) = match (record.is_closed, after) {
        (false, 0) => (first.1, first.1, 0.0),
        (false, n) if n == known.len() => (last.1, last.1, 0.0),
        (true, n) if n == 0 || n == known.len() => {
            let gap = first.0 + record.length - last.0;
            let from = if n == 0 { s + record.length - last.0 } else { s - last.0 };
            (last.1, first.1, from / gap)
        }
        (_, n) => (known[n - 1].1, known[n].1, (s - known[n - 1].0) / (known[n].0 - known[n - 1].0)),
    };
    let mix = |a: f64, b: f64| a * (1.0 - t) + b * t;
    let t_stress = mix(a.t_stress, b.t_stress);
    Some(TipDriving { k1: mix(a.k1, b.k1), k2: mix(a.k2, b.k2), t_stress, force: None })
}
