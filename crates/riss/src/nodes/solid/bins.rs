//! Points in cubic bins whose size follows the spacing by powers of two: whether a place is free.

use crate::math::Vector3;
use rustc_hash::FxHashMap;

/// End of a list.
const NONE: u32 = u32::MAX;

/// Points with the distance that each keeps from others.
#[derive(Clone, Debug, Default)]
pub(super) struct Bins {
    /// First point of each bin, by level and place.
    first: FxHashMap<(i32, [i32; 3]), u32>,
    /// Next point of the same bin.
    next: Vec<u32>,
    points: Vec<(Vector3, f64)>,
    /// Lowest and highest level in use.
    levels: Option<[i32; 2]>,
}

impl Bins {
    fn level(h: f64) -> i32 {
        h.log2().ceil() as i32
    }

    fn place(level: i32, p: Vector3) -> [i32; 3] {
        let scale = 2f64.powi(-level);
        [p.x, p.y, p.z].map(|x| (x * scale).floor() as i32)
    }

    /// Adds a point with its spacing.
    pub fn insert(&mut self, p: Vector3, h: f64) {
        let level = Self::level(h);
        let index = self.points.len() as u32;
        let old = self.first.insert((level, Self::place(level, p)), index);
        self.next.push(old.unwrap_or(NONE));
        self.points.push((p, h));
        self.levels = Some(self.levels.map_or([level; 2], |[low, high]| [low.min(level), high.max(level)]));
    }

    /// Whether no point is nearer to `p` than `closeness` times the mean of its spacing and `h`.
    ///
    /// Spacings of points that near to each other must not differ by more than a factor of two.
    pub fn is_clear(&self, p: Vector3, h: f64, closeness: f64) -> bool {
        let Some([low, high]) = self.levels else { return true };
        let own = Self::level(h);
        let reach = 1.5 * closeness * h;
        for level in [own, own - 1, own + 1] {
            if level < low || level > high {
                continue;
            }
            let from = Self::place(level, p - Vector3::repeat(reach));
            let to = Self::place(level, p + Vector3::repeat(reach));
            for x in from[0]..=to[0] {
                for y in from[1]..=to[1] {
                    for z in from[2]..=to[2] {
                        let mut index = self.first.get(&(level, [x, y, z])).copied().unwrap_or(NONE);
                        while index != NONE {
                            let (q, spacing) = self.points[index as usize];
                            let least = 0.5 * closeness * (h + spacing);
                            if (q - p).norm_squared() < least * least {
                                return false;
                            }
                            index = self.next[index as usize];
                        }
                    }
                }
            }
        }
        true
    }
}
