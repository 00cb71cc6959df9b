//! Bodies whose exact stress is known, smooth and singular.

use crate::bodies::*;
use riss::exact::{Cantilever, CrackTipField, ExactField, PlateWithHole};
use riss::geometry::curve::Curve;
use riss::material::{Elasticity, PlaneState};
use riss::math::{Matrix2, Vector2};
use riss::model::{BoundaryLoad, Domain, Model, RigidMotion, TractionValue};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// A free body under the tractions of an exact field on its whole boundary.
pub fn pulled_by(field: Arc<dyn ExactField>, domain: Domain, material: Elasticity) -> Model {
    let whole = all(&domain);
    let mut model = Model { material, rigid_motion: RigidMotion::MeanIsZero, ..Model::plain(domain) };
    model.loads.push(BoundaryLoad { part: Some(whole), value: TractionValue::Exact(field.clone()) });
    model.exact = Some(field);
    model
}

/// A body whose whole boundary moves like an exact field.
pub fn moved_by(field: Arc<dyn ExactField>, domain: Domain, material: Elasticity) -> Model {
    let whole = all(&domain);
    let mut model = Model { material, ..Model::plain(domain) };
    hold_exactly(&mut model, whole, &BOTH, &field);
    model.exact = Some(field);
    model
}

pub const MATERIAL: Elasticity = Elasticity { young: 1000.0, poisson: 0.3, plane: PlaneState::Strain };

pub fn cantilever() -> Model {
    let field: Arc<dyn ExactField> = Arc::new(Cantilever { length: 4.0, height: 1.0, load: 1.0 });
    moved_by(field, rectangle((0.0, -0.5), (4.0, 0.5)), MATERIAL)
}

/// A quarter of a plate with a round hole, side 5 radii.
pub fn plate_with_hole() -> Model {
    let at = Vector2::new;
    let line = |start, end| Curve::Line { start, end };
    let outline = vec![
        line(at(1.0, 0.0), at(5.0, 0.0)),
        line(at(5.0, 0.0), at(5.0, 5.0)),
        line(at(5.0, 5.0), at(0.0, 5.0)),
        line(at(0.0, 5.0), at(0.0, 1.0)),
        Curve::Arc { center: at(0.0, 0.0), radius: 1.0, start_angle: FRAC_PI_2, sweep: -FRAC_PI_2 },
    ];
    let domain = with_parts(Domain::new(outline, vec![]), &["bottom", "right", "top", "left", "hole"]);
    let field = Arc::new(PlateWithHole { center: at(0.0, 0.0), radius: 1.0, stress: 1.0 });
    pulled_by(field, domain, MATERIAL)
}

/// The square `[-1, 1]²` with a crack from the left to its middle, pulled by the field at the tip.
pub fn near_tip(k1: f64, k2: f64) -> Model {
    let field = CrackTipField { tip: Vector2::zeros(), angle: 0.0, k1, k2, t_stress: 0.0 };
    let mut model = pulled_by(Arc::new(field), rectangle((-1.0, -1.0), (1.0, 1.0)), MATERIAL);
    model.cracks.push(crack(&[(-1.0, 0.0), (0.0, 0.0)], [riss::crack::EndKind::Mouth, riss::crack::EndKind::Tip]));
    model
}

/// Lamé's ring under internal pressure, radii 1 and 2 [Timoshenko1970, art. 28].
pub fn ring() -> Model {
    let hole = vec![Curve::circle(Vector2::zeros(), 1.0)];
    let domain = with_parts(Domain::new(vec![Curve::circle(Vector2::zeros(), 2.0)], vec![hole]), &[]);
    pulled_by(Arc::new(Lame { pressure: 5.0 }), domain, MATERIAL)
}

/// The L-shape `[-1, 1]²` without its lower right quarter, moved by the opening field at the corner.
pub fn l_shape() -> Model {
    let corners = [(0.0, 0.0), (0.0, -1.0), (-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, 0.0)];
    // Polygons run counterclockwise: from the corner to the right, around, and back from below.
    let outline: Vec<(f64, f64)> = corners.into_iter().rev().collect();
    let field: Arc<dyn ExactField> = Arc::new(Corner);
    pulled_by(field, with_parts(Domain::new(polygon(&outline), vec![]), &[]), MATERIAL)
}

/// `σ_r, σ_θ = A (1 ∓ 4/r²)`, `A = p/3`.
#[derive(Debug)]
struct Lame {
    pressure: f64,
}

impl ExactField for Lame {
    fn displacement(&self, material: &Elasticity, at: Vector2) -> Vector2 {
        let a = self.pressure / 3.0;
        let uniform = material.strain(&(Matrix2::identity() * a))[(0, 0)];
        at * (uniform + 4.0 * a / (2.0 * material.shear() * at.norm_squared()))
    }

    fn gradient(&self, material: &Elasticity, at: Vector2) -> Matrix2 {
        let a = self.pressure / 3.0;
        let uniform = material.strain(&(Matrix2::identity() * a))[(0, 0)];
        let c = 4.0 * a / (2.0 * material.shear());
        let r2 = at.norm_squared();
        Matrix2::identity() * (uniform + c / r2) - at * at.transpose() * (2.0 * c / (r2 * r2))
    }
}

/// The opening field at a corner of 270° of material [SzaboBabuska1991], whose sides are free; the corner is
/// at the origin, the material around the direction of 135°.
#[derive(Debug)]
struct Corner;

/// The root of `sin(3πλ/2) + λ sin(3π/2) = 0` in (1/2, 1), and the ratio of both terms that frees the sides.
const LAMBDA: f64 = 0.544_483_736_782_463_9;
const RATIO: f64 = 0.543_075_578_836_737_1;

impl Corner {
    /// Displacement along the bisector and across it over `r^λ`, and its derivative by the angle.
    fn shape(material: &Elasticity, theta: f64) -> [[f64; 2]; 2] {
        let (l, kappa) = (LAMBDA, material.kolosov());
        let (a, b) = (kappa - RATIO * (l + 1.0), kappa + RATIO * (l + 1.0));
        let (p, q) = (l * theta, (l - 2.0) * theta);
        let value = [a * p.cos() - l * q.cos(), b * p.sin() + l * q.sin()];
        let slope = [-a * l * p.sin() + l * (l - 2.0) * q.sin(), b * l * p.cos() + l * (l - 2.0) * q.cos()];
        [value, slope].map(|v| v.map(|x| x / (2.0 * material.shear())))
    }

    fn axes() -> Matrix2 {
        let s = 0.5f64.sqrt();
        Matrix2::new(-s, -s, s, -s)
    }
}

impl ExactField for Corner {
    fn displacement(&self, material: &Elasticity, at: Vector2) -> Vector2 {
        let local = Self::axes().transpose() * at;
        let [value, _] = Self::shape(material, local.y.atan2(local.x));
        Self::axes() * Vector2::from(value) * local.norm().powf(LAMBDA)
    }

    fn gradient(&self, material: &Elasticity, at: Vector2) -> Matrix2 {
        let axes = Self::axes();
        let local = axes.transpose() * at;
        let (r, theta) = (local.norm(), local.y.atan2(local.x));
        let [value, slope] = Self::shape(material, theta).map(Vector2::from);
        let (sin, cos) = theta.sin_cos();
        let scale = r.powf(LAMBDA - 1.0);
        let x = (value * (LAMBDA * cos) - slope * sin) * scale;
        let y = (value * (LAMBDA * sin) + slope * cos) * scale;
        axes * Matrix2::from_columns(&[x, y]) * axes.transpose()
    }
}

/// Gradients against finite differences, equilibrium, and sides without traction.
#[test]
fn fields_are_what_they_should_be() {
    for (field, points) in [
        (Arc::new(Lame { pressure: 5.0 }) as Arc<dyn ExactField>, [(1.2, 0.4), (-1.0, 1.1), (0.3, -1.6)]),
        (Arc::new(Corner), [(0.5, 0.4), (-0.3, 0.1), (-0.4, -0.8)]),
    ] {
        for (x, y) in points {
            let (at, h) = (Vector2::new(x, y), 1e-5);
            let mut divergence = Vector2::zeros();
            for j in 0..2 {
                let step = Vector2::ith(j, h);
                let u = field.displacement(&MATERIAL, at + step) - field.displacement(&MATERIAL, at - step);
                assert!((u / (2.0 * h) - field.gradient(&MATERIAL, at).column(j)).norm() < 1e-9, "{field:?} {at}");
                let s = field.stress(&MATERIAL, at + step) - field.stress(&MATERIAL, at - step);
                divergence += s.column(j) / (2.0 * h);
            }
            assert!(divergence.norm() < 1e-6, "{field:?} {at}: {divergence}");
        }
    }
    let lame = Lame { pressure: 5.0 };
    assert!((lame.stress(&MATERIAL, Vector2::new(0.0, 1.0))[(1, 1)] + 5.0).abs() < 1e-12);
    assert!(lame.stress(&MATERIAL, Vector2::new(2.0, 0.0))[(0, 0)].abs() < 1e-12);
    for (at, normal) in [(Vector2::new(0.7, 0.0), Vector2::y()), (Vector2::new(0.0, -0.7), Vector2::x())] {
        assert!((Corner.stress(&MATERIAL, at) * normal).norm() < 1e-9, "{at}");
    }
}
