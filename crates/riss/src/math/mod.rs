//! Fixed-size linear algebra: vector and matrix types and the small factorizations that the point kernels need.
//!
//! Knows nothing of geometry. `nalgebra` types appear here under the names that the rest of the library uses.

pub mod cholesky;
pub mod gauss_legendre;
pub mod lanes;
pub mod symmetric_eigen;

/// A point or vector in `D` dimensions.
pub type Vector<const D: usize> = nalgebra::SVector<f64, D>;
/// A `D`×`D` tensor, rows first in [`nalgebra::SMatrix::new`].
pub type Matrix<const D: usize> = nalgebra::SMatrix<f64, D, D>;
/// A point or vector in the plane.
pub type Vector2 = Vector<2>;
/// A point or vector in space.
pub type Vector3 = Vector<3>;
/// A tensor in the plane.
pub type Matrix2 = Matrix<2>;

/// Unit vector along an axis.
#[inline]
pub fn axis<const D: usize>(d: usize) -> Vector<D> {
    Vector::from_fn(|k, _| if k == d { 1.0 } else { 0.0 })
}

/// Out-of-plane component of `a × b`: positive if `b` points to the left of `a`.
#[inline]
pub fn cross(a: Vector2, b: Vector2) -> f64 {
    a.x * b.y - a.y * b.x
}

/// `a` turned by +90°.
#[inline]
pub fn turn_left(a: Vector2) -> Vector2 {
    Vector2::new(-a.y, a.x)
}

/// Unit vector at `angle` [rad] from the x axis.
#[inline]
pub fn direction(angle: f64) -> Vector2 {
    Vector2::new(angle.cos(), angle.sin())
}

/// In-plane principal stresses, the greater first, and the unit direction of the greater.
pub fn principal_stresses(stress: &Matrix2) -> (f64, f64, Vector2) {
    let middle = 0.5 * stress.trace();
    let difference = 0.5 * (stress[(0, 0)] - stress[(1, 1)]);
    let shear = 0.5 * (stress[(0, 1)] + stress[(1, 0)]);
    let radius = difference.hypot(shear);
    (middle + radius, middle - radius, direction(0.5 * shear.atan2(difference)))
}
