//! Guard rails of solids: results that stand numerically, but where linear elastic fracture mechanics or the nodes do not
//! carry them.
//!
//! Each is said once for each crack or void, with the key of the case that it is about and a remedy.

use super::guard_rails::{LINEAR, OVER_LIGAMENT, OVERLAP_OF_STILL};
use super::solid_error_bars::crack_length;
use super::solid_record::{FrontPointRecord, FrontRecord, SolidResult};
use super::solid_static::SolidSettings;
use super::warnings::{Warnings, crack_key};
use crate::crack::FrontPoint;
use crate::geometry::surface::Surface;
use crate::geometry::triangle::{Triangle, area_vector};
use crate::math::Vector3;
use crate::model::{RigidMotion, SolidModel, SurfacePoint, VectorField};
use crate::nodes::solid::thinnest_wall;

/// Overlap of crack faces over the largest opening or sliding that is beyond the noise of coarse nodes.
const OVERLAP: f64 = 0.03;
/// A negative K_I below this share of the largest factor is noise.
const SMALL_FACTOR: f64 = 0.02;
/// Least number of nodes on a void: a ball with as many around its equator as a hole in the plane needs.
const ON_VOID: f64 = 80.0;
/// Least number of spacings through a wall.
const THROUGH_WALL: f64 = 3.0;
/// Least number of spacings over the radius of curvature of a front.
const OVER_BEND: f64 = 8.0;
/// Nodes for each square of the spacing on a surface: they stand in triangles.
const PER_SQUARE: f64 = 1.1547;
/// Forces out of balance by more than this share are no error of their integration.
const OUT_OF_BALANCE: f64 = 0.01;
/// Splits of triangles for that integration, until their edges are this share of the size of the body.
const FINE: f64 = 1.0 / 12.0;

/// Looks at a solution from all sides.
pub(super) fn inspect(model: &SolidModel, settings: &SolidSettings, result: &SolidResult, warnings: &mut Warnings) {
    for front in &result.fronts {
        discs(model, settings, front, warnings);
        plastic_zone(model, front, warnings);
        spacing(model, settings, front, warnings);
    }
    (0..model.cracks.len()).for_each(|crack| overlap(model, crack, result, warnings));
    voids(model, settings, warnings);
    thin(model, settings, warnings);
    balance(model, warnings);
}

fn place(p: Vector3) -> String {
    format!("({:.4}, {:.4}, {:.4})", p.x, p.y, p.z)
}

/// Points of a front around which no disc fits.
fn discs(model: &SolidModel, settings: &SolidSettings, front: &FrontRecord, warnings: &mut Warnings) {
    let missing: Vec<&FrontPoint> = front.points.iter().filter(|p| p.factors.is_none()).map(|p| &p.point).collect();
    let Some(first) = missing.first() else { return };
    let message = format!(
        "no domain for K fits around {} of {} points of the front of {}, the first at {}: the boundary, a void or another \
         crack is nearer than two spacings of {:.4}; ask for a smaller nodes.front_spacing",
        missing.len(),
        front.points.len(),
        model.crack_names[front.crack],
        place(first.position),
        settings.spacing.at(first.position)
    );
    warnings.about_crack(front.crack, message);
}

/// Distance ahead of a front to the boundary [length].
fn ligament(body: &Surface, p: &FrontPoint) -> f64 {
    let (mut free, mut cut) = (0.0, body.bounds().size().norm());
    for _ in 0..40 {
        let middle = 0.5 * (free + cut);
        if body.cuts(p.position, p.position + p.ahead * middle) { cut = middle } else { free = middle }
    }
    cut
}

/// Whether nodes resolve the body where it is thin.
fn thin(model: &SolidModel, settings: &SolidSettings, warnings: &mut Warnings) {
    let Some((wall, through)) = thinnest_wall(&model.body, &settings.spacing, THROUGH_WALL) else { return };
    let message = format!(
        "the body is {:.4} thick at {}, with only {through:.1} node spacings through it, and {THROUGH_WALL} are the least: what \
         bends there is wrong, and K with it; ask for a smaller nodes.spacing",
        wall.thickness,
        place(wall.corners.iter().sum::<Vector3>() / 3.0)
    );
    warnings.about("nodes", message);
}

/// Size of the plastic zone against the crack and what is ahead of it.
fn plastic_zone(model: &SolidModel, front: &FrontRecord, warnings: &mut Warnings) {
    let Some(yield_stress) = model.yield_stress else { return };
    let length = crack_length(&model.cracks[front.crack], front.is_closed);
    let needed = |p: &FrontPointRecord| {
        let factors = p.factors?.factors;
        Some(LINEAR * factors.iter().map(|k| k * k).sum::<f64>() / yield_stress.powi(2))
    };
    let worst = (front.points.iter())
        .filter_map(|p| Some((needed(p)?, ligament(&model.body, &p.point), &p.point)))
        .max_by(|a, b| (a.0 / a.1.min(length)).total_cmp(&(b.0 / b.1.min(length))));
    let Some((needed, ahead, point)) = worst else { return };
    let least = length.min(ahead);
    if needed > least {
        let what = if length < ahead { "crack is" } else { "ligament is" };
        let message = format!(
            "front of {} at {}: linear elastic fracture mechanics is doubtful: the {what} {least:.4} long, and should be longer \
             than (4/pi) (K/yield_stress)^2 = {needed:.4}; lower the load, or use an elastic-plastic method",
            model.crack_names[front.crack],
            place(point.position)
        );
        warnings.about_crack(front.crack, message);
    }
}

/// Whether nodes resolve the curve of a front, its crack, and what is ahead.
fn spacing(model: &SolidModel, settings: &SolidSettings, front: &FrontRecord, warnings: &mut Warnings) {
    let length = crack_length(&model.cracks[front.crack], front.is_closed);
    let lengths = |p: &FrontPoint| {
        let radius = 1.0 / p.curvature.abs().max(f64::MIN_POSITIVE);
        let ahead = ligament(&model.body, p);
        let least = [OVER_LIGAMENT, OVER_BEND, OVER_LIGAMENT];
        let what = ["its crack", "its radius of curvature", "the ligament ahead"];
        [length, radius, ahead].into_iter().zip(what).zip(least)
    };
    let all = front.points.iter().flat_map(|p| {
        let h = settings.spacing.at(p.point.position);
        lengths(&p.point).map(move |((l, what), least)| (l / h / least, l, what, least, p.point.position))
    });
    let Some((share, l, what, least, at)) = all.min_by(|a, b| a.0.total_cmp(&b.0)) else { return };
    if share < 1.0 {
        let message = format!(
            "front of {} at {}: only {:.1} node spacings over {what}, {l:.4} long, and {least} are the least; ask for a \
             smaller nodes.front_spacing",
            model.crack_names[front.crack],
            place(at),
            share * least
        );
        warnings.about_crack(front.crack, message);
    }
}

/// Whether faces pass through each other.
fn overlap(model: &SolidModel, crack: usize, result: &SolidResult, warnings: &mut Warnings) {
    let opened = &result.opened_cracks[crack];
    let largest = opened.openings.iter().map(|o| o.norm()).fold(0.0, f64::max);
    let mean = result.displacements.iter().sum::<Vector3>() / result.n_nodes.max(1) as f64;
    let motion = result.displacements.iter().map(|u| (u - mean).norm()).fold(0.0, f64::max);
    let noise = (OVERLAP * largest).max(OVERLAP_OF_STILL * motion);
    let overlapping = opened.gaps.iter().filter(|g| **g < -noise).count();
    let factors =
        || result.fronts.iter().filter(|f| f.crack == crack).flat_map(|f| &f.points).filter_map(|p| p.factors);
    let greatest = factors().flat_map(|f| f.factors).map(f64::abs).fold(0.0, f64::max);
    let is_negative = |f: &crate::fracture::FrontFactors| f.factors[0] < -f.uncertainty.max(SMALL_FACTOR * greatest);
    let (negative, known) = (factors().filter(is_negative).count(), factors().count());
    if overlapping == 0 && (negative == 0 || largest == 0.0) {
        return;
    }
    let share = 100.0 * overlapping as f64 / opened.gaps.len().max(1) as f64;
    let message = format!(
        "the faces of {} overlap at {share:.0} % of their nodes, and K_I is negative at {negative} of {known} points of its \
         front: they would touch there, and solids know no contact yet; load the crack open, or take K for an upper bound only \
         where it is open",
        model.crack_names[crack]
    );
    warnings.about(&crack_key(crack), message);
}

/// Whether nodes resolve every void: pieces of the boundary that enclose no material.
fn voids(model: &SolidModel, settings: &SolidSettings, warnings: &mut Warnings) {
    let body = &model.body;
    for piece in pieces(body) {
        let volume: f64 = piece.iter().map(|t| signed_volume(body.corners(*t), Vector3::zeros())).sum();
        if volume >= 0.0 {
            continue;
        }
        let nodes_on = |t: &u32| {
            let corners = body.corners(*t);
            let h = settings.spacing.at(corners.iter().sum::<Vector3>() / 3.0);
            PER_SQUARE * 0.5 * area_vector(corners).norm() / (h * h)
        };
        let n: f64 = piece.iter().map(nodes_on).sum();
        if n < ON_VOID {
            let name = &body.parts()[body.part_of(piece[0]) as usize].name;
            let at = place(body.corners(piece[0])[0]);
            let message = format!(
                "only about {n:.0} nodes stand on the void `{name}` at {at}, {ON_VOID} are the least for its stress; ask for a \
                 smaller spacing there with [[nodes.finer]]"
            );
            warnings.about("nodes", message);
        }
    }
}

/// Triangles that hang together.
fn pieces(body: &Surface) -> Vec<Vec<u32>> {
    let n = body.triangles().len();
    let mut is_seen = vec![false; n];
    let mut pieces = vec![];
    for start in 0..n {
        if std::mem::replace(&mut is_seen[start], true) {
            continue;
        }
        let mut piece = vec![start as u32];
        let mut next = 0;
        while let Some(t) = piece.get(next).copied() {
            next += 1;
            for other in (0..3).filter_map(|k| body.across(t, k)) {
                if !std::mem::replace(&mut is_seen[other as usize], true) {
                    piece.push(other);
                }
            }
        }
        pieces.push(piece);
    }
    pieces
}

/// Volume of the tetrahedron between a triangle and a point, positive if the point is on the inner side.
fn signed_volume([a, b, c]: Triangle, o: Vector3) -> f64 {
    (a - o).dot(&(b - o).cross(&(c - o))) / 6.0
}

/// Whether the loads on a body without supports are in balance.
fn balance(model: &SolidModel, warnings: &mut Warnings) {
    let solid = &model.solid;
    let is_held = solid.parts.iter().any(|p| !p.displacements.is_empty());
    // A force that varies over the volume is not integrated here.
    let VectorField::Constant(body_force) = solid.body_force else { return };
    if solid.rigid_motion != RigidMotion::MeanIsZero || is_held {
        return;
    }
    let body = &model.body;
    let (middle, size) = (body.bounds().center(), body.bounds().size().norm());
    let (mut force, mut moment, mut whole) = (Vector3::zeros(), Vector3::zeros(), 0.0);
    for t in 0..body.triangles().len() as u32 {
        let traction = &solid.parts[body.part_of(t) as usize].traction;
        let mut open = vec![body.corners(t)];
        while let Some([a, b, c]) = open.pop() {
            let longest = [a - b, b - c, c - a].map(|e| e.norm()).into_iter().fold(0.0, f64::max);
            if longest > FINE * size {
                let (d, e, f) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a));
                open.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
                continue;
            }
            let area = area_vector([a, b, c]);
            let position = (a + b + c) / 3.0;
            let normal = area.normalize();
            let at = SurfacePoint { position, normal, sight: position - normal * (1e-6 * size) };
            let pull = traction.value(&at) * (0.5 * area.norm());
            force += pull;
            moment += (position - middle).cross(&pull);
            whole += pull.norm();
            let volume = signed_volume([a, b, c], middle);
            let pull = body_force * volume;
            force += pull;
            moment += ((a + b + c - middle * 3.0) / 4.0).cross(&pull);
            whole += pull.norm();
        }
    }
    let share = force.norm().max(2.0 * moment.norm() / size) / whole;
    if share > OUT_OF_BALANCE {
        let message = format!(
            "the loads are out of balance by {:.0} % of their sum, the resultant is {} and its moment about {} is {}; what \
             balances them is spread over the nodes: add supports, or the missing load",
            100.0 * share,
            place(force),
            place(middle),
            place(moment)
        );
        warnings.about("rigid_motion", message);
    }
}
