//! Orientation, parts and stretches.

use super::{bad, good, template};
use riss::geometry::curve::Curve;
use riss::math::Vector2;
use riss::model::Domain;
use std::f64::consts::PI;

fn domain(geometry: &str) -> Domain {
    let mut template = template();
    template.geometry = geometry.into();
    good(&template).model.domain
}

/// The edges of a part by name.
fn edges<'a>(domain: &'a Domain, name: &str) -> Vec<&'a Curve> {
    let part = domain.parts.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no part {name}"));
    part.edges.iter().map(|&e| &domain.edges[e]).collect()
}

fn length(domain: &Domain, name: &str) -> f64 {
    edges(domain, name).iter().map(|e| e.length()).sum()
}

/// Consecutive edges meet, exactly where one of them is straight.
fn check_joints(domain: &Domain) {
    for range in &domain.loops {
        for e in range.clone() {
            let next = if e + 1 == range.end { range.start } else { e + 1 };
            let (p, q) = (domain.edges[e].point(1.0), domain.edges[next].point(0.0));
            let straight = [e, next].iter().any(|&k| matches!(domain.edges[k], Curve::Line { .. }));
            assert!((p - q).norm() <= if straight { 0.0 } else { 1e-14 * (1.0 + p.norm()) }, "{p} and {q}");
        }
    }
}

#[test]
fn rectangle_has_four_parts() {
    let domain = domain("[geometry.rectangle]\nlower = [0, 0]\nupper = [7, 16]\n");
    assert_eq!(domain.area(), 112.0);
    let normal = |name: &str| edges(&domain, name)[0].right_normal(0.5);
    assert_eq!(normal("left"), -Vector2::x());
    assert_eq!(normal("right"), Vector2::x());
    assert_eq!(normal("bottom"), -Vector2::y());
    assert_eq!(normal("top"), Vector2::y());
}

#[test]
fn direction_of_writing_does_not_matter() {
    for corners in ["[[0, 0], [2, 0], [0, 1]]", "[[0, 0], [0, 1], [2, 0]]"] {
        let domain = domain(&format!("[geometry.polygon]\ncorners = {corners}\nparts = ['a', 'b', 'c']\n"));
        assert_eq!(domain.area(), 1.0);
        check_joints(&domain);
        assert!((length(&domain, "b") - 5f64.sqrt()).abs() < 1e-15);
    }
}

#[test]
fn outline_of_lines_and_arcs() {
    // A quarter disk of radius 2, the same arc in three ways.
    for arc in [
        "{ to = [0, 2], through = [1.4142135623730951, 1.4142135623730951], part = 'arc' }",
        "{ to = [0, 2], center = [0, 0], turn = 'left', part = 'arc' }",
        "{ to = [0, 2], center = [1e-7, 0], turn = 'left', part = 'arc' }",
    ] {
        let domain = domain(&format!("[geometry.outline]\nstart = [0, 0]\nedges = [{{ to = [2, 0] }}, {arc}]\n"));
        assert!((domain.area() - PI).abs() < 1e-6, "{}", domain.area());
        assert_eq!(domain.edges.len(), 3);
        assert!((length(&domain, "arc") - PI).abs() < 1e-6);
        check_joints(&domain);
        assert!(domain.parts.iter().any(|p| p.name == "edge-3"));
    }
}

#[test]
fn outline_may_consist_of_arcs_only() {
    let edges = "{ to = [1, 0], through = [0, -1] }, { to = [-1, 0], through = [0, 1] }";
    let two = domain(&format!("[geometry.outline]\nstart = [-1, 0]\nedges = [{edges}]\n"));
    assert!((two.area() - PI).abs() < 1e-14 && two.edges.len() == 2);
    check_joints(&two);
    let one =
        domain("[geometry.outline]\nstart = [1, 0]\nedges = [{ to = [1, 0], center = [0, 0], turn = 'right' }]\n");
    assert!((one.area() - PI).abs() < 1e-14 && one.edges.len() == 1);
}

#[test]
fn holes_run_clockwise_and_have_their_name() {
    let hole = "[[hole]]\ncircle = { center = [3, 4], radius = 1 }\n\
                [[hole]]\nname = 'slot'\npolygon = [[2, 9], [4, 9], [4, 10], [2, 10]]\n";
    let domain = domain(&format!("[geometry.rectangle]\nlower = [0, 0]\nupper = [7, 16]\n{hole}"));
    assert!((domain.area() - (112.0 - PI - 2.0)).abs() < 1e-12);
    assert!(edges(&domain, "hole-1")[0].area_share() < 0.0);
    assert_eq!(edges(&domain, "slot").len(), 4);
    assert!(!domain.contains(Vector2::new(3.0, 9.5)) && domain.contains(Vector2::new(1.0, 9.5)));
    check_joints(&domain);
}

fn with_part(geometry: &str, part: &str) -> Domain {
    domain(&format!("{geometry}[[part]]\nname = 'grip'\n{part}\n"))
}

#[test]
fn stretch_of_a_straight_edge_in_either_order() {
    let rectangle = "[geometry.rectangle]\nlower = [0, 0]\nupper = [7, 16]\n";
    for ends in ["from = [2, 16]\nto = [5, 16]", "from = [5, 16]\nto = [2, 16]"] {
        let domain = with_part(rectangle, &format!("on = 'top'\n{ends}"));
        assert_eq!((domain.edges.len(), edges(&domain, "top").len()), (6, 3));
        assert_eq!((length(&domain, "grip"), length(&domain, "top")), (3.0, 7.0));
        assert_eq!(domain.area(), 112.0);
        check_joints(&domain);
    }
    let corner = with_part(rectangle, "on = 'top'\nfrom = [5, 16]\nto = [7, 16]");
    assert_eq!((corner.edges.len(), length(&corner, "grip")), (5, 2.0));
}

#[test]
fn stretch_of_a_circle_runs_counterclockwise() {
    let disk = "[geometry.disk]\ncenter = [0, 0]\nradius = 2\n";
    let quarter = with_part(disk, "on = 'edge'\nfrom = [2, 0]\nto = [0, 2]");
    assert!((length(&quarter, "grip") - PI).abs() < 1e-14);
    let rest = with_part(disk, "on = 'edge'\nfrom = [0, 2]\nto = [2, 0]");
    assert!((length(&rest, "grip") - 3.0 * PI).abs() < 1e-13);
    check_joints(&rest);
    let plate = "[geometry.rectangle]\nlower = [-5, -5]\nupper = [5, 5]\n\
                 [[hole]]\nname = 'bolt'\ncircle = { center = [0, 0], radius = 2 }\n";
    let upper = with_part(plate, "on = 'bolt'\nfrom = [1.4142, 1.4142]\nto = [-1.4142, 1.4142]");
    assert!((length(&upper, "grip") - PI).abs() < 1e-4);
    let middle = edges(&upper, "grip").iter().map(|e| e.point(0.5).y).fold(f64::INFINITY, f64::min);
    assert!(middle > 1.9);
    check_joints(&upper);
}

#[test]
fn stretches_over_several_edges_and_on_stretches() {
    let polygon =
        "[geometry.polygon]\ncorners = [[0, 0], [2, 0], [4, 0], [4, 4], [0, 4]]\nparts = ['b', 'b', 'r', 't', 'l']\n";
    let parts =
        "on = 'b'\nfrom = [1, 0]\nto = [3, 0]\n[[part]]\nname = 'inner'\non = 'grip'\nfrom = [1.5, 0]\nto = [2, 0]";
    let domain = with_part(polygon, parts);
    assert_eq!((length(&domain, "grip"), length(&domain, "inner"), length(&domain, "b")), (2.0, 0.5, 4.0));
    check_joints(&domain);
    let mut apart = template();
    apart.geometry = polygon.replace("'t'", "'b'") + "[[part]]\nname = 'grip'\non = 'b'\nfrom = [1, 0]\nto = [1, 4]\n";
    assert!(bad(&apart).contains("leaves the part"));
}
