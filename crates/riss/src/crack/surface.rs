//! A crack surface in a body: what of its rim is front, and where it meets the boundary.

use super::front::CrackFront;
use super::shape::{CrackDefect, CrackShape};
use crate::geometry::surface::mesh::weld;
use crate::geometry::surface::{Foot, Shape, Surface};
use crate::geometry::triangle::{Triangle, bounds, crossing};
use crate::math::Vector3;
use rustc_hash::FxHashSet;

/// Angle between normals from which an edge of a crack surface is sharp [rad].
pub(super) const FEATURE_ANGLE: f64 = 0.5;
/// A rim nearer to the boundary than this share of the body's size lies on it.
const ON_BOUNDARY: f64 = 1e-6;
/// The same over the radius of a round boundary, whose triangles are inscribed.
const ON_ROUND: f64 = 2e-3;
/// How far a crack that ends on the boundary is carried on beyond it, over the size of the body.
const OVERHANG: f64 = 4e-3;
/// Ends of pieces of a mouth nearer than this share of the body's size are one.
const SAME_POINT: f64 = 1e-8;
/// Longest way of a rim through the boundary, over that tolerance.
const PASSAGE: f64 = 20.0;
/// Places at which each edge of the rim is asked whether it is inside.
const SAMPLES: usize = 16;

/// A crack surface with its fronts.
#[derive(Clone, Debug)]
pub struct CrackSurface {
    /// The surface as it was given; it may reach out of the body.
    pub surface: Surface,
    /// Where it ends inside the body.
    pub fronts: Vec<CrackFront>,
    /// Where it meets the boundary.
    pub mouths: Mouths,
    /// What nothing can be seen through: the surface, carried on a little where its rim lies on the boundary.
    pub barrier: Vec<Triangle>,
}

/// The lines in which a crack meets the boundary.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mouths {
    /// Points on them.
    pub points: Vec<Vector3>,
    /// Straight pieces, in no order.
    pub pieces: Vec<MouthPiece>,
}

/// A straight piece of such a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MouthPiece {
    /// Indices of its end points.
    pub ends: [u32; 2],
    /// A triangle of the boundary that it lies on.
    pub triangle: u32,
}

/// What a place of the rim is to the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Position {
    Inside,
    OnBoundary,
    Outside,
}

/// A stretch of an edge of the rim.
#[derive(Clone, Copy, Debug)]
struct RimPiece {
    ends: [Vector3; 2],
    normals: [Vector3; 2],
    position: Position,
}

impl CrackSurface {
    /// Finds out what a crack is to a body.
    ///
    /// # Errors
    /// [`CrackDefect`] if the shape is none, or lies outside.
    pub fn new(shape: &CrackShape, body: &Surface) -> Result<Self, CrackDefect> {
        let surface = Surface::open(shape.mesh()?, FEATURE_ANGLE)?;
        let loops: Vec<Vec<RimPiece>> = rim_loops(&surface).iter().map(|l| pieces(&surface, l, body)).collect();
        let fronts: Vec<CrackFront> = loops.iter().flat_map(|l| fronts(l)).collect();
        let mut barrier: Vec<Triangle> = (0..surface.triangles().len() as u32).map(|t| surface.corners(t)).collect();
        for pieces in &loops {
            overhang(pieces, OVERHANG * body.bounds().size().norm(), &mut barrier);
        }
        let mouths = mouths(&barrier, body);
        if mouths.pieces.is_empty() && !body.contains(surface.vertices()[0]) {
            return Err(CrackDefect::Outside);
        }
        Ok(Self { surface, fronts, mouths, barrier })
    }

    /// Distance to the nearest front [length].
    pub fn front_distance(&self, p: Vector3) -> f64 {
        let to_segment = |[a, b]: [Vector3; 2]| {
            let e = b - a;
            let t = ((p - a).dot(&e) / e.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
            (p - a - e * t).norm()
        };
        self.fronts.iter().flat_map(CrackFront::segments).map(to_segment).fold(f64::INFINITY, f64::min)
    }
}

/// Vertices around each loop of the rim with their triangle, counterclockwise as seen from the positive side.
fn rim_loops(surface: &Surface) -> Vec<Vec<(u32, u32)>> {
    let mut next = vec![vec![]; surface.vertices().len()];
    for (t, corners) in surface.triangles().iter().enumerate() {
        for k in 0..3 {
            if surface.across(t as u32, k).is_none() {
                next[corners[k] as usize].push((corners[(k + 1) % 3], t as u32));
            }
        }
    }
    let mut loops = vec![];
    for start in 0..next.len() as u32 {
        while let Some((mut vertex, triangle)) = next[start as usize].pop() {
            let mut vertices = vec![(start, triangle)];
            while vertex != start {
                let Some((after, triangle)) = next[vertex as usize].pop() else { break };
                vertices.push((vertex, triangle));
                vertex = after;
            }
            loops.push(vertices);
        }
    }
    loops
}

/// The rim cut where it passes the boundary.
fn pieces(surface: &Surface, rim: &[(u32, u32)], body: &Surface) -> Vec<RimPiece> {
    let mut pieces = vec![];
    for k in 0..rim.len() {
        let (from, triangle) = rim[k];
        let (to, _) = rim[(k + 1) % rim.len()];
        let [a, b] = [from, to].map(|v| surface.vertices()[v as usize]);
        let mut cuts = vec![0.0];
        let at = |t: f64| a + (b - a) * t;
        let sample = |j: usize| (j as f64 + 0.5) / SAMPLES as f64;
        for j in 1..SAMPLES {
            let (s, t) = (sample(j - 1), sample(j));
            let before = position(body, at(s));
            if before != position(body, at(t)) {
                cuts.push(transition(s, t, |x| position(body, at(x)) == before));
            }
        }
        cuts.push(1.0);
        for w in cuts.windows(2) {
            let ends = [at(w[0]), at(w[1])];
            let normals = ends.map(|p| surface.normal_at(triangle, p));
            pieces.push(RimPiece { ends, normals, position: position(body, at(0.5 * (w[0] + w[1]))) });
        }
    }
    pass_straight_out(&mut pieces, body);
    pieces
}

/// A rim that leaves the body is within the tolerance of its boundary for a moment, which counts as inside.
fn pass_straight_out(pieces: &mut [RimPiece], body: &Surface) {
    let n = pieces.len();
    let is_on = |p: &RimPiece| p.position == Position::OnBoundary;
    let Some(start) = pieces.iter().position(|p| !is_on(p)) else { return };
    let mut k = start;
    while k < start + n {
        let run = (1..n).take_while(|j| is_on(&pieces[(k + j) % n])).count();
        let length: f64 = (1..=run).map(|j| pieces[(k + j) % n].ends).map(|[a, b]| (b - a).norm()).sum();
        let limit = PASSAGE * tolerance(body, &body.closest(pieces[(k + 1) % n].ends[0]));
        if run > 0 && length < limit && pieces[k % n].position != pieces[(k + run + 1) % n].position {
            (1..=run).for_each(|j| pieces[(k + j) % n].position = Position::Inside);
        }
        k += run + 1;
    }
}

/// What a place is to the body.
pub(super) fn position(body: &Surface, p: Vector3) -> Position {
    let foot = body.closest(p);
    if foot.distance <= tolerance(body, &foot) {
        Position::OnBoundary
    } else if body.is_behind(p, &foot) {
        Position::Inside
    } else {
        Position::Outside
    }
}

/// How near to the boundary a point counts as on it [length].
fn tolerance(body: &Surface, foot: &Foot) -> f64 {
    let round = match body.parts()[body.part_of(foot.triangle) as usize].shape {
        Shape::Triangles => 0.0,
        Shape::Cylinder { radius, .. } | Shape::Sphere { radius, .. } => ON_ROUND * radius,
    };
    round.max(ON_BOUNDARY * body.bounds().size().norm())
}

/// Where a condition that holds at `s` and not at `t` ceases to hold.
fn transition(mut s: f64, mut t: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..50 {
        let middle = 0.5 * (s + t);
        if holds(middle) { s = middle } else { t = middle }
    }
    0.5 * (s + t)
}

/// Joins the pieces inside the body.
fn fronts(pieces: &[RimPiece]) -> Vec<CrackFront> {
    let n = pieces.len();
    let is_front = |k: usize| pieces[k % n].position == Position::Inside;
    let make = |range: Vec<usize>, is_closed: bool| {
        let mut positions: Vec<Vector3> = range.iter().map(|k| pieces[k % n].ends[0]).collect();
        let mut normals: Vec<Vector3> = range.iter().map(|k| pieces[k % n].normals[0]).collect();
        if let (false, Some(last)) = (is_closed, range.last()) {
            positions.push(pieces[last % n].ends[1]);
            normals.push(pieces[last % n].normals[1]);
        }
        // The rim runs against the tangent `ahead × normal`.
        positions.reverse();
        normals.reverse();
        CrackFront::new(&positions, &normals, is_closed)
    };
    let Some(gap) = (0..n).find(|k| !is_front(*k)) else { return vec![make((0..n).collect(), true)] };
    let mut fronts = vec![];
    let mut run = vec![];
    for k in gap + 1..=gap + n {
        if is_front(k) {
            run.push(k);
        } else if !run.is_empty() {
            fronts.push(make(std::mem::take(&mut run), false));
        }
    }
    fronts
}

/// Carries the crack on beyond pieces of the rim that lie on the boundary.
fn overhang(pieces: &[RimPiece], reach: f64, barrier: &mut Vec<Triangle>) {
    let n = pieces.len();
    let along = |k: usize| (pieces[k % n].ends[1] - pieces[k % n].ends[0]).try_normalize(0.0).unwrap_or_default();
    let outward = |k: usize| along(k).cross(&pieces[k % n].normals[0]);
    let is_on = |k: usize| pieces[k % n].position == Position::OnBoundary;
    for k in (0..n).filter(|k| is_on(*k)) {
        let [a, b] = pieces[k].ends;
        let out = outward(k);
        // A neighbor that comes from inside goes on straight, so that the front meets the boundary without a kink.
        let straight = |neighbor: usize, direction: Vector3| {
            let rise = direction.dot(&out);
            if !is_on(neighbor) && rise > 0.3 { direction / rise } else { out }
        };
        let (p, q) = (a + straight(k + n - 1, along(k + n - 1)) * reach, b + straight(k + 1, -along(k + 1)) * reach);
        barrier.extend([[a, p, b], [b, p, q]]);
        // Fills the corner to the next piece on the boundary.
        if is_on(k + 1) && out.dot(&along(k + 1)) < -1e-9 {
            barrier.push([b, b + out * reach, b + outward(k + 1) * reach]);
        }
    }
}

/// Where the crack meets the boundary.
fn mouths(barrier: &[Triangle], body: &Surface) -> Mouths {
    let (mut ends, mut triangles) = (vec![], vec![]);
    for triangle in barrier {
        body.tree().visit(&bounds(*triangle), |t| {
            if let Some(found) = crossing(*triangle, body.corners(t)) {
                ends.extend(found);
                triangles.push(t);
            }
        });
    }
    let (points, index) = weld(&ends, SAME_POINT * body.bounds().size().norm());
    let (mut pieces, mut seen) = (vec![], FxHashSet::default());
    for (pair, triangle) in index.chunks_exact(2).zip(triangles) {
        // Where an edge lies on the line, both triangles at it tell the same piece.
        let ends = [pair[0].min(pair[1]), pair[0].max(pair[1])];
        if ends[0] != ends[1] && seen.insert(ends) {
            pieces.push(MouthPiece { ends, triangle });
        }
    }
    Mouths { points, pieces }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::aabb::Aabb;
    use crate::geometry::surface::makers::{cuboid, cylinder};
    use std::f64::consts::PI;

    fn v(x: f64, y: f64, z: f64) -> Vector3 {
        Vector3::new(x, y, z)
    }

    fn block() -> Surface {
        Surface::closed(cuboid(Aabb { lower: v(-10.0, 0.0, -10.0), upper: v(10.0, 4.0, 10.0) }), 0.5).unwrap()
    }

    fn mouth_length(crack: &CrackSurface) -> f64 {
        let at = |k: u32| crack.mouths.points[k as usize];
        crack.mouths.pieces.iter().map(|m| (at(m.ends[1]) - at(m.ends[0])).norm()).sum()
    }

    fn polygon(corners: &[[f64; 3]]) -> CrackShape {
        CrackShape::Polygon { corners: corners.iter().copied().map(Vector3::from).collect() }
    }

    #[test]
    fn a_disc_inside_is_all_front() {
        let normal = v(1.0, 2.0, 2.0) / 3.0;
        let center = v(1.0, 2.0, 0.5);
        let crack = CrackSurface::new(&CrackShape::disc(center, normal, 1.5), &block()).unwrap();
        assert!(crack.mouths.pieces.is_empty());
        let [front] = crack.fronts.as_slice() else { panic!() };
        assert!(front.is_closed && (front.length / (3.0 * PI) - 1.0).abs() < 1e-4);
        for p in front.points.iter().chain(&front.sampled(37)) {
            let outward = (p.position - center).normalize();
            assert!((p.ahead - outward).norm() < 1e-6 && (p.normal - normal).norm() < 1e-9);
            assert!((p.ahead.cross(&p.normal) - p.tangent).norm() < 1e-12);
            assert!((p.curvature * 1.5 - 1.0).abs() < 1e-9);
        }
        let apart = front.points[1].position - front.points[0].position;
        assert!(apart.dot(&front.points[0].tangent) > 0.0);
    }

    #[test]
    fn an_ellipse_bends_as_it_should() {
        let shape = CrackShape::Ellipse {
            center: v(0.0, 2.0, 0.0),
            normal: v(0.0, 1.0, 0.0),
            first_axis: v(1.0, 0.0, 0.0),
            radii: [4.0, 2.0],
        };
        let crack = CrackSurface::new(&shape, &block()).unwrap();
        for p in &crack.fronts[0].points {
            let (x, z) = (p.position.x, p.position.z);
            let gradient = v(x / 16.0, 0.0, z / 4.0);
            let curvature = (4.0 * 2.0f64).powi(-2) * (x * x / 256.0 + z * z / 16.0).powf(-1.5);
            assert!((p.ahead - gradient.normalize()).norm() < 2e-3);
            assert!((p.curvature / curvature - 1.0).abs() < 2e-3, "{} {curvature}", p.curvature);
        }
    }

    /// A through crack, with its rim on the boundary or beyond it.
    #[test]
    fn a_through_crack_has_one_straight_front() {
        for (far, side) in [(-10.0, 0.0), (-12.0, 1.0), (-10.0, 2.0)] {
            let corners = [[far, -side, 0.0], [0.0, -side, 0.0], [0.0, 4.0 + side, 0.0], [far, 4.0 + side, 0.0]];
            let crack = CrackSurface::new(&polygon(&corners), &block()).unwrap();
            let [front] = crack.fronts.as_slice() else { panic!("{} fronts", crack.fronts.len()) };
            assert!(!front.is_closed && (front.length - 4.0).abs() < 1e-4, "{}", front.length);
            assert!(front.points.iter().all(|p| (p.ahead - v(1.0, 0.0, 0.0)).norm() < 1e-9 && p.curvature == 0.0));
            // Along the left side and both sides of the crack.
            assert!((mouth_length(&crack) - 24.0).abs() < 1e-3, "{}", mouth_length(&crack));
            let sides = crack.fronts[0].segments().map(|[a, b]| (b - a).norm()).sum::<f64>();
            assert!((sides - front.length).abs() < 1e-12);
        }
    }

    #[test]
    fn half_a_disc_opens_at_the_surface() {
        let crack = CrackSurface::new(&CrackShape::disc(v(0.0, 0.0, 0.0), v(0.0, 0.0, 1.0), 2.0), &block()).unwrap();
        let [front] = crack.fronts.as_slice() else { panic!() };
        assert!(!front.is_closed && (front.length / (2.0 * PI) - 1.0).abs() < 1e-4);
        assert!((mouth_length(&crack) - 4.0).abs() < 1e-3, "{}", mouth_length(&crack));
        let ends = [front.points[0].position, front.points.last().unwrap().position];
        assert!(ends.iter().all(|p| p.y.abs() < 1e-4 && (p.x.abs() - 2.0).abs() < 1e-4));
    }

    #[test]
    fn cracks_in_a_shaft_end_at_its_side() {
        let names = ["side", "bottom", "top"];
        let shaft = Surface::closed(cylinder(v(0.0, 0.0, 0.0), v(0.0, 0.0, 6.0), 2.0, names), 0.5).unwrap();
        // All of the section on one side of x = 0.5, cut off exactly at the round side, or beyond it.
        let beyond = polygon(&[[0.5, -3.0, 3.0], [3.0, -3.0, 3.0], [3.0, 3.0, 3.0], [0.5, 3.0, 3.0]]);
        let limit = (0.25f64).acos();
        let mut corners: Vec<Vector3> = vec![];
        for k in 0..=40 {
            let angle = limit * (k as f64 / 20.0 - 1.0);
            corners.push(v(2.0 * angle.cos(), 2.0 * angle.sin(), 3.0));
        }
        for shape in [beyond, CrackShape::Polygon { corners }] {
            let crack = CrackSurface::new(&shape, &shaft).unwrap();
            let [front] = crack.fronts.as_slice() else { panic!("{} fronts", crack.fronts.len()) };
            let chord = 2.0 * (4.0 - 0.25f64).sqrt();
            assert!((front.length / chord - 1.0).abs() < 3e-3, "{} {chord}", front.length);
            let mouth = mouth_length(&crack);
            assert!((mouth / (4.0 * limit) - 1.0).abs() < 3e-3, "{mouth} {}", 4.0 * limit);
            assert!(front.points.iter().all(|p| (p.ahead - v(-1.0, 0.0, 0.0)).norm() < 1e-9));
        }
    }

    #[test]
    fn defects_are_named() {
        let far = CrackShape::disc(v(0.0, 50.0, 0.0), v(0.0, 0.0, 1.0), 2.0);
        assert_eq!(CrackSurface::new(&far, &block()).unwrap_err(), CrackDefect::Outside);
        let bent = polygon(&[[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 2.0, 0.5], [0.0, 2.0, 0.0]]);
        assert!(matches!(CrackSurface::new(&bent, &block()), Err(CrackDefect::NotPlane { .. })));
        let bow = polygon(&[[0.0, 1.0, 0.0], [2.0, 2.5, 0.0], [2.0, 1.0, 0.0], [0.0, 2.0, 0.0]]);
        assert!(matches!(CrackSurface::new(&bow, &block()), Err(CrackDefect::Crosses { .. })));
    }
}
