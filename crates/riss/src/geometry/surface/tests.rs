//! Simple bodies and their voids.

use super::makers::{ball, cuboid, cylinder, unit_disc};
use super::*;
use crate::geometry::aabb::Aabb;
use crate::geometry::triangle::Feature;
use proptest::prelude::*;
use std::f64::consts::PI;

const SHARP: f64 = 0.5;

fn v(x: f64, y: f64, z: f64) -> Vector3 {
    Vector3::new(x, y, z)
}

fn block() -> TriangleMesh {
    cuboid(Aabb { lower: v(0.0, 0.0, 0.0), upper: v(1.0, 2.0, 3.0) })
}

fn with(mut outer: TriangleMesh, voids: &[TriangleMesh]) -> Surface {
    voids.iter().for_each(|m| outer.append(m));
    Surface::closed(outer, SHARP).unwrap()
}

#[test]
fn a_box_has_twelve_edges_and_eight_corners() {
    let surface = with(block(), &[]);
    assert_eq!((surface.vertices().len(), surface.n_patches()), (8, 6));
    assert_eq!((surface.chains().len(), surface.corner_vertices().len()), (12, 8));
    assert!((surface.volume() - 6.0).abs() < 1e-14 && (surface.area(None) - 22.0).abs() < 1e-14);
    assert_eq!(surface.parts()[5].name, "z-max");
    assert!((surface.area(Some(5)) - 2.0).abs() < 1e-15);
}

#[test]
fn normals_point_out_of_the_body_however_triangles_run() {
    let mut mesh = block();
    mesh.append(&ball(v(0.5, 1.0, 1.5), 0.3, "void"));
    for k in [0, 3, 12, 13, 500] {
        mesh.triangles[k].swap(0, 1);
    }
    let surface = Surface::closed(mesh, SHARP).unwrap();
    let middle = v(0.5, 1.0, 1.5);
    for t in 0..surface.triangles().len() as u32 {
        let at = surface.corners(t).iter().sum::<Vector3>() / 3.0;
        let is_void = surface.parts()[surface.part_of(t) as usize].name == "void";
        let outward = (at - middle).dot(&surface.normals()[t as usize]);
        assert!(if is_void { outward < 0.0 } else { outward > 0.0 });
    }
    // The triangles of the void are inscribed: a little too small.
    let sphere = 4.0 / 3.0 * PI * 0.027;
    assert!(surface.volume() > 6.0 - sphere && surface.volume() < 6.0 - 0.99 * sphere);
}

#[test]
fn a_cylinder_has_two_edges_and_no_corner() {
    let surface = with(cylinder(v(0.0, 0.0, 1.0), v(0.0, 0.0, 3.0), 0.5, ["side", "bottom", "top"]), &[]);
    assert_eq!((surface.chains().len(), surface.corner_vertices().len(), surface.n_patches()), (2, 0, 3));
    assert!(surface.chains().iter().all(|c| c.vertices.first() == c.vertices.last() && !c.is_rim));
    assert!((surface.volume() / (PI * 0.5) - 1.0).abs() < 1e-3);
    let foot = surface.closest(v(0.3, 0.4, 2.0));
    assert!((surface.normal_at(foot.triangle, v(0.3, 0.4, 2.0)) - v(0.6, 0.8, 0.0)).norm() < 1e-15);
    assert_eq!(surface.hollowness(foot.triangle), 0.0);
}

#[test]
fn voids_are_hollow() {
    let surface = with(block(), &[ball(v(0.5, 1.0, 1.5), 0.25, "void")]);
    let foot = surface.closest(v(0.5, 1.0, 1.2));
    assert_eq!(surface.hollowness(foot.triangle), 4.0);
    // The same from triangles alone, whose curvature is that of the angles between them.
    let mut mesh = surface.mesh();
    mesh.parts.iter_mut().for_each(|p| p.shape = Shape::Triangles);
    let surface = Surface::closed(mesh, SHARP).unwrap();
    let found = surface.hollowness(surface.closest(v(0.5, 1.0, 1.2)).triangle);
    assert!(found > 2.0 && found < 5.0, "{found}");
}

#[test]
fn discs_are_filled_with_triangles_that_turn_the_same_way() {
    for n in [16, 96, 256] {
        let (points, triangles) = unit_disc(n);
        let twice = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|k| points[k as usize]);
            crate::math::cross(b - a, c - a)
        };
        assert!(triangles.iter().all(|t| twice(t) > 0.0));
        let area = 0.5 * triangles.iter().map(twice).sum::<f64>();
        let polygon = 0.5 * n as f64 * (2.0 * PI / n as f64).sin();
        assert!((area - polygon).abs() < 1e-13);
    }
}

#[test]
fn defects_are_named() {
    let mut mesh = block();
    mesh.triangles.pop();
    mesh.part_of.pop();
    assert!(matches!(Surface::closed(mesh, SHARP), Err(SurfaceDefect::NotClosed { .. })));
    let mut mesh = block();
    mesh.push([v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(0.5, -1.0, -1.0)], 0);
    assert!(matches!(Surface::closed(mesh, SHARP), Err(SurfaceDefect::Branches { .. })));
    assert_eq!(Surface::open(TriangleMesh::default(), SHARP).unwrap_err(), SurfaceDefect::Empty);
    let mut mesh = block();
    mesh.vertices[3].y = f64::NAN;
    assert_eq!(Surface::closed(mesh, SHARP).unwrap_err(), SurfaceDefect::NotFinite { vertex: 3 });
}

#[test]
fn wedges_tell_what_meets_at_a_point() {
    let surface = with(block(), &[]);
    let at = |p: Vector3| {
        let foot = surface.closest(p);
        (foot.feature, surface.wedges(&foot, p))
    };
    let total = |w: &[Wedge]| w.iter().map(Wedge::angle).sum::<f64>();
    let (feature, wedges) = at(v(0.3, 0.9, 3.1));
    assert_eq!(feature, Feature::Face);
    assert!((total(&wedges) - 2.0 * PI).abs() < 1e-12 && wedges.iter().all(|w| w.normal == v(0.0, 0.0, 1.0)));
    let (_, wedges) = at(v(1.1, 0.9, 3.1));
    assert!((total(&wedges) - 2.0 * PI).abs() < 1e-12);
    let top: Vec<_> = wedges.iter().filter(|w| w.part == 5).copied().collect();
    assert!((total(&top) - PI).abs() < 1e-12);
    let (_, wedges) = at(v(1.1, 2.1, 3.1));
    assert!((total(&wedges) - 1.5 * PI).abs() < 1e-12);
    // Half of the half turn on top is left above a plane across the edge.
    let half: f64 = top.iter().filter_map(|w| w.above(v(0.0, 1.0, 0.0))).map(|w| w.angle()).sum();
    assert!((half - 0.5 * PI).abs() < 1e-12);
    let slanted: f64 = top.iter().filter_map(|w| w.above(v(0.0, 0.6, -0.8))).map(|w| w.angle()).sum();
    assert!((slanted - 0.5 * PI).abs() < 1e-12);
}

proptest! {
    #[test]
    fn signed_distance_to_a_box_is_the_closed_form(p in proptest::array::uniform3(-1.0..4.0f64)) {
        let (surface, p) = (with(block(), &[]), Vector3::from(p));
        let outside = (v(0.0, 0.0, 0.0) - p).sup(&(p - v(1.0, 2.0, 3.0)));
        let exact = outside.sup(&Vector3::zeros()).norm() + outside.max().min(0.0);
        prop_assert!((surface.signed_distance(p) - exact).abs() < 1e-12);
        prop_assert_eq!(surface.contains(p), exact < 0.0);
    }
}
