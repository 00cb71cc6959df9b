//! Which squares are too coarse for the error in them, and which are finer than needed [CPM, Eqs. A.6-A.8].

use super::error_estimate::ErrorEstimate;
use super::quadtree::{Quadtree, Square};
use crate::integration::IntegrationPoint;
use std::collections::BTreeMap;

/// Thresholds over the target of the global error: `L_fin = 2 η_t`, `L_rec = 0.5 η_t` [CPM, Eq. A.8].
const REFINE_ABOVE: f64 = 2.0;
const COARSEN_BELOW: f64 = 0.5;

/// Squares to change.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Marks {
    /// Squares to split, by level.
    pub refine: Vec<Square>,
    /// Squares to join with their siblings, by level.
    pub coarsen: Vec<Square>,
}

/// Compares the error in each square, `η_i = ‖E_i‖ / (‖U‖/√n)`, with a target; `n` counts the squares on the body.
///
/// - `points`: the integration points of the estimate
/// - `target`: `η_t`, the relative error of the whole that is aimed at
pub fn mark(tree: &Quadtree, estimate: &ErrorEstimate, points: &[IntegrationPoint<2>], target: f64) -> Marks {
    let mut errors: BTreeMap<Square, f64> = BTreeMap::new();
    for (point, error) in points.iter().zip(&estimate.points) {
        if let Some(square) = tree.leaf_at(point.position) {
            *errors.entry(square).or_default() += error;
        }
    }
    let unit = estimate.energy / errors.len().max(1) as f64;
    let beyond = |limit: f64| limit * limit * unit;
    // Squares off the body hold no error: they may be as coarse as 2:1 lets them.
    let off = tree.leaves().into_iter().filter(|s| !errors.contains_key(s)).map(|s| (s, 0.0));
    let mut all: Vec<(Square, f64)> = off.collect();
    all.extend(errors);
    all.sort_by_key(|s| s.0);
    let select = |keep: &dyn Fn(f64) -> bool| all.iter().filter(|(_, e)| keep(*e)).map(|(s, _)| *s).collect();
    Marks {
        refine: select(&|e| e > beyond(REFINE_ABOVE * target)),
        coarsen: select(&|e| e < beyond(COARSEN_BELOW * target)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::aabb::Aabb;
    use crate::math::Vector2;

    /// Four squares with one point each: `η_i = √(4 e_i / U)`.
    #[test]
    fn thresholds_are_those_of_the_paper() {
        let bounds = Aabb { lower: Vector2::zeros(), upper: Vector2::repeat(2.0) };
        let tree = Quadtree::uniform(&bounds, 1.0);
        let at = |x: f64, y: f64| IntegrationPoint { position: Vector2::new(x, y), weight: 1.0 };
        let points = [at(0.5, 0.5), at(1.5, 0.5), at(0.5, 1.5), at(1.5, 1.5)];
        // η_i = 0.42, 0.38, 0.11 and 0.09 for U = 4: around 2 η_t = 0.4 and η_t / 2 = 0.1.
        let errors = [0.42f64, 0.38, 0.11, 0.09].map(|eta| eta * eta).to_vec();
        let estimate = ErrorEstimate { error: errors.iter().sum(), points: errors, energy: 4.0 };
        let marks = mark(&tree, &estimate, &points, 0.2);
        assert_eq!(marks.refine, [Square { level: 0, i: 0, j: 0 }]);
        assert_eq!(marks.coarsen, [Square { level: 0, i: 1, j: 1 }]);
    }
}
