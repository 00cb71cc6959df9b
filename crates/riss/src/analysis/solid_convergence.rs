//! The same solid on nodes of several spacings: the limits that factors along fronts, or load curves, go to, and how fast.

use super::cohesive::LoadingSettings;
use super::convergence::{Limit, limits};
use super::record::{Observer, Stage};
use super::solid_cohesive::solid_loading;
use super::solid_record::FrontRecord;
use super::solid_static::{SolidSettings, solid_static};
use super::warnings::Warning;
use super::{GrowthEndKind, LoadingStep};
use crate::error::{Error, Result};
use crate::math::Vector3;
use crate::model::SolidModel;
use std::ops::ControlFlow;

/// What came out on nodes of several spacings.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidConvergenceStudy {
    /// From the coarsest nodes to the finest.
    pub levels: Vec<SolidLevel>,
    /// Fronts with factors, at the points that are known in every solution.
    pub fronts: Vec<FrontConvergence>,
    /// Values of the load curve, where cracks are cohesive.
    pub loading: Vec<ValueConvergence>,
}

/// One solution of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidLevel {
    /// Node spacing over that of the settings.
    pub factor: f64,
    /// Nodes.
    pub n_nodes: usize,
}

/// Where the factors along a front go.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontConvergence {
    /// Name of the crack.
    pub crack: String,
    /// Its number among the fronts of the crack, from 0.
    pub front: usize,
    /// Whether it is a loop.
    pub is_closed: bool,
    /// Its length [length].
    pub length: f64,
    /// Points along it.
    pub points: Vec<PointConvergence>,
}

/// Where the factors at a point of a front go.
#[derive(Clone, Debug, PartialEq)]
pub struct PointConvergence {
    /// Length along the front [length].
    pub s: f64,
    /// The point.
    pub position: Vector3,
    /// `K_I`, `K_II` and `K_III` of each level [stress·√length].
    pub factors: Vec<[f64; 3]>,
    /// Their error bar in each level [stress·√length].
    pub uncertainties: Vec<f64>,
    /// Limits of the three; their order is that of all points of the front together.
    pub limits: Option<[Limit; 3]>,
}

/// Where a value goes.
#[derive(Clone, Debug, PartialEq)]
pub struct ValueConvergence {
    /// What it is.
    pub name: &'static str,
    /// In each level.
    pub values: Vec<f64>,
    /// The limit.
    pub limit: Option<Limit>,
}

/// Solves on nodes that stand `factors` times as far apart as the settings say; with `loading`, cohesive cracks are loaded. Cracks
/// do not grow.
///
/// # Errors
/// Those of [`solid_static`] and [`solid_loading`], and [`Error::LoadCurve`] if a load curve breaks off.
pub fn converge_solid(
    model: &SolidModel,
    settings: &SolidSettings,
    loading: Option<&LoadingSettings>,
    factors: &[f64],
    observer: &mut dyn Observer,
) -> Result<SolidConvergenceStudy> {
    let mut factors = factors.to_vec();
    factors.sort_by(|a, b| b.total_cmp(a));
    let (mut levels, mut all_fronts, mut curves) = (vec![], vec![], vec![]);
    for factor in factors {
        let settings = SolidSettings { spacing: settings.spacing.scaled(factor), ..settings.clone() };
        let n_nodes = match (&model.cohesive, loading) {
            (Some(cohesive), Some(loading)) => {
                let mut counted = Counted { observer: &mut *observer, n_nodes: 0 };
                let record = solid_loading(model, cohesive, &settings, loading, None, None, &mut counted)?;
                let n_nodes = counted.n_nodes;
                let record = record.ok_or_else(|| unfinished("it was stopped"))?;
                if record.end.kind == GrowthEndKind::Failed {
                    return Err(unfinished(&format!("at {factor} times the spacing: {}", record.end.reason)));
                }
                let peak = record.curve[record.peak];
                let last = record.curve.last().map_or(0.0, |p| p.dissipated_energy);
                curves.push([peak.load, peak.displacement, last]);
                n_nodes
            }
            _ => {
                let result = solid_static(model, &settings, observer)?;
                all_fronts.push(result.fronts);
                result.n_nodes
            }
        };
        levels.push(SolidLevel { factor, n_nodes });
    }
    let spacings: Vec<f64> = levels.iter().map(|l| l.factor).collect();
    let value = |(k, name): (usize, &'static str)| {
        let values: Vec<f64> = curves.iter().map(|c| c[k]).collect();
        let series = spacings.iter().copied().zip(values.iter().copied()).collect::<Vec<_>>();
        ValueConvergence { name, values, limit: limits(&[series]).map(|l| l[0]) }
    };
    let names = ["peak load", "displacement at peak", "dissipated energy"];
    let loading = if curves.is_empty() { vec![] } else { names.into_iter().enumerate().map(value).collect() };
    let n_fronts = all_fronts.first().map_or(0, Vec::len);
    let fronts = (0..n_fronts).map(|f| {
        let of_levels: Vec<&FrontRecord> = all_fronts.iter().map(|l| &l[f]).collect();
        let number = all_fronts[0][..f].iter().filter(|o| o.crack == of_levels[0].crack).count();
        front(model, number, &of_levels, &spacings)
    });
    Ok(SolidConvergenceStudy { fronts: fronts.collect(), levels, loading })
}

fn unfinished(reason: &str) -> Error {
    Error::LoadCurve { reason: reason.into() }
}

/// Points stand at the same places in all levels: they follow from the front alone.
fn front(model: &SolidModel, number: usize, levels: &[&FrontRecord], spacings: &[f64]) -> FrontConvergence {
    let is_known = |p: &usize| levels.iter().all(|l| l.points[*p].factors.is_some());
    let known: Vec<usize> = (0..levels[0].points.len()).filter(is_known).collect();
    let factors = |p: usize| levels.iter().filter_map(move |l| l.points[p].factors.as_ref());
    let series = |p: usize, mode: usize| -> Vec<(f64, f64)> {
        spacings.iter().copied().zip(factors(p).map(|f| f.factors[mode])).collect()
    };
    let all: Vec<_> = known.iter().flat_map(|p| (0..3).map(|mode| series(*p, mode))).collect();
    let limits = limits(&all);
    let point = |(k, p): (usize, &usize)| PointConvergence {
        s: levels[0].points[*p].point.s,
        position: levels[0].points[*p].point.position,
        factors: factors(*p).map(|f| f.factors).collect(),
        uncertainties: factors(*p).map(|f| f.uncertainty).collect(),
        limits: limits.as_ref().map(|l| [0, 1, 2].map(|mode| l[3 * k + mode])),
    };
    FrontConvergence {
        crack: model.crack_names[levels[0].crack].clone(),
        front: number,
        is_closed: levels[0].is_closed,
        length: levels[0].length,
        points: known.iter().enumerate().map(point).collect(),
    }
}

/// Counts the nodes of what it hears of.
struct Counted<'a> {
    observer: &'a mut dyn Observer,
    n_nodes: usize,
}

impl Observer for Counted<'_> {
    fn stage(&mut self, stage: Stage) {
        self.observer.stage(stage);
    }

    fn warning(&mut self, warning: &Warning) {
        self.observer.warning(warning);
    }

    fn loading_step(&mut self, step: &LoadingStep) -> ControlFlow<()> {
        self.n_nodes = step.result.n_nodes;
        ControlFlow::Continue(())
    }
}
