//! The plate [0, 20] x [0, 10] with holes of radius 1.5 at (6, 5) and (14, 5), saved by Gmsh.

use riss::case::gmsh::{GmshModel, read_gmsh};
use riss::geometry::polygon;
use riss::math::Vector2;
use riss::model::Domain;

pub const FILES: [&str; 6] = [
    "two-holes-22-ascii",
    "two-holes-22-binary",
    "two-holes-41-ascii",
    "two-holes-41-binary",
    "two-holes-41-second-order-quads",
    "two-holes-22-second-order-quads-binary",
];

pub fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(format!("{}/tests/data/{name}.msh", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

fn model(name: &str) -> GmshModel {
    read_gmsh(&bytes(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn check_plate(domain: &Domain, n_hole_edges: usize) {
    assert_eq!(domain.loops, [0..4, 4..4 + n_hole_edges, 4 + n_hole_edges..4 + 2 * n_hole_edges]);
    let part = |name: &str| domain.parts.iter().find(|p| p.name == name).unwrap();
    let names: Vec<_> = domain.parts.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["left", "right", "bottom", "top", "hole-1", "hole-2"]);
    for (name, middle) in [("left", (0.0, 5.0)), ("right", (20.0, 5.0)), ("bottom", (10.0, 0.0)), ("top", (10.0, 10.0))]
    {
        let [edge] = part(name).edges[..] else { panic!("{name} is not one edge") };
        assert!((domain.edges[edge].point(0.5) - Vector2::new(middle.0, middle.1)).norm() < 1e-12, "{name}");
    }
    for (name, center, edges) in [
        ("hole-1", Vector2::new(6.0, 5.0), 4..4 + n_hole_edges),
        ("hole-2", Vector2::new(14.0, 5.0), 4 + n_hole_edges..4 + 2 * n_hole_edges),
    ] {
        assert_eq!(part(name).edges, edges.clone().collect::<Vec<_>>());
        for edge in edges {
            assert!(((domain.edges[edge].point(0.0) - center).norm() - 1.5).abs() < 1e-9, "{name}");
        }
    }
    // Regular polygons in the holes.
    let n = n_hole_edges as f64;
    let hole = 0.5 * n * 1.5 * 1.5 * (std::f64::consts::TAU / n).sin();
    assert!((domain.area() - (200.0 - 2.0 * hole)).abs() < 1e-6, "area {}", domain.area());
}

#[test]
fn all_formats_give_the_same_domain() {
    let first = model(FILES[0]).into_domain().unwrap();
    check_plate(&first, 48);
    for name in &FILES[1..4] {
        let domain = model(name).into_domain().unwrap();
        assert_eq!(domain.loops, first.loops, "{name}");
        assert_eq!(domain.parts, first.parts, "{name}");
        for (a, b) in domain.edges.iter().zip(&first.edges) {
            // ASCII files have 16 digits.
            assert!((a.point(0.0) - b.point(0.0)).norm() < 1e-13, "{name}: {a:?}, {b:?}");
        }
    }
}

#[test]
fn midside_nodes_are_vertices_of_the_boundary() {
    let first = model(FILES[4]).into_domain().unwrap();
    check_plate(&first, first.loops[1].len());
    assert!(first.loops[1].len().is_multiple_of(2));
    let second = model(FILES[5]).into_domain().unwrap();
    assert_eq!((second.loops, second.parts), (first.loops, first.parts));
}

#[test]
fn cells_cover_the_body_counterclockwise() {
    for name in FILES {
        let model = model(name);
        let corners = |cell: &[u32]| cell.iter().map(|&v| model.vertices[v as usize]).collect::<Vec<_>>();
        let cells: Vec<_> =
            model.triangles.iter().map(|t| corners(t)).chain(model.quads.iter().map(|q| corners(q))).collect();
        assert!(cells.iter().all(|c| polygon::area(c) > 0.0));
        let covered: f64 = cells.iter().map(|c| polygon::area(c)).sum();
        // Corners only: cells of second order are a little off the circle.
        let difference = (covered - model.clone().into_domain().unwrap().area()).abs();
        assert!(difference < if model.quads.is_empty() { 1e-9 } else { 1.0 }, "{name}: {difference}");
    }
}
