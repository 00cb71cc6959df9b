//! The body: its outer surface, its voids, and its named parts.

use super::schema::{SolidBall, SolidBox, SolidCylinder, SolidFile, SolidGeometry, SolidMeshFile};
use super::stl::read_stl;
use crate::case::build::boxes::bounds;
use crate::case::build::report::Report;
use crate::case::files::Files;
use crate::case::gmsh::read_gmsh_surface;
use crate::geometry::aabb::Aabb;
use crate::geometry::surface::makers::{ball, cuboid, cylinder};
use crate::geometry::surface::{Part, Shape, Surface, TriangleMesh};
use crate::math::Vector3;

/// The name that stands for all of the boundary.
pub(super) const BOUNDARY: &str = "boundary";
/// Angle between triangles from which an edge is sharp, if the case says none [degrees].
const FEATURE_ANGLE: f64 = 30.0;
/// A part may leave its box by this share of the size of the body.
const OFF_BOX: f64 = 1e-9;

/// The surface of the body; `None` if it has problems.
pub(super) fn body(file: &SolidFile, files: &Files, report: &mut Report) -> Option<Surface> {
    let (mut mesh, key, angle) = match &file.geometry {
        SolidGeometry::Box(b) => (boxed(b, "geometry.box", report)?, "geometry.box", FEATURE_ANGLE),
        SolidGeometry::Cylinder(c) => {
            let names = ["side", "bottom", "top"];
            (round(c, "geometry.cylinder", names, report)?, "geometry.cylinder", FEATURE_ANGLE)
        }
        SolidGeometry::Ball(b) => (sphere(b, "geometry.ball", "surface", report)?, "geometry.ball", FEATURE_ANGLE),
        SolidGeometry::Stl(f) => {
            (from_file(f, files, "geometry.stl.file", read_stl, report)?, "geometry.stl.file", angle(f))
        }
        SolidGeometry::Gmsh(f) => {
            let read = |bytes: &[u8]| read_gmsh_surface(bytes).map_err(|e| e.to_string());
            (from_file(f, files, "geometry.gmsh.file", read, report)?, "geometry.gmsh.file", angle(f))
        }
    };
    for (index, void) in file.void.iter().enumerate() {
        mesh.append(&add_void(void, index, report)?);
    }
    let mut surface = closed(mesh, angle, key, report)?;
    if matches!(file.geometry, SolidGeometry::Stl(_)) {
        surface = closed(by_patches(&surface), angle, key, report)?;
    }
    if file.part.is_empty() {
        return Some(surface);
    }
    let mesh = named_parts(file, &surface, report)?;
    closed(mesh, angle, "part", report)
}

fn angle(file: &SolidMeshFile) -> f64 {
    file.feature_angle.unwrap_or(FEATURE_ANGLE)
}

fn closed(mesh: TriangleMesh, angle: f64, key: &str, report: &mut Report) -> Option<Surface> {
    Surface::closed(mesh, angle.to_radians()).map_err(|e| report.error(key, e.to_string()).key.clone()).ok()
}

fn boxed(b: &SolidBox, key: &str, report: &mut Report) -> Option<TriangleMesh> {
    bounds(b.lower, b.upper, key, report).map(cuboid)
}

fn round(c: &SolidCylinder, key: &str, names: [&str; 3], report: &mut Report) -> Option<TriangleMesh> {
    let (from, to) = (Vector3::from(c.from), Vector3::from(c.to));
    if from == to {
        report.error(format!("{key}.to"), "both ends of the cylinder are the same point");
        return None;
    }
    report.positive(format!("{key}.radius"), c.radius).then(|| cylinder(from, to, c.radius, names))
}

fn sphere(b: &SolidBall, key: &str, name: &str, report: &mut Report) -> Option<TriangleMesh> {
    report.positive(format!("{key}.radius"), b.radius).then(|| ball(Vector3::from(b.center), b.radius, name))
}

fn from_file(
    file: &SolidMeshFile,
    files: &Files,
    key: &str,
    read: impl Fn(&[u8]) -> Result<TriangleMesh, String>,
    report: &mut Report,
) -> Option<TriangleMesh> {
    let bytes = report.known(key, files.bytes(&file.file))?;
    read(&bytes).map_err(|message| report.error(key, message).key.clone()).ok()
}

/// The surface of a void, in one part.
fn add_void(void: &super::schema::Void, index: usize, report: &mut Report) -> Option<TriangleMesh> {
    let key = format!("void[{index}]");
    let name = void.name.clone().unwrap_or_else(|| format!("void-{}", index + 1));
    match (&void.ball, &void.cylinder, &void.cuboid) {
        (Some(b), None, None) => sphere(b, &format!("{key}.ball"), &name, report),
        (None, Some(c), None) => round(c, &format!("{key}.cylinder"), [&name, &name, &name], report),
        (None, None, Some(b)) => {
            let mut mesh = boxed(b, &format!("{key}.box"), report)?;
            mesh.parts = vec![Part { name, shape: Shape::Triangles }];
            mesh.part_of.iter_mut().for_each(|p| *p = 0);
            Some(mesh)
        }
        _ => {
            report.error(key, "a void has one shape").allow("one of `ball`, `cylinder`, `box`");
            None
        }
    }
}

/// Every smooth piece as a part of its own; the largest comes first.
fn by_patches(surface: &Surface) -> TriangleMesh {
    let n = surface.n_patches() as usize;
    let mut areas = vec![0.0; n];
    for (t, _) in surface.triangles().iter().enumerate() {
        let corners = surface.corners(t as u32);
        areas[surface.patch_of(t as u32) as usize] += crate::geometry::triangle::area_vector(corners).norm();
    }
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| areas[*b].total_cmp(&areas[*a]).then(a.cmp(b)));
    let mut rank = vec![0; n];
    order.iter().enumerate().for_each(|(r, p)| rank[*p] = r as u32);
    let mut mesh = surface.mesh();
    // Voids keep their shapes and names.
    let is_file = |t: usize| surface.part_of(t as u32) == 0;
    let others: Vec<Part> = mesh.parts[1..].to_vec();
    let of_file: std::collections::BTreeSet<u32> =
        (0..mesh.triangles.len()).filter(|t| is_file(*t)).map(|t| rank[surface.patch_of(t as u32) as usize]).collect();
    let number: std::collections::BTreeMap<u32, u32> = of_file.iter().zip(0..).map(|(r, k)| (*r, k)).collect();
    for t in 0..mesh.triangles.len() {
        mesh.part_of[t] = match number.get(&rank[surface.patch_of(t as u32) as usize]) {
            Some(k) if is_file(t) => *k,
            _ => mesh.part_of[t] - 1 + number.len() as u32,
        };
    }
    let name = |k: usize| Part { name: format!("face-{}", k + 1), shape: Shape::Triangles };
    mesh.parts = (0..number.len()).map(name).chain(others).collect();
    mesh
}

/// Gives triangles inside boxes a part of their own.
fn named_parts(file: &SolidFile, surface: &Surface, report: &mut Report) -> Option<TriangleMesh> {
    let mut mesh = surface.mesh();
    let near = Vector3::repeat(OFF_BOX * surface.bounds().size().norm());
    let mut is_sound = true;
    for (index, part) in file.part.iter().enumerate() {
        let key = format!("part[{index}]");
        if part.name == BOUNDARY || mesh.parts.iter().any(|p| p.name == part.name) {
            report.error(format!("{key}.name"), format!("there is already a part named `{}`", part.name));
            is_sound = false;
            continue;
        }
        let (lower, upper) = (Vector3::from(part.within.lower) - near, Vector3::from(part.within.upper) + near);
        let within = Aabb { lower, upper };
        let chosen: Vec<usize> = (0..mesh.triangles.len())
            .filter(|t| mesh.triangles[*t].iter().all(|v| within.contains(&mesh.vertices[*v as usize])))
            .collect();
        let Some(first) = chosen.first() else {
            report.error(format!("{key}.within"), "no triangle of the boundary lies in this box");
            is_sound = false;
            continue;
        };
        // One new part for each part that triangles come from, since their shapes may differ.
        let shape = mesh.parts[mesh.part_of[*first] as usize].shape;
        if chosen.iter().any(|t| mesh.parts[mesh.part_of[*t] as usize].shape != shape) {
            report.error(format!("{key}.within"), "the box holds pieces of differently shaped parts");
            is_sound = false;
            continue;
        }
        let new = mesh.add_part(&part.name, shape);
        chosen.iter().for_each(|t| mesh.part_of[*t] = new);
    }
    is_sound.then_some(mesh)
}
