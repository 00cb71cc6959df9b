//! Crack paths: ends put on the boundary or recognized as tips, everything between them inside the body; joined where they
//! meet.

use super::cohesive;
use super::crossings::{Segment, first_contact, folds_back};
use super::loads::{Tried, try_field};
use super::outline::vector;
use super::report::Report;
use crate::case::schema;
use crate::crack::meetings::{Meeting, join};
use crate::crack::{CrackPath, EndKind};
use crate::geometry::curve::Curve;
use crate::math::Vector2;
use crate::model::{CohesiveCrack, CrackFaceLoad, Domain, FieldPoint, ScalarField};

/// An end this close to the boundary, times the size of the body, lies on it.
const ON_BOUNDARY: f64 = 1e-6;
/// An end may stick out of the body by this times its size; it is clipped.
const OVERHANG: f64 = 0.05;
/// Turn of an arc in one segment [degrees].
const ARC_STEP: f64 = 2.0;
/// Stretches of each segment at whose ends a pressure is tried.
const PRESSURE_SAMPLES: usize = 8;
/// More points in one crack are refused.
const MAX_POINTS: usize = 20_000;

/// All cracks of a case.
pub(super) struct Cracks {
    pub paths: Vec<CrackPath>,
    pub face_loads: Vec<CrackFaceLoad>,
    /// What of each path is cohesive, if anything is.
    pub cohesive: Vec<Option<CohesiveCrack<2>>>,
    /// Whether any pressure on their faces differs from zero.
    pub acts: bool,
}

/// All cracks that are sound.
pub(super) fn cracks(list: &[schema::Crack], domain: &Domain, report: &mut Report) -> Cracks {
    let (mut loads, mut all_cohesive) = (vec![], vec![]);
    let mut acts = false;
    let size = domain.aabb().size().norm();
    let mut paths: Vec<(usize, CrackPath)> = vec![];
    let mut names: Vec<String> = vec![];
    for (index, crack) in list.iter().enumerate() {
        let key = format!("crack[{index}]");
        let name = crack.name.clone().unwrap_or_else(|| format!("crack-{}", index + 1));
        if names.contains(&name) {
            report.error(format!("{key}.name"), format!("there is already a crack named `{name}`"));
        }
        names.push(name.clone());
        let shape = vertices(crack, &key, domain, report);
        let points = shape.as_ref().map_or(&[][..], |s| &s.0);
        let pressure =
            crack.pressure.as_ref().and_then(|p| try_pressure(p, &format!("{key}.pressure"), points, report));
        let cohesive = cohesive::crack(crack, &key, report);
        let Some((vertices, key)) = shape else { continue };
        let mut builder = Builder { domain, size, key, vertices, ends: [EndKind::Tip; 2] };
        if builder.is_simple(report) && builder.place_ends(report) && builder.is_inside(report) {
            if let Some(pressure) = pressure.filter(|p| !matches!(p.field, ScalarField::Constant(0.0))) {
                acts |= pressure.largest > 0.0;
                loads.push(CrackFaceLoad { crack: paths.len(), pressure: pressure.field });
            }
            let notches = cohesive.as_ref().map_or(&[][..], |c| &c.notches);
            let vertices = cohesive::cut_at_notches(&builder.vertices, notches, builder.tolerance());
            paths.push((index, CrackPath { name, vertices, ends: builder.ends }));
            all_cohesive.push(cohesive);
        }
    }
    Cracks { paths: join_all(paths, size, report), face_loads: loads, cohesive: all_cohesive, acts }
}

/// A pressure that is finite along a path.
fn try_pressure(pressure: &schema::Scalar, key: &str, path: &[Vector2], report: &mut Report) -> Option<Tried> {
    let along = path
        .windows(2)
        .flat_map(|w| (0..=PRESSURE_SAMPLES).map(|k| w[0] + (w[1] - w[0]) * (k as f64 / PRESSURE_SAMPLES as f64)));
    try_field(pressure, key, along.map(|position| FieldPoint { position, normal: Vector2::zeros() }), report)
}

fn vertices(crack: &schema::Crack, key: &str, domain: &Domain, report: &mut Report) -> Option<(Vec<Vector2>, String)> {
    match (&crack.path, &crack.arc) {
        (Some(path), None) if path.len() > MAX_POINTS => {
            report.error(format!("{key}.path"), format!("{} points", path.len())).allow(format!("up to {MAX_POINTS}"));
            None
        }
        (Some(path), None) => Some((path.iter().map(|p| vector(*p)).collect(), format!("{key}.path"))),
        (None, Some(arc)) => Some((arc_vertices(arc, &format!("{key}.arc"), domain, report)?, format!("{key}.arc"))),
        _ => {
            report.error(key, "a crack has one shape").allow("path or arc");
            None
        }
    }
}

fn arc_vertices(arc: &schema::CrackArc, key: &str, domain: &Domain, report: &mut Report) -> Option<Vec<Vector2>> {
    let (start, end) = (vector(arc.start), vector(arc.end));
    let Some(curve @ Curve::Arc { center, sweep, radius, .. }) = Curve::arc_through(start, vector(arc.through), end)
    else {
        report.error(format!("{key}.through"), "start, through and end lie on a line").suggest("use `path`");
        return None;
    };
    let size = domain.aabb().size().norm();
    if radius >= 1e5 * size || !radius.is_finite() {
        report.error(key, "this arc is as good as straight").suggest("use `path`");
        return None;
    }
    let turn = sweep.abs().to_degrees();
    let mut step = ARC_STEP;
    if let Some(spacing) = arc.spacing {
        if !report.positive(format!("{key}.spacing"), spacing) {
            return None;
        }
        step = step.min(turn * spacing / curve.length());
    }
    let n = (turn / step).ceil();
    if n >= MAX_POINTS as f64 {
        report.error(format!("{key}.spacing"), format!("too fine: {n} segments")).allow(format!("up to {MAX_POINTS}"));
        return None;
    }
    // Along tangents that meet outside the arc, so that the first and last segment point as the arc does at its ends:
    // chords would be off by half a step, and K with them by the sine of that.
    let outward = 1.0 / (0.5 * sweep / n).cos();
    let corner = |k: usize| center + (curve.point((k as f64 + 0.5) / n) - center) * outward;
    Some(std::iter::once(start).chain((0..n as usize).map(corner)).chain([end]).collect())
}

/// A crack on its way to a [`CrackPath`].
struct Builder<'a> {
    domain: &'a Domain,
    size: f64,
    key: String,
    vertices: Vec<Vector2>,
    ends: [EndKind; 2],
}

impl Builder<'_> {
    fn tolerance(&self) -> f64 {
        ON_BOUNDARY * self.size
    }

    fn vertex_key(&self, k: usize) -> String {
        if self.key.ends_with("path") { format!("{}[{k}]", self.key) } else { self.key.clone() }
    }

    fn end_index(&self, end: usize) -> usize {
        if end == 0 { 0 } else { self.vertices.len() - 1 }
    }

    fn is_simple(&self, report: &mut Report) -> bool {
        let n = self.vertices.len();
        if n < 2 {
            report.error(self.key.clone(), format!("a crack has at least 2 points, this one has {n}"));
            return false;
        }
        let bounds = self.domain.aabb();
        if !self.vertices.iter().any(|p| (p - bounds.center()).amax() <= self.size) {
            report.error(self.key.clone(), "this crack lies outside the body");
            return false;
        }
        if let Some(k) = (1..n).find(|&k| (self.vertices[k] - self.vertices[k - 1]).norm() <= self.tolerance()) {
            report.error(self.vertex_key(k), "this point repeats the one before it");
            return false;
        }
        let segments = segments(&self.vertices, 0);
        let tolerance = self.tolerance();
        let contact = first_contact(&segments, tolerance, |i, j| j > i + 1).or_else(|| {
            (1..n - 1).map(|k| (k - 1, k)).find(|&(i, j)| folds_back(&segments[i], &segments[j], tolerance))
        });
        if let Some((_, j)) = contact {
            report.error(self.vertex_key(j), "the crack crosses or touches itself in the segment after this point");
        }
        contact.is_none()
    }

    /// Snaps, clips or accepts both ends.
    fn place_ends(&mut self, report: &mut Report) -> bool {
        let on_boundary = |p: &Vector2| self.domain.distance_to_boundary(*p) <= self.tolerance();
        if !self.vertices.iter().any(|p| self.domain.contains(*p) || on_boundary(p)) && self.cuts().is_empty() {
            report.error(self.key.clone(), "this crack lies outside the body");
            return false;
        }
        self.place_end(0, report) && self.place_end(1, report)
    }

    fn place_end(&mut self, end: usize, report: &mut Report) -> bool {
        let k = self.end_index(end);
        let inner = if end == 0 { 1 } else { k - 1 };
        let (p, q) = (self.vertices[k], self.vertices[inner]);
        if self.domain.distance_to_boundary(p) <= self.tolerance() {
            self.vertices[k] = snapped(self.domain, p);
            self.ends[end] = EndKind::Mouth;
            return true;
        }
        if self.domain.contains(p) {
            return true;
        }
        let cuts = self.domain.edges.iter().flat_map(|e| e.meetings(p, q, self.tolerance()));
        let first = cuts.fold(f64::INFINITY, f64::min);
        let mouth = p + (q - p) * first;
        let key = self.vertex_key(k);
        if !first.is_finite() || (mouth - q).norm() <= self.tolerance() {
            report.error(key, "this end of the crack lies outside the body");
            return false;
        }
        let overhang = (mouth - p).norm();
        if overhang > OVERHANG * self.size {
            let message = format!("this end of the crack lies outside the body, by {overhang:.4}");
            report.error(key, message).suggest(format!("end it on the boundary at [{}, {}]", mouth.x, mouth.y));
            return false;
        }
        self.vertices[k] = snapped(self.domain, mouth);
        self.ends[end] = EndKind::Mouth;
        let mouth = self.vertices[k];
        report.note(key, format!("this end of the crack is clipped at the boundary, at [{}, {}]", mouth.x, mouth.y));
        true
    }

    /// Meetings with the boundary: segment, point and edge.
    fn cuts(&self) -> Vec<(usize, Vector2, usize)> {
        let mut cuts = vec![];
        for (k, w) in self.vertices.windows(2).enumerate() {
            for (e, edge) in self.domain.edges.iter().enumerate() {
                let at = edge.meetings(w[0], w[1], self.tolerance());
                cuts.extend(at.into_iter().map(|s| (k, w[0] + (w[1] - w[0]) * s, e)));
            }
        }
        cuts
    }

    /// Whether the crack meets the boundary only at its mouths.
    fn is_inside(&self, report: &mut Report) -> bool {
        let on_boundary = |p: Vector2| self.domain.distance_to_boundary(p) <= self.tolerance();
        if let Some(k) = self.vertices.windows(2).position(|w| on_boundary((w[0] + w[1]) * 0.5)) {
            let along =
                [0.25, 0.75].iter().all(|&s| on_boundary(self.vertices[k] * (1.0 - s) + self.vertices[k + 1] * s));
            if along {
                report.error(
                    self.vertex_key(k),
                    "the crack runs along the boundary after this point; if that is a plane of symmetry, give the \
                     whole body: K and J are then those of the whole crack",
                );
                return false;
            }
        }
        let last = self.vertices.len() - 1;
        // Shallow mouths meet the boundary within a wider tolerance.
        let at_mouth = |p: Vector2| {
            [(0, 0), (1, last)].iter().any(|&(end, k)| {
                self.ends[end] == EndKind::Mouth && (p - self.vertices[k]).norm() <= 10.0 * self.tolerance()
            })
        };
        let cut = self.cuts().into_iter().find(|c| !at_mouth(c.1));
        let Some((k, p, edge)) = cut else {
            let middle = (self.vertices[0] + self.vertices[1]) * 0.5;
            if !self.domain.contains(middle) {
                report.error(self.key.clone(), "this crack lies outside the body");
                return false;
            }
            return true;
        };
        let message = match self.hole_of(edge) {
            Some(name) => format!("the crack passes through the hole `{name}` at ({:.6}, {:.6})", p.x, p.y),
            None => format!("the crack meets the boundary at ({:.6}, {:.6}), between its ends", p.x, p.y),
        };
        report.error(self.vertex_key(k), message).suggest("split it into two cracks that end there");
        false
    }

    fn hole_of(&self, edge: usize) -> Option<&str> {
        let is_outline = self.domain.outline().contains(&edge);
        let part = self.domain.parts.iter().find(|p| p.edges.contains(&edge))?;
        (!is_outline).then_some(part.name.as_str())
    }
}

/// The closest point of the boundary.
fn snapped(domain: &Domain, p: Vector2) -> Vector2 {
    let (edge, _) = domain.closest_edge(p);
    domain.on_edge(edge, p)
}

fn segments(vertices: &[Vector2], chain: usize) -> Vec<Segment> {
    let all = vertices.windows(2).enumerate();
    all.map(|(edge, w)| Segment { ends: (w[0], w[1]), chain, edge }).collect()
}

/// Joins cracks that meet; says where.
fn join_all(paths: Vec<(usize, CrackPath)>, size: f64, report: &mut Report) -> Vec<CrackPath> {
    let (keys, mut cracks): (Vec<usize>, Vec<CrackPath>) = paths.into_iter().unzip();
    match join(&mut cracks, ON_BOUNDARY * size) {
        Ok(meetings) => {
            for Meeting { place, cracks: met } in meetings {
                let others: Vec<String> =
                    met[..met.len() - 1].iter().map(|c| format!("`{}`", cracks[*c].name)).collect();
                let message = format!("this crack meets {} at ({:.6}, {:.6})", others.join(", "), place.x, place.y);
                report.note(format!("crack[{}]", keys[met[met.len() - 1]]), message);
            }
        }
        Err(overlap) => {
            let [a, b] = overlap.cracks;
            let message = format!("this crack runs along the crack `{}`", cracks[a].name);
            report
                .error(format!("crack[{}]", keys[b]), message)
                .suggest("leave out the stretch that both have in common");
        }
    }
    cracks
}
