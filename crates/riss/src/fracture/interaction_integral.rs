//! Stress intensity factors, T-stress and J at a tip by domain integrals [Moran1987].
//!
//! With `P_1j = W δ_1j - σ_ij u_i,1` in the tip frame, the energy release rate is
//! `J = -∫ P_1j q,j dA - ∫ b_i u_i,1 q dA + ∫_faces P_1j m_j q ds`, `b` the body force, `m` out of the body. On the faces
//! `P_1j m_j = W m_1 - t_i u_i,1` with the traction `t`. The interaction integral takes the mixed terms of the solution and
//! an auxiliary field. That field is continued analytically up to the crack itself, however it bends
//! behind the tip; what traction it then leaves on the faces stands in the face term.

use super::settings::{FractureSettings, JIntegral, TipDomainShape};
use super::tip_domain::{DomainPoint, PLATEAU, TipView};
use crate::approximation::moving_least_squares::Derivatives;
use crate::approximation::point_batch::{PointBatch, Wanted};
use crate::approximation::{ShapeFunctions, Surroundings};
use crate::error::Result;
use crate::exact::crack_tip_field::{TipMode, tip_field};
use crate::geometry::aabb::Aabb;
use crate::material::Elasticity;
use crate::math::{Matrix2, Vector2};
use crate::system::{Discretization, Solution};
use rayon::prelude::*;

/// Fracture quantities at a tip from one domain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipIntegrals {
    /// Radius of the domain [length].
    pub radius: f64,
    /// Mode I stress intensity factor [stress·√length]; positive opens.
    pub k1: f64,
    /// Mode II stress intensity factor [stress·√length]; positive slides the left face ahead.
    pub k2: f64,
    /// T-stress [stress].
    pub t_stress: f64,
    /// J-integral [stress·length].
    pub j: f64,
}

/// A displacement gradient at every point of the body, seen from a side.
pub trait GradientField: Sync {
    /// Buffers of one thread.
    type Buffer: Default;
    /// `[(i, j)] = ∂u_i/∂x_j` in global axes.
    fn gradient(&self, at: Vector2, sight: Vector2, buffer: &mut Self::Buffer) -> Result<Matrix2>;

    /// The same at some points that lie together, each with from where it sees.
    fn gradients(&self, views: &[[Vector2; 2]], buffer: &mut Self::Buffer, gradients: &mut Vec<Matrix2>) -> Result<()> {
        gradients.clear();
        for [at, sight] in views {
            gradients.push(self.gradient(*at, *sight, buffer)?);
        }
        Ok(())
    }
}

/// Points of a domain that are looked up together.
const TOGETHER: usize = 4;

/// The gradient of a solution.
#[derive(Clone, Copy, Debug)]
pub struct SolutionField<'a> {
    /// Where.
    pub discrete: &'a Discretization,
    /// What.
    pub solution: &'a Solution,
}

impl GradientField for SolutionField<'_> {
    type Buffer = FieldBuffer;

    fn gradient(&self, at: Vector2, sight: Vector2, buffer: &mut Self::Buffer) -> Result<Matrix2> {
        let FieldBuffer { around, shape, .. } = buffer;
        self.discrete.approximation.evaluate(at, sight, Derivatives::First, around, shape)?;
        Ok(shape.gradient(&self.solution.parameters))
    }

    fn gradients(&self, views: &[[Vector2; 2]], buffer: &mut Self::Buffer, gradients: &mut Vec<Matrix2>) -> Result<()> {
        let (approximation, parameters) = (&self.discrete.approximation, &self.solution.parameters);
        let FieldBuffer { around, shape, batch } = buffer;
        gradients.clear();
        approximation.survey(&Aabb::of_points(views.iter().flatten().copied()), around);
        if approximation.is_plain(around) {
            approximation.fill_nodes(around.candidates.iter().copied(), batch);
            batch.set_points(views.iter().map(|[at, _]| (*at, Vector2::zeros())));
            if approximation.evaluate_batch(Wanted::Gradients, batch) {
                let stride = batch.stride();
                gradients.extend((0..views.len()).map(|q| {
                    around.candidates.iter().enumerate().fold(Matrix2::zeros(), |sum, (a, i)| {
                        let slope = Vector2::from([0, 1].map(|d| batch.gradients[d][a * stride + q]));
                        sum + parameters[*i as usize] * slope.transpose()
                    })
                }));
                return Ok(());
            }
        }
        for [at, sight] in views {
            approximation.evaluate_surveyed(*at, *sight, Derivatives::First, around, shape)?;
            gradients.push(shape.gradient(parameters));
        }
        Ok(())
    }
}

/// Buffers of [`SolutionField`].
#[derive(Clone, Debug, Default)]
pub struct FieldBuffer {
    around: Surroundings,
    shape: ShapeFunctions<2>,
    batch: PointBatch,
}

/// Force per volume at a point of the body, global axes [stress/length].
pub type ForceAt<'a> = &'a (dyn Fn(Vector2) -> Vector2 + Sync);

/// Pressure on both faces at a point of the crack [stress]; positive pushes them apart.
pub type PressureAt<'a> = &'a (dyn Fn(Vector2) -> f64 + Sync);

/// What acts on the faces of a crack.
#[derive(Clone, Copy)]
pub struct FacePressure<'a> {
    /// The pressure along the crack.
    pub at: PressureAt<'a>,
    /// Opening of the solution just behind the tip [length]: where sight ends at the crack it does not go to zero.
    pub tip_opening: f64,
}

/// What acts around a tip.
#[derive(Clone, Copy, Default)]
pub struct TipLoads<'a> {
    /// Inside the body, if anything.
    pub body_force: Option<ForceAt<'a>>,
    /// On the crack faces, if anything.
    pub face_pressure: Option<FacePressure<'a>>,
}

/// Evaluates every domain of a tip, smallest first.
///
/// T is the stress along the crack that does not fade at the tip. The interaction with a point force gives it against
/// the stress across the crack, `(σ_11 - σ_22) / E'`, and `σ_22` is minus the pressure on the faces.
///
/// # Errors
/// Those of the field.
pub fn tip_integrals<F: GradientField>(
    view: &TipView,
    radii: &[f64],
    settings: &FractureSettings,
    material: &Elasticity,
    loads: &TipLoads,
    field: &F,
) -> Result<Vec<TipIntegrals>> {
    radii
        .iter()
        .map(|&radius| {
            let domain = view.domain(settings.domain, radius);
            let mut sum = integrate(view, &domain.area, material, field, |p, state| {
                state.eshelby_along(p.q_local(view)).map(|v| -v * p.weight)
            })?;
            let faces = integrate(view, &domain.faces, material, field, |p, state| {
                state.face_term(p.normal_local(view)).map(|v| v * p.weight * p.q.x)
            })?;
            let work = load_terms(loads, view, (settings.domain, radius, PLATEAU), material, field)?;
            (0..4).for_each(|i| sum[i] += faces[i] + work[i]);
            let j = match settings.j_integral {
                JIntegral::Domain => sum[3],
                JIntegral::Contour => contour_j(view, radius, settings, material, loads, field)?,
            };
            let young = material.effective_young();
            let across = loads.face_pressure.map_or(0.0, |p| -(p.at)(view.frame.position));
            let t_stress = young * sum[2] + across;
            Ok(TipIntegrals { radius, k1: 0.5 * young * sum[0], k2: 0.5 * young * sum[1], t_stress, j })
        })
        .collect()
}

/// J over a contour and the bent faces inside [stress·length].
fn contour_j<F: GradientField>(
    view: &TipView,
    radius: f64,
    settings: &FractureSettings,
    material: &Elasticity,
    loads: &TipLoads,
    field: &F,
) -> Result<f64> {
    let contour = view.contour(settings.domain, radius);
    let around = integrate(view, &contour, material, field, |p, state| {
        state.eshelby_along(p.normal_local(view)).map(|v| v * p.weight)
    })?;
    let faces = view.faces(settings.domain, radius, 1.0, 1);
    let inside = integrate(view, &faces, material, field, |p, state| {
        state.face_term(p.normal_local(view)).map(|v| v * p.weight)
    })?;
    let work = load_terms(loads, view, (settings.domain, radius, 1.0), material, field)?;
    Ok(around[3] + inside[3] + work[3])
}

/// What loads inside a domain of given shape, radius and plateau of q add: `-∫ b_i u_i,1 q dA - ∫_faces t_i u_i,1 q ds`.
fn load_terms<F: GradientField>(
    loads: &TipLoads,
    view: &TipView,
    (shape, radius, plateau): (TipDomainShape, f64, f64),
    material: &Elasticity,
    field: &F,
) -> Result<Integrals> {
    let mut sum = [0.0; 4];
    if let Some(force) = loads.body_force {
        let points = view.interior(shape, radius, plateau);
        let body = integrate(view, &points, material, field, |p, state| {
            state.work_along(local(view, force(p.position))).map(|v| -v * p.weight * p.q.x)
        })?;
        (0..4).for_each(|i| sum[i] += body[i]);
    }
    if let Some(pressure) = loads.face_pressure {
        let mut points = view.faces(shape, radius, plateau, 0);
        // A pressure pushes against the body: the traction is -p m.
        points.iter_mut().for_each(|p| p.weight *= (pressure.at)(p.position));
        let faces = integrate(view, &points, material, field, |p, state| {
            state.work_along(p.normal_local(view)).map(|v| v * p.weight * p.q.x)
        })?;
        (0..4).for_each(|i| sum[i] += faces[i]);
        // The integral of the opening's derivative begins with its jump at the tip.
        sum[3] += (pressure.at)(view.frame.position) * pressure.tip_opening;
    }
    Ok(sum)
}

/// Components in the tip frame.
fn local(view: &TipView, v: Vector2) -> Vector2 {
    Vector2::new(v.dot(&view.frame.x1()), v.dot(&view.frame.x2()))
}

impl DomainPoint {
    fn q_local(&self, view: &TipView) -> Vector2 {
        local(view, self.q)
    }

    fn normal_local(&self, view: &TipView) -> Vector2 {
        local(view, self.normal)
    }
}

/// Integrands: interaction with modes I and II and the point force, and the solution with itself.
type Integrals = [f64; 4];

/// Values of an integrand at points, in their order, from the gradients there.
///
/// - `at`: position of a point, and where it sees from
pub(super) fn integrands<F: GradientField, P: Sync, V: Clone + Default + Send>(
    points: &[P],
    field: &F,
    at: impl Fn(&P) -> [Vector2; 2] + Sync,
    integrand: impl Fn(&P, &Matrix2) -> V + Sync,
) -> Result<Vec<V>> {
    let mut values = vec![V::default(); points.len()];
    values
        .par_chunks_mut(TOGETHER)
        .zip(points.par_chunks(TOGETHER))
        .with_min_len(64 / TOGETHER)
        .map_init(<(F::Buffer, Vec<Matrix2>)>::default, |(buffer, gradients), (values, points)| {
            let mut views = [[Vector2::zeros(); 2]; TOGETHER];
            let views = &mut views[..points.len()];
            views.iter_mut().zip(points).for_each(|(view, p)| *view = at(p));
            field.gradients(views, buffer, gradients)?;
            for ((value, p), gradient) in values.iter_mut().zip(points).zip(gradients.iter()) {
                *value = integrand(p, gradient);
            }
            Ok(())
        })
        .collect::<Result<()>>()?;
    Ok(values)
}

fn integrate<F: GradientField>(
    view: &TipView,
    points: &[DomainPoint],
    material: &Elasticity,
    field: &F,
    integrand: impl Fn(&DomainPoint, &State) -> Integrals + Sync,
) -> Result<Integrals> {
    let rotation = Matrix2::from_columns(&[view.frame.x1(), view.frame.x2()]);
    let value = |p: &DomainPoint, gradient: &Matrix2| {
        integrand(p, &State::new(material, rotation.transpose() * gradient * rotation, p))
    };
    let values = integrands(points, field, |p| [p.position, p.sight], value)?;
    // In order, so that any number of threads gives the same bits.
    let mut sum = [0.0; 4];
    for v in values {
        (0..4).for_each(|i| sum[i] += v[i]);
    }
    Ok(sum)
}

/// The solution and the auxiliary fields at a point, in the tip frame.
struct State {
    gradient: Matrix2,
    stress: Matrix2,
    auxiliary: [(Matrix2, Matrix2); 3],
}

impl State {
    fn new(material: &Elasticity, gradient: Matrix2, at: &DomainPoint) -> Self {
        let auxiliary = [TipMode::Opening, TipMode::Sliding, TipMode::PointForce].map(|mode| {
            let gradient = tip_field(mode, material, at.r, at.theta).1;
            (gradient, material.stress(&gradient))
        });
        Self { gradient, stress: material.stress(&gradient), auxiliary }
    }

    /// `P_1j v_j`.
    fn eshelby_along(&self, v: Vector2) -> Integrals {
        let own = 0.5 * self.stress.dot(&self.gradient) * v.x - (self.stress * v).dot(&self.gradient.column(0));
        let mixed = self.auxiliary.map(|(gradient, stress)| {
            self.stress.dot(&gradient) * v.x
                - (self.stress * v).dot(&gradient.column(0))
                - (stress * v).dot(&self.gradient.column(0))
        });
        [mixed[0], mixed[1], mixed[2], own]
    }

    /// `f_i u_i,1`.
    fn work_along(&self, force: Vector2) -> Integrals {
        let mixed = self.auxiliary.map(|(gradient, _)| force.dot(&gradient.column(0)));
        [mixed[0], mixed[1], mixed[2], force.dot(&self.gradient.column(0))]
    }

    /// `P_1j m_j` on a face, less what the traction does.
    fn face_term(&self, m: Vector2) -> Integrals {
        let own = 0.5 * self.stress.dot(&self.gradient) * m.x;
        let mixed = self
            .auxiliary
            .map(|(gradient, stress)| self.stress.dot(&gradient) * m.x - (stress * m).dot(&self.gradient.column(0)));
        [mixed[0], mixed[1], mixed[2], own]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crack::{CrackPath, End, EndKind, TipFrame, TipId};
    use crate::exact::{CrackTipField, ExactField};
    use crate::material::PlaneState;

    struct Exact(CrackTipField, Elasticity);

    impl GradientField for Exact {
        type Buffer = ();
        fn gradient(&self, at: Vector2, _: Vector2, _: &mut ()) -> Result<Matrix2> {
            Ok(self.0.gradient(&self.1, at))
        }
    }

    #[test]
    fn straight_crack_gives_back_what_was_put_in() {
        let material = Elasticity { young: 7.0, poisson: 0.3, plane: PlaneState::Strain };
        let crack = CrackPath {
            name: "c".into(),
            vertices: vec![Vector2::new(-2.0, -1.0), Vector2::new(0.1, 0.2)],
            ends: [EndKind::Mouth, EndKind::Tip],
        };
        let frame: TipFrame = crack.frame(End::End);
        let exact = CrackTipField { tip: frame.position, angle: frame.angle, k1: 1.3, k2: -0.7, t_stress: 0.4 };
        let view = TipView {
            id: TipId { crack: 0, end: End::End },
            frame,
            path: crack.from_end(End::End),
            largest_radius: 1.0,
        };
        for domain in [TipDomainShape::Disc, TipDomainShape::Square] {
            let settings = FractureSettings { domain, ..FractureSettings::default() };
            let field = Exact(exact, material);
            let found = tip_integrals(&view, &[0.2, 0.9], &settings, &material, &TipLoads::default(), &field).unwrap();
            let j = (1.3f64 * 1.3 + 0.7 * 0.7) / material.effective_young();
            for t in found {
                assert!((t.k1 - 1.3).abs() < 1e-6, "{domain:?} {t:?}");
                assert!((t.k2 + 0.7).abs() < 1e-6, "{domain:?} {t:?}");
                assert!((t.t_stress - 0.4).abs() < 1e-5, "{domain:?} {t:?}");
                assert!((t.j - j).abs() < 1e-6, "{domain:?} {t:?}");
            }
            let contour = contour_j(&view, 0.5, &settings, &material, &TipLoads::default(), &field).unwrap();
            assert!((contour - j).abs() < 1e-6, "{contour} {j}");
        }
    }
}
