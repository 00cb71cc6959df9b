//! Functions of the distance and angle at a crack front [EFG, Eq. 50], in two and three dimensions.
//!
//! A front is a point in the plane and a curve in space. Near a place it is taken for an arc of a circle in the plane of
//! the crack, so that distance and angle have closed derivatives.

use super::front_sheets::on_sheet;
use super::tip_functions::{MOST_FUNCTIONS, TipFunctions};
use crate::geometry::aabb::Aabb;
use crate::math::{Matrix, Vector};

/// A point of a crack front with its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontFrame<const D: usize> {
    /// The point.
    pub position: Vector<D>,
    /// Unit vector in the plane of the crack, normal to the front, away from the crack (x1).
    pub ahead: Vector<D>,
    /// Unit normal of the crack (x2).
    pub normal: Vector<D>,
    /// Curvature of the front in the plane of the crack [1/length]; positive if the crack is convex.
    pub curvature: f64,
    /// Curvature of the front out of that plane [1/length]; positive if it bends away from the normal, zero for a plane
    /// crack.
    pub normal_curvature: f64,
}

/// The arc of a front near a frame: it bends in the plane of the tangent and of `axis`, away from this.
struct Arc<const D: usize> {
    curvature: f64,
    axis: Vector<D>,
    /// Normal to the plane of the arc.
    binormal: Vector<D>,
    /// Cosine and sine of the angle from `ahead` to `axis`.
    turn: [f64; 2],
}

/// A function with first and second derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<const D: usize> {
    /// Value.
    pub value: f64,
    /// Gradient.
    pub gradient: Vector<D>,
    /// Second derivatives.
    pub second_derivatives: Matrix<D>,
}

impl<const D: usize> FrontFrame<D> {
    /// Unit tangent of the front, `ahead` × `normal`; zero in the plane.
    pub fn tangent(&self) -> Vector<D> {
        let (a, n) = (&self.ahead, &self.normal);
        let cross = |i: usize| a[(i + 1) % D] * n[(i + 2) % D] - a[(i + 2) % D] * n[(i + 1) % D];
        if D == 3 { Vector::from_fn(|i, _| cross(i)) } else { Vector::zeros() }
    }

    /// The arc of the front.
    #[inline]
    fn arc(&self) -> Arc<D> {
        if self.normal_curvature == 0.0 {
            return Arc { curvature: self.curvature, axis: self.ahead, binormal: self.normal, turn: [1.0, 0.0] };
        }
        let curvature = self.curvature.hypot(self.normal_curvature);
        let [c, s] = [self.curvature / curvature, self.normal_curvature / curvature];
        let (axis, binormal) = (self.ahead * c + self.normal * s, self.normal * c - self.ahead * s);
        Arc { curvature, axis, binormal, turn: [c, s] }
    }

    /// Distances from the front along the crack and normal to it [length]: `√(x1² + x2²)` is that from the arc.
    #[inline]
    pub fn plane(&self, at: Vector<D>) -> [f64; 2] {
        let d = at - self.position;
        let Arc { curvature, axis, binormal, turn: [c, s] } = self.arc();
        let (a, n) = (d.dot(&axis), d.dot(&binormal));
        if curvature == 0.0 {
            return [a, n];
        }
        let in_plane2 = (d.norm_squared() - n * n).max(0.0);
        let q = curvature * (2.0 * a + curvature * in_plane2);
        let x = (2.0 * a + curvature * in_plane2) / (1.0 + (1.0 + q).max(0.0).sqrt());
        [x * c - n * s, x * s + n * c]
    }

    /// The frame where the plane normal to the arc holds a point.
    fn slid_to(&self, at: Vector<D>) -> Self {
        let d = at - self.position;
        let Arc { curvature, axis, binormal, turn: [c, s] } = self.arc();
        let (a, n) = (d.dot(&axis), d.dot(&binormal));
        let along = d - axis * a - binormal * n;
        let reach = 1.0 + curvature * a;
        let stretch = reach.hypot(curvature * along.norm());
        if reach <= 0.0 {
            return *self;
        }
        let slid = (axis * reach + along * curvature) / stretch;
        let drop = curvature * along.norm_squared() / (stretch * (stretch + reach));
        let position = self.position + along / stretch - axis * drop;
        Self { position, ahead: slid * c - binormal * s, normal: slid * s + binormal * c, ..*self }
    }

    /// Distance and angle, this on the sheet nearest to a known angle `near`: 0 for places that are not on or behind a
    /// crack.
    #[inline]
    pub fn polar(&self, at: Vector<D>, near: f64) -> [f64; 2] {
        let [x, y] = self.plane(at);
        [(x * x + y * y).sqrt(), on_sheet(y.atan2(x), near)]
    }

    /// Values of the four functions [√length].
    ///
    /// - `near`: unit vector at half the known angle that [`Self::polar`] takes
    #[inline]
    pub fn values(&self, at: Vector<D>, near: [f64; 2]) -> [f64; MOST_FUNCTIONS] {
        let [x, y] = self.plane(at);
        let r = (x * x + y * y).sqrt();
        // √r cos θ/2 and √r sin θ/2, the larger one first, without the difference of r and x.
        let large = (0.5 * (r + x.abs())).sqrt();
        let small = if large > 0.0 { 0.5 * y / large } else { 0.0 };
        let [c, s] = if x >= 0.0 { [large, small] } else { [small.abs(), large.copysign(y)] };
        // On the sheet nearest to the known angle, half angles are less than a right angle apart.
        let sheet = if c * near[0] + s * near[1] < 0.0 { -1.0 } else { 1.0 };
        let (c, s) = (sheet * c, sheet * s);
        // sin θ = 2 sin θ/2 cos θ/2.
        let sine = if r > 0.0 { 2.0 * c * s / r } else { 0.0 };
        [c, s, s * sine, c * sine]
    }

    /// Values and derivatives of the four functions; the point must not lie on the front.
    pub fn jets(&self, at: Vector<D>, near: f64) -> [Jet<D>; MOST_FUNCTIONS] {
        let [r, theta] = self.polar(at, near);
        let (sin, cos) = theta.sin_cos();
        let d = at - self.position;
        let Arc { curvature, axis, binormal, turn: [c, s] } = self.arc();
        let (a, n) = (d.dot(&axis), d.dot(&binormal));
        let along = d - axis * a - binormal * n;
        let q = curvature * (2.0 * a + curvature * (a * a + along.norm_squared()));
        let stretch = (1.0 + q).max(f64::MIN_POSITIVE).sqrt();
        let outward = (axis * (1.0 + curvature * a) + along * curvature) / stretch;
        let (first, second) = (outward * c - binormal * s, outward * s + binormal * c);
        // The arc bends in its own plane only.
        let plane = Matrix::identity() - outward * outward.transpose() - binormal * binormal.transpose();
        let bend = plane * (curvature / stretch);
        let (radial, across) = (first * cos + second * sin, second * cos - first * sin);
        let (by_radius, by_angle) = (radial.dot(&outward), across.dot(&outward));
        TipFunctions::Full.angular(theta).map(|[g, g1, g2]| {
            let slope = (radial * (0.5 * g) + across * g1) / r.sqrt();
            let mixed = radial * across.transpose();
            let curved = radial * radial.transpose() * (-0.25 * g)
                + (mixed + mixed.transpose()) * (-0.5 * g1)
                + across * across.transpose() * (g2 + 0.5 * g);
            let outwards = (0.5 * g * by_radius + g1 * by_angle) / r.sqrt();
            Jet { value: r.sqrt() * g, gradient: slope, second_derivatives: curved / (r * r.sqrt()) + bend * outwards }
        })
    }
}

/// A crack front as a chain of points with their axes; a single point in the plane.
#[derive(Clone, Debug)]
pub struct FrontLine<const D: usize> {
    frames: Vec<FrontFrame<D>>,
    is_closed: bool,
    bounds: Aabb<D>,
}

/// Whether the last point of a chain is joined to the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrontEnds {
    /// Two ends.
    Open,
    /// None.
    Closed,
}

impl<const D: usize> FrontLine<D> {
    /// A front through the positions of `frames`; curvatures between them follow from their axes.
    pub fn new(frames: Vec<FrontFrame<D>>, ends: FrontEnds) -> Self {
        let bounds = Aabb::of_points(frames.iter().map(|f| f.position));
        Self { frames, is_closed: ends == FrontEnds::Closed, bounds }
    }

    /// The points.
    pub fn frames(&self) -> &[FrontFrame<D>] {
        &self.frames
    }

    /// The box around the points.
    pub fn bounds(&self) -> &Aabb<D> {
        &self.bounds
    }

    /// The frame at the place of the front that is nearest to a point; none for a front without points.
    pub fn nearest(&self, at: Vector<D>) -> Option<FrontFrame<D>> {
        let n = self.frames.len();
        if n < 2 {
            return self.frames.first().copied();
        }
        let last = if self.is_closed { n } else { n - 1 };
        let pairs = (0..last).map(|i| (&self.frames[i], &self.frames[(i + 1) % n]));
        let mut best: Option<(f64, FrontFrame<D>)> = None;
        for (a, b) in pairs {
            let e = b.position - a.position;
            // The chord's foot would jump where chords meet: the planes normal to the arc at both ends divide its length.
            let ahead_of = |f: &FrontFrame<D>| {
                (at - f.position).dot(&(e - f.ahead * e.dot(&f.ahead) - f.normal * e.dot(&f.normal)).normalize())
            };
            let (from, to) = (ahead_of(a), ahead_of(b));
            let t = if from > to { (from / (from - to)).clamp(0.0, 1.0) } else { 0.5 };
            let frame = between(a, b, t);
            let distance = (at - frame.position).norm_squared();
            if best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, if t > 0.0 && t < 1.0 { frame.slid_to(at) } else { frame }));
            }
        }
        best.map(|(_, frame)| frame)
    }
}

/// The frame at the fraction `t` of the way between two points of a front, on the arc through them.
fn between<const D: usize>(a: &FrontFrame<D>, b: &FrontFrame<D>, t: f64) -> FrontFrame<D> {
    let chord = b.position - a.position;
    let curvature = (b.ahead - a.ahead).dot(&chord) / chord.norm_squared();
    let normal = (a.normal * (1.0 - t) + b.normal * t).normalize();
    let mean = a.ahead * (1.0 - t) + b.ahead * t;
    let ahead = (mean - normal * mean.dot(&normal)).normalize();
    let normal_curvature = a.normal_curvature * (1.0 - t) + b.normal_curvature * t;
    let rise = 0.5 * chord.norm_squared() * t * (1.0 - t);
    let position = a.position + chord * t + (ahead * curvature + normal * normal_curvature) * rise;
    FrontFrame { position, ahead, normal, curvature, normal_curvature }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn frame(curvature: f64) -> FrontFrame<3> {
        let ahead = Vector::<3>::new(0.6, 0.8, 0.0);
        let normal = Vector::<3>::new(0.0, 0.0, 1.0);
        FrontFrame { position: Vector::<3>::new(0.1, -0.2, 0.3), ahead, normal, curvature, normal_curvature: 0.0 }
    }

    #[test]
    fn distances_are_those_from_a_circle() {
        for curvature in [0.5, -0.4] {
            let f = frame(curvature);
            let center = f.position - f.ahead / curvature;
            for at in [Vector::<3>::new(0.5, 0.1, 0.7), Vector::<3>::new(-0.3, 0.4, 0.1)] {
                let radius = (at - center - f.normal * (at - center).dot(&f.normal)).norm();
                let expected = (radius - 1.0 / curvature.abs()) * curvature.signum();
                assert!((f.plane(at)[0] - expected).abs() < 1e-14);
            }
        }
    }

    /// The front of a spherical cap: distance and angle in the planes through its axis are the same all around.
    #[test]
    fn the_front_of_a_cap_is_a_circle() {
        let (radius, dip) = (2.0f64, 0.5f64);
        let at = |angle: f64, r: f64, z: f64| Vector::<3>::new(r * angle.cos(), r * angle.sin(), z);
        let (ahead, normal) = (at(0.0, dip.cos(), -dip.sin()), at(0.0, dip.sin(), dip.cos()));
        let (curvature, normal_curvature) = (dip.cos() / radius, dip.sin() / radius);
        let f = FrontFrame { position: at(0.0, radius, 0.0), ahead, normal, curvature, normal_curvature };
        for angle in [0.0, 0.1, -0.4] {
            for (r, z) in [(2.2, 0.3), (1.7, -0.2)] {
                let [x, y] = f.plane(at(angle, r, z));
                let d = at(0.0, r - radius, z);
                assert!((x - d.dot(&ahead)).abs() < 1e-14 && (y - d.dot(&normal)).abs() < 1e-14, "{x} {y}");
                let slid = f.slid_to(at(angle, r, z));
                assert!((slid.position - at(angle, radius, 0.0)).norm() < 1e-14);
                assert!((slid.ahead - at(angle, dip.cos(), -dip.sin())).norm() < 1e-14);
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_finite_differences() {
        for (curvature, normal_curvature) in [(0.0, 0.0), (0.5, 0.0), (-0.4, 0.0), (0.5, 0.3), (-0.4, 0.6), (0.0, -0.5)]
        {
            let f = FrontFrame { normal_curvature, ..frame(curvature) };
            for at in
                [Vector::<3>::new(0.5, 0.1, 0.7), Vector::<3>::new(-0.3, 0.4, 0.1), Vector::<3>::new(0.3, -0.5, 0.2)]
            {
                let jets = f.jets(at, 0.0);
                for d in 0..3 {
                    let step = Vector::<3>::ith(d, 1e-6);
                    let (ahead, behind) = (f.jets(at + step, 0.0), f.jets(at - step, 0.0));
                    for k in 0..MOST_FUNCTIONS {
                        assert!((jets[k].value - f.values(at, [1.0, 0.0])[k]).abs() < 1e-15);
                        let slope = (ahead[k].value - behind[k].value) / 2e-6;
                        assert!((slope - jets[k].gradient[d]).abs() < 1e-8, "{k} {d}: {slope} {:?}", jets[k]);
                        let bend = (ahead[k].gradient - behind[k].gradient) / 2e-6;
                        assert!((bend - jets[k].second_derivatives.column(d)).norm() < 1e-7, "{k} {d} {bend}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_chain_of_points_gives_the_circle_back() {
        let frames = (0..24)
            .map(|k| {
                let (s, c) = (TAU * k as f64 / 24.0).sin_cos();
                let ahead = Vector::<3>::new(c, s, 0.0);
                FrontFrame {
                    position: ahead * 2.0,
                    ahead,
                    normal: Vector::<3>::z(),
                    curvature: 0.0,
                    normal_curvature: 0.0,
                }
            })
            .collect();
        let front = FrontLine::new(frames, FrontEnds::Closed);
        for angle in [0.0f64, 0.06, 0.13, 6.2] {
            let near = front.nearest(Vector::<3>::new(angle.cos() * 1.8, angle.sin() * 1.8, 0.2)).unwrap();
            let expected = Vector::<3>::new(angle.cos(), angle.sin(), 0.0);
            // The sagitta of a chord is 2 (1 - cos 7.5°) = 0.017: what is left of it is of higher order.
            assert!(
                (near.position - expected * 2.0).norm() < 2e-4 && (near.ahead - expected).norm() < 2e-4,
                "{near:?}"
            );
            assert!((near.curvature - 0.5).abs() < 1e-12);
        }
    }
}
