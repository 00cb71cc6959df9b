//! The nearest nodes that a point sees.

use crate::geometry::aabb::Aabb;
use crate::geometry::obstacles::Opaque;
use crate::geometry::tree::BoxTree;
use crate::math::Vector;
use crate::nodes::cloud::Cloud;
use std::sync::Arc;

/// A cloud with a tree over its nodes and what hides them.
#[derive(Clone)]
pub struct VisibleNodes<const D: usize> {
    cloud: Cloud<D>,
    tree: BoxTree<D>,
    obstacles: Arc<dyn Opaque<D> + Send>,
    /// Diagonal of the box around all nodes.
    extent: f64,
}

impl<const D: usize> VisibleNodes<D> {
    /// Makes the tree.
    pub fn new(cloud: Cloud<D>, obstacles: Arc<dyn Opaque<D> + Send>) -> Self {
        let tree = BoxTree::of_points(&cloud.positions);
        let extent = Aabb::of_points(cloud.positions.iter().copied()).size().norm();
        Self { cloud, tree, obstacles, extent }
    }

    /// The nodes.
    pub fn cloud(&self) -> &Cloud<D> {
        &self.cloud
    }

    /// Squared distances and indices of the nodes that are seen from `sight`, nearest to `at` first and without `own`; returns
    /// the support radius.
    ///
    /// The support is the largest one that holds no more than `wanted` nodes [C3D, after Eq. 12].
    pub fn nearest_into(
        &self,
        own: Option<u32>,
        at: Vector<D>,
        sight: Vector<D>,
        wanted: usize,
        found: &mut Vec<(f64, u32)>,
    ) -> f64 {
        let spacing = own.map_or_else(|| self.spacing_near(at), |i| self.cloud.spacings[i as usize]);
        let needed = wanted - usize::from(own.is_some());
        let mut radius = 1.15 * spacing * ball_radius::<D>(wanted);
        loop {
            found.clear();
            let r2 = radius * radius;
            self.tree.visit(&Aabb::around(at, Vector::repeat(radius)), |j| {
                let d2 = (self.cloud.positions[j as usize] - at).norm_squared();
                if d2 <= r2 && own != Some(j) {
                    found.push((d2, j));
                }
            });
            let is_all = radius > self.extent;
            if found.len() > needed || is_all {
                found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                let mut n_visible = 0;
                found.retain(|&(_, j)| {
                    let keep = n_visible <= needed && self.obstacles.visible(sight, self.cloud.sights[j as usize]);
                    n_visible += usize::from(keep);
                    keep
                });
                if n_visible > needed || is_all {
                    break;
                }
            }
            radius *= 1.25;
        }
        if found.len() <= needed {
            // The whole body: the farthest node keeps a small weight.
            return 1.1 * found.last().map_or(radius, |last| last.0.sqrt());
        }
        let limit = found[needed].0;
        // Nodes as far as the first one that is left out have no weight.
        let kept = found.partition_point(|f| f.0 < limit);
        found.truncate(kept);
        limit.sqrt()
    }

    /// Spacing of a node near a point.
    fn spacing_near(&self, at: Vector<D>) -> f64 {
        let mut radius = self.extent / (self.cloud.len() as f64).powf(1.0 / D as f64);
        loop {
            let mut nearest = (f64::INFINITY, radius);
            self.tree.visit(&Aabb::around(at, Vector::repeat(radius)), |j| {
                let d2 = (self.cloud.positions[j as usize] - at).norm_squared();
                if d2 < nearest.0 {
                    nearest = (d2, self.cloud.spacings[j as usize]);
                }
            });
            if nearest.0.is_finite() || radius > self.extent {
                return nearest.1;
            }
            radius *= 2.0;
        }
    }
}

/// Radius of a ball that holds `n` unit cells.
pub fn ball_radius<const D: usize>(n: usize) -> f64 {
    use std::f64::consts::PI;
    let unit_ball = if D == 2 { PI } else { 4.0 / 3.0 * PI };
    (n as f64 / unit_ball).powf(1.0 / D as f64)
}
