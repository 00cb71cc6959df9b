//! Functions that span the field at a crack tip [EFG, Eqs. 50, 52], along cracks that kink [EFG, Eqs. 57-59].

use crate::crack::{CrackPath, End, TipFrame};
use crate::math::{Matrix2, Vector2, cross, direction, turn_left};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Most functions of a set.
pub const MOST_FUNCTIONS: usize = 4;

/// A crack must turn by less than this at a kink for the fields to be mapped around it [rad].
///
/// At a right angle no room is left between the perpendicular and the crack, and the map degenerates.
pub const LARGEST_TURN: f64 = 1.4;

/// Functions of the distance `r` from a tip and the angle `θ` from the direction ahead, `θ = ±π` on the crack faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TipFunctions {
    /// `√r cos θ/2, √r sin θ/2, √r sin θ/2 sin θ, √r cos θ/2 sin θ`: they span the displacements of both modes
    /// [EFG, Eq. 50].
    Full,
    /// `√r` [EFG, Eq. 52].
    Radial,
}

impl TipFunctions {
    /// Number of functions.
    pub fn count(self) -> usize {
        match self {
            Self::Full => 4,
            Self::Radial => 1,
        }
    }

    /// The functions over `√r`, with their first and second derivatives by the angle.
    pub(super) fn angular(self, theta: f64) -> [[f64; 3]; MOST_FUNCTIONS] {
        match self {
            Self::Full => {
                let (s, c) = (0.5 * theta).sin_cos();
                // sin 3θ/2 and cos 3θ/2.
                let (s3, c3) = (s * (3.0 - 4.0 * s * s), c * (4.0 * c * c - 3.0));
                // sin θ/2 sin θ = (cos θ/2 - cos 3θ/2)/2, cos θ/2 sin θ = (sin θ/2 + sin 3θ/2)/2.
                [
                    [c, -0.5 * s, -0.25 * c],
                    [s, 0.5 * c, -0.25 * s],
                    [0.5 * (c - c3), 0.25 * (3.0 * s3 - s), 0.125 * (9.0 * c3 - c)],
                    [0.5 * (s + s3), 0.25 * (c + 3.0 * c3), -0.125 * (s + 9.0 * s3)],
                ]
            }
            Self::Radial => [[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3], [0.0; 3]],
        }
    }
}

/// Values and derivatives of the functions of a set at a point; those beyond their number are zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipJet {
    /// Values [√length].
    pub values: [f64; MOST_FUNCTIONS],
    /// Gradients in global axes [1/√length].
    pub gradients: [Vector2; MOST_FUNCTIONS],
    /// Second derivatives in global axes [length^(-3/2)].
    pub second_derivatives: [Matrix2; MOST_FUNCTIONS],
}

/// Coordinates at a tip in which the crack is straight, however it bends behind the tip.
#[derive(Clone, Debug)]
pub struct TipCoordinates {
    frame: TipFrame,
    /// Farthest from the tip first.
    kinks: Vec<Kink>,
    /// Nearer to the tip than this, derivatives are those at this distance, so that they are finite [length].
    core: f64,
}

/// A vertex of a crack, in the tip frame, and the map that aligns what lies behind it with what lies ahead.
#[derive(Clone, Copy, Debug)]
struct Kink {
    center: Vector2,
    /// Unit vectors along the segment ahead, towards the tip, and along the segment behind, away from it.
    ahead: Vector2,
    behind: Vector2,
    /// Turn of the mapped angle per turn of the angle, to the right and to the left of the crack seen from the kink
    /// (C_a, C_b of Eq. 57).
    slopes: [f64; 2],
}

/// A mapped point, with first and second derivatives by the original point, all in the tip frame.
#[derive(Clone, Copy, Debug)]
struct Mapped {
    place: Vector2,
    jacobian: Matrix2,
    /// Second derivatives of each coordinate.
    bends: [Matrix2; 2],
}

impl TipCoordinates {
    /// Coordinates at an end of a crack, good up to the distance `reach` from it; `core` is the distance below which
    /// derivatives are held [length].
    ///
    /// Kinks are mapped from the farthest one on: the map at a kink leaves everything ahead of it in place, so that the
    /// crack behind is straight when the next kink nearer to the tip is mapped.
    pub fn new(crack: &CrackPath, end: End, reach: f64, core: f64) -> Self {
        let frame = crack.frame(end);
        let path: Vec<Vector2> = crack.from_end(end).iter().map(|p| frame.local(*p)).collect();
        // Beyond a kink that cannot be mapped nothing can; regions end there.
        let mut kinks: Vec<Kink> =
            path.windows(3).take_while(|w| w[1].norm() < reach).map_while(|w| Kink::new([w[0], w[1], w[2]])).collect();
        kinks.reverse();
        Self { frame, kinks, core }
    }

    /// Sets the distance below which derivatives are held [length].
    pub fn set_core(&mut self, core: f64) {
        self.core = core;
    }

    /// The direction ahead of the tip [rad].
    pub fn angle(&self) -> f64 {
        self.frame.angle
    }

    /// The tip.
    pub fn tip(&self) -> Vector2 {
        self.frame.position
    }

    /// Distance and angle of a point in the coordinates that straighten the crack; `sight` tells the side of points on
    /// the crack.
    pub fn polar(&self, at: Vector2, sight: Vector2) -> [f64; 2] {
        let [place, seen] = [at, sight].map(|p| self.frame.local(p));
        let (mapped, seen) = self.map(place, seen);
        [mapped.place.norm(), angle_beside(mapped.place, seen)]
    }

    /// Values of the functions alone.
    pub fn values(&self, functions: TipFunctions, at: Vector2, sight: Vector2) -> [f64; MOST_FUNCTIONS] {
        let [r, theta] = match functions {
            TipFunctions::Full => self.polar(at, sight),
            TipFunctions::Radial => [(at - self.tip()).norm(), 0.0],
        };
        functions.angular(theta).map(|g| r.sqrt() * g[0])
    }

    /// Values and derivatives of the functions.
    pub fn jet(&self, functions: TipFunctions, at: Vector2, sight: Vector2) -> TipJet {
        let [place, seen] = [at, sight].map(|p| self.frame.local(p));
        let (mapped, seen) = match functions {
            TipFunctions::Full => self.map(place, seen),
            // The distance has no cut that a map would have to turn.
            TipFunctions::Radial => (Mapped::start(place), seen),
        };
        let theta = angle_beside(mapped.place, seen);
        let (root, r) = (mapped.place.norm().sqrt(), mapped.place.norm().max(self.core));
        let radial = direction(theta);
        let polar = Matrix2::from_columns(&[radial, turn_left(radial)]);
        let axes = Matrix2::from_columns(&[self.frame.x1(), self.frame.x2()]);
        let mut jet = TipJet {
            values: [0.0; MOST_FUNCTIONS],
            gradients: [Vector2::zeros(); MOST_FUNCTIONS],
            second_derivatives: [Matrix2::zeros(); MOST_FUNCTIONS],
        };
        for (k, [g, g1, g2]) in functions.angular(theta).into_iter().enumerate().take(functions.count()) {
            // Derivatives of √r g(θ) along the ray and across it.
            let slope = polar * Vector2::new(0.5 * g, g1) / r.sqrt();
            let bend = Matrix2::new(-0.25 * g, -0.5 * g1, -0.5 * g1, g2 + 0.5 * g) / (r * r.sqrt());
            let bend = polar * bend * polar.transpose();
            let [bx, by] = mapped.bends;
            let second = mapped.jacobian.transpose() * bend * mapped.jacobian + bx * slope.x + by * slope.y;
            jet.values[k] = root * g;
            jet.gradients[k] = axes * (mapped.jacobian.transpose() * slope);
            jet.second_derivatives[k] = axes * second * axes.transpose();
        }
        jet
    }

    /// Maps a point and the place it sees from around all kinks.
    fn map(&self, place: Vector2, mut seen: Vector2) -> (Mapped, Vector2) {
        let is_own = seen == place;
        let mut mapped = Mapped::start(place);
        for kink in &self.kinks {
            if let Some(slope) = kink.slope(seen) {
                mapped = mapped.then(kink, slope);
                seen = if is_own { mapped.place } else { kink.turn(seen, slope).place };
            }
        }
        (mapped, seen)
    }
}

/// Angle of a point, continued beyond ±π where the place it sees from lies on the other side of the cut.
fn angle_beside(place: Vector2, seen: Vector2) -> f64 {
    let theta = place.y.atan2(place.x);
    if seen == place {
        return theta;
    }
    theta + TAU * ((seen.y.atan2(seen.x) - theta) / TAU).round()
}

impl Kink {
    /// The kink at the second of three vertices, the first of which is nearest to the tip; none if it turns too far.
    fn new([next, center, last]: [Vector2; 3]) -> Option<Self> {
        let (ahead, behind) = ((next - center).normalize(), (last - center).normalize());
        // How far the crack turns to the left on its way to the tip: π - θ_R.
        let turn = cross(-behind, ahead).atan2(-behind.dot(&ahead));
        let slope = |room: f64| FRAC_PI_2 / room;
        let slopes = [slope(FRAC_PI_2 - turn), slope(FRAC_PI_2 + turn)];
        (turn.abs() < LARGEST_TURN).then_some(Self { center, ahead, behind, slopes })
    }

    /// Turn of the mapped angle per turn of the angle at a point; nothing ahead of the perpendicular, where the map is
    /// the identity [EFG, Eq. 57].
    fn slope(&self, p: Vector2) -> Option<f64> {
        let d = p - self.center;
        let is_left = cross(self.behind, d) > 0.0;
        (d.dot(&self.ahead) < 0.0).then(|| self.slopes[usize::from(is_left)])
    }

    /// The map around this kink alone [EFG, Eqs. 58, 59].
    fn turn(&self, p: Vector2, slope: f64) -> Mapped {
        let d = p - self.center;
        let r = d.norm();
        let (sin, cos) = (slope * cross(self.behind, d).atan2(self.behind.dot(&d))).sin_cos();
        let (before, after) = (d / r, -(self.ahead * cos + turn_left(self.ahead) * sin));
        let across = turn_left(before);
        let jacobian = after * before.transpose() + turn_left(after) * across.transpose() * slope;
        // r e(α') has no other second derivatives than (1 - slope²) e/r across the ray.
        let bend = across * across.transpose() * ((1.0 - slope * slope) / r);
        Mapped { place: self.center + after * r, jacobian, bends: [bend * after.x, bend * after.y] }
    }
}

impl Mapped {
    fn start(place: Vector2) -> Self {
        Self { place, jacobian: Matrix2::identity(), bends: [Matrix2::zeros(); 2] }
    }

    /// This map followed by that around a kink.
    fn then(self, kink: &Kink, slope: f64) -> Self {
        let next = kink.turn(self.place, slope);
        let bends = [0, 1].map(|m| {
            self.jacobian.transpose() * next.bends[m] * self.jacobian
                + self.bends[0] * next.jacobian[(m, 0)]
                + self.bends[1] * next.jacobian[(m, 1)]
        });
        Self { place: next.place, jacobian: next.jacobian * self.jacobian, bends }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crack::EndKind;
    use std::f64::consts::PI;

    fn crack(vertices: &[(f64, f64)]) -> CrackPath {
        let vertices = vertices.iter().map(|v| Vector2::new(v.0, v.1)).collect();
        CrackPath { name: "c".into(), vertices, ends: [EndKind::Tip; 2] }
    }

    /// Straight, kinked, and with many segments, some of them turning by 75°.
    fn cracks() -> Vec<CrackPath> {
        let turn = 75f64.to_radians();
        let arc = (0..=20).map(|k| direction(0.08 * k as f64)).map(|p| (p.x, p.y)).collect::<Vec<_>>();
        vec![
            crack(&[(-1.0, -0.3), (0.2, 0.1)]),
            crack(&[(-1.0, 0.0), (0.0, 0.0), (turn.cos() * 0.2, turn.sin() * 0.2)]),
            crack(&[(-1.0, 0.1), (-0.5, -0.1), (0.0, 0.1), (0.1, 0.4), (0.3, 0.5)]),
            crack(&arc),
        ]
    }

    fn ends(check: impl Fn(&CrackPath, End, &TipCoordinates)) {
        for path in cracks() {
            for end in [End::Start, End::End] {
                check(&path, end, &TipCoordinates::new(&path, end, f64::INFINITY, 0.0));
            }
        }
    }

    #[test]
    fn straight_functions_are_those_of_the_paper() {
        let path = crack(&[(-1.0, 0.0), (0.0, 0.0)]);
        let at = Vector2::new(-0.3, 0.4);
        let (root, theta) = (0.5f64.sqrt(), 0.4f64.atan2(-0.3));
        let (s, c) = (0.5 * theta).sin_cos();
        let coordinates = TipCoordinates::new(&path, End::End, f64::INFINITY, 0.0);
        let full = coordinates.values(TipFunctions::Full, at, at);
        let expected = [c, s, s * theta.sin(), c * theta.sin()].map(|g| root * g);
        assert!(full.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{full:?} {expected:?}");
        assert!((coordinates.values(TipFunctions::Radial, at, at)[0] - root).abs() < 1e-15);
    }

    #[test]
    fn angle_is_half_a_turn_on_all_faces() {
        ends(|path, end, coordinates| {
            for w in path.from_end(end).windows(2) {
                let left = turn_left((w[0] - w[1]).normalize());
                for t in [0.1, 0.5, 0.9] {
                    let at = w[0] + (w[1] - w[0]) * t;
                    for (side, expected) in [(left, PI), (-left, -PI)] {
                        let [_, theta] = coordinates.polar(at, at + side * 1e-7);
                        assert!((theta - expected).abs() < 1e-9, "{path:?} {end:?} {at}: {theta}");
                    }
                }
            }
        });
    }

    #[test]
    fn derivatives_are_those_of_finite_differences() {
        ends(|path, end, coordinates| {
            let mut compared = 0;
            for k in 0..200 {
                let at = coordinates.tip() + direction(0.7 * k as f64) * (0.02 + 0.005 * k as f64);
                let step = 1e-6;
                // Derivatives jump across the crack and the perpendiculars at its kinks.
                let beside = |v: f64| v.abs() > 1e-4;
                let clear = path.from_end(end).windows(2).all(|w| {
                    let e = (w[0] - w[1]).normalize();
                    beside((at - w[1]).dot(&e)) && beside((at - w[1]).dot(&turn_left(e)))
                });
                if !clear {
                    continue;
                }
                compared += 1;
                for functions in [TipFunctions::Full, TipFunctions::Radial] {
                    let jet = coordinates.jet(functions, at, at);
                    let values = coordinates.values(functions, at, at);
                    assert!(jet.values.iter().zip(values).all(|(a, b)| (a - b).abs() < 1e-14), "{jet:?} {values:?}");
                    for d in 0..2 {
                        let e = Vector2::ith(d, step);
                        let [ahead, behind] = [at + e, at - e].map(|p| coordinates.jet(functions, p, p));
                        for i in 0..MOST_FUNCTIONS {
                            let by = (ahead.values[i] - behind.values[i]) / (2.0 * step);
                            let size = 1.0 + jet.gradients[i].norm() + jet.second_derivatives[i].norm();
                            assert!((by - jet.gradients[i][d]).abs() < 1e-7 * size, "{path:?} {at} {i}: {by} {jet:?}");
                            let by = (ahead.gradients[i] - behind.gradients[i]) / (2.0 * step);
                            let found = jet.second_derivatives[i].column(d).into_owned();
                            assert!((by - found).norm() < 1e-5 * size, "{path:?} {at} {i}: {by} {found}");
                        }
                    }
                }
            }
            assert!(compared > 150, "{compared}");
        });
    }

    #[test]
    fn core_keeps_derivatives_finite() {
        let coordinates = TipCoordinates::new(&cracks()[0], End::End, 1.0, 1e-4);
        let jet = coordinates.jet(TipFunctions::Full, coordinates.tip(), coordinates.tip());
        assert!(jet.values.iter().all(|v| *v == 0.0));
        assert!((jet.gradients[0].norm() - 50.0).abs() < 1e-9, "{jet:?}");
    }
}
