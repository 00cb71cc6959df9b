//! What the report of a solid draws of each step: cracks with their opening and fields on the boundary, as files of their
//! own, and the edges of the body.

use super::super::solid_results::{FrontResults, SolidResults};
use super::super::whole_file::write_whole;
use super::{MOST_BYTES, REPORT_FOLDER, RunSource, boundary, read_source};
use crate::analysis::SolidResult;
use crate::math::Vector3;
use crate::model::SolidModel;
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::fs;
use std::io;
use std::path::Path;

/// Edges sharper than this are drawn [rad].
const SHARP: f64 = 0.5;
/// Edges of a body at most; of those with more, every second, third, ... is drawn.
const MOST_EDGES: usize = 4000;
/// Digits of coordinates and openings.
const DIGITS: usize = 5;

/// Files from which a report draws, with what results do not hold.
#[derive(Clone, Debug, Default)]
pub struct Scenes {
    /// Ends of edges of the body, six numbers each.
    body: Vec<f64>,
    /// Steps with what is drawn of them.
    steps: Vec<(usize, StepScene)>,
    /// What was run.
    source: Option<RunSource>,
}

/// Vertices and triangles.
pub(crate) type Triangulated = (Vec<Vector3>, Vec<[u32; 3]>);

/// A crack as it is drawn.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SceneCrack {
    /// Name; empty until the page is put together.
    #[serde(default)]
    name: String,
    /// Coordinates of points [length].
    points: Vec<f64>,
    /// Displacement of the positive face over the negative one [length].
    openings: Vec<f64>,
    /// Its part along the normal [length].
    gaps: Vec<f64>,
    /// Corners, three each.
    triangles: Vec<u32>,
}

/// A step as its file holds it.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StepScene {
    cracks: Vec<SceneCrack>,
    /// Fields on the boundary.
    boundary: serde_json::Value,
}

/// A step as the page holds it.
#[derive(Serialize)]
struct Scene<'a> {
    label: String,
    body: &'a [f64],
    boundary: &'a serde_json::Value,
    cracks: Vec<SceneCrack>,
    fronts: &'a [FrontResults],
}

fn body_name() -> String {
    format!("{REPORT_FOLDER}/body.json")
}

fn step_name(step: usize) -> String {
    format!("{REPORT_FOLDER}/scene_{step:04}.json")
}

/// Writes what the report draws of a step; returns the names of the files.
///
/// # Errors
/// What the system says.
pub(crate) fn write_scene(
    dir: &Path,
    step: usize,
    model: &SolidModel,
    result: &SolidResult,
) -> io::Result<Vec<String>> {
    fs::create_dir_all(dir.join(REPORT_FOLDER))?;
    let cracks: Vec<SceneCrack> = (result.opened_cracks.iter())
        .map(|opened| SceneCrack {
            name: String::new(),
            points: flat(&opened.positions),
            openings: flat(&opened.openings),
            gaps: opened.gaps.iter().map(|g| short(*g)).collect(),
            triangles: opened.triangles.iter().flatten().copied().collect(),
        })
        .collect();
    write_whole(&dir.join(body_name()), &serde_json::to_vec(&body_edges(model))?)?;
    let scene = StepScene { cracks, boundary: boundary::pack(&result.boundary)? };
    write_whole(&dir.join(step_name(step)), &serde_json::to_vec(&scene)?)?;
    Ok(vec![body_name(), step_name(step)])
}

/// Removes what an earlier run has left from a step on.
///
/// # Errors
/// What the system says.
pub(crate) fn clear_scenes(dir: &Path, from: usize) -> io::Result<()> {
    let Ok(entries) = fs::read_dir(dir.join(REPORT_FOLDER)) else { return Ok(()) };
    for entry in entries {
        let path = entry?.path();
        if step_of(&path).is_some_and(|step| step >= from) {
            fs::remove_file(path)?;
        }
    }
    Ok(())
}

fn step_of(path: &Path) -> Option<usize> {
    let name = path.file_name()?.to_str()?;
    name.strip_prefix("scene_")?.strip_suffix(".json")?.parse().ok()
}

/// Names of all files of scenes in a folder, in order.
pub(crate) fn scene_files(dir: &Path) -> Vec<String> {
    let steps = steps(dir);
    let body = (!steps.is_empty()).then(body_name);
    body.into_iter().chain(steps.into_iter().map(|s| step_name(s.0))).collect()
}

/// Steps with the bytes of their files.
fn steps(dir: &Path) -> Vec<(usize, u64)> {
    let entries = fs::read_dir(dir.join(REPORT_FOLDER)).into_iter().flatten().flatten();
    let mut steps: Vec<(usize, u64)> =
        entries.filter_map(|e| Some((step_of(&e.path())?, e.metadata().ok()?.len()))).collect();
    steps.sort_unstable();
    steps
}

impl Scenes {
    /// Reads those of a folder, from the last step backwards every one or every second, third, ... so that the page stays small.
    ///
    /// # Errors
    /// What the system says; `InvalidData` if a file is none of ours.
    pub(crate) fn read(dir: &Path) -> io::Result<Self> {
        let found = steps(dir);
        let total = |every: usize| found.iter().rev().step_by(every).map(|s| s.1).sum::<u64>();
        let Some(every) = (1..=found.len()).find(|n| total(*n) <= MOST_BYTES) else { return Ok(Self::default()) };
        let mut steps = vec![];
        for (step, _) in found.iter().rev().step_by(every).rev() {
            steps.push((*step, serde_json::from_slice(&fs::read(dir.join(step_name(*step)))?)?));
        }
        let body = serde_json::from_slice(&fs::read(dir.join(body_name()))?)?;
        Ok(Self { body, steps, source: read_source(dir)? })
    }

    /// Vertices and triangles of all cracks of a step, or of the last.
    pub(crate) fn surfaces(&self, step: Option<usize>) -> Option<Vec<Triangulated>> {
        let (_, scene) = match step {
            None => self.steps.last(),
            Some(step) => self.steps.iter().find(|s| s.0 == step),
        }?;
        let surface = |c: &SceneCrack| {
            let vertices = c.points.chunks_exact(3).map(Vector3::from_column_slice).collect();
            (vertices, c.triangles.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect())
        };
        Some(scene.cracks.iter().map(surface).collect())
    }

    /// What was run, if the folder tells.
    pub(crate) fn source(&self) -> Option<&RunSource> {
        self.source.as_ref()
    }

    /// Whether there is nothing to draw.
    pub(crate) fn is_empty(&self) -> bool {
        self.steps.is_empty()
    }

    /// A step with what the results say of it; the edges of the body go with the first.
    fn scene<'a>(&'a self, k: usize, results: &'a SolidResults) -> Scene<'a> {
        let number = |v: Option<f64>| v.map_or("?".into(), |v| short(v).to_string());
        let (number_of_step, StepScene { cracks, boundary }) = &self.steps[k];
        let step = results.steps.iter().find(|s| s.step == *number_of_step);
        let point = results.load_curve.get(*number_of_step);
        let names: Vec<&String> = match step {
            Some(step) => step.cracks.iter().map(|c| &c.name).collect(),
            None => results.cracks.iter().map(|c| &c.name).collect(),
        };
        let label = match (step, point) {
            (Some(step), _) => {
                let area = step.cracks.iter().map(|c| c.area).sum();
                format!("step {number_of_step}: crack area {}", number(area))
            }
            (None, Some(p)) => {
                format!("step {number_of_step}: load {} at displacement {}", number(p.load), number(p.displacement))
            }
            (None, None) => String::new(),
        };
        let fronts = step.map_or(&results.fronts, |s| &s.fronts);
        let named = |(crack, name): (&SceneCrack, &&String)| SceneCrack { name: (*name).clone(), ..crack.clone() };
        let body = if k == 0 { &self.body[..] } else { &[] };
        Scene { label, body, boundary, cracks: cracks.iter().zip(&names).map(named).collect(), fronts }
    }

    /// The steps as JSON, with names, fronts and labels of the results.
    pub(crate) fn json(&self, results: &SolidResults) -> String {
        let scenes: Vec<Scene> = (0..self.steps.len()).map(|k| self.scene(k, results)).collect();
        serde_json::to_string(&scenes).unwrap_or_default()
    }
}

/// Sharp edges of a body; if there are few, those of all its triangles.
fn body_edges(model: &SolidModel) -> Vec<f64> {
    let body = &model.body;
    let ends = |(t, k): (u32, usize)| {
        let corners = body.corners(t);
        [corners[k], corners[(k + 1) % 3]]
    };
    let mut edges: Vec<[Vector3; 2]> = body.folds(SHARP).map(ends).collect();
    if edges.is_empty() {
        let mut seen = HashSet::new();
        let is_new = |(t, k): &(u32, usize)| {
            let corners = body.triangles()[*t as usize];
            let (a, b) = (corners[*k], corners[(k + 1) % 3]);
            seen.insert((a.min(b), a.max(b)))
        };
        let all = (0..body.triangles().len() as u32).flat_map(|t| (0..3).map(move |k| (t, k)));
        edges = all.filter(is_new).map(ends).collect();
    }
    let every = edges.len().div_ceil(MOST_EDGES).max(1);
    edges.iter().step_by(every).flat_map(|e| flat(e)).collect()
}

fn flat(vectors: &[Vector3]) -> Vec<f64> {
    vectors.iter().flat_map(|v| [v.x, v.y, v.z]).map(short).collect()
}

/// A few digits are enough for pictures.
fn short(v: f64) -> f64 {
    format!("{v:.*e}", DIGITS).parse().unwrap_or(v)
}
