//! Weight functions of the distance to a node [EFG, Eq. 1].

use super::settings::{SupportShape, WeightFunction};
use crate::math::{Matrix, Vector};

/// Exponent of the Gaussian at the rim of the support: `(d_max/α)²` with `d_max = 4 α`.
const GAUSSIAN_EXPONENT: f64 = 16.0;

impl WeightFunction {
    /// Weights and slopes `w'/s` of many squared relative distances; the choice of function is made once.
    pub fn values_and_slopes(self, s2: &[f64], weights: &mut [f64], slopes: &mut [f64]) {
        macro_rules! fill {
            ($function:expr) => {
                for ((s2, w), slope) in s2.iter().zip(weights).zip(slopes) {
                    (*w, *slope) = $function.value_and_slope(*s2);
                }
            };
        }
        match self {
            Self::Gaussian => fill!(Self::Gaussian),
            Self::QuarticSpline => fill!(Self::QuarticSpline),
            Self::CubicSpline => fill!(Self::CubicSpline),
        }
    }

    /// Weight `w(s)` and `w'(s)/s` at relative distance `s = d/r < 1`.
    #[inline(always)]
    pub fn value_and_slope(self, s2: f64) -> (f64, f64) {
        match self {
            Self::Gaussian => {
                let scale = 1.0 / (1.0 - (-GAUSSIAN_EXPONENT).exp());
                let e = (-GAUSSIAN_EXPONENT * s2).exp();
                ((e - (-GAUSSIAN_EXPONENT).exp()) * scale, -2.0 * GAUSSIAN_EXPONENT * e * scale)
            }
            Self::QuarticSpline => {
                let s = s2.sqrt();
                (1.0 + s2 * (-6.0 + 8.0 * s - 3.0 * s2), -12.0 + 24.0 * s - 12.0 * s2)
            }
            Self::CubicSpline => {
                let s = s2.sqrt();
                if s <= 0.5 {
                    (2.0 / 3.0 + s2 * (-4.0 + 4.0 * s), -8.0 + 12.0 * s)
                } else {
                    let t = 1.0 - s;
                    (4.0 / 3.0 * t * t * t, -4.0 * t * t / s)
                }
            }
        }
    }

    /// `(w'/s)'/s`, for second derivatives; the singular point `s = 0` counts as zero, where its factor vanishes.
    #[inline]
    pub fn slope_of_slope(self, s2: f64) -> f64 {
        let s = s2.sqrt();
        if s == 0.0 {
            return 0.0;
        }
        match self {
            Self::Gaussian => {
                4.0 * GAUSSIAN_EXPONENT.powi(2) * (-GAUSSIAN_EXPONENT * s2).exp() / (1.0 - (-GAUSSIAN_EXPONENT).exp())
            }
            Self::QuarticSpline => 24.0 * (1.0 - s) / s,
            Self::CubicSpline if s <= 0.5 => 12.0 / s,
            Self::CubicSpline => 4.0 * (1.0 / s2 - 1.0) / s,
        }
    }

    /// Weight and gradient by the point, for a node at `offset` (node minus point) with the given support.
    #[inline]
    pub fn weight<const D: usize>(
        self,
        shape: SupportShape,
        offset: &Vector<D>,
        radii: &Vector<D>,
    ) -> (f64, Vector<D>) {
        match shape {
            SupportShape::Circular => {
                let inverse2 = 1.0 / (radii[0] * radii[0]);
                let (w, slope) = self.value_and_slope(offset.norm_squared() * inverse2);
                (w, offset * (-slope * inverse2))
            }
            SupportShape::Rectangular => {
                let axis: [(f64, f64); D] = std::array::from_fn(|d| {
                    let s = offset[d] / radii[d];
                    let (w, slope) = self.value_and_slope(s * s);
                    (w, -slope * s / radii[d])
                });
                let w = axis.iter().map(|a| a.0).product();
                let gradient = std::array::from_fn::<f64, D, _>(|d| {
                    (0..D).map(|k| if k == d { axis[k].1 } else { axis[k].0 }).product()
                });
                (w, Vector::<D>::from(gradient))
            }
        }
    }

    /// Second derivatives of the weight by the point.
    pub fn second_derivatives<const D: usize>(
        self,
        shape: SupportShape,
        offset: &Vector<D>,
        radii: &Vector<D>,
    ) -> Matrix<D> {
        match shape {
            SupportShape::Circular => {
                let inverse2 = 1.0 / (radii[0] * radii[0]);
                let s2 = offset.norm_squared() * inverse2;
                let slope = self.value_and_slope(s2).1 * inverse2;
                Matrix::<D>::identity() * slope
                    + offset * offset.transpose() * (self.slope_of_slope(s2) * inverse2 * inverse2)
            }
            SupportShape::Rectangular => {
                let axis: [[f64; 3]; D] = std::array::from_fn(|d| {
                    let s = offset[d] / radii[d];
                    let (w, slope) = self.value_and_slope(s * s);
                    let second = slope + s * s * self.slope_of_slope(s * s);
                    [w, -slope * s / radii[d], second / (radii[d] * radii[d])]
                });
                Matrix::<D>::from_fn(|i, j| (0..D).map(|k| axis[k][(k == i) as usize + (k == j) as usize]).product())
            }
        }
    }

    /// Whether a node at `offset` reaches the point.
    #[inline]
    pub fn reaches<const D: usize>(shape: SupportShape, offset: &Vector<D>, radii: &Vector<D>) -> bool {
        match shape {
            SupportShape::Circular => offset.norm_squared() < radii[0] * radii[0],
            SupportShape::Rectangular => (0..D).all(|d| offset[d].abs() < radii[d]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_match_finite_differences() {
        let radii = Vector::<2>::new(1.3, 0.9);
        for function in [WeightFunction::Gaussian, WeightFunction::QuarticSpline, WeightFunction::CubicSpline] {
            for shape in [SupportShape::Circular, SupportShape::Rectangular] {
                for offset in [Vector::<2>::new(0.3, -0.2), Vector::<2>::new(-0.7, 0.55), Vector::<2>::new(0.4, 0.8)] {
                    let gradient = function.weight(shape, &offset, &radii).1;
                    let second = function.second_derivatives(shape, &offset, &radii);
                    for d in 0..2 {
                        let step = Vector::<2>::ith(d, 1e-6);
                        // Moving the point forward moves the offset back.
                        let (ahead, behind) = (
                            function.weight(shape, &(offset - step), &radii),
                            function.weight(shape, &(offset + step), &radii),
                        );
                        assert!(((ahead.0 - behind.0) / 2e-6 - gradient[d]).abs() < 1e-8);
                        assert!(
                            ((ahead.1 - behind.1) / 2e-6 - second.column(d)).norm() < 1e-7,
                            "{function:?} {shape:?}"
                        );
                    }
                }
            }
            assert!(function.value_and_slope(1.0).0.abs() < 1e-15);
        }
    }
}
