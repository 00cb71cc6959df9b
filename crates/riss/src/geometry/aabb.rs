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
