//! Clouds of simple bodies: how many nodes, how far apart, what they stand on, what they see.

use super::*;
use crate::crack::CrackShape;
use crate::geometry::aabb::Aabb;
use crate::geometry::obstacles::Opaque;
use crate::geometry::surface::makers::{ball, cuboid, cylinder};
use crate::geometry::tree::BoxTree;
use crate::math::Vector3;
use crate::nodes::cloud::{Facet, Place, Side, SurfaceId};
use std::f64::consts::PI;

fn v(x: f64, y: f64, z: f64) -> Vector3 {
    Vector3::new(x, y, z)
}

struct Body {
    surface: Surface,
    cracks: Vec<CrackSurface>,
    spacing: SolidSpacing,
    solid: SolidCloud,
}

impl Body {
    fn new(mesh: crate::geometry::surface::TriangleMesh, shapes: &[CrackShape], h: f64, at_front: f64) -> Self {
        Self::with_fronts(mesh, shapes, h, at_front, NodesOnFronts::None)
    }

    fn with_fronts(
        mesh: crate::geometry::surface::TriangleMesh,
        shapes: &[CrackShape],
        h: f64,
        at_front: f64,
        fronts: NodesOnFronts,
    ) -> Self {
        let surface = Surface::closed(mesh, 0.5).unwrap();
        let cracks: Vec<_> = shapes.iter().map(|s| CrackSurface::new(s, &surface).unwrap()).collect();
        let pieces = cracks.iter().flat_map(|c| &c.fronts).flat_map(|f| f.segments().collect::<Vec<_>>());
        let spacing = SolidSpacing::new(h, 0.2, pieces.map(|s| (Region::Segment(s), at_front)).collect());
        let solid = generate_solid(&surface, &cracks, &spacing, fronts).unwrap();
        Self { surface, cracks, spacing, solid }
    }

    /// The least distance of two nodes that are no pair over the mean of their spacings.
    fn least_distance(&self) -> f64 {
        let cloud = &self.solid.cloud;
        let tree = BoxTree::of_points(&cloud.positions);
        let mut least = f64::INFINITY;
        for (i, (p, h)) in cloud.positions.iter().zip(&cloud.spacings).enumerate() {
            tree.visit(&Aabb::around(*p, Vector3::repeat(*h)), |j| {
                let (q, k) = (cloud.positions[j as usize], cloud.spacings[j as usize]);
                if j as usize > i && *p != q {
                    least = least.min((p - q).norm() / (0.5 * (h + k)));
                }
            });
        }
        least
    }

    /// The largest distance from a place of the body to the nearest node over the spacing, among random places.
    fn largest_gap(&self) -> f64 {
        let cloud = &self.solid.cloud;
        let (tree, bounds) = (BoxTree::of_points(&cloud.positions), self.surface.bounds());
        let mut largest = 0.0f64;
        for i in 0..20_000 {
            let share = Vector3::from_fn(|d, _| sites::scatter(i, d as u64 + 9));
            let p = bounds.lower + bounds.size().component_mul(&share);
            if self.surface.contains(p) {
                let h = self.spacing.at(p);
                let mut nearest = f64::INFINITY;
                let query = Aabb::around(p, Vector3::repeat(2.0 * h));
                tree.visit(&query, |j| nearest = nearest.min((cloud.positions[j as usize] - p).norm()));
                largest = largest.max(nearest / h);
            }
        }
        largest
    }

    fn facets(&self) -> impl Iterator<Item = (usize, &Facet<3>)> {
        let of = |(i, place)| match place {
            &Place::Inside => vec![],
            Place::Surface(facets) | Place::Front { facets, .. } => facets.iter().map(|f| (i, f)).collect(),
        };
        self.solid.cloud.places.iter().enumerate().flat_map(of)
    }

    /// What must hold for any cloud.
    fn check(&self) {
        let cloud = &self.solid.cloud;
        assert!(self.least_distance() > 0.8 - 1e-9, "{}", self.least_distance());
        assert!(self.largest_gap() < 1.0, "{}", self.largest_gap());
        let obstacles = solid_obstacles(&self.surface, &self.cracks);
        for (i, facet) in self.facets() {
            assert!((facet.normal.norm() - 1.0).abs() < 1e-12 && facet.angle > 0.0);
            let (p, h) = (cloud.positions[i], cloud.spacings[i]);
            let inward = facet.sight - p;
            assert!(inward.dot(&facet.normal) < 0.0 && inward.norm() < 0.5 * h);
            assert!((cloud.sights[i] - p).dot(&facet.normal) < 0.0 || matches!(cloud.places[i], Place::Front { .. }));
        }
        for pair in &self.solid.pairs {
            let [a, b] = pair.nodes.map(|k| k as usize);
            assert_eq!(cloud.positions[a], cloud.positions[b]);
            assert!(!obstacles.visible(cloud.sights[a], cloud.sights[b]));
            let face = |k: usize, side: Side| {
                let id = SurfaceId::Face { crack: pair.crack, side };
                let Place::Surface(facets) = &cloud.places[k] else { panic!() };
                facets.iter().find(|f| f.surface == id).expect("the face").normal
            };
            assert!((face(a, Side::Positive) + face(b, Side::Negative)).norm() < 1e-9);
        }
        let n_faces = self.facets().filter(|(_, f)| matches!(f.surface, SurfaceId::Face { .. })).count();
        let n_fronts = cloud.places.iter().filter(|p| matches!(p, Place::Front { .. })).count();
        assert_eq!(n_faces, 2 * (self.solid.pairs.len() + n_fronts));
    }
}

fn cube() -> crate::geometry::surface::TriangleMesh {
    cuboid(Aabb { lower: v(0.0, 0.0, 0.0), upper: v(1.0, 1.0, 1.0) })
}

#[test]
fn a_cube_gets_as_many_nodes_as_a_grid() {
    let body = Body::new(cube(), &[], 0.08, 1.0);
    body.check();
    let count = |n: usize| {
        let of = |p: &&Place<3>| matches!(p, Place::Surface(f) if f.len() == n);
        body.solid.cloud.places.iter().filter(of).count()
    };
    // Corners; 12 edges of 12.5 spacings; 6 faces; what is left inside.
    assert_eq!((count(3), count(2)), (8, 12 * 12));
    let on_faces = 6.0 * 11.5 * 11.5;
    assert!((count(1) as f64 / on_faces - 1.0).abs() < 0.1, "{}", count(1));
    let inside = body.solid.cloud.len() - count(1) - count(2) - count(3);
    assert!((inside as f64 / 11.5f64.powi(3) - 1.0).abs() < 0.05, "{inside}");
    for (i, facet) in body.facets() {
        let SurfaceId::Part(part) = facet.surface else { panic!() };
        let (axis, end) = (part as usize / 2, part % 2);
        assert_eq!(body.solid.cloud.positions[i][axis], f64::from(end));
        assert_eq!(facet.normal[axis], if end == 1 { 1.0 } else { -1.0 });
    }
    let angles: f64 = body.facets().map(|(_, f)| f.angle).sum();
    let all = count(1) as f64 * 2.0 * PI + count(2) as f64 * 2.0 * PI + 8.0 * 1.5 * PI;
    assert!((angles / all - 1.0).abs() < 1e-12);
}

#[test]
fn voids_and_round_sides_get_nodes_with_exact_normals() {
    let mut mesh = cuboid(Aabb { lower: v(-2.0, -2.0, -2.0), upper: v(2.0, 2.0, 2.0) });
    mesh.append(&ball(v(0.0, 0.0, 0.0), 1.0, "void"));
    let body = Body::new(mesh, &[], 0.25, 1.0);
    body.check();
    let mut n = 0;
    for (i, facet) in body.facets().filter(|(_, f)| f.surface == SurfaceId::Part(6)) {
        let p = body.solid.cloud.positions[i];
        assert!((p.norm() - 1.0).abs() < 1e-12 && (facet.normal + p).norm() < 1e-12);
        n += 1;
    }
    assert!((n as f64 / (4.0 * PI * 16.0) - 1.0).abs() < 0.1, "{n}");
    // Neighbors along the void see each other, those on its far side do not.
    let cloud = &body.solid.cloud;
    let on_void: Vec<usize> = body.facets().filter(|(_, f)| f.surface == SurfaceId::Part(6)).map(|(i, _)| i).collect();
    let obstacles = solid_obstacles(&body.surface, &[]);
    for (i, j) in on_void.iter().flat_map(|i| on_void.iter().map(move |j| (*i, *j))).filter(|(i, j)| i < j) {
        let apart = (cloud.positions[i] - cloud.positions[j]).norm();
        let sees = obstacles.visible(cloud.sights[i], cloud.sights[j]);
        assert!(if apart < 0.75 { sees } else { apart < 1.5 || !sees }, "{apart}");
    }
}

#[test]
fn a_through_crack_splits_what_it_passes() {
    let corners = vec![v(-0.5, 0.0, 0.5), v(0.52, 0.0, 0.5), v(0.52, 1.0, 0.5), v(-0.5, 1.0, 0.5)];
    let body = Body::new(cube(), &[CrackShape::Polygon { corners }], 0.1, 0.1);
    body.check();
    let cloud = &body.solid.cloud;
    let mut n_mouth = 0;
    for pair in &body.solid.pairs {
        let p = cloud.positions[pair.nodes[0] as usize];
        assert!((p.z - 0.5).abs() < 1e-15 && p.x <= 0.47 + 1e-7);
        let parts = |k: u32| match &cloud.places[k as usize] {
            Place::Surface(facets) => facets.iter().filter(|f| matches!(f.surface, SurfaceId::Part(_))).collect(),
            Place::Inside | Place::Front { .. } => vec![],
        };
        n_mouth += usize::from(!parts(pair.nodes[0]).is_empty());
        for k in pair.nodes {
            let on_edge = p.x == 0.0 && (p.y == 0.0 || p.y == 1.0);
            let expected = if on_edge { 2 } else { usize::from(p.x == 0.0 || p.y == 0.0 || p.y == 1.0) };
            assert_eq!(parts(k).len(), expected, "{p:?}");
            // Half the circle on a face, a quarter on an edge.
            let angle = if on_edge { 0.5 * PI } else { PI };
            assert!(parts(k).iter().all(|f| (f.angle - angle).abs() < 1e-9));
        }
    }
    // Ten spacings along x = 0; half a spacing less than 5.2, which is about five, along both sides.
    assert_eq!(n_mouth, 9 + 2 + 2 * 5);
}

#[test]
fn a_penny_has_nodes_on_both_faces_but_none_on_its_front() {
    let (center, normal) = (v(0.05, 0.0, 0.1), v(0.6, 0.0, 0.8));
    let mesh = || cuboid(Aabb { lower: v(-2.0, -2.0, -2.0), upper: v(2.0, 2.0, 2.0) });
    let body = Body::new(mesh(), &[CrackShape::disc(center, normal, 1.0)], 0.4, 0.08);
    body.check();
    for pair in &body.solid.pairs {
        let p = body.solid.cloud.positions[pair.nodes[0] as usize] - center;
        assert!(p.dot(&normal).abs() < 1e-12 && p.norm() < 1.0 - 0.039);
    }
    for p in &body.solid.cloud.positions {
        assert!(body.cracks[0].front_distance(*p) > 0.039);
    }
    let body = Body::with_fronts(mesh(), &[CrackShape::disc(center, normal, 1.0)], 0.4, 0.08, NodesOnFronts::Single);
    body.check();
    let n = body.solid.cloud.places.iter().filter(|p| matches!(p, Place::Front { .. })).count();
    assert_eq!(n, (2.0 * PI / 0.08).round() as usize);
}

#[test]
fn cracks_reach_the_round_side_of_a_shaft() {
    let mesh = cylinder(v(0.0, 0.0, -2.0), v(0.0, 0.0, 2.0), 1.0, ["side", "bottom", "top"]);
    let corners = vec![v(0.3, -2.0, 0.0), v(2.0, -2.0, 0.0), v(2.0, 2.0, 0.0), v(0.3, 2.0, 0.0)];
    let body = Body::new(mesh, &[CrackShape::Polygon { corners }], 0.15, 0.1);
    body.check();
    let cloud = &body.solid.cloud;
    let n_side = body.facets().filter(|(_, f)| f.surface == SurfaceId::Part(0)).count();
    assert!(n_side > 300);
    for (i, facet) in body.facets().filter(|(_, f)| f.surface == SurfaceId::Part(0)) {
        let p = cloud.positions[i];
        assert!((p.xy().norm() - 1.0).abs() < 1e-12 && (facet.normal - v(p.x, p.y, 0.0)).norm() < 1e-9);
    }
}

/// A cone starts at the hollow wall of a void: sights are lifted over the bend of either, and must neither leave
/// the body nor come to the other side of the crack.
#[test]
fn mouths_of_bent_cracks_on_hollow_walls_look_into_the_body() {
    let mut mesh = cuboid(Aabb { lower: v(-4.0, -4.0, -4.0), upper: v(4.0, 4.0, 4.0) });
    mesh.append(&cylinder(v(0.0, 0.0, -1.0), v(0.0, 0.0, 1.0), 1.0, ["wall", "floor", "roof"]));
    const N: u32 = 24;
    let vertices = (0..2 * N).map(|k| {
        let (sin, cos) = (2.0 * PI * f64::from(k / 2) / f64::from(N)).sin_cos();
        let along = if k % 2 == 0 { -0.3 } else { 1.2 };
        let r = 1.0 + 0.8 * along;
        v(r * cos, r * sin, 0.6 * along)
    });
    let around = |k: u32| [2 * k, 2 * k + 1, 2 * ((k + 1) % N), 2 * ((k + 1) % N) + 1];
    let cone = crate::geometry::surface::TriangleMesh {
        vertices: vertices.collect(),
        triangles: (0..N)
            .flat_map(|k| {
                let [a, b, c, d] = around(k);
                [[a, b, d], [a, d, c]]
            })
            .collect(),
        part_of: vec![0; 2 * N as usize],
        parts: vec![crate::geometry::surface::Part {
            name: "cone".into(),
            shape: crate::geometry::surface::Shape::Triangles,
        }],
    };
    let body = Body::new(mesh, &[CrackShape::Triangles(cone)], 0.4, 0.3);
    body.check();
    let cloud = &body.solid.cloud;
    let is_mouth = |i: &usize| {
        let Place::Surface(facets) = &cloud.places[*i] else { return false };
        facets.iter().any(|f| f.surface == SurfaceId::Part(6))
    };
    let mouths: Vec<usize> =
        body.solid.pairs.iter().flat_map(|p| p.nodes.map(|i| i as usize)).filter(is_mouth).collect();
    assert!(mouths.len() > 20);
    let obstacles = solid_obstacles(&body.surface, &body.cracks);
    for (i, facet) in body.facets().filter(|(i, _)| mouths.contains(i)) {
        assert!(body.surface.contains(facet.sight), "{} {facet:?}", cloud.positions[i]);
        assert!(obstacles.visible(cloud.sights[i], facet.sight), "{} {facet:?}", cloud.positions[i]);
    }
}

#[test]
fn the_same_request_gives_the_same_bits() {
    let make = || Body::new(cube(), &[CrackShape::disc(v(0.5, 0.5, 0.5), v(0.0, 0.6, 0.8), 0.2)], 0.15, 0.05);
    let (a, b) = (make().solid.cloud, make().solid.cloud);
    assert_eq!((a.positions, a.sights, a.places), (b.positions, b.sights, b.places));
}

#[test]
fn absurd_spacings_are_refused_at_once() {
    let surface = Surface::closed(cube(), 0.5).unwrap();
    for h in [1e-3, 1e-9, 1e-200] {
        let error = generate_solid(&surface, &[], &SolidSpacing::uniform(h), NodesOnFronts::None).unwrap_err();
        assert!(error.to_string().contains("at most 3000000"), "{error}");
    }
}

/// A cylinder with a blind hole, by its profile turned around the z axis.
fn cup() -> crate::geometry::surface::TriangleMesh {
    let profile = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.5, 2.0), (0.5, 1.0), (0.0, 1.0)];
    let n = 40;
    let mut mesh = crate::geometry::surface::TriangleMesh::default();
    for (k, w) in profile.windows(2).enumerate() {
        let part = mesh.add_part(&format!("{k}"), crate::geometry::surface::Shape::Triangles);
        let at = |(r, z): (f64, f64), i: usize| {
            let (sin, cos) = (2.0 * PI * (i % n) as f64 / n as f64).sin_cos();
            v(r * cos, r * sin, z)
        };
        for i in 0..n {
            let [a, b, c, d] = [at(w[0], i), at(w[0], i + 1), at(w[1], i + 1), at(w[1], i)];
            if a != b {
                mesh.push([a, b, c], part);
            }
            if c != d {
                mesh.push([a, c, d], part);
            }
        }
    }
    mesh
}

#[test]
fn on_the_edge_at_the_ground_of_a_hole_each_surface_looks_at_its_own_side() {
    let body = Body::new(cup(), &[], 0.1, 0.1);
    let cloud = &body.solid.cloud;
    let on_edge = |p: &Vector3| (p.z - 1.0).abs() < 1e-9 && p.xy().norm() > 0.49 && p.xy().norm() < 0.51;
    let nodes: Vec<usize> = (0..cloud.len()).filter(|i| on_edge(&cloud.positions[*i])).collect();
    assert!(nodes.len() > 25);
    for i in nodes {
        let Place::Surface(facets) = &cloud.places[i] else { panic!("it is on the boundary") };
        let [one, other] = &facets[..] else { panic!("two surfaces meet there, not {}", facets.len()) };
        for (a, b) in [(one, other), (other, one)] {
            let inward = b.sight - cloud.positions[i];
            assert!(inward.dot(&a.normal) > 0.3 * inward.norm() && inward.dot(&b.normal) < 0.0);
        }
    }
}
