//! Cracks of solids for other programs: CSV of fronts with their factors, VTK and STL of surfaces.

use super::report::solid_scene::Scenes;
use super::solid_results::{FrontResults, SolidResults};
use super::solid_writer::solid_restart_state;
use super::vtk::{Array, triangles};
use crate::math::Vector3;
use std::fmt::Write;
use std::io;
use std::path::Path;

/// A file for the cracks of a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolidCrackFormat {
    /// One row for each point of each front, with its factors.
    Csv,
    /// Triangles for ParaView.
    Vtp,
    /// Triangles for CAD.
    Stl,
}

/// A crack as a surface.
struct CrackTriangles {
    name: String,
    vertices: Vec<Vector3>,
    triangles: Vec<[u32; 3]>,
}

/// The cracks in a folder of results, at the end or in a step; none if the folder holds nothing of such a step.
///
/// # Errors
/// What the system says; `InvalidData` if a file is none of ours.
pub fn solid_cracks_as(
    format: SolidCrackFormat,
    dir: &Path,
    results: &SolidResults,
    step: Option<usize>,
) -> io::Result<Option<Vec<u8>>> {
    Ok(match format {
        SolidCrackFormat::Csv => fronts(results, step).map(fronts_csv).transpose()?,
        SolidCrackFormat::Vtp => surfaces(dir, results, step)?.map(|c| vtp(&c)),
        SolidCrackFormat::Stl => surfaces(dir, results, step)?.map(|c| stl(&c).into_bytes()),
    })
}

fn fronts(results: &SolidResults, step: Option<usize>) -> Option<&[FrontResults]> {
    match step {
        None => Some(&results.fronts),
        Some(step) => results.steps.iter().find(|s| s.step == step).map(|s| &s.fronts[..]),
    }
}

fn fronts_csv(fronts: &[FrontResults]) -> io::Result<Vec<u8>> {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(vec![]);
    writer.write_record(["crack", "front", "s", "x", "y", "z", "K_I", "K_II", "K_III", "K_uncertainty", "T", "J"])?;
    for (k, front) in fronts.iter().enumerate() {
        let number = fronts[..k].iter().filter(|f| f.crack == front.crack).count();
        for p in &front.points {
            let [x, y, z] = p.position;
            writer.serialize((
                &front.crack,
                number,
                p.s,
                [x, y, z],
                [p.k1, p.k2, p.k3, p.k_uncertainty, p.t_stress, p.j],
            ))?;
        }
    }
    writer.into_inner().map_err(|e| e.into_error())
}

/// Those that grew as they grew; others between their nodes.
fn surfaces(dir: &Path, results: &SolidResults, step: Option<usize>) -> io::Result<Option<Vec<CrackTriangles>>> {
    let Some(last) = results.steps.last() else {
        let scenes = Scenes::read(dir)?;
        let names = results.cracks.iter().map(|c| c.name.clone());
        let of = scenes.surfaces(step).map(|all| all.into_iter().zip(names));
        let crack = |((vertices, triangles), name)| CrackTriangles { name, vertices, triangles };
        return Ok(of.map(|all| all.map(crack).collect()));
    };
    let wanted = step.unwrap_or(last.step);
    let Some(found) = results.steps.iter().find(|s| s.step == wanted) else { return Ok(None) };
    let state = solid_restart_state(dir, wanted)?;
    let crack = |(crack, named): (&crate::crack::GrowingCrack, &super::solid_results::SolidStepCrack)| CrackTriangles {
        name: named.name.clone(),
        vertices: crack.vertices().to_vec(),
        triangles: crack.triangles().to_vec(),
    };
    Ok(Some(state.cracks.iter().zip(&found.cracks).map(crack).collect()))
}

fn vtp(cracks: &[CrackTriangles]) -> Vec<u8> {
    let (mut positions, mut corners, mut index) = (vec![], vec![], vec![]);
    for (k, crack) in cracks.iter().enumerate() {
        let first = positions.len() as u32;
        positions.extend(&crack.vertices);
        corners.extend(crack.triangles.iter().map(|t| t.map(|v| v + first)));
        index.extend(vec![k as i64; crack.triangles.len()]);
    }
    triangles(&positions, &corners, &[Array::integers("crack", index)])
}

fn stl(cracks: &[CrackTriangles]) -> String {
    let mut text = String::new();
    for crack in cracks {
        let name: String = crack.name.chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).collect();
        let _ = writeln!(text, "solid {name}");
        for t in &crack.triangles {
            let [a, b, c] = t.map(|v| crack.vertices[v as usize]);
            let n = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default();
            let _ = writeln!(text, "facet normal {:e} {:e} {:e}\nouter loop", n.x, n.y, n.z);
            for v in [a, b, c] {
                let _ = writeln!(text, "vertex {:e} {:e} {:e}", v.x, v.y, v.z);
            }
            text.push_str("endloop\nendfacet\n");
        }
        let _ = writeln!(text, "endsolid {name}");
    }
    text
}
