//! Boxes with jittered nodes, whole or with a crack from one face to the middle.

use riss::approximation::{FitBuffer, ShapeFunctions};
use riss::geometry::obstacles::Opaque;
use riss::math::{Matrix, Vector, axis};
use riss::model::SurfacePoint;
use riss::nodes::cloud::{Cloud, Facet, Place, Side, SurfaceId};
use riss::system::Collocation;

/// A box from `lower` to `upper`; part `2 d` is its face at the lower end of axis `d`, part `2 d + 1` at the upper.
pub struct Box<const D: usize> {
    pub lower: Vector<D>,
    pub upper: Vector<D>,
    /// Steps between nodes along the axes.
    pub steps: [usize; D],
    /// How far nodes are moved at most, over the spacing.
    pub jitter: f64,
    pub crack: Crack,
    pub seed: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crack {
    None,
    /// `x_0 < 0` in the plane `x_(D-1) = 0`, on which a layer of nodes must lie.
    HalfPlane,
}

/// Nothing hides anything.
pub struct Clear;

impl<const D: usize> Opaque<D> for Clear {
    fn visible(&self, _: Vector<D>, _: Vector<D>) -> bool {
        true
    }
}

/// The crack of [`Crack::HalfPlane`].
pub struct HalfPlane;

impl<const D: usize> Opaque<D> for HalfPlane {
    fn visible(&self, a: Vector<D>, b: Vector<D>) -> bool {
        let (s, t) = (a[D - 1], b[D - 1]);
        s * t >= 0.0 || (a[0] * t - b[0] * s) / (t - s) > 0.0
    }
}

pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(0x9E37_79B9_7F4A_7C15 ^ seed.wrapping_mul(0x2545_F491_4F6C_DD1D))
    }

    /// Between -1 and 1.
    pub fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

impl<const D: usize> Box<D> {
    /// The box from -1 to 1 with `n` steps along each axis.
    pub fn cube(n: usize) -> Self {
        let one = Vector::repeat(1.0);
        Self { lower: -one, upper: one, steps: [n; D], jitter: 0.2, crack: Crack::None, seed: 7 }
    }

    pub fn spacing(&self) -> Vector<D> {
        Vector::from_fn(|d, _| (self.upper[d] - self.lower[d]) / self.steps[d] as f64)
    }

    pub fn cloud(&self) -> Cloud<D> {
        let (h, mut random, mut cloud) = (self.spacing(), Random::new(self.seed), Cloud::default());
        let n: usize = self.steps.iter().map(|s| s + 1).product();
        for k in 0..n {
            let mut rest = k;
            let index: [usize; D] = std::array::from_fn(|d| {
                let i = rest % (self.steps[d] + 1);
                rest /= self.steps[d] + 1;
                i
            });
            let mut p = Vector::<D>::from_fn(|d, _| self.lower[d] + h[d] * index[d] as f64);
            let mut parts = vec![];
            for d in 0..D {
                let shift = self.jitter * h[d] * random.next();
                if index[d] == 0 {
                    parts.push((SurfaceId::Part(2 * d as u32), -axis::<D>(d)));
                } else if index[d] == self.steps[d] {
                    p[d] = self.upper[d];
                    parts.push((SurfaceId::Part(2 * d as u32 + 1), axis::<D>(d)));
                } else {
                    p[d] += shift;
                }
            }
            let on_plane =
                self.crack == Crack::HalfPlane && (h[D - 1] * index[D - 1] as f64 + self.lower[D - 1]).abs() < 1e-9;
            let x = self.lower[0] + h[0] * index[0] as f64;
            if !on_plane || x > 1e-9 {
                push(&mut cloud, p, h.max(), parts, None);
                continue;
            }
            p[D - 1] = 0.0;
            let face = |side, sign: f64| (SurfaceId::Face { crack: 0, side }, -axis::<D>(D - 1) * sign);
            if x.abs() < 1e-9 {
                p[0] = 0.0;
                parts.extend([face(Side::Positive, 1.0), face(Side::Negative, -1.0)]);
                push(&mut cloud, p, h.max(), parts, Some(0));
                continue;
            }
            for (side, sign) in [(Side::Positive, 1.0), (Side::Negative, -1.0)] {
                let mut parts = parts.clone();
                parts.push(face(side, sign));
                push(&mut cloud, p, h.max(), parts, None);
            }
        }
        cloud
    }
}

pub fn push<const D: usize>(
    cloud: &mut Cloud<D>,
    p: Vector<D>,
    spacing: f64,
    surfaces: Vec<(SurfaceId, Vector<D>)>,
    front: Option<u32>,
) {
    let small = 1e-4 * spacing;
    let sum = surfaces.iter().fold(Vector::<D>::zeros(), |s, f| s + f.1);
    let facets: Vec<Facet<D>> = surfaces
        .iter()
        .map(|(surface, normal)| Facet {
            surface: *surface,
            normal: *normal,
            // On a front the two faces look from their own sides.
            sight: p - if front.is_some() { *normal } else { sum } * small,
            angle: 1.0,
        })
        .collect();
    let place = match (front, facets.is_empty()) {
        (Some(crack), _) => Place::Front { crack, facets },
        (None, true) => Place::Inside,
        (None, false) => Place::Surface(facets),
    };
    cloud.push(p, p - sum * small, spacing, place);
}

/// Largest error of displacements over the largest exact one.
pub fn displacement_error<const D: usize>(
    collocation: &Collocation<D>,
    found: &[Vector<D>],
    exact: impl Fn(&SurfacePoint<D>) -> Vector<D>,
) -> f64 {
    let cloud = collocation.cloud();
    let (mut error, mut scale) = (0.0f64, 0.0f64);
    for (i, u) in found.iter().enumerate() {
        let (position, sight) = (cloud.positions[i], cloud.sights[i]);
        let expected = exact(&SurfacePoint { position, normal: Vector::zeros(), sight });
        error = error.max((u - expected).norm());
        scale = scale.max(expected.norm());
    }
    error / scale
}

/// Stress of a solution at a point inside the body.
pub fn stress<const D: usize>(collocation: &Collocation<D>, found: &[Vector<D>], at: Vector<D>) -> Matrix<D> {
    let (mut buffer, mut shape) = (FitBuffer::default(), ShapeFunctions::default());
    collocation.approximation.at_point(at, at, &mut buffer, &mut shape).unwrap();
    let mut gradient = Matrix::<D>::zeros();
    shape.neighbors.iter().zip(&shape.gradients).for_each(|(i, g)| gradient += found[*i as usize] * g.transpose());
    let material = &collocation.solid.material;
    (gradient + gradient.transpose()) * material.shear()
        + Matrix::from_diagonal_element(material.lame() * gradient.trace())
}
