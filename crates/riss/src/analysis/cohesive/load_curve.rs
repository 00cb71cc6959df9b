//! The load curve: points of the path with their energies, and where it ends.

use super::condensed::Condensed;
use super::path::{CohesiveState, Path};
use super::settings::LoadingSettings;
use crate::analysis::growth_record::{GrowthEnd, GrowthEndKind};
use crate::analysis::record::Observer;
use crate::material::CohesiveLaw;
use serde::{Deserialize, Serialize};

/// Pairs that are open by less than this, over `G_f/f_t`, call for no growth: the first to open may do so by noise.
const OPENED: f64 = 0.01;
/// Steps with fields, besides the first, that of the peak and the last.
const PICTURES: usize = 10;
/// Loads count as balanced if their sum is below this share of their sizes.
const BALANCED: f64 = 0.02;

/// A point of the load curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LoadPoint {
    /// Factor on all loads and prescribed displacements.
    pub load_factor: f64,
    /// Resultant of the loads, or what the prescribed displacements take [stress·length²].
    pub load: f64,
    /// Its displacement: the load does its work on it [length].
    pub displacement: f64,
    /// Area that has reached its strength [area].
    pub crack_area: f64,
    /// Energy dissipated by the cracks [stress·length³].
    pub dissipated_energy: f64,
    /// Energy stored in the body and in unbroken bonds [stress·length³].
    pub elastic_energy: f64,
    /// Work of the load so far, by the trapezoidal rule [stress·length³].
    pub external_work: f64,
}

/// What load and displacement of a body are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::analysis) struct LoadMeasure {
    /// Resultant of the loads [stress·length²].
    pub resultant: f64,
    /// Largest prescribed displacement [length].
    pub prescribed: f64,
}

/// What a pair is for the load curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::analysis) struct Bond {
    /// Area of crack that it stands for [area].
    pub area: f64,
    /// Whether the crack has to grow before it opens.
    pub is_near_front: bool,
}

/// A path with its states.
pub(in crate::analysis) struct Followed {
    pub curve: Vec<LoadPoint>,
    pub states: Vec<CohesiveState>,
    pub end: GrowthEnd,
    /// Largest shear between opened faces that cannot slide [stress].
    pub most_shear: f64,
    /// The pair at which the path ends because a front has to grow.
    pub reached: Option<usize>,
    /// Whether the observer ended it.
    pub is_stopped: bool,
}

/// Follows the path until it ends, a front has to grow or the observer stops it.
pub(in crate::analysis) fn follow(
    condensed: &Condensed,
    measure: LoadMeasure,
    law: &CohesiveLaw,
    loading: &LoadingSettings,
    bonds: &[Bond],
    observer: &mut dyn Observer,
) -> Followed {
    let mut path = Path::new(condensed, law);
    let mut followed = Followed {
        curve: vec![LoadPoint::default()],
        states: vec![path.state.clone()],
        end: GrowthEnd { kind: GrowthEndKind::NoTipGrows, reason: "no load opens a cohesive crack".into() },
        most_shear: 0.0,
        reached: None,
        is_stopped: false,
    };
    let mut done = [0.0; 2];
    let mut goes_on = path.begin();
    let mut greatest = 0.0f64;
    while goes_on {
        let tractions = path.tractions();
        let now = condensed.work(path.state.load_factor, &path.state.openings);
        let before = followed.curve[followed.curve.len() - 1];
        let rise = path.state.load_factor - before.load_factor;
        let external_work = before.external_work
            + 0.5 * (path.state.load_factor + before.load_factor) * (now[0] - done[0])
            + 0.5 * (now[1] + done[1]) * rise;
        done = now;
        let mut point = point(&path.state, condensed, measure, law, bonds, now);
        point.external_work = external_work;
        followed.curve.push(point);
        followed.states.push(path.state.clone());
        followed.is_stopped = observer.load_curve(&followed.curve).is_break();
        if followed.is_stopped {
            break;
        }
        for pair in (0..bonds.len()).filter(|k| path.state.is_open[*k]) {
            let [_, s, t] = condensed.of_pair(pair, &tractions);
            let is_stuck = condensed.columns[pair + 1] == condensed.columns[pair] + 1;
            followed.most_shear = followed.most_shear.max(if is_stuck { s.hypot(t) } else { 0.0 });
        }
        greatest = greatest.max(point.load.abs());
        let opens = |k: &usize| path.state.is_open[*k] && path.state.history[*k] >= OPENED * law.opening_scale();
        followed.reached = (0..bonds.len()).filter(opens).find(|k| bonds[*k].is_near_front);
        if followed.reached.is_some() {
            break;
        }
        let end = |kind, reason: String| Some(GrowthEnd { kind, reason });
        let limit = loading.largest_displacement.filter(|u| point.displacement.abs() >= *u);
        let ended = if point.load.abs() <= loading.stop_load * greatest {
            end(GrowthEndKind::LimitReached, format!("the load has fallen to {} of its peak", loading.stop_load))
        } else if let Some(limit) = limit {
            end(GrowthEndKind::LimitReached, format!("the displacement has reached {limit}"))
        } else if followed.curve.len() > loading.steps {
            end(GrowthEndKind::StepsDone, format!("{} steps are done", loading.steps))
        } else {
            None
        };
        if let Some(end) = ended {
            followed.end = end;
            break;
        }
        goes_on = path.advance();
        if !goes_on {
            let reason = "no step of the path converges from here, however short".into();
            followed.end = GrowthEnd { kind: GrowthEndKind::Failed, reason };
        }
    }
    followed
}

/// Values of a state but for the external work.
fn point(
    state: &CohesiveState,
    condensed: &Condensed,
    measure: LoadMeasure,
    law: &CohesiveLaw,
    bonds: &[Bond],
    conjugates: [f64; 2],
) -> LoadPoint {
    let [by_loads, by_reactions] = conjugates;
    let (load, displacement) = if measure.prescribed > 0.0 {
        (by_reactions / measure.prescribed, state.load_factor * measure.prescribed)
    } else {
        (state.load_factor * measure.resultant, by_loads / measure.resultant)
    };
    let mut point = LoadPoint { load_factor: state.load_factor, load, displacement, ..LoadPoint::default() };
    for (k, bond) in bonds.iter().enumerate().filter(|(k, _)| state.is_open[*k]) {
        point.crack_area += bond.area;
        point.dissipated_energy += condensed.areas[k] * law.dissipated(state.history[k]);
    }
    // That of the body, and what bonds give back when they unload to the origin.
    point.elastic_energy = 0.5 * state.load_factor * (by_loads + by_reactions);
    point
}

/// Points of the curve that get fields: evenly along it, as it is drawn, with the first, the peak and the last.
pub(in crate::analysis) fn pictures(curve: &[LoadPoint], peak: usize) -> Vec<usize> {
    let extent = |get: fn(&LoadPoint) -> f64| curve.iter().map(|p| get(p).abs()).fold(f64::MIN_POSITIVE, f64::max);
    let (load, displacement) = (extent(|p| p.load), extent(|p| p.displacement));
    let mut along = vec![0.0];
    for w in curve.windows(2) {
        let step = ((w[1].load - w[0].load) / load).hypot((w[1].displacement - w[0].displacement) / displacement);
        along.push(along[along.len() - 1] + step);
    }
    let last = curve.len() - 1;
    let at = |k: usize| along.partition_point(|s| *s < along[last] * k as f64 / PICTURES as f64).min(last);
    let mut points: Vec<usize> = (1..PICTURES).map(at).chain([1.min(last), peak, last]).collect();
    points.sort_unstable();
    points.dedup();
    points
}

/// Resultant of loads: half of their sum of sizes where they balance.
pub(in crate::analysis) fn resultant(sum: f64, sizes: f64) -> f64 {
    if sum > BALANCED * sizes { sum } else { 0.5 * sizes }
}

/// Index of the greatest load.
pub(in crate::analysis) fn peak_of(curve: &[LoadPoint]) -> usize {
    (0..curve.len()).fold(0, |m, k| if curve[k].load.abs() > curve[m].load.abs() { k } else { m })
}
