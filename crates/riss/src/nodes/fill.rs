//! Irregular nodes of prescribed spacing inside the body, by advancing from the points that are there [SlakKosec2019].

use super::spacing::SpacingField;
use crate::math::{Vector2, direction};
use rustc_hash::FxHashMap;

/// Candidates around each point.
const CANDIDATES: usize = 12;
/// Closest allowed distance over the spacing at the candidate.
const CLOSENESS: f64 = 0.85;

/// New points such that every point of the body has one within about its spacing and none nearer than
/// most of it to another. `inside` must hold for new points; it is asked only near given points.
pub fn fill(
    given: &[(Vector2, f64)],
    spacing: &SpacingField,
    limit: usize,
    inside: &dyn Fn(Vector2) -> bool,
) -> Vec<(Vector2, f64)> {
    let mut grid = LevelGrid::default();
    let mut points: Vec<(Vector2, f64)> = given.to_vec();
    for (i, &(p, h)) in given.iter().enumerate() {
        grid.insert(i as u32, p, h);
    }
    let mut current = 0;
    while current < points.len() && points.len() < limit {
        let (p, h) = points[current];
        // A different start angle for each point, from its index, so that runs repeat.
        let start = current as f64 * 2.399_963_229_728_653;
        for k in 0..CANDIDATES {
            let candidate = p + direction(start + k as f64 * std::f64::consts::TAU / CANDIDATES as f64) * h;
            let own = spacing.at(candidate);
            if grid.any_within(CLOSENESS * own, candidate, own, &points, |_| true) {
                continue;
            }
            let near_given = current < given.len()
                || grid.any_within(2.0 * own, candidate, own, &points, |i| (i as usize) < given.len());
            if !near_given || inside(candidate) {
                grid.insert(points.len() as u32, candidate, own);
                points.push((candidate, own));
            }
        }
        current += 1;
    }
    points.split_off(given.len())
}

/// Points in square bins whose size follows their spacing by powers of two.
#[derive(Default)]
struct LevelGrid {
    levels: FxHashMap<i32, FxHashMap<[i64; 2], Vec<u32>>>,
}

impl LevelGrid {
    fn level(h: f64) -> i32 {
        h.log2().floor() as i32
    }

    fn bin(level: i32, p: Vector2) -> [i64; 2] {
        let size = 2f64.powi(level);
        [(p.x / size).floor() as i64, (p.y / size).floor() as i64]
    }

    fn insert(&mut self, index: u32, p: Vector2, h: f64) {
        let level = Self::level(h);
        self.levels.entry(level).or_default().entry(Self::bin(level, p)).or_default().push(index);
    }

    /// Whether a point of about the spacing `h` that `counts` is nearer than `reach`.
    fn any_within(
        &self,
        reach: f64,
        p: Vector2,
        h: f64,
        points: &[(Vector2, f64)],
        counts: impl Fn(u32) -> bool,
    ) -> bool {
        let is_near = |i: &u32| (points[*i as usize].0 - p).norm() < reach && counts(*i);
        (Self::level(h) - 1..=Self::level(h) + 1).any(|level| {
            let Some(bins) = self.levels.get(&level) else { return false };
            // No point is lost by round-off.
            let margin = Vector2::repeat(reach * (1.0 + 1e-9));
            let ([i0, j0], [i1, j1]) = (Self::bin(level, p - margin), Self::bin(level, p + margin));
            (i0..=i1).any(|i| (j0..=j1).any(|j| bins.get(&[i, j]).is_some_and(|bin| bin.iter().any(is_near))))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fills_a_square_at_the_spacing() {
        let h = 0.05;
        let mut given = vec![];
        for k in 0..20 {
            let t = k as f64 * h;
            given.extend([(t, 0.0), (1.0, t), (1.0 - t, 1.0), (0.0, 1.0 - t)].map(|(x, y)| (Vector2::new(x, y), h)));
        }
        let inside = |p: Vector2| p.x > 0.0 && p.x < 1.0 && p.y > 0.0 && p.y < 1.0;
        let new = fill(&given, &SpacingField::uniform(h), 10_000, &inside);
        assert!((300..480).contains(&new.len()), "{}", new.len());
        for (i, (p, _)) in new.iter().enumerate() {
            assert!(inside(*p));
            assert!(new[..i].iter().chain(&given).all(|(q, _)| (p - q).norm() >= CLOSENESS * h));
        }
    }
}
