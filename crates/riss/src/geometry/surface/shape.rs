//! The surfaces that triangles stand for.

use crate::math::Vector3;

/// What the triangles of a part approximate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// The triangles themselves, with normals smoothed between sharp edges.
    Triangles,
    /// A circular cylinder.
    Cylinder {
        /// A point of the axis.
        center: Vector3,
        /// Unit vector along the axis.
        axis: Vector3,
        /// Radius [length].
        radius: f64,
    },
    /// A sphere.
    Sphere {
        /// Its center.
        center: Vector3,
        /// Radius [length].
        radius: f64,
    },
}

impl Shape {
    /// The nearest point of the surface; the point itself for triangles.
    pub fn project(&self, p: Vector3) -> Vector3 {
        match self {
            Self::Triangles => p,
            Self::Cylinder { radius, .. } | Self::Sphere { radius, .. } => {
                let outward = self.away(p);
                p + outward * (radius / outward.norm() - 1.0)
            }
        }
    }

    /// Unit normal at a point, on the side of `hint`; `hint` itself for triangles.
    pub fn normal(&self, p: Vector3, hint: Vector3) -> Vector3 {
        match self {
            Self::Triangles => hint,
            Self::Cylinder { .. } | Self::Sphere { .. } => {
                let away = self.away(p).normalize();
                if away.dot(&hint) < 0.0 { -away } else { away }
            }
        }
    }

    /// Curvature where the normal points to the center, so that the surface is hollow; zero where it bulges.
    pub fn hollowness(&self, p: Vector3, normal: Vector3) -> f64 {
        match self {
            Self::Triangles => 0.0,
            Self::Cylinder { radius, .. } | Self::Sphere { radius, .. } => {
                if self.away(p).dot(&normal) < 0.0 {
                    1.0 / radius
                } else {
                    0.0
                }
            }
        }
    }

    /// From the center or the axis to a point.
    fn away(&self, p: Vector3) -> Vector3 {
        match self {
            Self::Triangles => Vector3::zeros(),
            Self::Cylinder { center, axis, .. } => (p - center) - axis * (p - center).dot(axis),
            Self::Sphere { center, .. } => p - center,
        }
    }
}
