//! Axis-aligned boxes.

use crate::math::Vector;

/// An axis-aligned box; empty if `lower > upper`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb<const D: usize> {
    /// Least coordinates.
    pub lower: Vector<D>,
    /// Greatest coordinates.
    pub upper: Vector<D>,
}

impl<const D: usize> Aabb<D> {
    /// The box that holds nothing.
    pub fn empty() -> Self {
        Self { lower: Vector::repeat(f64::INFINITY), upper: Vector::repeat(f64::NEG_INFINITY) }
    }

    /// The least box around `points`.
    pub fn of_points(points: impl IntoIterator<Item = Vector<D>>) -> Self {
        points.into_iter().fold(Self::empty(), |b, p| b.including(p))
    }

    /// The box `center ± half_size`.
    #[inline]
    pub fn around(center: Vector<D>, half_size: Vector<D>) -> Self {
        Self { lower: center - half_size, upper: center + half_size }
    }

    /// The least box that also holds `p`.
    #[inline]
    pub fn including(self, p: Vector<D>) -> Self {
        Self { lower: self.lower.inf(&p), upper: self.upper.sup(&p) }
    }

    /// The least box around both.
    #[inline]
    pub fn union(self, other: Self) -> Self {
        Self { lower: self.lower.inf(&other.lower), upper: self.upper.sup(&other.upper) }
    }

    /// Whether the closed boxes have a point in common.
    #[inline]
    pub fn intersects(&self, other: &Self) -> bool {
        (0..D).all(|d| self.lower[d] <= other.upper[d] && other.lower[d] <= self.upper[d])
    }

    /// Squared distance of a point; zero inside.
    #[inline]
    pub fn squared_distance(&self, p: &Vector<D>) -> f64 {
        let outside = |d: usize| (self.lower[d] - p[d]).max(p[d] - self.upper[d]).max(0.0);
        (0..D).map(|d| outside(d) * outside(d)).sum()
    }

    /// Whether a point lies in the closed box.
    #[inline]
    pub fn contains(&self, p: &Vector<D>) -> bool {
        (0..D).all(|d| self.lower[d] <= p[d] && p[d] <= self.upper[d])
    }

    /// The part of the segment from `a` to `b` inside the box.
    pub fn clipped(&self, a: Vector<D>, b: Vector<D>) -> Option<[Vector<D>; 2]> {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for d in 0..D {
            let step = b[d] - a[d];
            if step == 0.0 {
                if a[d] < self.lower[d] || a[d] > self.upper[d] {
                    return None;
                }
                continue;
            }
            let (s, t) = ((self.lower[d] - a[d]) / step, (self.upper[d] - a[d]) / step);
            (from, to) = (from.max(s.min(t)), to.min(s.max(t)));
        }
        (from < to).then(|| [a + (b - a) * from, a + (b - a) * to])
    }

    /// The middle of the box.
    #[inline]
    pub fn center(&self) -> Vector<D> {
        (self.lower + self.upper) * 0.5
    }

    /// Edge lengths.
    #[inline]
    pub fn size(&self) -> Vector<D> {
        self.upper - self.lower
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vector2;

    #[test]
    fn segments_are_clipped_at_the_box() {
        let v = Vector2::new;
        let bounds = Aabb::of_points([v(0.0, 0.0), v(2.0, 1.0)]);
        let ends = bounds.clipped(v(-1.0, 0.5), v(1.0, 0.5)).expect("it enters");
        assert!((ends[0] - v(0.0, 0.5)).norm() < 1e-15 && (ends[1] - v(1.0, 0.5)).norm() < 1e-15);
        let ends = bounds.clipped(v(-1.0, -1.0), v(3.0, 3.0)).expect("it crosses");
        assert!(ends[0].norm() < 1e-15 && (ends[1] - v(1.0, 1.0)).norm() < 1e-15);
        assert!(bounds.clipped(v(-1.0, 0.0), v(0.0, 2.1)).is_none());
        assert!(bounds.clipped(v(3.0, 0.0), v(3.0, 1.0)).is_none());
        assert!(bounds.contains(&v(2.0, 1.0)) && !bounds.contains(&v(2.0, 1.1)));
    }
}
