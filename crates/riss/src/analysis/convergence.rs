//! The same problem on nodes of several spacings: the limit that stress intensity factors go to, and how fast.

use super::linear_static::linear_static;
use super::record::{Observer, TipRecord};
use super::settings::Settings;
use crate::crack::End;
use crate::error::{Error, Result};
use crate::model::Model;

/// Orders that are tried, in steps of a hundredth.
const ORDERS: [f64; 2] = [0.5, 4.0];
/// Factor of safety on the distance to the limit [EcaHoekstra2014].
const SAFETY: f64 = 1.25;

/// What came out on nodes of several spacings.
#[derive(Clone, Debug, PartialEq)]
pub struct ConvergenceStudy {
    /// From the coarsest nodes to the finest.
    pub levels: Vec<Level>,
    /// Where the values of all tips go, in their order, first `K_I`, then `K_II`; none without at least three levels.
    pub limits: Vec<[Option<Limit>; 2]>,
}

/// One solution of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Node spacing over that of the settings.
    pub factor: f64,
    /// Nodes.
    pub n_nodes: usize,
    /// Strain energy [stress·length³].
    pub strain_energy: f64,
    /// All tips that have factors in every solution.
    pub tips: Vec<StudiedTip>,
}

/// A tip in one solution.
#[derive(Clone, Debug, PartialEq)]
pub struct StudiedTip {
    /// Name of the crack.
    pub crack: String,
    /// Which of its ends.
    pub end: End,
    /// `K_I` and `K_II` [stress·√length].
    pub factors: [f64; 2],
    /// Their error bar [stress·√length].
    pub uncertainty: f64,
}

/// The limit of a value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// The value.
    pub value: f64,
    /// Its own error bar.
    pub uncertainty: f64,
    /// Order of convergence in the node spacing.
    pub order: f64,
}

/// Solves on nodes that stand `factors` times as far apart as the settings say.
///
/// # Errors
/// Those of [`linear_static`], and [`Error::NodeGeneration`] if the settings list positions.
pub fn converge(
    model: &Model,
    settings: &Settings,
    factors: &[f64],
    observer: &mut dyn Observer,
) -> Result<ConvergenceStudy> {
    let mut factors = factors.to_vec();
    factors.sort_by(|a, b| b.total_cmp(a));
    let mut levels = vec![];
    for factor in factors {
        let nodes = settings.nodes.scaled(model, factor).ok_or_else(|| Error::NodeGeneration {
            reason: "positions of nodes that are listed cannot be made finer".into(),
        })?;
        let settings = Settings { nodes, accuracy: None, ..settings.clone() };
        let result = linear_static(model, &settings, observer)?;
        let tips = result.step.cracks.iter().flat_map(|c| c.tips.iter().filter_map(|t| studied(&c.name, t)));
        let (tips, strain_energy) = (tips.collect(), result.strain_energy);
        levels.push(Level { factor, n_nodes: result.n_nodes, strain_energy, tips });
    }
    keep_known_in_all(&mut levels);
    let n_tips = levels.first().map_or(0, |l| l.tips.len());
    let limits = (0..n_tips).map(|tip| {
        let values = |mode: usize| levels.iter().map(|l| (l.factor, l.tips[tip].factors[mode])).collect::<Vec<_>>();
        [limit(&values(0)), limit(&values(1))]
    });
    Ok(ConvergenceStudy { limits: limits.collect(), levels })
}

fn studied(crack: &str, tip: &TipRecord) -> Option<StudiedTip> {
    let (factors, uncertainty) = ([tip.k1?, tip.k2?], tip.k_uncertainty.unwrap_or(0.0));
    Some(StudiedTip { crack: crack.into(), end: tip.end, factors, uncertainty })
}

/// Drops tips that some solution knows nothing of.
fn keep_known_in_all(levels: &mut [Level]) {
    let all = levels.to_vec();
    for level in levels {
        let is_in = |l: &Level, t: &StudiedTip| l.tips.iter().any(|o| o.crack == t.crack && o.end == t.end);
        level.tips.retain(|t| all.iter().all(|l| is_in(l, t)));
    }
}

/// Fits `v + c h^p` to values at spacings `h`; the order with the least squared residual counts.
pub fn limit(values: &[(f64, f64)]) -> Option<Limit> {
    limits(&[values.to_vec()]).map(|l| l[0])
}

/// The same for several values that share one order; none without values, or if one of them has less than three.
pub fn limits(series: &[Vec<(f64, f64)>]) -> Option<Vec<Limit>> {
    if series.is_empty() || series.iter().any(|values| values.len() < 3) {
        return None;
    }
    let steps = ((ORDERS[1] - ORDERS[0]) * 100.0) as usize;
    let orders = (0..=steps).map(|k| ORDERS[0] + 0.01 * k as f64);
    let residual = |order: f64| series.iter().map(|values| fit(values, order).1).sum::<f64>();
    let (order, _) = orders.map(|order| (order, residual(order))).min_by(|a, b| a.1.total_cmp(&b.1))?;
    let limit = |values: &Vec<(f64, f64)>| {
        let (value, residual) = fit(values, order);
        let finest = values.iter().min_by(|a, b| a.0.total_cmp(&b.0))?.1;
        let scatter = (residual / (values.len() - 2) as f64).sqrt();
        Some(Limit { value, uncertainty: SAFETY * (finest - value).abs() + scatter, order })
    };
    series.iter().map(limit).collect()
}

/// Value at zero of the fit with an order, and the squared residual.
fn fit(values: &[(f64, f64)], order: f64) -> (f64, f64) {
    let (value, slope) = line(values.iter().map(|(h, v)| (h.powf(order), *v)));
    (value, values.iter().map(|(h, v)| (value + slope * h.powf(order) - v).powi(2)).sum())
}

/// Value at zero and slope of the line of least squares.
fn line(points: impl Iterator<Item = (f64, f64)> + Clone) -> (f64, f64) {
    let n = points.clone().count() as f64;
    let (mx, my) = points.clone().fold((0.0, 0.0), |m, p| (m.0 + p.0 / n, m.1 + p.1 / n));
    let (top, bottom) = points.fold((0.0, 0.0), |s, (x, y)| (s.0 + (x - mx) * (y - my), s.1 + (x - mx) * (x - mx)));
    let slope = if bottom > 0.0 { top / bottom } else { 0.0 };
    (my - slope * mx, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_of_a_power_is_found() {
        let values: Vec<(f64, f64)> = [2.0, 1.4, 1.0, 0.7].map(|h: f64| (h, 3.0 - 0.2 * h.powf(1.7))).to_vec();
        let limit = limit(&values).unwrap();
        assert!((limit.value - 3.0).abs() < 1e-9 && (limit.order - 1.7).abs() < 1e-9);
        assert!(limit.uncertainty >= (values[3].1 - 3.0).abs());
    }

    #[test]
    fn scatter_widens_the_bar() {
        let values = [(2.0, 1.1), (1.4, 0.9), (1.0, 1.1), (0.7, 0.9), (0.5, 1.1)];
        let limit = limit(&values).unwrap();
        assert!(limit.uncertainty > 0.08 && (limit.value - 1.0).abs() < limit.uncertainty);
    }

    #[test]
    fn two_values_have_no_limit() {
        assert_eq!(limit(&[(2.0, 1.0), (1.0, 1.1)]), None);
    }
}
