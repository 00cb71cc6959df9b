//! Crack surfaces of a solid.

use super::schema::{SolidCrack, SolidFile};
use super::stl::read_stl;
use crate::case::build::report::Report;
use crate::case::files::Files;
use crate::crack::{CrackShape, CrackSurface};
use crate::geometry::surface::Surface;
use crate::math::Vector3;
use crate::model::{CohesiveCrack, VectorField};

/// All cracks of a case.
#[derive(Default)]
pub(super) struct Cracks {
    pub names: Vec<String>,
    pub surfaces: Vec<CrackSurface>,
    pub faces: Vec<VectorField<3>>,
    pub cohesive: Vec<Option<CohesiveCrack<3>>>,
    /// Whether one is under pressure.
    pub acts: bool,
}

pub(super) fn cracks(file: &SolidFile, body: &Surface, files: &Files, report: &mut Report) -> Cracks {
    let mut cracks = Cracks::default();
    for (index, crack) in file.crack.iter().enumerate() {
        let key = format!("crack[{index}]");
        let name = crack.name.clone().unwrap_or_else(|| format!("crack-{}", index + 1));
        if cracks.names.contains(&name) {
            report.error(format!("{key}.name"), format!("there is already a crack named `{name}`"));
        }
        let Some((kind, shape)) = shape(crack, &key, files, report) else { continue };
        let surface = match CrackSurface::new(&shape, body) {
            Ok(surface) => surface,
            Err(defect) => {
                report.error(format!("{key}.{kind}"), defect.to_string());
                continue;
            }
        };
        if let Some(other) = cracks.surfaces.iter().position(|c| meet(c, &surface)) {
            let message = format!("meets crack `{}`; cracks must not meet", cracks.names[other]);
            report.error(format!("{key}.{kind}"), message);
            continue;
        }
        let pressure = crack.pressure.unwrap_or(0.0);
        cracks.acts |= pressure != 0.0;
        cracks.faces.push(if pressure == 0.0 { VectorField::zero() } else { VectorField::pressure(pressure) });
        cracks.cohesive.push(super::cohesive::crack(crack, &key, report));
        cracks.names.push(name);
        cracks.surfaces.push(surface);
    }
    cracks
}

/// Whether triangles of two cracks cut each other.
fn meet(a: &CrackSurface, b: &CrackSurface) -> bool {
    b.barrier.iter().any(|t| {
        let mut found = false;
        a.surface.tree().visit(&crate::geometry::triangle::bounds(*t), |k| {
            found = found || crate::geometry::triangle::crossing(a.surface.corners(k), *t).is_some();
        });
        found
    })
}

/// The shape with its key.
fn shape(crack: &SolidCrack, key: &str, files: &Files, report: &mut Report) -> Option<(&'static str, CrackShape)> {
    match (&crack.disc, &crack.ellipse, &crack.polygon, &crack.stl) {
        (Some(disc), None, None, None) => {
            let normal = unit(disc.normal, &format!("{key}.disc.normal"), report);
            let sound = report.positive(format!("{key}.disc.radius"), disc.radius);
            let shape = CrackShape::disc(Vector3::from(disc.center), normal?, disc.radius);
            sound.then_some(("disc", shape))
        }
        (None, Some(e), None, None) => {
            let normal = unit(e.normal, &format!("{key}.ellipse.normal"), report)?;
            let axis = Vector3::from(e.axis);
            let axis = unit((axis - normal * axis.dot(&normal)).into(), &format!("{key}.ellipse.axis"), report);
            let sound = e.radii.iter().all(|r| report.positive(format!("{key}.ellipse.radii"), *r));
            let center = Vector3::from(e.center);
            let shape = CrackShape::Ellipse { center, normal, first_axis: axis?, radii: e.radii };
            sound.then_some(("ellipse", shape))
        }
        (None, None, Some(corners), None) if corners.len() >= 3 => {
            let corners = corners.iter().copied().map(Vector3::from).collect();
            Some(("polygon", CrackShape::Polygon { corners }))
        }
        (None, None, Some(corners), None) => {
            report.error(format!("{key}.polygon"), format!("{} corners, at least 3 are needed", corners.len()));
            None
        }
        (None, None, None, Some(file)) => {
            let key = format!("{key}.stl");
            match read_stl(&report.known(&key, files.bytes(file))?) {
                Ok(mesh) => Some(("stl", CrackShape::Triangles(mesh))),
                Err(message) => {
                    report.error(key, message);
                    None
                }
            }
        }
        _ => {
            report.error(key, "a crack has one shape").allow("one of `disc`, `ellipse`, `polygon`, `stl`");
            None
        }
    }
}

/// A direction of length one.
pub(super) fn unit(direction: [f64; 3], key: &str, report: &mut Report) -> Option<Vector3> {
    let unit = Vector3::from(direction).try_normalize(1e-12);
    if unit.is_none() {
        report.error(key, "is no direction");
    }
    unit
}
