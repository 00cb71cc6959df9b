//! Cracks whose faces touch without friction.
//!
//! Goal: the pressure between the faces is what the closed forms say: none of it makes K_I, all of the shear makes K_II.
//!
//! ```text
//!      | | | | |  1
//!      v v v v v                    p = x on the faces, |x| < 1:
//!    +-----------+                     pulled together on the left, pushed apart on the right
//!    |     /     |
//!    |    /  ) β |                   -1 ~~~~~~ -1/3 ==================== 1
//!    +-----------+                      closed            open
//!      ^ ^ ^ ^ ^
//! ```
//!
//! Tolerances: K_II as without contact, 0.5 %. K_I and the pressure at the tip come from openings that the tip's own error
//! disturbs: 2 % of K_II, 10 % of the stress.

use super::bodies::{inner_crack, rectangle, solve, tips};
use riss::analysis::{Settings, StaticResult, TipStatus};
use riss::math::{Matrix2, direction, turn_left};
use riss::model::{BoundaryLoad, Contact, CrackFaceLoad, Model, RigidMotion, ScalarField, TractionValue};
use std::f64::consts::PI;
use std::sync::Arc;

/// A crack of half length 1 at an angle to the x axis in a free plate of half edge 30: its sides add 0.1 %.
fn plate(degrees: f64) -> Model {
    let d = direction(degrees.to_radians());
    let cracks = vec![inner_crack(&[[-d.x, -d.y], [d.x, d.y]])];
    let rigid_motion = RigidMotion::MeanIsZero;
    Model { cracks, rigid_motion, ..Model::plain(rectangle([-30.0, -30.0], [30.0, 30.0], &[])) }
}

fn pressed(degrees: f64, stress: Matrix2, contact: Option<Contact>) -> StaticResult {
    let mut model = Model { contact, ..plate(degrees) };
    model.loads.push(BoundaryLoad { part: None, value: TractionValue::UniformStress(stress) });
    solve(&model, &Settings::default())
}

/// Compression `-1` along y. A closed crack passes the stress across it on: K_I = 0, K_II = τ √π, T the stress along it,
/// J = K_II²/E' [Tada, section 5].
fn check_slanted(degrees: f64, contact: Contact) {
    let d = direction(degrees.to_radians());
    let stress = Matrix2::new(0.0, 0.0, 0.0, -1.0);
    let result = pressed(degrees, stress, Some(contact));
    let (k2, along) = (d.dot(&(stress * turn_left(d))) * PI.sqrt(), d.dot(&(stress * d)));
    for tip in tips(&result) {
        let found = [tip.k1, tip.k2, tip.t_stress, tip.j].map(Option::unwrap);
        assert!((found[1] - k2).abs() < 0.005 * k2.abs().max(0.1), "{degrees}: {tip:?}");
        assert!(found[0].abs() < 0.02 * k2.abs().max(0.1), "{degrees}: {tip:?}");
        assert!((found[2] - along).abs() < 0.1, "{degrees}: {tip:?}, T = {along}");
        assert!((found[3] - k2 * k2 * (1.0 - 0.3 * 0.3)).abs() < 0.01 * k2.powi(2).max(0.1), "{degrees}: {tip:?}");
        assert_eq!(tip.status, TipStatus::Closed);
    }
    assert!(result.warnings.is_empty(), "{:?}", result.warnings);
}

#[test]
fn tada_2000_closed_crack_under_compression() {
    for degrees in [0.0, 30.0, 45.0, 60.0] {
        check_slanted(degrees, Contact::default());
    }
}

#[test]
fn k_of_a_closed_crack_does_not_depend_on_the_penalty() {
    for penalty in [1e2, 1e4, 1e5] {
        check_slanted(30.0, Contact { penalty });
    }
}

/// Where no faces meet, nothing at all changes.
#[test]
fn contact_leaves_an_open_crack_alone() {
    let tension = Matrix2::new(0.0, 0.0, 0.0, 1.0);
    let [free, contact] = [None, Some(Contact::default())].map(|contact| pressed(30.0, tension, contact));
    for (a, b) in tips(&free).into_iter().zip(tips(&contact)) {
        assert_eq!((a.k1, a.k2, a.t_stress, a.j, a.status), (b.k1, b.k2, b.t_stress, b.j, b.status));
    }
}

/// Under `p = x` a part of length 2l around x0 stays open, from the tip at 1 to where K vanishes: with
/// `K = (x0 ± l/2) √(π l)` at its ends [Tada, section 5], x0 = l/2 and x0 + l = 1, so l = 2/3 and K = 2/3 √(2π/3) at the
/// tip at 1 [BowieFreese1976].
#[test]
fn bowie_freese_1976_partly_closed_crack() {
    let pressure = ScalarField::Function(Arc::new(|at| at.position.x));
    let crack_face_loads = vec![CrackFaceLoad { crack: 0, pressure }];
    let model = Model { crack_face_loads, contact: Some(Contact::default()), ..plate(0.0) };
    let result = solve(&model, &Settings::default());
    let tips = tips(&result);
    let k = 2.0 / 3.0 * (2.0 * PI / 3.0).sqrt();
    assert!((tips[1].k1.unwrap() / k - 1.0).abs() < 0.005, "{:?}", tips[1]);
    assert!(tips[0].k1.unwrap().abs() < 0.005 * k, "{:?}", tips[0]);
    assert_eq!((tips[0].status, tips[1].status), (TipStatus::Closed, TipStatus::Stationary));
    assert!(result.warnings.is_empty(), "{:?}", result.warnings);
}
