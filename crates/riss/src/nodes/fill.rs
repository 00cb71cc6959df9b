//! Irregular nodes of prescribed spacing inside the body, by advancing from the points that are there [SlakKosec2019].

use super::spacing::SpacingField;
use crate::math::{Vector2, direction};
use rustc_hash::FxHashMap;
use std::f64::consts::TAU;

/// Candidates around each point.
const CANDIDATES: usize = 12;
/// Closest allowed distance over the spacing at the candidate.
const CLOSENESS: f64 = 0.85;
/// Over the spacing at the candidate, how near given points are for it to be asked whether it is inside.
const NEAR_GIVEN: f64 = 2.0;

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
    let mut around = vec![];
    let mut current = 0;
    while current < points.len() && points.len() < limit {
        let (p, h) = points[current];
        // A different start angle for each point, from its index, so that runs repeat.
        let start = current as f64 * 2.399_963_229_728_653;
        let at = |k: usize| p + direction(start + k as f64 * TAU / CANDIDATES as f64) * h;
        let candidates: [_; CANDIDATES] = std::array::from_fn(|k| (at(k), spacing.at(at(k))));
        let (least, largest) = candidates.iter().fold((h, h), |(l, g), c| (c.1.min(l), c.1.max(g)));
        let reach = h + NEAR_GIVEN * largest;
        grid.within_into(reach, p, [least, largest], &points, &mut around);
        for (candidate, own) in candidates {
            let is_like = |level: i32| (level - LevelGrid::level(own)).abs() <= 1;
            let any_within = |reach: f64, first: usize| {
                let is_near = |(i, q, level): &(u32, Vector2, i32)| {
                    (*i as usize) < first && is_like(*level) && (q - candidate).norm() < reach
                };
                around.iter().any(is_near)
            };
            if any_within(CLOSENESS * own, usize::MAX) {
                continue;
            }
            let near_given = current < given.len() || any_within(NEAR_GIVEN * own, given.len());
            if !near_given || inside(candidate) {
                let index = points.len() as u32;
                grid.insert(index, candidate, own);
                around.push((index, candidate, LevelGrid::level(own)));
                points.push((candidate, own));
            }
        }
        current += 1;
    }
    points.split_off(given.len())
}

/// Size of a bin over the power of two below the spacing in it: few bins are asked, with some points each.
const BIN: f64 = 4.0;

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
        let size = 2f64.powi(level) * BIN;
        [(p.x / size).floor() as i64, (p.y / size).floor() as i64]
    }

    fn insert(&mut self, index: u32, p: Vector2, h: f64) {
        let level = Self::level(h);
        self.levels.entry(level).or_default().entry(Self::bin(level, p)).or_default().push(index);
    }

    /// Points within a distance, with their levels; those whose spacing is far from a range of spacings are left out.
    fn within_into(
        &self,
        reach: f64,
        p: Vector2,
        spacings: [f64; 2],
        points: &[(Vector2, f64)],
        found: &mut Vec<(u32, Vector2, i32)>,
    ) {
        found.clear();
        for level in Self::level(spacings[0]) - 1..=Self::level(spacings[1]) + 1 {
            let Some(bins) = self.levels.get(&level) else { continue };
            // No point is lost by round-off.
            let margin = Vector2::repeat(reach * (1.0 + 1e-9));
            let ([i0, j0], [i1, j1]) = (Self::bin(level, p - margin), Self::bin(level, p + margin));
            for bin in (i0..=i1).flat_map(|i| (j0..=j1).filter_map(move |j| bins.get(&[i, j]))) {
                let near = bin.iter().map(|i| (*i, points[*i as usize].0, level));
                found.extend(near.filter(|(_, q, _)| (q - p).norm() <= margin.x));
            }
        }
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
