//! Cotterell and Rice (1980): a crack along a circular arc under equal biaxial tension, from a case file.
//!
//! Goal: an arc of a case file has the K of an arc, though its path is a polygon.
//!
//! ```text
//!       ____
//!     /      \     radius 1 around the origin, half angle 45°, stress 1 in all directions,
//!    o   |    o    plate 160 x 160, so large that its sides add 0.01 % [K goes with (R/W)²]
//! ```
//!
//! Tolerance: 0.5 % of |K|. A polygon of chords of 2° would miss K_I by 1.1 %, for its tips point 1° off the arc.

use super::bodies::{solve, tips};
use riss::case::Case;
use std::f64::consts::{FRAC_PI_4, PI};
use std::path::Path;

const CASE: &str = r#"
title = "Arc"
rigid_motion = "mean-is-zero"
material = { young = 1.0, poisson = 0.3, plane = "strain" }
geometry.rectangle = { lower = [-80, -80], upper = [80, 80] }
crack = [{ arc = { start = [-0.7071067811865476, 0.7071067811865476], through = [0, 1], end = [0.7071067811865476, 0.7071067811865476] } }]
remote_stress = { xx = 1, yy = 1 }
"#;

#[test]
fn cotterell_rice_1980_arc_crack() {
    let case = Case::parse(CASE, Path::new("case.toml"), &[]).unwrap_or_else(|e| panic!("{e:?}"));
    let result = solve(&case.model, &case.settings);
    let half = 0.5 * FRAC_PI_4;
    let scale = (PI * FRAC_PI_4.sin()).sqrt() / (1.0 + half.sin().powi(2));
    let (k1, k2) = (scale * half.cos(), scale * half.sin());
    for (tip, k2) in tips(&result).into_iter().zip([k2, -k2]) {
        let errors = [tip.k1.unwrap() - k1, tip.k2.unwrap() - k2].map(|e| e.abs() / scale);
        assert!(errors.iter().all(|e| *e < 0.005), "{errors:?}: {tip:?}");
    }
}
