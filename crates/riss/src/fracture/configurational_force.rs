//! The configurational force on a crack tip [CPM, section 3].
//!
//! With the Eshelby stress `Σ = W δ - Hᵀ σ`, `H_ij = ∂u_i/∂x_j`, the force is `g = ∫ Σ n ds` around the tip, `n` away
//! from it, over any outline, or `-∫ Σ ∇q dA` over any domain. On both, what the crack faces inside hold comes in
//! addition: `∫ W m ds`, `m` out of the body. It is the jump of the energy across the crack, zero for a pure
//! field of `K_I` and `K_II`, and as `K_II T / √r` with a T-stress [CPM, Eq. 13].
//!
//! Differs from [CPM, Eqs. 8, 12, 18]: their signs do not agree. Here `g_1 = J > 0`, and the crack grows along `+g`.
//! Differs from [CPM, Eq. 22]: q is one in the middle of a domain, so that the nodes at the tip count least.

use super::interaction_integral::{FacePressure, ForceAt, GradientField, TipLoads, integrands};
use super::settings::{FaceTerm, FractureSettings, JIntegral, TipDomainShape};
use super::tip_domain::{PLATEAU, TipView, rim};
use crate::error::Result;
use crate::material::Elasticity;
use crate::math::gauss_legendre::gauss_legendre;
use crate::math::{Matrix2, Vector2, turn_left};
use crate::nodes::triangulation::SIGHT_SHIFT;

/// Points on each piece of the crack faces.
const FACE_POINTS: usize = 24;
/// Part of the radius in which the energy on the faces is extrapolated.
const TIP_SHARE: f64 = 1.0 / 9.0;

/// The configurational force from one domain or outline, in the tip frame: ahead, and to the left.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConfigurationalForce {
    /// Radius of the domain [length].
    pub radius: f64,
    /// What the domain or its outline holds, body forces and pressure on the faces included [stress·length].
    pub around: Vector2,
    /// What the crack faces hold [stress·length].
    pub faces: Vector2,
}

impl ConfigurationalForce {
    /// The force, with or without what the faces hold [stress·length].
    pub fn value(&self, term: FaceTerm) -> Vector2 {
        match term {
            FaceTerm::Included => self.around + self.faces,
            FaceTerm::LeftOut => self.around,
        }
    }
}

/// The force that follows from stress intensity factors, `(α (K_I² + K_II²), -2 α K_I K_II)`, `α = 1/E'`, in the tip
/// frame [CPM, Eq. 21] [stress·length].
pub fn force_of_factors(k1: f64, k2: f64, material: &Elasticity) -> Vector2 {
    Vector2::new(k1 * k1 + k2 * k2, -2.0 * k1 * k2) / material.effective_young()
}

/// Evaluates every domain of a tip, smallest first, as the settings say: over domains or along their outlines.
///
/// - `loads`: what acts inside the body and on the crack faces, if anything
///
/// # Errors
/// Those of the field.
pub fn configurational_forces<F: GradientField>(
    view: &TipView,
    radii: &[f64],
    settings: &FractureSettings,
    material: &Elasticity,
    loads: &TipLoads,
    field: &F,
) -> Result<Vec<ConfigurationalForce>> {
    let shape = settings.domain;
    let one = |&radius: &f64| {
        let (mut around, plateau) = match settings.j_integral {
            JIntegral::Domain => (over_domain(view, shape, radius, material, field)?, PLATEAU),
            JIntegral::Contour => (along_outline(view, shape, radius, material, field)?, 1.0),
        };
        if let Some(force) = loads.body_force {
            around -= work_of_body_force(view, (shape, radius, plateau), force, field)?;
        }
        if let Some(pressure) = &loads.face_pressure {
            around += work_of_pressure(view, (shape, radius, plateau), pressure, field)?;
        }
        let faces = over_faces(view, (shape, radius, plateau), material, field)?;
        let local = |v: Vector2| Vector2::new(v.dot(&view.frame.x1()), v.dot(&view.frame.x2()));
        Ok(ConfigurationalForce { radius, around: local(around), faces: local(faces) })
    };
    radii.iter().map(one).collect()
}

/// `Σ v` of a displacement gradient, global axes.
fn eshelby(material: &Elasticity, gradient: &Matrix2, v: Vector2) -> Vector2 {
    let stress = material.stress(gradient);
    v * (0.5 * stress.dot(gradient)) - gradient.transpose() * (stress * v)
}

/// `-∫ Σ ∇q dA`.
fn over_domain<F: GradientField>(
    view: &TipView,
    shape: TipDomainShape,
    radius: f64,
    material: &Elasticity,
    field: &F,
) -> Result<Vector2> {
    let points = view.domain(shape, radius).area;
    sum(field, &points, |p| (p.position, p.sight), |p, gradient| -eshelby(material, gradient, p.q) * p.weight)
}

/// `∫ Σ n ds`.
fn along_outline<F: GradientField>(
    view: &TipView,
    shape: TipDomainShape,
    radius: f64,
    material: &Elasticity,
    field: &F,
) -> Result<Vector2> {
    let points = view.contour(shape, radius);
    sum(field, &points, |p| (p.position, p.sight), |p, gradient| eshelby(material, gradient, p.normal) * p.weight)
}

/// `∫ q Hᵀ b dA`: the divergence of the Eshelby stress where a body force acts.
fn work_of_body_force<F: GradientField>(
    view: &TipView,
    (shape, radius, plateau): (TipDomainShape, f64, f64),
    force: ForceAt,
    field: &F,
) -> Result<Vector2> {
    let points = view.interior(shape, radius, plateau);
    sum(
        field,
        &points,
        |p| (p.position, p.sight),
        |p, gradient| gradient.transpose() * force(p.position) * (p.weight * p.q.x),
    )
}

/// `-∫ q Hᵀ t ds` over both faces, where a pressure is the traction `-p m` [CPM, Eqs. 10, 13]. The integral of the opening's
/// derivative begins with its jump at the tip.
fn work_of_pressure<F: GradientField>(
    view: &TipView,
    (shape, radius, plateau): (TipDomainShape, f64, f64),
    pressure: &FacePressure,
    field: &F,
) -> Result<Vector2> {
    let points = view.faces(shape, radius, plateau, 0);
    let along = sum(
        field,
        &points,
        |p| (p.position, p.sight),
        |p, gradient| gradient.transpose() * p.normal * ((pressure.at)(p.position) * p.weight * p.q.x),
    )?;
    Ok(along + view.frame.x1() * ((pressure.at)(view.frame.position) * pressure.tip_opening))
}

/// `∫ q W m ds` over both faces; q is one all the way for an outline, whose `plateau` is one.
fn over_faces<F: GradientField>(
    view: &TipView,
    (shape, radius, plateau): (TipDomainShape, f64, f64),
    material: &Elasticity,
    field: &F,
) -> Result<Vector2> {
    let points = face_points(view, shape, radius, plateau);
    let half_modulus = 0.5 * material.effective_young();
    sum(
        field,
        &points,
        |p| (p.position, p.sight),
        |p, gradient| {
            // A free face is stretched along itself only: W = E' ε² / 2. What the solution has of traction is its error. A
            // pressure adds the same on both faces.
            let along = turn_left(p.normal);
            let stretch = along.dot(&(gradient * along));
            p.normal * (half_modulus * stretch * stretch * p.weight)
        },
    )
}

/// A point on a crack face, its weight times q.
struct FacePoint {
    position: Vector2,
    sight: Vector2,
    normal: Vector2,
    weight: f64,
}

/// Points on both faces from the tip to where the crack leaves the domain.
///
/// What the solution has of stress along the faces at the tip is noise of the size of the force itself on any nodes. The jump
/// of the energy is `f(√r)/√r` with a smooth f: the line that fits f from r_0 to 4 r_0 stands for it within r_0.
fn face_points(view: &TipView, shape: TipDomainShape, radius: f64, plateau: f64) -> Vec<FacePoint> {
    let level = |p: Vector2| {
        let local = view.frame.local(p);
        local.norm() / (rim(shape, local.y.atan2(local.x)) * radius)
    };
    let rule = gauss_legendre(FACE_POINTS);
    let mut points = vec![];
    for (k, w) in view.path.windows(2).enumerate() {
        let e = w[1] - w[0];
        // r_0 as a part of the first segment.
        let hidden = if k == 0 { (TIP_SHARE * radius / e.norm()).min(0.25) } else { 0.0 };
        let mut stops = vec![hidden];
        for limit in [plateau, 1.0] {
            if level(w[0]) < limit && level(w[1]) > limit {
                stops.push(crossing(|t| level(w[0] + e * t) - limit));
            }
        }
        if level(w[1]) < 1.0 {
            stops.push(1.0);
        }
        for &(u, wu) in rule.iter().filter(|_| k == 0) {
            // With s = √r and u = s/s_0 - 1: 2 ∫ (f_0 + f_1 (2u - 1)) ds over u from -1 to 0, f_0 and f_1 from 0 to 1.
            let share = hidden * (1.0 + u).powi(2);
            let functional = 2.0 * (1.0 - 6.0 * (2.0 * u - 1.0));
            let weight = wu * functional * (hidden * share).sqrt() * e.norm();
            add_both(&mut points, w, share, weight);
        }
        for (from, to) in stops.windows(2).map(|s| (s[0], s[1])).filter(|(from, to)| from < to) {
            for &(s, ws) in &rule {
                let share = from + (to - from) * s;
                let at = level(w[0] + e * share);
                let q = if at <= plateau { 1.0 } else { (1.0 - at) / (1.0 - plateau) };
                add_both(&mut points, w, share, q * ws * (to - from) * e.norm());
            }
        }
        if level(w[1]) >= 1.0 {
            break;
        }
    }
    points
}

/// Adds the points on both faces at a share of a segment.
fn add_both(points: &mut Vec<FacePoint>, segment: &[Vector2], share: f64, weight: f64) {
    let e = segment[1] - segment[0];
    let left = turn_left(e.normalize());
    let position = segment[0] + e * share;
    let shift = SIGHT_SHIFT * e.norm() * share.min(1.0 - share);
    for normal in [left, -left] {
        points.push(FacePoint { position, sight: position - normal * shift, normal, weight });
    }
}

/// The zero of a rising function in (0, 1), by bisection.
fn crossing(f: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 { low = middle } else { high = middle }
    }
    high
}

/// Sum over points, in order, so that any number of threads gives the same bits.
fn sum<F: GradientField, P: Sync>(
    field: &F,
    points: &[P],
    at: impl Fn(&P) -> (Vector2, Vector2) + Sync,
    integrand: impl Fn(&P, &Matrix2) -> Vector2 + Sync,
) -> Result<Vector2> {
    let values = integrands(points, field, |p| at(p).into(), integrand)?;
    Ok(values.into_iter().fold(Vector2::zeros(), |s, v| s + v))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crack::{CrackPath, End, EndKind, TipId};
    use crate::exact::{CrackTipField, ExactField};
    use crate::material::PlaneState;
    use std::f64::consts::PI;

    struct Exact(CrackTipField, Elasticity);

    impl GradientField for Exact {
        type Buffer = ();
        fn gradient(&self, at: Vector2, sight: Vector2, _: &mut ()) -> Result<Matrix2> {
            // On a face, from its own side.
            Ok(self.0.gradient(&self.1, at + (sight - at) * 1e-3))
        }
    }

    const MATERIAL: Elasticity = Elasticity { young: 7.0, poisson: 0.3, plane: PlaneState::Stress };
    const SHAPES: [TipDomainShape; 2] = [TipDomainShape::Disc, TipDomainShape::Square];

    /// Forces of the exact field at a tip in a crack that lies askew, from several sizes.
    fn forces(k: [f64; 2], t_stress: f64, domain: TipDomainShape, j_integral: JIntegral) -> Vec<ConfigurationalForce> {
        let crack = CrackPath {
            name: "c".into(),
            vertices: vec![Vector2::new(-2.0, -1.0), Vector2::new(0.1, 0.2)],
            ends: [EndKind::Mouth, EndKind::Tip],
        };
        let frame = crack.frame(End::End);
        let field = CrackTipField { tip: frame.position, angle: frame.angle, k1: k[0], k2: k[1], t_stress };
        let id = TipId { crack: 0, end: End::End };
        let view = TipView { id, frame, path: crack.from_end(End::End), largest_radius: 1.0 };
        let settings = FractureSettings { domain, j_integral, ..FractureSettings::default() };
        let field = Exact(field, MATERIAL);
        configurational_forces(&view, &[0.01, 0.2, 0.9], &settings, &MATERIAL, &TipLoads::default(), &field).unwrap()
    }

    #[test]
    fn force_is_that_of_the_factors_over_any_domain_and_outline() {
        for k in [[1.3, -0.7], [0.4, 0.9], [1.0, 0.0], [0.0, 1.0]] {
            for t_stress in [0.0, 0.4] {
                let exact = force_of_factors(k[0], k[1], &MATERIAL);
                for (shape, integral) in SHAPES.iter().flat_map(|s| [(*s, JIntegral::Domain), (*s, JIntegral::Contour)])
                {
                    for found in forces(k, t_stress, shape, integral) {
                        let force = found.value(FaceTerm::Included);
                        assert!((force - exact).norm() < 1e-6, "{k:?} {shape:?} {integral:?}: {found:?}, {exact:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn signs_are_those_of_growth() {
        // g_1 = J = (K_I² + K_II²)/E', and K_II > 0 turns the crack to the right.
        let force = force_of_factors(3.0, 1.0, &MATERIAL);
        assert!((force - Vector2::new(10.0, -6.0) / 7.0).norm() < 1e-15);
    }

    /// With `σ_11 = T ∓ 2 K_II/√(2πr)` on the faces, the energy jumps by `4 T K_II / (E' √(2πr))`: over a length c of
    /// crack, `8 T K_II √c / (E' √(2π))` are missing where the faces are left out.
    #[test]
    fn without_the_faces_a_t_stress_makes_the_outline_drift() {
        let (k, t) = ([1.3, -0.7], 0.4);
        for shape in SHAPES {
            for found in forces(k, t, shape, JIntegral::Contour) {
                let missing = 8.0 * t * k[1] * found.radius.sqrt() / (7.0 * (2.0 * PI).sqrt());
                let expected = force_of_factors(k[0], k[1], &MATERIAL) - Vector2::new(0.0, missing);
                assert!((found.value(FaceTerm::LeftOut) - expected).norm() < 1e-6, "{shape:?}: {found:?}");
                assert!((found.faces - Vector2::new(0.0, missing)).norm() < 1e-6, "{shape:?}: {found:?}");
            }
        }
    }
}
