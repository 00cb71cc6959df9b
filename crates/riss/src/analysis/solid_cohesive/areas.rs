//! Area of crack face that belongs to each pair of nodes, and how much of it is cohesive.

use super::work::EDGE;
use crate::geometry::point_tree::PointTree;
use crate::geometry::triangle::area_vector;
use crate::math::Vector3;
use crate::model::{CohesiveCrack, SolidModel};
use crate::nodes::solid::SolidSpacing;
use rayon::prelude::*;

/// Parts of a triangle of about one spacing, along each side.
const PARTS: usize = 4;

/// Area that is nearest to a pair.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FaceArea {
    /// All of it in the body [area].
    pub total: f64,
    /// What of it is cohesive [area].
    pub cohesive: f64,
}

impl FaceArea {
    /// Share that is cohesive.
    pub fn share(&self) -> f64 {
        if self.total > 0.0 { self.cohesive / self.total } else { 0.0 }
    }
}

/// Areas of the pairs at `positions` on a crack.
pub(super) fn face_areas(
    model: &SolidModel,
    crack: usize,
    cohesive: Option<&CohesiveCrack<3>>,
    positions: &[Vector3],
    spacing: &SolidSpacing,
) -> Vec<FaceArea> {
    let surface = &model.cracks[crack].surface;
    let mut pieces = vec![];
    for t in 0..surface.triangles().len() as u32 {
        surface.for_each_piece(t, |p| EDGE * spacing.at(p), |piece| pieces.push(piece));
    }
    let pairs = PointTree::new(positions);
    let of_piece = |corners: &[Vector3; 3]| {
        let area = 0.5 * area_vector(*corners).norm() / (PARTS * PARTS) as f64;
        let mut found = vec![];
        for [a, b] in centers() {
            let p = corners[0] + (corners[1] - corners[0]) * a + (corners[2] - corners[0]) * b;
            if model.body.contains(p)
                && let Some(pair) = pairs.nearest(p)
            {
                found.push((pair as usize, area, cohesive.is_some_and(|c| !c.is_notch(p))));
            }
        }
        found
    };
    let mut areas = vec![FaceArea::default(); positions.len()];
    for (pair, area, is_cohesive) in pieces.par_iter().map(of_piece).collect::<Vec<_>>().into_iter().flatten() {
        areas[pair].total += area;
        areas[pair].cohesive += if is_cohesive { area } else { 0.0 };
    }
    areas
}

/// Centers of the parts of a triangle, by two of their barycentric coordinates.
fn centers() -> impl Iterator<Item = [f64; 2]> {
    let n = PARTS;
    let at = move |i: usize, j: usize, third: f64| [(i as f64 + third) / n as f64, (j as f64 + third) / n as f64];
    let upright = (0..n).flat_map(move |i| (0..n - i).map(move |j| at(i, j, 1.0 / 3.0)));
    let inverted = (0..n - 1).flat_map(move |i| (0..n - 1 - i).map(move |j| at(i, j, 2.0 / 3.0)));
    upright.chain(inverted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_as_many_as_their_area_says() {
        let all: Vec<[f64; 2]> = centers().collect();
        assert_eq!(all.len(), PARTS * PARTS);
        let mean = all.iter().map(|c| c[0]).sum::<f64>() / all.len() as f64;
        assert!((mean - 1.0 / 3.0).abs() < 1e-12 && all.iter().all(|[a, b]| a + b < 1.0));
    }
}
