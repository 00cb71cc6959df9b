//! Loops of edges from what the case says about outline and holes.

use super::boundary::{Boundary, Edge};
use super::report::Report;
use crate::case::files::Files;
use crate::case::schema::{Disk, Geometry, Hole, Outline, OutlineEdge, Point, Polygon, Rectangle, Turn};
use crate::geometry::curve::Curve;
use crate::math::Vector2;

/// The distances of an arc's ends from its center may differ by this fraction of the radius.
const RADIUS_MISMATCH: f64 = 1e-6;
/// An arc whose radius is larger than this times its length is straight.
const NEARLY_STRAIGHT: f64 = 1e5;

pub(super) fn vector(p: Point) -> Vector2 {
    Vector2::new(p[0], p[1])
}

/// Adds the outline; `None` if it has problems.
pub(super) fn add_outline(
    boundary: &mut Boundary,
    geometry: &Geometry,
    files: &Files,
    report: &mut Report,
) -> Option<()> {
    let edges = match geometry {
        Geometry::Rectangle(r) => rectangle(boundary, r, report)?,
        Geometry::Disk(d) => circle(boundary, d, "geometry.disk", "edge", report)?,
        Geometry::Polygon(p) => {
            let names = polygon_names(p, report)?;
            polygon(boundary, &p.corners, &names, "geometry.polygon.corners", report)?
        }
        Geometry::Outline(o) => outline(boundary, o, "geometry.outline", None, report)?,
        Geometry::Gmsh(file) => return super::mesh::add_mesh(boundary, &file.file, files, report),
        // The file was read with all that it says, and its body is added where that is at hand.
        Geometry::Abaqus(file) => {
            report.error("geometry.abaqus.file", format!("{} was not read", file.file));
            return None;
        }
    };
    boundary.push_loop(edges);
    Some(())
}

/// Adds hole number `index`; `None` if it has problems.
pub(super) fn add_hole(boundary: &mut Boundary, hole: &Hole, index: usize, report: &mut Report) -> Option<()> {
    let key = format!("hole[{index}]");
    let name = hole.name.clone().unwrap_or_else(|| format!("hole-{}", index + 1));
    if boundary.find_part(&name).is_some() || name == super::OUTLINE {
        report.error(format!("{key}.name"), format!("there is already a part named `{name}`"));
        return None;
    }
    let edges = match (&hole.circle, &hole.polygon, &hole.outline) {
        (Some(d), None, None) => circle(boundary, d, &format!("{key}.circle"), &name, report)?,
        (None, Some(corners), None) => {
            let names = vec![name; corners.len()];
            polygon(boundary, corners, &names, &format!("{key}.polygon"), report)?
        }
        (None, None, Some(o)) => outline(boundary, o, &format!("{key}.outline"), Some(&name), report)?,
        _ => {
            report.error(key, "a hole has one shape").allow("circle, polygon or outline");
            return None;
        }
    };
    boundary.push_loop(edges);
    Some(())
}

fn line(boundary: &mut Boundary, start: Vector2, end: Vector2, name: &str, key: String) -> Edge {
    Edge { curve: Curve::Line { start, end }, parts: vec![boundary.part(name)], key }
}

fn rectangle(boundary: &mut Boundary, r: &Rectangle, report: &mut Report) -> Option<Vec<Edge>> {
    let (lower, upper) = (vector(r.lower), vector(r.upper));
    if !(lower.x < upper.x && lower.y < upper.y) {
        report.error("geometry.rectangle.upper", "both coordinates must be greater than those of `lower`");
        return None;
    }
    let corners = [lower, Vector2::new(upper.x, lower.y), upper, Vector2::new(lower.x, upper.y)];
    let names = ["bottom", "right", "top", "left"];
    let edge = |k: usize| line(boundary, corners[k], corners[(k + 1) % 4], names[k], "geometry.rectangle.upper".into());
    Some((0..4).map(edge).collect())
}

fn circle(boundary: &mut Boundary, d: &Disk, key: &str, name: &str, report: &mut Report) -> Option<Vec<Edge>> {
    report.positive(format!("{key}.radius"), d.radius).then(|| {
        let curve = Curve::circle(vector(d.center), d.radius);
        vec![Edge { curve, parts: vec![boundary.part(name)], key: key.into() }]
    })
}

fn polygon_names(p: &Polygon, report: &mut Report) -> Option<Vec<String>> {
    let n = p.corners.len();
    let names = p.parts.clone().unwrap_or_else(|| (1..=n).map(|k| format!("edge-{k}")).collect());
    if names.len() != n {
        report.error("geometry.polygon.parts", format!("{} names for {n} edges", names.len()));
        return None;
    }
    check_reserved(&names, "geometry.polygon.parts", report)?;
    Some(names)
}

fn check_reserved(names: &[String], key: &str, report: &mut Report) -> Option<()> {
    let reserved = names.iter().any(|n| n == super::OUTLINE);
    if reserved {
        report.error(key, "the name `outline` is kept for all outer edges together");
    }
    (!reserved).then_some(())
}

fn polygon(
    boundary: &mut Boundary,
    corners: &[Point],
    names: &[String],
    key: &str,
    report: &mut Report,
) -> Option<Vec<Edge>> {
    let n = corners.len();
    if n < 3 {
        report.error(key, format!("a polygon has at least 3 corners, this one has {n}"));
        return None;
    }
    let edge = |k: usize| {
        let (start, end) = (vector(corners[k]), vector(corners[(k + 1) % n]));
        line(boundary, start, end, &names[k], format!("{key}[{k}]"))
    };
    Some((0..n).map(edge).collect())
}

/// A chain of edges; they all belong to `name` if it is given.
fn outline(
    boundary: &mut Boundary,
    outline: &Outline,
    key: &str,
    name: Option<&str>,
    report: &mut Report,
) -> Option<Vec<Edge>> {
    let mut edges = vec![];
    let mut names = vec![];
    let start = vector(outline.start);
    let mut from = start;
    let mut sound = true;
    for (k, edge) in outline.edges.iter().enumerate() {
        let own = edge.part.clone().unwrap_or_else(|| format!("edge-{}", k + 1));
        names.push(own.clone());
        let key = format!("{key}.edges[{k}]");
        match edge_curve(from, edge, &key, report) {
            Some(curve) => edges.push(Edge { curve, parts: vec![boundary.part(name.unwrap_or(&own))], key }),
            None => sound = false,
        }
        from = vector(edge.to);
    }
    check_reserved(&names, &format!("{key}.edges"), report)?;
    // Ends that differ by rounding only are joined later.
    if (from - start).norm() > 1e-12 * (from.norm() + start.norm()) {
        let own = format!("edge-{}", outline.edges.len() + 1);
        edges.push(line(boundary, from, start, name.unwrap_or(&own), format!("{key}.start")));
    }
    if sound && edges.is_empty() {
        report.error(format!("{key}.edges"), "an outline has edges");
        return None;
    }
    sound.then_some(edges)
}

fn edge_curve(from: Vector2, edge: &OutlineEdge, key: &str, report: &mut Report) -> Option<Curve> {
    let to = vector(edge.to);
    let curve = match (edge.through, edge.center, edge.turn) {
        (None, None, None) => Curve::Line { start: from, end: to },
        (Some(through), None, None) => match Curve::arc_through(from, vector(through), to) {
            Some(arc) => arc,
            None => {
                let message = "the arc's start, `through` and `to` lie on a line";
                report.error(format!("{key}.through"), message).suggest("leave `through` out for a straight edge");
                return None;
            }
        },
        (None, Some(center), Some(turn)) => arc_around(from, to, vector(center), turn, key, report)?,
        (None, Some(_), None) => {
            report
                .error(key, "an arc around a center needs `turn`")
                .allow("left (counterclockwise), right (clockwise)");
            return None;
        }
        _ => {
            report
                .error(key, "contradicting edge")
                .allow("`through`, or `center` with `turn`, or none for a straight edge");
            return None;
        }
    };
    if let Curve::Arc { radius, .. } = curve
        && (radius >= NEARLY_STRAIGHT * curve.length() || !radius.is_finite())
    {
        report.error(key, "this arc is as good as straight").suggest("write a straight edge");
        return None;
    }
    Some(curve)
}

fn arc_around(
    from: Vector2,
    to: Vector2,
    center: Vector2,
    turn: Turn,
    key: &str,
    report: &mut Report,
) -> Option<Curve> {
    let (r, s) = ((from - center).norm(), (to - center).norm());
    if (r - s).abs() > RADIUS_MISMATCH * r.max(s) {
        let message = format!("the ends of the arc are {r} and {s} away from the center");
        report.error(format!("{key}.center"), message).suggest("both distances are the radius");
        return None;
    }
    // The center moves onto the bisector of the chord, so that both ends are met exactly.
    let chord = to - from;
    let center = match chord.norm_squared() {
        c if c > 0.0 => center - chord * ((center - (from + to) * 0.5).dot(&chord) / c),
        _ => center,
    };
    Some(Curve::arc_around(center, from, to, turn == Turn::Left))
}
