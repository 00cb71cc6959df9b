//! The shortest ways from every node around corners, and on from there to points.

use crate::geometry::aabb::Aabb;
use crate::geometry::geodesics::{Corners, Way, Within};
use crate::geometry::obstacles::Obstacles;
use crate::math::Vector2;
use crate::nodes::Nodes;
use rayon::prelude::*;

/// Obstacles, and for each node the corners around which it acts.
#[derive(Clone, Debug)]
pub(super) struct NodeWays {
    pub obstacles: Obstacles,
    corners: Corners,
    ends: Vec<usize>,
    ways: Vec<Way>,
}

/// What a survey found, and which corners the present point sees. A buffer.
#[derive(Clone, Debug, Default)]
pub(super) struct WaysBuffer {
    /// Obstacles that may hide.
    pub near: Vec<u32>,
    /// Corners that any candidate can reach, ascending, and their places.
    corners: Vec<u32>,
    places: Vec<Vector2>,
    /// Ways of the candidates, one list after the other, with corners by index in `corners`.
    ends: Vec<usize>,
    ways: Vec<(u32, f64)>,
    /// Length and shade of the last leg to each corner from the present point, once it was asked for.
    legs: Vec<Option<[f64; 2]>>,
}

/// The end of the shortest way from a node to a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct LastLeg {
    /// Where it starts.
    pub corner: Vector2,
    /// Length of the whole way, with its shades [length].
    pub length: f64,
}

impl NodeWays {
    /// Finds the ways of all nodes inside their supports, which are disks.
    ///
    /// - `within`: from a support radius to which ways count
    /// - `leg(radius, near, a, b)`: see [`Corners::ways_from`]
    pub fn new(
        nodes: &Nodes<2>,
        obstacles: Obstacles,
        corners: Corners,
        within: fn(f64) -> Within,
        leg: impl Fn(f64, &[u32], Vector2, Vector2) -> Option<f64> + Sync,
    ) -> Self {
        let mut result = Self { obstacles, corners, ends: vec![], ways: vec![] };
        if result.corners.is_empty() {
            return result;
        }
        let find = |i: usize| {
            let (origin, sight, radius) = (nodes.positions[i], nodes.sights[i], nodes.support_radii[i].x);
            result
                .corners
                .ways_from(&result.obstacles, origin, sight, within(radius), |near, a, b| leg(radius, near, a, b))
        };
        let lists: Vec<Vec<Way>> = (0..nodes.len()).into_par_iter().with_min_len(64).map(find).collect();
        for list in lists {
            result.ways.extend(list);
            result.ends.push(result.ways.len());
        }
        result
    }

    fn of(&self, node: u32) -> &[Way] {
        let i = node as usize;
        &self.ways[(if i == 0 { 0 } else { self.ends[i - 1] })..self.ends[i]]
    }

    /// Looks up what may matter between the candidates and points in a box that reaches to all of them.
    pub fn survey(&self, reach: &Aabb<2>, candidates: &[u32], buffer: &mut WaysBuffer) {
        let WaysBuffer { near, corners, places, ends, ways, .. } = buffer;
        self.obstacles.near_into(reach, near);
        corners.clear();
        places.clear();
        ends.clear();
        ways.clear();
        if near.is_empty() || self.corners.is_empty() {
            return;
        }
        for &i in candidates {
            corners.extend(self.of(i).iter().map(|w| w.corner));
        }
        if corners.is_empty() {
            return;
        }
        corners.sort_unstable();
        corners.dedup();
        places.extend(corners.iter().map(|c| self.corners.place(*c)));
        self.obstacles.near_into(&places.iter().fold(*reach, |b, p| b.including(*p)), near);
        for &i in candidates {
            for way in self.of(i) {
                let local = corners.partition_point(|c| *c < way.corner);
                ways.push((local as u32, way.length));
            }
            ends.push(ways.len());
        }
    }
}

impl WaysBuffer {
    /// Forgets what the last point saw.
    #[inline]
    pub fn start_point(&mut self) {
        self.legs.clear();
        self.legs.resize(self.corners.len(), None);
    }

    /// Whether nothing can hide.
    #[inline]
    pub fn is_open(&self) -> bool {
        self.near.is_empty()
    }

    fn list(&self, candidate: usize) -> std::ops::Range<usize> {
        match self.ends.is_empty() {
            true => 0..0,
            false => (if candidate == 0 { 0 } else { self.ends[candidate - 1] })..self.ends[candidate],
        }
    }

    /// The shortest way from a candidate around a corner to the point, if there is one inside its support.
    ///
    /// - `leg(near, corner)`: length of the last leg and its shade, infinite if it is blocked; each radius of shade
    ///   makes the way as much longer
    #[inline]
    pub fn shortest(
        &mut self,
        candidate: usize,
        at: Vector2,
        radius: f64,
        leg: impl Fn(&[u32], Vector2) -> [f64; 2],
    ) -> Option<LastLeg> {
        let mut best = LastLeg { corner: at, length: radius };
        for k in self.list(candidate) {
            let (local, length) = self.ways[k];
            let corner = self.places[local as usize];
            if length + (at - corner).norm() < best.length {
                let [last, shade] = *self.legs[local as usize].get_or_insert_with(|| leg(&self.near, corner));
                let whole = length + last + radius * shade;
                if whole < best.length {
                    best = LastLeg { corner, length: whole };
                }
            }
        }
        (best.length < radius).then_some(best)
    }

    /// Whether any corner that a candidate reaches has a last leg to the point.
    pub fn reaches(&mut self, candidate: usize, leg: impl Fn(&[u32], Vector2) -> [f64; 2]) -> bool {
        self.list(candidate).any(|k| {
            let local = self.ways[k].0 as usize;
            self.legs[local].get_or_insert_with(|| leg(&self.near, self.places[local]))[0].is_finite()
        })
    }
}
