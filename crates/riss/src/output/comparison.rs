//! How the results of two runs differ: crack paths, stress intensity factors along them, load curves.

use super::loading_comparison::{LoadingComparison, Tolerances};
use super::results::{CrackResults, Results, TipResults};
use crate::crack::End;
use crate::geometry::path_distance::{path_distance, path_length};
use crate::math::Vector2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Differences of a second run from a first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Comparison {
    /// Cracks that both have, in the order of the first.
    pub cracks: Vec<CrackComparison>,
    /// Names of cracks that only the first has.
    pub only_in_first: Vec<String>,
    /// Names of cracks that only the second has.
    pub only_in_second: Vec<String>,
    /// Load curves of cohesive cracks, if both have them; tips are then not compared.
    pub loading: Option<LoadingComparison>,
    /// Whether one of them has a load curve and the other has not.
    pub one_load_curve: bool,
}

/// Differences of one crack.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CrackComparison {
    /// Name of the crack.
    pub name: String,
    /// Lengths of its last paths [length].
    pub lengths: [f64; 2],
    /// Greatest distance of a point of one last path from the other one, as far as both go [length].
    pub path_distance: f64,
    /// The same over the length of the first path.
    pub path_distance_relative: f64,
    /// Tips that both have.
    pub tips: Vec<TipComparison>,
}

/// Differences of the stress intensity factors of one tip, where it has grown as far in both runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TipComparison {
    /// Which end of the path.
    pub end: End,
    /// Steps of the first run that were compared; the second is interpolated between its steps.
    pub steps: usize,
    /// Greatest difference of `K_I` or `K_II` over the magnitude of both in the first run.
    #[serde(rename = "K_difference")]
    pub k_difference: Option<f64>,
    /// How far the tip has grown there [length].
    pub grown: Option<f64>,
    /// Mean of that difference over the steps.
    #[serde(rename = "K_difference_mean")]
    pub k_difference_mean: Option<f64>,
    /// The larger error bar of both runs there, over the magnitude in the first run.
    #[serde(rename = "K_uncertainty")]
    pub k_uncertainty: Option<f64>,
}

impl Comparison {
    /// Compares two runs; cracks belong together by name.
    pub fn new(first: &Results, second: &Results) -> Self {
        let cracks = |r: &Results| r.steps.last().map_or(vec![], |s| s.cracks.clone());
        let (a, b) = (cracks(first), cracks(second));
        let missing = |of: &[CrackResults], from: &[CrackResults]| {
            of.iter().filter(|c| !from.iter().any(|d| d.name == c.name)).map(|c| c.name.clone()).collect()
        };
        let pairs = a.iter().filter_map(|c| Some((c, b.iter().find(|d| d.name == c.name)?)));
        let mut cracks: Vec<CrackComparison> = pairs.map(|(c, d)| compare_crack(c, d, first, second)).collect();
        let loading = LoadingComparison::new(first.loading_with_curve(), second.loading_with_curve());
        if loading.is_some() {
            cracks.iter_mut().for_each(|c| c.tips.clear());
        }
        Self {
            cracks,
            only_in_first: missing(&a, &b),
            only_in_second: missing(&b, &a),
            loading,
            one_load_curve: first.loading.is_some() != second.loading.is_some(),
        }
    }

    /// Whether both have the same cracks and load curves, within shares of lengths, magnitudes of factors and greatest loads.
    pub fn agrees(&self, allowed: &Tolerances) -> bool {
        let Tolerances { path, k, load } = *allowed;
        let near = |c: &CrackComparison| {
            c.path_distance_relative <= path && c.tips.iter().all(|t| t.k_difference.is_some_and(|d| d <= k))
        };
        self.only_in_first.is_empty()
            && self.only_in_second.is_empty()
            && self.cracks.iter().all(near)
            && !self.one_load_curve
            && self.loading.as_ref().is_none_or(|l| l.agrees(load))
    }
}

fn compare_crack(a: &CrackResults, b: &CrackResults, first: &Results, second: &Results) -> CrackComparison {
    let [path_a, path_b] = [a, b].map(|c| c.path.iter().map(|p| Vector2::from(*p)).collect::<Vec<_>>());
    let lengths = [path_length(&path_a), path_length(&path_b)];
    let distance = path_distance(&path_a, &path_b);
    let tips = [End::Start, End::End].into_iter().filter_map(|end| {
        let [way_a, way_b] = [first, second].map(|r| way(r, &a.name, end));
        (!way_a.is_empty() && !way_b.is_empty()).then(|| compare_tip(end, &way_a, &way_b))
    });
    CrackComparison {
        name: a.name.clone(),
        lengths,
        path_distance: distance,
        path_distance_relative: distance / lengths[0],
        tips: tips.collect(),
    }
}

/// Factors of a tip where it has grown to a length.
#[derive(Clone, Copy)]
struct Station {
    grown: f64,
    factors: Vector2,
    uncertainty: f64,
}

/// All steps in which a tip has factors.
fn way(results: &Results, crack: &str, end: End) -> Vec<Station> {
    let mut stations = vec![];
    let (mut grown, mut last) = (0.0, None);
    for step in &results.steps {
        let Some(crack) = step.cracks.iter().find(|c| c.name == crack) else { continue };
        let Some(tip) = crack.tips.iter().find(|t| t.end == end) else { continue };
        let position = Vector2::from(tip.position);
        grown += last.map_or(0.0, |p: Vector2| (position - p).norm());
        last = Some(position);
        if let TipResults { k1: Some(k1), k2: Some(k2), k_uncertainty, .. } = tip {
            let (factors, uncertainty) = (Vector2::new(*k1, *k2), k_uncertainty.unwrap_or(0.0));
            stations.push(Station { grown, factors, uncertainty });
        }
    }
    stations
}

fn compare_tip(end: End, a: &[Station], b: &[Station]) -> TipComparison {
    let mut worst: Option<(f64, f64, f64)> = None;
    let (mut sum, mut steps) = (0.0, 0);
    for station in a {
        let Some(other) = between(b, station.grown) else { continue };
        let size = station.factors.norm();
        let difference = (station.factors - other.factors).amax() / size;
        (sum, steps) = (sum + difference, steps + 1);
        if worst.is_none_or(|w| difference > w.0) {
            worst = Some((difference, station.grown, station.uncertainty.max(other.uncertainty) / size));
        }
    }
    TipComparison {
        end,
        steps,
        k_difference: worst.map(|w| w.0),
        grown: worst.map(|w| w.1),
        k_difference_mean: worst.map(|_| sum / steps as f64),
        k_uncertainty: worst.map(|w| w.2),
    }
}

/// A station between two others, if the tip has grown so far; ends reach a little beyond, for rounding.
fn between(way: &[Station], grown: f64) -> Option<Station> {
    let slack = 1e-9 * way.last()?.grown.max(grown);
    let after = way.iter().position(|s| s.grown >= grown - slack)?;
    if after == 0 {
        return (way[0].grown <= grown + slack).then_some(way[0]);
    }
    let (p, q) = (way[after - 1], way[after]);
    let t = ((grown - p.grown) / (q.grown - p.grown)).min(1.0);
    Some(Station {
        grown,
        factors: p.factors + (q.factors - p.factors) * t,
        uncertainty: p.uncertainty.max(q.uncertainty),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::{CrackRecord, StaticResult, StepRecord, TipRecord};
    use crate::crack::{EndKind, TipFrame};
    use crate::output::{RunInfo, RunStatus};

    /// A run in which a crack grows along a path, its factors being functions of the x coordinate of the tip.
    fn run(name: &str, path: &[(f64, f64)], factors: impl Fn(f64) -> (f64, f64)) -> Results {
        let points: Vec<Vector2> = path.iter().map(|p| Vector2::new(p.0, p.1)).collect();
        let step = |k: usize| {
            let (k1, k2) = factors(points[k].x);
            let frame = TipFrame { position: points[k], angle: 0.0 };
            let tip = TipRecord {
                k1: Some(k1),
                k2: Some(k2),
                k_uncertainty: Some(0.01),
                k1_direct: None,
                k2_direct: None,
                ..TipRecord::unknown(End::End, frame)
            };
            let ends = [EndKind::Mouth, EndKind::Tip];
            let crack = CrackRecord { name: name.into(), path: points[..=k].to_vec(), ends, tips: vec![tip] };
            StaticResult::unsolved(StepRecord {
                step: k - 1,
                load_factor: 1.0,
                cycles: None,
                cycles_range: None,
                stability: None,
                end: None,
                cracks: vec![crack],
                reactions: vec![],
            })
        };
        let info = RunInfo {
            title: "t".into(),
            method: "m".into(),
            units: None,
            status: RunStatus::Done,
            wall_time_s: 0.0,
            stage_time_s: vec![],
            peak_memory_bytes: None,
        };
        let steps: Vec<StaticResult> = (1..points.len()).map(step).collect();
        let results = steps.iter().map(|s| crate::output::results::StepResults::new(s, &[])).collect();
        Results::of_steps(&info, steps.last().unwrap(), results)
    }

    #[test]
    fn factors_are_compared_where_the_tips_have_grown_as_far() {
        let a = run("c", &[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0)], |x| (10.0 * x, 0.0));
        // Steps of half the length, K_II = 1 from x = 2 on, and one step less far.
        let b =
            run("c", &[(0.0, 0.1), (1.0, 0.1), (1.5, 0.1), (2.0, 0.1), (2.5, 0.1)], |x| (10.0 * x, (x - 1.5).max(0.0)));
        let found = Comparison::new(&a, &b);
        let crack = &found.cracks[0];
        assert_eq!(crack.lengths, [3.0, 2.5]);
        assert!((crack.path_distance - 0.1).abs() < 1e-12 && (crack.path_distance_relative - 0.1 / 3.0).abs() < 1e-12);
        let tip = &crack.tips[0];
        // At 1 nothing, at 2 K_II = 0.5 of 20; beyond 2.5 the second has not grown.
        assert_eq!((tip.steps, tip.grown), (2, Some(1.0)));
        assert!((tip.k_difference.unwrap() - 0.025).abs() < 1e-12);
        assert!((tip.k_difference_mean.unwrap() - 0.0125).abs() < 1e-12);
        assert!((tip.k_uncertainty.unwrap() - 0.01 / 20.0).abs() < 1e-12);
        let within = |path, k| found.agrees(&Tolerances { path, k, load: 0.0 });
        assert!(within(0.04, 0.026) && !within(0.03, 0.026) && !within(0.04, 0.024));
        let same = Comparison::new(&a, &a);
        assert!(same.agrees(&Tolerances { path: 0.0, k: 0.0, load: 0.0 }) && same.cracks[0].tips[0].steps == 3);
    }

    #[test]
    fn cracks_of_other_names_do_not_agree() {
        let path = [(0.0, 0.0), (1.0, 0.0)];
        let found = Comparison::new(&run("a", &path, |_| (1.0, 0.0)), &run("b", &path, |_| (1.0, 0.0)));
        assert_eq!(
            (found.only_in_first.as_slice(), found.only_in_second.as_slice()),
            (&["a".into()][..], &["b".into()][..])
        );
        assert!(found.cracks.is_empty() && !found.agrees(&Tolerances { path: 1.0, k: 1.0, load: 1.0 }));
    }
}
