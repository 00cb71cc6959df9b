//! Guard rails: results that stand numerically, but where linear elastic fracture mechanics or the nodes do not carry them.
//!
//! Each is said once for each crack or part in a run, with the key of the case that it is about and a remedy.

use super::record::{CrackRecord, Observer, StaticResult, TipRecord};
use super::warnings::{Warning, crack_key};
use crate::crack::TipId;
use crate::material::PlaneState;
use crate::math::{Vector2, cross, turn_left};
use crate::model::Model;
use std::f64::consts::PI;

/// A length must be this many times `(K/σ_Y)²` for the plastic zone to be small against it [Dowling2013, section 8.7].
pub(super) const LINEAR: f64 = 4.0 / PI;
/// The thickness must be this many times `(K/σ_Y)²` for plane strain at the tip [ASTME399].
const PLANE_STRAIN: f64 = 2.5;
/// Radius of the plastic zone ahead of a tip over `(K/σ_Y)²` in plane stress, the larger one [Irwin1960].
const PLASTIC_RADIUS: f64 = 1.0 / (2.0 * PI);
/// Share of the body that may be beyond yield away from tips: corners and supports always are.
const YIELDED: f64 = 0.05;
/// Least number of node spacings over a ligament.
pub(super) const OVER_LIGAMENT: f64 = 4.0;
/// Least number of nodes around a hole.
const AROUND_HOLE: usize = 16;
/// Overlap of crack faces over the largest opening or sliding that is beyond numerical noise.
const OVERLAP: f64 = 0.01;
/// The same over the difference of displacements along a face, for cracks that hardly open or slide.
pub(super) const OVERLAP_OF_STILL: f64 = 0.001;
/// Turn between two straight increments beyond which a path lags behind its curvature [rad].
const SHARP_TURN: f64 = 0.35;

/// What has been said in a run; kept so that a resumed run says nothing twice.
pub(super) struct Rails<'a> {
    pub said: &'a mut Vec<String>,
    pub observer: &'a mut dyn Observer,
}

impl Rails<'_> {
    fn say(&mut self, rail: &str, key: String, message: String, result: &mut StaticResult) {
        let mark = format!("{rail} {key}");
        if self.said.contains(&mark) {
            return;
        }
        self.said.push(mark);
        let warning = Warning { key: Some(key), message };
        self.observer.warning(&warning);
        result.warnings.push(warning);
    }

    /// Looks at a solution from all sides.
    pub fn inspect(&mut self, model: &Model, result: &mut StaticResult) {
        for crack in 0..result.step.cracks.len() {
            for tip in result.step.cracks[crack].tips.clone() {
                self.plastic_zone(model, crack, &tip, result);
                self.ligament(model, crack, &tip, result);
            }
            self.overlap(model, crack, result);
        }
        self.yielding(model, result);
        // Holes do not change as cracks grow.
        if result.step.step == 0 {
            self.holes(model, result);
        }
    }

    /// Turns of straight increments that are too sharp for their length.
    pub fn turn(&mut self, tip: TipId, angle: f64, increment: f64, result: &mut StaticResult) {
        if angle.abs() > SHARP_TURN {
            let name = &result.step.cracks[tip.crack].name;
            let message = format!(
                "{name} turns by {:.0} degrees within one increment of {increment:.4}; take a smaller growth.increment, or growth.control = \"converged\"",
                angle.to_degrees().abs()
            );
            self.say("turn", "growth.increment".into(), message, result);
        }
    }

    /// Size of the plastic zone against crack, ligament and thickness.
    fn plastic_zone(&mut self, model: &Model, crack: usize, tip: &TipRecord, result: &mut StaticResult) {
        let (Some(yield_stress), Some(k1), Some(k2)) = (model.yield_stress, tip.k1, tip.k2) else { return };
        let size = (k1.hypot(k2) / yield_stress).powi(2);
        let record = &result.step.cracks[crack];
        let (length, ligament) = (model.cracks[crack].handbook_length(), ligament(model, crack, tip).0);
        let least = length.min(ligament);
        let at = place(record, tip);
        if LINEAR * size > least {
            let what = if length < ligament { "crack is" } else { "ligament is" };
            let message = format!(
                "{at}: linear elastic fracture mechanics is doubtful: the {what} {least:.4} long, and should be longer than (4/pi) (K/yield_stress)^2 = {:.4}; lower the load, or use an elastic-plastic method",
                LINEAR * size
            );
            self.say("plastic zone", crack_key(crack), message, result);
        }
        if !model.thickness_is_given {
            return;
        }
        let thickness = model.thickness;
        match model.material.plane {
            PlaneState::Strain if thickness < PLANE_STRAIN * size => {
                let message = format!(
                    "{at}: the thickness {thickness:.4} is less than 2.5 (K/yield_stress)^2 = {:.4}: there is no plane strain at the tip; take plane = \"stress\"",
                    PLANE_STRAIN * size
                );
                self.say("plane strain", "material.plane".into(), message, result);
            }
            PlaneState::Stress if thickness > 2.0 * PLANE_STRAIN * size && thickness > least => {
                let message = format!(
                    "{at}: the thickness {thickness:.4} is more than twice 2.5 (K/yield_stress)^2 = {:.4} and more than the {least:.4} around the tip: plane strain governs there; take plane = \"strain\"",
                    PLANE_STRAIN * size
                );
                self.say("plane stress", "material.plane".into(), message, result);
            }
            PlaneState::Strain | PlaneState::Stress => {}
        }
    }

    /// Whether nodes resolve what lies between a tip and the nearest other thing.
    fn ligament(&mut self, model: &Model, crack: usize, tip: &TipRecord, result: &mut StaticResult) {
        let (width, toward) = ligament(model, crack, tip);
        let middle = tip.position + (toward - tip.position) * 0.5;
        let within = result.nodes.iter().filter(|n| (n.position - middle).norm() <= 0.5 * width).count();
        // As many squares as nodes cover the disk.
        let across = (within as f64 * 4.0 / PI).sqrt();
        if across < OVER_LIGAMENT && !result.nodes.is_empty() {
            let at = place(&result.step.cracks[crack], tip);
            let message = format!(
                "{at}: only {across:.1} node spacings between the tip and the nearest boundary or crack, {width:.4} away at ({:.4}, {:.4}); ask for a smaller nodes spacing there",
                toward.x, toward.y
            );
            self.say("ligament", crack_key(crack), message, result);
        }
    }

    /// Whether faces pass through each other.
    fn overlap(&mut self, model: &Model, crack: usize, result: &mut StaticResult) {
        if model.contact.is_some() {
            return;
        }
        let Some(faces) = result.fields.crack_faces.get(crack) else { return };
        let jumps = || faces.left.iter().zip(&faces.right).map(|(a, b)| a - b);
        let largest = jumps().map(|j| j.norm()).fold(0.0, f64::max);
        let along = faces.left.iter().map(|u| (u - faces.left[0]).norm()).fold(0.0, f64::max);
        let noise = (OVERLAP * largest).max(OVERLAP_OF_STILL * along);
        let depth = |k: usize| {
            let n = faces.positions.len();
            let along = faces.positions[(k + 1).min(n - 1)] - faces.positions[k.saturating_sub(1)];
            -(faces.left[k] - faces.right[k]).dot(&turn_left(along).try_normalize(0.0).unwrap_or_default())
        };
        let overlapping = (0..faces.positions.len()).filter(|k| depth(*k) > noise).count();
        if overlapping > 0 {
            let message = format!(
                "the faces of crack {} overlap along about {:.0} % of it, where they would touch; K and J are those of faces that do not; add a [contact] section",
                result.step.cracks[crack].name,
                (100.0 * overlapping as f64 / faces.positions.len() as f64).max(1.0)
            );
            self.say("overlap", crack_key(crack), message, result);
        }
    }

    /// How much of the body is beyond yield away from tips.
    fn yielding(&mut self, model: &Model, result: &mut StaticResult) {
        let Some(yield_stress) = model.yield_stress else { return };
        let fields = &result.fields;
        let zones: Vec<(Vector2, f64)> = (result.step.cracks.iter().flat_map(|c| &c.tips))
            .filter_map(|t| Some((t.position, 2.0 * PLASTIC_RADIUS * (t.k1?.hypot(t.k2?) / yield_stress).powi(2))))
            .collect();
        let (mut yielded, mut whole) = (0.0, 0.0);
        for triangle in &fields.triangles {
            let [a, b, c] = triangle.map(|k| fields.positions[k as usize]);
            let area = 0.5 * cross(b - a, c - a).abs();
            let middle = (a + b + c) / 3.0;
            whole += area;
            let beyond = triangle.iter().all(|k| fields.von_mises[*k as usize] > yield_stress);
            if beyond && zones.iter().all(|(p, r)| (middle - p).norm() > *r) {
                yielded += area;
            }
        }
        if yielded > YIELDED * whole {
            let message = format!(
                "{:.0} % of the body are beyond the yield stress {yield_stress} away from the crack tips: it is not linear elastic under this load",
                100.0 * yielded / whole
            );
            self.say("yielding", "material.yield_stress".into(), message, result);
        }
    }

    /// Whether nodes resolve every hole.
    fn holes(&mut self, model: &Model, result: &mut StaticResult) {
        let size = model.domain.aabb().size().norm();
        for (k, edges) in model.domain.loops.iter().enumerate().skip(1) {
            let on_hole = |p: Vector2| edges.clone().any(|e| model.domain.edges[e].distance(p) < 1e-7 * size);
            let n = result.nodes.iter().filter(|n| on_hole(n.position)).count();
            if n < AROUND_HOLE && !result.nodes.is_empty() {
                let at = model.domain.edges[edges.start].point(0.0);
                let message = format!(
                    "only {n} nodes stand on the hole at ({:.4}, {:.4}), {AROUND_HOLE} are the least for its stress; ask for a smaller nodes spacing there",
                    at.x, at.y
                );
                self.say("hole", format!("hole[{}]", k - 1), message, result);
            }
        }
    }
}

fn place(crack: &CrackRecord, tip: &TipRecord) -> String {
    format!("tip of crack {} at ({:.4}, {:.4})", crack.name, tip.position.x, tip.position.y)
}

/// Distance from a tip to the nearest boundary or other crack, and the point there [length].
fn ligament(model: &Model, crack: usize, tip: &TipRecord) -> (f64, Vector2) {
    let p = tip.position;
    let (edge, _) = model.domain.closest_edge(p);
    let mut nearest = model.domain.on_edge(edge, p);
    for (_, other) in model.cracks.iter().enumerate().filter(|(k, _)| *k != crack) {
        for (a, b) in other.segments() {
            let e = b - a;
            let foot = a + e * ((p - a).dot(&e) / e.norm_squared()).clamp(0.0, 1.0);
            if (foot - p).norm() < (nearest - p).norm() {
                nearest = foot;
            }
        }
    }
    ((nearest - p).norm(), nearest)
}
