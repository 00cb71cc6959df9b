//! The nearest nodes that a point sees.

use crate::geometry::aabb::Aabb;
use crate::geometry::obstacles::Opaque;
use crate::geometry::point_tree::PointTree;
use crate::math::Vector;
use crate::nodes::cloud::Cloud;
use std::cmp::Ordering;
use std::sync::Arc;

/// A cloud with a tree over its nodes and what hides them.
#[derive(Clone)]
pub struct VisibleNodes<const D: usize> {
    cloud: Cloud<D>,
    tree: PointTree<D>,
    obstacles: Arc<dyn Opaque<D> + Send>,
    /// Diagonal of the box around all nodes.
    extent: f64,
    /// Farthest that a node looks from besides its position.
    shift: f64,
}

/// The first radius that is searched over that of a ball with room for the nodes wanted, and growth from search to search:
/// a surface, an edge or a corner takes away half of a ball, and then half of that.
const FIRST: f64 = 1.08;
const GROWTH: f64 = 1.25;

impl<const D: usize> VisibleNodes<D> {
    /// Makes the tree.
    pub fn new(cloud: Cloud<D>, obstacles: Arc<dyn Opaque<D> + Send>) -> Self {
        let tree = PointTree::new(&cloud.positions);
        let extent = Aabb::of_points(cloud.positions.iter().copied()).size().norm();
        let shifts = cloud.positions.iter().zip(&cloud.sights).map(|(p, s)| (p - s).norm());
        let shift = shifts.fold(0.0, f64::max);
        Self { cloud, tree, obstacles, extent, shift }
    }

    /// The nodes.
    pub fn cloud(&self) -> &Cloud<D> {
        &self.cloud
    }

    /// Squared distances and indices of the nodes that are seen from `sight`, without `own` and in no order; returns the
    /// support radius.
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
        let mut radius = FIRST * spacing * ball_radius::<D>(wanted);
        loop {
            self.tree.within_into(at, radius, found);
            found.retain(|f| own != Some(f.1));
            let is_all = radius > self.extent;
            if found.len() > needed || is_all {
                let around = Aabb::around(at, Vector::repeat(radius + self.shift)).including(sight);
                if self.obstacles.is_clear(&around) {
                    if found.len() > needed {
                        found.select_nth_unstable_by(needed, nearer);
                    }
                } else {
                    found.sort_unstable_by(nearer);
                    self.keep_seen(sight, needed + 1, found);
                }
                if found.len() > needed || is_all {
                    break;
                }
            }
            radius *= GROWTH;
        }
        if found.len() <= needed {
            // The whole body: the farthest node keeps a small weight.
            let farthest = found.iter().map(|f| f.0).reduce(f64::max);
            return 1.1 * farthest.map_or(radius, f64::sqrt);
        }
        let limit = found[needed].0;
        // Nodes as far as the first one that is left out have no weight.
        found.truncate(needed);
        found.retain(|f| f.0 < limit);
        limit.sqrt()
    }

    /// Keeps the first `n` nodes that are seen: sight is dear, and most nodes are farther away than those wanted.
    fn keep_seen(&self, sight: Vector<D>, n: usize, found: &mut Vec<(f64, u32)>) {
        let mut kept = 0;
        for k in 0..found.len() {
            if kept < n && self.obstacles.visible(sight, self.cloud.sights[found[k].1 as usize]) {
                found[kept] = found[k];
                kept += 1;
            }
        }
        found.truncate(kept);
    }

    /// The nearest node that sees a point, with working memory; none if no node does.
    pub fn nearest(&self, at: Vector<D>, found: &mut Vec<(f64, u32)>) -> Option<u32> {
        let mut radius = self.spacing_near(at);
        loop {
            self.tree.within_into(at, radius, found);
            found.sort_unstable_by(nearer);
            let is_clear = self.obstacles.is_clear(&Aabb::around(at, Vector::repeat(radius + self.shift)));
            let sees = |j: u32| is_clear || self.obstacles.visible(at, self.cloud.sights[j as usize]);
            let nearest = found.iter().map(|f| f.1).find(|j| sees(*j));
            if nearest.is_some() || radius > self.extent {
                return nearest;
            }
            radius *= GROWTH;
        }
    }

    /// Spacing of the nearest node.
    fn spacing_near(&self, at: Vector<D>) -> f64 {
        self.tree.nearest(at).map_or(self.extent, |j| self.cloud.spacings[j as usize])
    }
}

/// By distance, then by index.
fn nearer(a: &(f64, u32), b: &(f64, u32)) -> Ordering {
    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
}

/// Radius of a ball that holds `n` unit cells.
pub fn ball_radius<const D: usize>(n: usize) -> f64 {
    use std::f64::consts::PI;
    let unit_ball = if D == 2 { PI } else { 4.0 / 3.0 * PI };
    (n as f64 / unit_ball).powf(1.0 / D as f64)
}
