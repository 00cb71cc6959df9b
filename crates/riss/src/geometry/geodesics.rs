//! Shortest ways around obstacles: straight from corner to corner.

use super::aabb::Aabb;
use super::obstacles::Obstacles;
use super::tree::BoxTree;
use crate::math::Vector2;

/// Places that shortest ways may bend around, each moved slightly off its obstacle.
#[derive(Clone, Debug)]
pub struct Corners {
    places: Vec<Vector2>,
    bends: Vec<Bend>,
    tree: BoxTree<2>,
}

/// Which ways bend at a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bend {
    /// All.
    Every,
    /// Those from an origin that does not see the corner itself.
    Hidden,
}

/// The shortest way from an origin to a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way {
    /// Index of the corner.
    pub corner: u32,
    /// Length, with what the legs cost besides [length].
    pub length: f64,
}

/// Which ways count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Within {
    /// Those shorter than this [length].
    Length(f64),
    /// Those that stay in a disk around the origin, however long [length].
    Disk(f64),
}

impl Within {
    fn radius(self) -> f64 {
        match self {
            Self::Length(radius) | Self::Disk(radius) => radius,
        }
    }

    fn longest(self) -> f64 {
        match self {
            Self::Length(length) => length,
            Self::Disk(_) => f64::INFINITY,
        }
    }
}

impl Corners {
    /// Makes the tree.
    pub fn new(corners: Vec<(Vector2, Bend)>) -> Self {
        let (places, bends): (Vec<_>, Vec<_>) = corners.into_iter().unzip();
        Self { tree: BoxTree::of_points(&places), places, bends }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Where a corner is.
    #[inline]
    pub fn place(&self, corner: u32) -> Vector2 {
        self.places[corner as usize]
    }

    /// Ways from an origin to all corners that it can reach, ascending by corner.
    ///
    /// - `sight`: from where the origin sees
    /// - `leg(near, a, b)`: length of the straight leg between two places, or nothing if one of the obstacles `near`
    ///   blocks it
    pub fn ways_from(
        &self,
        obstacles: &Obstacles,
        origin: Vector2,
        sight: Vector2,
        within: Within,
        leg: impl Fn(&[u32], Vector2, Vector2) -> Option<f64>,
    ) -> Vec<Way> {
        let radius = within.radius();
        let mut near = vec![];
        self.tree.visit(&Aabb::around(origin, Vector2::repeat(radius)), |c| {
            if (self.places[c as usize] - origin).norm() < radius {
                near.push(c);
            }
        });
        if near.is_empty() {
            return vec![];
        }
        near.sort_unstable();
        let mut walls = vec![];
        let bounds = Aabb::of_points(near.iter().map(|c| self.place(*c)).chain([origin, sight]));
        obstacles.near_into(&bounds, &mut walls);
        let longest = within.longest();
        let leg = |a, b| leg(&walls, a, b).unwrap_or(f64::INFINITY);
        let mut lengths: Vec<f64> = near.iter().map(|c| leg(sight, self.place(*c))).collect();
        let bends = |k: usize| match self.bends[near[k] as usize] {
            Bend::Every => true,
            Bend::Hidden => !obstacles.visible_past(&walls, sight, self.place(near[k])),
        };
        let (mut open, straight): (Vec<usize>, Vec<usize>) = (0..near.len()).partition(|k| bends(*k));
        straight.into_iter().for_each(|k| lengths[k] = f64::INFINITY);
        // Dijkstra's algorithm; corners are few, so the nearest open one is searched plainly.
        while let Some(k) = (0..open.len()).min_by(|a, b| lengths[open[*a]].total_cmp(&lengths[open[*b]])) {
            let from = open.swap_remove(k);
            if lengths[from] >= longest || lengths[from].is_infinite() {
                break;
            }
            for &to in &open {
                let (a, b) = (self.place(near[from]), self.place(near[to]));
                let least = lengths[from] + (b - a).norm();
                if least < lengths[to].min(longest) {
                    lengths[to] = lengths[to].min(lengths[from] + leg(a, b));
                }
            }
        }
        let found = near.into_iter().zip(lengths).filter(|(_, length)| length.is_finite() && *length < longest);
        found.map(|(corner, length)| Way { corner, length }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn around(obstacles: &Obstacles, corners: &Corners, origin: Vector2, within: Within) -> Vec<Way> {
        corners.ways_from(obstacles, origin, origin, within, |near, a, b| {
            obstacles.visible_past(near, a, b).then(|| (b - a).norm())
        })
    }

    /// A polygon of many sides inside the unit circle, seen from two radii away: the tangent, then the arc.
    #[test]
    fn way_around_a_circle_is_tangent_and_arc() {
        let n = 720;
        let rim = |k: usize| crate::math::direction(2.0 * PI * k as f64 / n as f64);
        let obstacles = Obstacles::new((0..n).map(|k| [rim(k), rim(k + 1)]).collect());
        let corners = Corners::new((0..n).map(|k| (rim(k) * (1.0 + 1e-9), Bend::Every)).collect());
        let ways = around(&obstacles, &corners, Vector2::new(2.0, 0.0), Within::Length(10.0));
        assert_eq!(ways.len(), n);
        for degrees in [90, 120, 150, 179] {
            let arc = (degrees as f64).to_radians() - PI / 3.0;
            let found = ways[degrees * n / 360].length;
            // Chords are shorter than arcs by a 24th of the square of their angle.
            assert!((found - 3f64.sqrt() - arc).abs() < 1e-5, "{found} at {degrees} degrees");
        }
    }

    #[test]
    fn ways_pass_two_walls_and_end_at_the_limit() {
        let v = Vector2::new;
        let obstacles = Obstacles::new(vec![[v(0.0, -9.0), v(0.0, 1.0)], [v(1.0, 0.0), v(1.0, 9.0)]]);
        let corners = Corners::new(vec![(v(0.0, 1.0 + 1e-9), Bend::Every), (v(1.0, -1e-9), Bend::Hidden)]);
        let origin = v(-1.0, 0.0);
        let ways = around(&obstacles, &corners, origin, Within::Length(4.0));
        let lengths: Vec<f64> = ways.iter().map(|w| w.length).collect();
        assert!((lengths[0] - 2f64.sqrt()).abs() < 1e-8 && (lengths[1] - 8f64.sqrt()).abs() < 1e-8, "{lengths:?}");
        assert_eq!(around(&obstacles, &corners, origin, Within::Length(2.5)).len(), 1);
        assert_eq!(around(&obstacles, &corners, origin, Within::Disk(2.5)).len(), 2);
    }
}
