//! What fuzzing runs: functions that take any bytes, and assert what must hold of what riss makes of them.
//!
//! The targets of `cargo fuzz` call them, and so does `crates/riss/tests/fuzz.rs`, on any toolchain.

use riss::adaptivity::Quadtree;
use riss::case::{AnyCase, Case, CaseErrors};
use riss::crack::{CrackShape, CrackSurface};
use riss::geometry::aabb::Aabb;
use riss::geometry::surface::makers::cuboid;
use riss::geometry::surface::{Shape, Surface, TriangleMesh};
use riss::geometry::{polygon as polygons, predicates as plane, triangle as space};
use riss::math::{Vector2, Vector3};
use riss::model::FieldPoint;
use std::path::Path;

/// Case files do not lie beside anything that they could read.
const NOWHERE: &str = "no-such-folder/case.toml";
/// Angle from which edges are sharp [rad].
const SHARP: f64 = 0.5;

/// A case file, and overrides behind NUL bytes.
pub fn case_file(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let mut pieces = text.split('\0');
    let case = pieces.next().unwrap_or_default();
    let overrides: Vec<String> = pieces.take(8).map(String::from).collect();
    match AnyCase::parse(case, Path::new(NOWHERE), &overrides) {
        Ok(_) => {}
        Err(errors) => check_errors(&errors),
    }
}

fn check_errors(errors: &CaseErrors) {
    assert!(!errors.problems.is_empty() && !errors.to_string().is_empty());
    for problem in &errors.problems {
        assert!(!problem.message.is_empty());
        let text = match problem.origin {
            riss::case::Origin::File => &errors.text,
            riss::case::Origin::Override(k) => &errors.overrides[k],
        };
        let span = problem.span.clone().unwrap_or(0..0);
        assert!(span.start <= span.end && span.end <= text.len().max(1), "{problem}");
    }
}

/// A mesh of Gmsh, as a plane body and as a surface in space.
pub fn msh(bytes: &[u8]) {
    if let Ok(model) = riss::case::gmsh::read_gmsh(bytes) {
        let n = model.vertices.len();
        assert!(model.boundary.iter().flatten().all(|e| (e.start as usize) < n && (e.end as usize) < n));
        let _ = model.into_domain();
    }
    if let Ok(mesh) = riss::case::gmsh::read_gmsh_surface(bytes) {
        ask_surface(mesh);
    }
}

/// An input file of Abaqus or CalculiX.
pub fn inp(bytes: &[u8]) {
    match riss::case::read_abaqus_as_case(bytes, Path::new("body.inp")) {
        Ok((text, _)) => {
            // Its mesh is not there, and nothing else may be wrong with the case.
            let errors = Case::parse(&text, Path::new(NOWHERE), &[]).map(|_| ()).expect_err("there is no mesh");
            assert!(errors.problems.iter().all(|p| p.key == "geometry.abaqus.file"), "{errors}\n{text}");
        }
        Err(message) => assert!(!message.is_empty()),
    }
}

/// Triangles of an STL file.
pub fn stl(bytes: &[u8]) {
    if let Ok(mesh) = riss::case::read_stl(bytes) {
        ask_surface(mesh);
    }
}

/// A traction that a text gives, asked for its value.
pub fn expression(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    // What TOML itself would take for an end of the text or an escape is not what this is about.
    let text: String = text.chars().filter(|c| *c != '\'' && !c.is_control()).collect();
    let case = format!(
        "rigid_motion = 'mean-is-zero'\nmaterial = {{ young = 1, poisson = 0.3, plane = 'strain' }}\n\
         geometry.rectangle = {{ lower = [0, 0], upper = [2, 1] }}\nload = [{{ on = 'top', traction = ['{text}', 0] }}]"
    );
    match Case::parse(&case, Path::new(NOWHERE), &[]) {
        Ok(case) => {
            for load in &case.model.loads {
                let at = FieldPoint { position: Vector2::new(0.5, 1.0), normal: Vector2::new(0.0, 1.0) };
                let (one, two) =
                    (load.value.traction(&case.model.material, &at), load.value.traction(&case.model.material, &at));
                assert!(one.x.to_bits() == two.x.to_bits() && one.y == 0.0);
            }
        }
        Err(errors) => check_errors(&errors),
    }
}

/// Any polygon, clipped by the halves of a box around it.
pub fn polygon(bytes: &[u8]) {
    let mut input = Input(bytes);
    let corners: Vec<Vector2> = (0..40).map_while(|_| input.point2()).collect();
    let bounds = Aabb::of_points(corners.iter().copied());
    let whole = polygons::area(&corners);
    let _ = (polygons::is_convex(&corners), polygons::self_crossing(&corners));
    if corners.is_empty() {
        return;
    }
    let middle = bounds.center();
    let _ = polygons::contains(&corners, middle);
    assert!(!polygons::contains(&corners, bounds.upper + Vector2::repeat(1.0 + bounds.upper.amax())));
    let left = Aabb { lower: bounds.lower, upper: Vector2::new(middle.x, bounds.upper.y) };
    let right = Aabb { lower: Vector2::new(middle.x, bounds.lower.y), upper: bounds.upper };
    let mut sum = 0.0;
    for half in [left, right] {
        let piece = polygons::clipped(&corners, &half);
        assert!(piece.iter().all(|p| half.contains(p)), "{piece:?} leaves {half:?}");
        sum += polygons::area(&piece);
    }
    let scale = bounds.size().x * bounds.size().y * corners.len() as f64;
    // Positions far from the origin are known to so many digits only.
    let digits = 1e-14 * bounds.upper.amax().max(bounds.lower.amax()) * bounds.size().amax() * corners.len() as f64;
    assert!((sum - whole).abs() <= 1e-9 * scale + digits + f64::MIN_POSITIVE, "{sum} for {whole} of {corners:?}");
}

/// Segments and triangles: what must not depend on the order of their corners.
pub fn predicates(bytes: &[u8]) {
    let mut input = Input(bytes);
    if let [Some(a), Some(b), Some(c), Some(d)] = [(); 4].map(|()| input.point2()) {
        let turn = plane::orientation(a, b, c);
        assert_eq!(sign(turn), sign(plane::orientation(b, c, a)));
        assert_eq!(sign(turn), -sign(plane::orientation(b, a, c)));
        let crosses = plane::segments_cross(a, b, c, d);
        assert_eq!(crosses, plane::segments_cross(b, a, c, d));
        assert_eq!(crosses, plane::segments_cross(c, d, a, b));
        assert!(!crosses || plane::segment_is_cut(a, b, c, d));
        assert!(plane::distance_between_segments(a, b, c, d) >= 0.0);
    }
    let mut corner = || input.point3();
    if let [Some(a), Some(b), Some(c), Some(d), Some(e), Some(f)] = [(); 6].map(|()| corner()) {
        let volume = space::orientation3(a, b, c, d);
        assert_eq!(sign(volume), sign(space::orientation3(b, c, a, d)));
        assert_eq!(sign(volume), -sign(space::orientation3(b, a, c, d)));
        assert_eq!(space::cuts_segment([a, b, c], d, e), space::cuts_segment([a, b, c], e, d));
        assert_eq!(space::cuts_segment([a, b, c], d, e), space::cuts_segment([b, c, a], d, e));
        let _ = space::crossing([a, b, c], [d, e, f]);
        let (foot, _) = space::closest([a, b, c], d);
        let nearest_corner = [a, b, c].map(|p| (p - d).norm()).into_iter().fold(f64::INFINITY, f64::min);
        let size = [a, b, c, d].map(|p| p.norm()).into_iter().fold(0.0, f64::max);
        assert!((foot - d).norm() <= nearest_corner + 1e-6 * size, "{foot} of {a} {b} {c} for {d}");
    }
}

/// A quadtree that is split and joined: its squares cover the box once, balanced.
pub fn quadtree(bytes: &[u8]) {
    let mut input = Input(bytes);
    let (Some(first), Some(second), Some(part)) = (input.point2(), input.point2(), input.byte()) else { return };
    let bounds = Aabb::of_points([first, second]);
    let size = bounds.size();
    if !(size.min() > 1e-3 * size.max() && size.max() > 0.0) {
        return;
    }
    let mut tree = Quadtree::uniform(&bounds, size.max() / f64::from(1 + part % 6));
    let area = |tree: &Quadtree| tree.leaves().iter().map(|s| tree.size(*s).powi(2)).sum::<f64>();
    let whole = area(&tree);
    for _ in 0..24 {
        let (Some(x), Some(y), Some(action)) = (input.byte(), input.byte(), input.byte()) else { break };
        let share = Vector2::new(f64::from(x), f64::from(y)) / 255.0;
        let Some(leaf) = tree.leaf_at(bounds.lower + size.component_mul(&share)) else {
            panic!("no square at {share} of the box");
        };
        match (action % 4, leaf.parent()) {
            (0..=2, _) => drop(tree.refine(&[leaf])),
            (_, Some(parent)) => drop(tree.coarsen(&parent.children())),
            (_, None) => drop(tree.coarsen(&tree.leaves())),
        }
        assert!((area(&tree) - whole).abs() <= 1e-12 * whole);
    }
}

/// Triangles as a surface, as a body, and as a crack in a cube; polygons as cracks.
pub fn surface(bytes: &[u8]) {
    let mut input = Input(bytes);
    let points: Vec<Vector3> = (0..60).map_while(|_| input.point3()).collect();
    let mut mesh = TriangleMesh::default();
    let part = mesh.add_part("any", Shape::Triangles);
    for corners in points.chunks_exact(3) {
        mesh.push([corners[0], corners[1], corners[2]], part);
    }
    ask_surface(mesh.clone());
    let cube = Surface::closed(cuboid(Aabb { lower: Vector3::repeat(-2.0), upper: Vector3::repeat(2.0) }), SHARP);
    let cube = cube.expect("a cube is a body");
    for shape in [CrackShape::Triangles(mesh), CrackShape::Polygon { corners: points.into_iter().take(8).collect() }] {
        if let Ok(crack) = CrackSurface::new(&shape, &cube) {
            for front in &crack.fronts {
                assert!(front.length > 0.0);
                let p = front.at(0.3 * front.length);
                assert!(p.position.iter().chain(p.ahead.iter()).chain(p.normal.iter()).all(|x| x.is_finite()), "{p:?}");
            }
            assert!(!crack.front_distance(Vector3::zeros()).is_nan());
        }
    }
}

/// Builds a surface and asks it whatever is asked of surfaces.
fn ask_surface(mesh: TriangleMesh) {
    // What is asked takes time in proportion, and shows nothing more.
    if mesh.triangles.len() > 3000 {
        return;
    }
    for surface in [Surface::closed(mesh.clone(), SHARP), Surface::open(mesh, SHARP)].into_iter().flatten() {
        let bounds = surface.bounds();
        for p in [bounds.center(), bounds.upper + bounds.size(), surface.vertices()[0]] {
            let foot = surface.closest(p);
            assert!((foot.triangle as usize) < surface.triangles().len());
            let _ =
                (surface.contains(p), surface.cuts(p, bounds.lower), surface.locate(p, 1e-9 * bounds.size().norm()));
            let _ = surface.normal_at(foot.triangle, foot.position);
        }
        assert!(!surface.area(None).is_nan() && !surface.volume().is_nan());
    }
}

fn sign(v: f64) -> i8 {
    i8::from(v > 0.0) - i8::from(v < 0.0)
}

/// Bytes as coordinates.
struct Input<'a>(&'a [u8]);

impl Input<'_> {
    fn byte(&mut self) -> Option<u8> {
        let (first, rest) = self.0.split_first()?;
        self.0 = rest;
        Some(*first)
    }

    /// On a coarse grid mostly, where ties are; any number of modest size else.
    fn coordinate(&mut self) -> Option<f64> {
        let tag = self.byte()?;
        if tag < 200 || self.0.len() < 8 {
            return Some((f64::from(tag) - 100.0) / 32.0);
        }
        let (raw, rest) = self.0.split_at(8);
        self.0 = rest;
        let value = f64::from_le_bytes(raw.try_into().expect("eight bytes"));
        // Exact signs need room in the exponent.
        Some(if value.abs() < 1e30 && value.abs() > 1e-30 { value } else { 0.0 })
    }

    fn point2(&mut self) -> Option<Vector2> {
        Some(Vector2::new(self.coordinate()?, self.coordinate()?))
    }

    fn point3(&mut self) -> Option<Vector3> {
        Some(Vector3::new(self.coordinate()?, self.coordinate()?, self.coordinate()?))
    }
}
