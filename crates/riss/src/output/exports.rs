//! Cracks and their stress intensity factors for other programs: CSV, VTK, STL, and beta factors for easigrow and AFGROW.

use super::results::{CrackResults, Results, StepResults, TipResults};
use super::vtk::{Array, lines};
use crate::crack::End;
use crate::math::{Vector2, turn_left};
use std::f64::consts::PI;
use std::fmt::Write;
use std::io;

/// A file for cracks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CrackFormat {
    /// One row for each point of each path.
    Csv,
    /// Polylines for ParaView.
    Vtp,
    /// The strip that a crack in the plane is in a sheet, from z = 0 to the thickness.
    Stl {
        /// Width of the strip [length].
        thickness: f64,
    },
}

/// The cracks of a step.
///
/// # Errors
/// None that writing to memory can meet; the type is that of the `csv` crate.
pub fn cracks_as(format: CrackFormat, step: &StepResults) -> io::Result<Vec<u8>> {
    match format {
        CrackFormat::Csv => cracks_csv(&step.cracks),
        CrackFormat::Vtp => Ok(cracks_vtp(&step.cracks)),
        CrackFormat::Stl { thickness } => Ok(cracks_stl(&step.cracks, thickness).into_bytes()),
    }
}

/// What beta factors refer to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BetaReference {
    /// Stress of the loads of the case, such as the remote stress [stress].
    pub stress: f64,
    /// Distance from where the crack began to the free edge ahead [length].
    pub distance: f64,
}

/// Beta factors of a tip as a "1-D beta factor solution file" of easigrow (`--beta file-1d:FILE`): lines of the crack
/// length over the distance to the free edge, and β = K/(σ √(π c)); none if no step has a factor.
///
/// K and c are those of [`afgrow_table`].
pub fn beta_table(results: &Results, crack: &str, end: End, reference: &BetaReference) -> Option<String> {
    let rows = beta_factors(results, crack, end, reference.stress)?;
    let one_line = crack.replace(['\n', '\r'], " ");
    let mut text = format!(
        "# Beta factors of the {} of {one_line}: K/(stress sqrt(pi c)), stress {}, sideways {}\n# c/sideways beta\n",
        if end == End::Start { "start" } else { "end" },
        reference.stress,
        reference.distance
    );
    for (length, beta) in rows {
        let _ = writeln!(text, "{} {beta}", length / reference.distance);
    }
    Some(text)
}

/// Beta factors of a tip in the two columns of AFGROW's table of user-defined betas, for pasting: the crack length c
/// and β = K/(σ √(π c)), with a tab between; none if no step has a factor.
///
/// K is the equivalent factor where growth has one, else `K_I`. The length c is that of the path from its mouth, or from
/// the middle of the path in the first step if the crack has two tips.
///
/// - `stress`: σ, of the loads of the case, such as the remote stress [stress]
pub fn afgrow_table(results: &Results, crack: &str, end: End, stress: f64) -> Option<String> {
    let mut text = String::new();
    for (length, beta) in beta_factors(results, crack, end, stress)? {
        let _ = writeln!(text, "{length}\t{beta}");
    }
    Some(text)
}

/// Crack lengths that grow from row to row, and their beta factors.
fn beta_factors(results: &Results, crack: &str, end: End, stress: f64) -> Option<Vec<(f64, f64)>> {
    let find = |step: &StepResults| step.cracks.iter().find(|c| c.name == crack).cloned();
    let first = results.steps.iter().find_map(find)?;
    let mut rows: Vec<(f64, f64)> = vec![];
    for crack in results.steps.iter().filter_map(find) {
        let Some(tip) = crack.tips.iter().find(|t| t.end == end) else { continue };
        let Some(k) = tip.k_equivalent.or(tip.k1).filter(|k| *k > 0.0) else { continue };
        let length = length_from_origin(&first, &crack, end);
        // A tip that waits gives the same length again.
        if rows.last().is_none_or(|r| length > r.0) && length > 0.0 {
            rows.push((length, k / (stress * (PI * length).sqrt())));
        }
    }
    (!rows.is_empty()).then_some(rows)
}

/// All tips of a run, by name of the crack and end.
pub fn tips(results: &Results) -> Vec<(String, End)> {
    let mut found = vec![];
    for crack in results.steps.iter().flat_map(|s| &s.cracks) {
        for TipResults { end, .. } in &crack.tips {
            if !found.iter().any(|(name, e)| *name == crack.name && e == end) {
                found.push((crack.name.clone(), *end));
            }
        }
    }
    found
}

fn points(crack: &CrackResults) -> Vec<Vector2> {
    crack.path.iter().map(|p| Vector2::from(*p)).collect()
}

fn length(path: &[Vector2]) -> f64 {
    // An empty sum is -0.
    path.windows(2).map(|w| (w[1] - w[0]).norm()).fold(0.0, |sum, l| sum + l)
}

fn length_from_origin(first: &CrackResults, now: &CrackResults, end: End) -> f64 {
    let (before, path) = (points(first), points(now));
    let from_start = if first.tips.len() < 2 {
        // From the mouth, which is the end that is no tip.
        match end {
            End::End => 0.0,
            End::Start => length(&path),
        }
    } else {
        let begin = before.first().copied().unwrap_or_default();
        let nearest = (0..path.len()).min_by(|a, b| (path[*a] - begin).norm().total_cmp(&(path[*b] - begin).norm()));
        length(&path[..=nearest.unwrap_or(0)]) + 0.5 * length(&before)
    };
    match end {
        End::End => length(&path) - from_start,
        End::Start => from_start,
    }
}

fn cracks_csv(cracks: &[CrackResults]) -> io::Result<Vec<u8>> {
    let mut writer = csv::WriterBuilder::new().has_headers(false).from_writer(vec![]);
    writer.write_record(["crack", "point", "x", "y", "length"])?;
    for crack in cracks {
        let path = points(crack);
        for (k, p) in path.iter().enumerate() {
            writer.serialize((&crack.name, k, p.x, p.y, length(&path[..=k])))?;
        }
    }
    writer.into_inner().map_err(|e| e.into_error())
}

fn cracks_vtp(cracks: &[CrackResults]) -> Vec<u8> {
    let paths: Vec<Vec<Vector2>> = cracks.iter().map(points).collect();
    let lengths = paths.iter().flat_map(|p| (0..p.len()).map(|k| length(&p[..=k])));
    let sizes: Vec<usize> = paths.iter().map(Vec::len).collect();
    lines(
        &paths.concat(),
        &sizes,
        &[Array::scalars("length", lengths)],
        &[Array::integers("crack", 0..paths.len() as i64)],
    )
}

/// Two triangles a segment; their normals point to the left of the path.
fn cracks_stl(cracks: &[CrackResults], thickness: f64) -> String {
    let mut text = String::new();
    for crack in cracks {
        let name: String = crack.name.chars().map(|c| if c.is_ascii_graphic() { c } else { '_' }).collect();
        let _ = writeln!(text, "solid {name}");
        for side in points(crack).windows(2) {
            let [p, q] = [side[0], side[1]];
            let normal = turn_left(q - p).try_normalize(0.0).unwrap_or_default();
            let (low_p, low_q, high_p, high_q) = ((p, 0.0), (q, 0.0), (p, thickness), (q, thickness));
            for triangle in [[low_p, high_q, low_q], [low_p, high_p, high_q]] {
                let _ = writeln!(text, "facet normal {:e} {:e} 0", normal.x, normal.y);
                text.push_str("outer loop\n");
                for (v, z) in triangle {
                    let _ = writeln!(text, "vertex {:e} {:e} {z:e}", v.x, v.y);
                }
                text.push_str("endloop\nendfacet\n");
            }
        }
        let _ = writeln!(text, "endsolid {name}");
    }
    text
}
