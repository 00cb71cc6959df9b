//! Stress intensity factors, T-stress and J at points of a crack front, in the plane and in space.
//!
//! Over the disc normal to the front, with `P_1j = W δ_1j - σ_kj u_k,1` in the frame of the front point and `q` falling
//! from one to zero [Moran1987],
//! `J = -∫ P_1α q,α dA + ∫ (P_13,3 - b_k u_k,1) q dA - ∫_faces t_k u_k,1 q ds`, α = 1, 2.
//! The second term holds what changes along the front; its derivatives are those of the fit. The auxiliary fields are
//! those of a straight front, which are exact in the disc, so that no term for the curvature of the front is missing.
//! Where the crack is bent the disc is cut along it: the auxiliary fields are continued up to the crack [`DiscCut`], and
//! since they leave tractions there, the faces add `∫ P_1α n_α q ds`.
//! The one for T is that of a unit force per length of the front, along `ahead` [Nakamura1992].

use super::disc_cut::DiscCut;
use crate::approximation::{FitBuffer, FrontFrame, ShapeFunctions};
use crate::error::Result;
use crate::exact::crack_tip_field::{TipMode, tip_field};
use crate::exact::out_of_plane_gradient;
use crate::material::Elasticity;
use crate::math::gauss_legendre::gauss_legendre;
use crate::math::{Matrix, Vector, axis};
use crate::model::{SurfacePoint, VectorField};
use crate::system::Collocation;
use rayon::prelude::*;
use std::f64::consts::TAU;

/// `q` is one up to this share of the radius and falls linearly from there.
const PLATEAU: f64 = 0.5;
/// Gauss points along the radius in the plateau and in the slope, and around each half of the disc.
const RADIAL: usize = 8;
const ANGULAR: usize = 20;
/// Gauss points along each face, where `q` is one and where it falls.
const FACE: usize = 10;
/// Points on faces look from this far off, over the radius.
const OFF: f64 = 1e-6;
/// The strain along the front is taken this far ahead of it, over the radius: what changes with √r there no longer counts.
const BESIDE: f64 = 1e-5;

/// Fracture quantities at a point of a front from one disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontIntegrals {
    /// Radius of the disc [length].
    pub radius: f64,
    /// Factors of modes I, II and III [stress·√length]; the last is zero in the plane.
    pub factors: [f64; 3],
    /// Stress along `ahead` that does not fade at the front [stress].
    pub t_stress: f64,
    /// J-integral [stress·length].
    pub j: f64,
}

/// Fracture quantities at a point of a front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrontFactors {
    /// Factors of modes I, II and III, mean of all discs [stress·√length].
    pub factors: [f64; 3],
    /// Largest deviation of a disc from the mean, over all modes [stress·√length].
    pub uncertainty: f64,
    /// Stress along `ahead` that does not fade at the front, mean of all discs [stress].
    pub t_stress: f64,
    /// Largest deviation of the T-stress of a disc from the mean [stress].
    pub t_uncertainty: f64,
    /// J-integral, mean of all discs [stress·length].
    pub j: f64,
    /// Largest deviation of J of a disc from the mean [stress·length].
    pub j_uncertainty: f64,
}

impl FrontFactors {
    /// Joins the results of some discs.
    pub fn of(discs: &[FrontIntegrals]) -> Self {
        let n = discs.len() as f64;
        let factors = std::array::from_fn(|m| discs.iter().map(|d| d.factors[m]).sum::<f64>() / n);
        let off = |d: &FrontIntegrals| (0..3).map(|m| (d.factors[m] - factors[m]).abs()).fold(0.0, f64::max);
        let t_stress = discs.iter().map(|d| d.t_stress).sum::<f64>() / n;
        let j = discs.iter().map(|d| d.j).sum::<f64>() / n;
        Self {
            factors,
            uncertainty: discs.iter().map(off).fold(0.0, f64::max),
            t_stress,
            t_uncertainty: discs.iter().map(|d| (d.t_stress - t_stress).abs()).fold(0.0, f64::max),
            j,
            j_uncertainty: discs.iter().map(|d| (d.j - j).abs()).fold(0.0, f64::max),
        }
    }
}

/// Evaluates discs of the given radii at a point of the front of a crack.
///
/// The discs must lie inside the body with nothing but the crack in them. The tangent that belongs to mode III is `ahead` × `normal`.
///
/// `T = E' (I + ν ε_33) + σ_22` with the interaction `I` with the unit force, the strain along the front and the stress
/// that tractions on the faces leave across the crack [Nakamura1992].
///
/// # Errors
/// Those of the shape functions.
pub fn front_integrals<const D: usize>(
    collocation: &Collocation<D>,
    displacements: &[Vector<D>],
    cut: &DiscCut<'_, D>,
    crack: usize,
    radii: &[f64],
) -> Result<Vec<FrontIntegrals>> {
    let disc = Disc { collocation, displacements, cut, axes: axes(cut.frame), crack };
    radii.iter().map(|&radius| disc.integrate(radius)).collect()
}

/// Axes of a front point as columns.
fn axes<const D: usize>(frame: &FrontFrame<D>) -> Matrix<D> {
    let columns = [frame.ahead, frame.normal, frame.tangent()];
    Matrix::from_fn(|i, j| columns[j][i])
}

/// Interactions with modes I to III and with the unit force, and the solution with itself.
type Integrals = [f64; 5];

/// Fields that the solution interacts with.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Auxiliary {
    Opening,
    Sliding,
    Tearing,
    /// Unit force per length on the front, along `ahead`.
    Force,
}

impl Auxiliary {
    /// Those that there are in `D` dimensions, each with its place in [`Integrals`].
    fn all<const D: usize>() -> impl Iterator<Item = (usize, Self)> {
        let all = [Self::Opening, Self::Sliding, Self::Tearing, Self::Force];
        all.into_iter().enumerate().filter(|(_, mode)| D == 3 || *mode != Self::Tearing)
    }

    /// Displacement gradient at a straight front.
    fn gradient<const D: usize>(self, material: &Elasticity, r: f64, theta: f64) -> Matrix<D> {
        let in_plane = |mode| {
            let (_, gradient) = tip_field(mode, material, r, theta);
            Matrix::from_fn(|i, j| if i < 2 && j < 2 { gradient[(i, j)] } else { 0.0 })
        };
        match self {
            Self::Opening => in_plane(TipMode::Opening),
            Self::Sliding => in_plane(TipMode::Sliding),
            Self::Force => in_plane(TipMode::PointForce),
            Self::Tearing => axis::<D>(D - 1) * out_of_plane_gradient::<D>(material, r, theta).transpose(),
        }
    }
}

struct Disc<'a, const D: usize> {
    collocation: &'a Collocation<D>,
    displacements: &'a [Vector<D>],
    cut: &'a DiscCut<'a, D>,
    axes: Matrix<D>,
    crack: usize,
}

/// A point of a rule.
struct DiscPoint {
    r: f64,
    theta: f64,
    weight: f64,
}

/// The solution at a point, in the frame of the front.
struct State<const D: usize> {
    gradient: Matrix<D>,
    stress: Matrix<D>,
    /// Derivatives of both along the front.
    gradient_along: Matrix<D>,
    stress_along: Matrix<D>,
}

impl<const D: usize> Disc<'_, D> {
    fn integrate(&self, radius: f64) -> Result<FrontIntegrals> {
        let solid = &self.collocation.solid;
        let mut points = self.around(slope_rule(PLATEAU * radius, radius));
        if D == 3 || !is_zero(&solid.body_force) {
            points.extend(self.around(plateau_rule(PLATEAU * radius)));
        }
        let values: Vec<Integrals> = points
            .par_iter()
            .map_init(Default::default, |buffer, p| self.area_term(p, radius, buffer))
            .collect::<Result<_>>()?;
        let mut sum = Integrals::default();
        // In order, so that any number of threads gives the same bits.
        values.iter().for_each(|v| (0..5).for_each(|i| sum[i] += v[i]));
        if self.cut.sides.is_some() || !solid.faces.get(self.crack).is_none_or(is_zero) {
            let faces = self.face_terms(radius)?;
            (0..5).for_each(|i| sum[i] += faces[i]);
        }
        let material = &solid.material;
        let young = material.effective_young();
        let factors = [0.5 * young * sum[0], 0.5 * young * sum[1], material.shear() * sum[2]];
        let along = if D == 3 { material.poisson * self.strain_along(radius)? } else { 0.0 };
        let t_stress = young * (sum[3] + along) + self.stress_across();
        Ok(FrontIntegrals { radius, factors, t_stress, j: sum[4] })
    }

    /// Strain along the front, just ahead of it.
    fn strain_along(&self, radius: f64) -> Result<f64> {
        let at = self.cut.place(BESIDE * radius, 0.0);
        Ok(self.state(at, at, &mut Default::default())?.gradient[(D - 1, D - 1)])
    }

    /// Stress across the crack at the front, which is that of the tractions on its faces.
    fn stress_across(&self) -> f64 {
        let (position, normal) = (self.cut.frame.position, -self.cut.frame.normal);
        let at = SurfacePoint { position, normal, sight: position };
        self.collocation.solid.faces.get(self.crack).map_or(0.0, |f| f.value(&at).dot(&normal))
    }

    fn state(&self, at: Vector<D>, sight: Vector<D>, buffer: &mut Buffer<D>) -> Result<State<D>> {
        let (fit, shape) = buffer;
        self.collocation.approximation.at_point(at, sight, fit, shape)?;
        let (mut gradient, mut along) = (Matrix::<D>::zeros(), Matrix::<D>::zeros());
        let e3: Vector<D> = self.axes.column(D - 1).into_owned();
        for (k, &i) in shape.neighbors.iter().enumerate() {
            let u = self.displacements[i as usize];
            gradient += u * shape.gradients[k].transpose();
            if D == 3 {
                along += u * (shape.second_derivatives[k] * e3).transpose();
            }
        }
        let turn = |g: Matrix<D>| self.axes.transpose() * g * self.axes;
        let (gradient, gradient_along) = (turn(gradient), turn(along));
        let material = &self.collocation.solid.material;
        Ok(State {
            gradient,
            stress: stress(material, &gradient),
            gradient_along,
            stress_along: stress(material, &gradient_along),
        })
    }

    fn area_term(&self, p: &DiscPoint, radius: f64, buffer: &mut Buffer<D>) -> Result<Integrals> {
        let at = self.cut.place(p.r, p.theta);
        let state = self.state(at, at, buffer)?;
        let is_slope = p.r > PLATEAU * radius;
        let q = if is_slope { (radius - p.r) / ((1.0 - PLATEAU) * radius) } else { 1.0 };
        let slope = if is_slope { -1.0 / ((1.0 - PLATEAU) * radius) } else { 0.0 };
        let radial = Vector::<D>::from_fn(|d, _| [p.theta.cos(), p.theta.sin(), 0.0][d]);
        let solid = &self.collocation.solid;
        let force = self.axes.transpose() * solid.body_force.value(&SurfacePoint::inside(at));
        let rest = |gradient: &Matrix<D>| gradient.column(0).dot(&force);
        let energy = 0.5 * state.stress.dot(&state.gradient);
        let mut found = Integrals::default();
        found[4] = -(energy * radial[0] - flux(&state.stress, &state.gradient, &radial)) * slope;
        found[4] += q * (along(&state, &state.stress, &state.gradient) - rest(&state.gradient));
        for (mode, field) in Auxiliary::all::<D>() {
            let gradient = field.gradient(&solid.material, p.r, p.theta);
            let stress = stress(&solid.material, &gradient);
            let mixed = flux(&state.stress, &gradient, &radial) + flux(&stress, &state.gradient, &radial);
            found[mode] = -(state.stress.dot(&gradient) * radial[0] - mixed) * slope;
            found[mode] += q * (along(&state, &stress, &gradient) - rest(&gradient));
        }
        Ok(found.map(|v| v * p.weight))
    }

    /// What the faces add: tractions, and where the crack is bent what the fields leave there.
    fn face_terms(&self, radius: f64) -> Result<Integrals> {
        let mut buffer = Default::default();
        let mut sum = Integrals::default();
        let solid = &self.collocation.solid;
        let is_bent = self.cut.sides.is_some();
        let turn = |v: Vector<D>| self.axes.transpose() * v;
        for side in [1.0, -1.0] {
            for (r, weight) in face_points(radius) {
                let q = ((radius - r) / ((1.0 - PLATEAU) * radius)).min(1.0);
                let (position, across) = self.cut.face(r);
                let normal = across * -side;
                let length = normal.norm();
                let normal = normal / length;
                let sight = position - normal * (OFF * radius);
                let traction = solid
                    .faces
                    .get(self.crack)
                    .map_or(Vector::zeros(), |f| turn(f.value(&SurfacePoint { position, normal, sight })));
                let (normal, share) = (turn(normal), weight * length * q);
                let state = self.state(position, sight, &mut buffer)?;
                let energy = 0.5 * state.stress.dot(&state.gradient);
                sum[4] += (energy * normal[0] - traction.dot(&state.gradient.column(0))) * share;
                let theta = self.cut.angle(r) - if side > 0.0 { 0.0 } else { TAU };
                for (mode, field) in Auxiliary::all::<D>() {
                    let gradient = field.gradient::<D>(&solid.material, r, theta);
                    sum[mode] -= traction.dot(&gradient.column(0)) * share;
                    if is_bent {
                        let stress = stress(&solid.material, &gradient);
                        let left = flux(&stress, &state.gradient, &normal);
                        sum[mode] += (state.stress.dot(&gradient) * normal[0] - left) * share;
                    }
                }
            }
        }
        Ok(sum)
    }

    /// Points at radii with their weights, in both halves of the disc.
    fn around(&self, radii: impl Iterator<Item = (f64, f64)>) -> Vec<DiscPoint> {
        let mut points = vec![];
        for (r, weight) in radii {
            let above = self.cut.angle(r);
            for (y, wy) in gauss_legendre(ANGULAR) {
                for (from, range) in [(0.0, above), (above - TAU, TAU - above)] {
                    points.push(DiscPoint { r, theta: from + range * y, weight: weight * wy * range * r });
                }
            }
        }
        points
    }
}

type Buffer<const D: usize> = (FitBuffer<D>, ShapeFunctions<D>);

/// `σ_kα u_k,1` in the direction `radial`, of the stress of one field and the gradient of another.
fn flux<const D: usize>(stress: &Matrix<D>, gradient: &Matrix<D>, radial: &Vector<D>) -> f64 {
    (stress * radial).dot(&gradient.column(0))
}

/// Derivative along the front of `P_13`, mixed of the solution and a field; all of it if the field is the solution.
///
/// `-σ_k3,3 u_k,1 - σ_k3 u_k,13` with the last factor of each term taken from where it changes along the front.
fn along<const D: usize>(state: &State<D>, stress: &Matrix<D>, gradient: &Matrix<D>) -> f64 {
    if D < 3 {
        return 0.0;
    }
    -state.stress_along.column(D - 1).dot(&gradient.column(0))
        - stress.column(D - 1).dot(&state.gradient_along.column(0))
}

fn stress<const D: usize>(material: &Elasticity, gradient: &Matrix<D>) -> Matrix<D> {
    (gradient + gradient.transpose()) * material.shear()
        + Matrix::from_diagonal_element(material.lame() * gradient.trace())
}

fn is_zero<const D: usize>(field: &VectorField<D>) -> bool {
    match field {
        VectorField::Constant(v) => v.norm() == 0.0,
        VectorField::Function(_) => false,
    }
}

/// Gauss points where `q` falls, between two radii.
fn slope_rule(from: f64, to: f64) -> impl Iterator<Item = (f64, f64)> {
    gauss_legendre(RADIAL).into_iter().map(move |(x, w)| (from + x * (to - from), w * (to - from)))
}

/// Gauss points where `q` is one, up to a radius; `r = s²` takes roots out of the integrands.
fn plateau_rule(to: f64) -> impl Iterator<Item = (f64, f64)> {
    gauss_legendre(RADIAL).into_iter().map(move |(x, w)| (to * x * x, 2.0 * to * x * w))
}

/// Gauss points along a face up to a radius.
fn face_points(radius: f64) -> impl Iterator<Item = (f64, f64)> {
    let ends = [0.0, (PLATEAU * radius).sqrt(), radius.sqrt()];
    [0, 1].into_iter().flat_map(move |part| {
        let (from, length) = (ends[part], ends[part + 1] - ends[part]);
        gauss_legendre(FACE).into_iter().map(move |(x, weight)| {
            // r = s² takes the root out of the auxiliary fields.
            let s = from + x * length;
            (s * s, 2.0 * weight * s * length)
        })
    })
}
