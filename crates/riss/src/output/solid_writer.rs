//! Writes growth in a solid step by step: after each step the folder is complete, whatever happens next.

use super::report::REPORT_FILE;
use super::report::solid_scene::{Scenes, clear_scenes, scene_files, write_scene};
use super::run_writer::{RESTART_FOLDER, restart_name};
use super::solid_files::{boundary, cracks, nodes, read_solid_results};
use super::solid_report::solid_report;
use super::solid_results::{SolidResults, SolidStepResults};
use super::vtk::{Array, CellType, Cells, collection, spatial_grid};
use super::whole_file::{remove_if_there, write_all};
use super::{RESULTS_FILE, RunInfo};
use crate::analysis::{SolidGrowthState, SolidStep};
use crate::crack::GrowingCrack;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Kinds of files of a step.
const KINDS: [&str; 4] = ["nodes", "boundary", "cracks", "surfaces"];

/// The folder of a run in which the cracks of a solid grow.
#[derive(Clone, Debug)]
pub struct SolidWriter {
    dir: PathBuf,
    steps: Vec<SolidStepResults>,
}

impl SolidWriter {
    /// Starts anew in `dir`, which is made if needed; results of an earlier run are removed.
    ///
    /// # Errors
    /// What the system says.
    pub fn new(dir: &Path) -> io::Result<Self> {
        fs::create_dir_all(dir.join(RESTART_FOLDER))?;
        remove_if_there(&dir.join(RESULTS_FILE))?;
        remove_from(dir, 0)?;
        clear_scenes(dir, 0)?;
        Ok(Self { dir: dir.into(), steps: vec![] })
    }

    /// Goes on in the folder of an earlier run with the step `first`, which is made again; later ones are removed.
    ///
    /// # Errors
    /// What the system says; `InvalidData` if the results there lack one of the steps before.
    pub fn resume(dir: &Path, first: usize) -> io::Result<Self> {
        let mut steps = read_solid_results(dir).map_or(vec![], |r| r.steps);
        steps.retain(|s| s.step < first);
        if steps.iter().map(|s| s.step).ne(0..first) {
            let message = format!("there are no results of all steps before {first}");
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        remove_from(dir, first + 1)?;
        clear_scenes(dir, first + 1)?;
        Ok(Self { dir: dir.into(), steps })
    }

    /// Writes the files of a step and brings those of the run up to date; returns the paths, `results.json` last.
    ///
    /// # Errors
    /// What the system says.
    pub fn write_step(
        &mut self,
        info: &RunInfo,
        step: &SolidStep,
        state: &SolidGrowthState,
    ) -> io::Result<Vec<PathBuf>> {
        self.steps.push(SolidStepResults::new(step));
        let mut files = vec![
            (file_name("nodes", step.step), nodes(&step.result)),
            (file_name("boundary", step.step), boundary(&step.result)),
            (file_name("cracks", step.step), cracks(&step.result)),
            (file_name("surfaces", step.step), surfaces(&state.cracks)),
            (restart_name(step.step), serde_json::to_vec(state)?),
        ];
        for kind in KINDS {
            let all: Vec<(usize, String)> = self.steps.iter().map(|s| (s.step, file_name(kind, s.step))).collect();
            files.push((format!("{kind}.pvd"), collection(&all)));
        }
        let mut names: Vec<String> = files.iter().map(|f| f.0.clone()).collect();
        for earlier in 0..step.step {
            names.extend(KINDS.map(|kind| file_name(kind, earlier)));
            names.push(restart_name(earlier));
        }
        write_scene(&self.dir, step.step, &step.model, &step.result)?;
        names.extend(scene_files(&self.dir));
        names.push(REPORT_FILE.into());
        let mut results = SolidResults::new(&step.model, info, &step.result, names);
        results.grown(self.steps.clone(), step.end.clone());
        files.push((REPORT_FILE.into(), solid_report(&results, &Scenes::read(&self.dir)?).into_bytes()));
        files.push((RESULTS_FILE.into(), (serde_json::to_string_pretty(&results)? + "\n").into_bytes()));
        write_all(&self.dir, &files)
    }
}

/// The state from which a step of growth in a solid can be repeated.
///
/// # Errors
/// What the system says; `InvalidData` if the file is none of ours.
pub fn solid_restart_state(dir: &Path, step: usize) -> io::Result<SolidGrowthState> {
    Ok(serde_json::from_slice(&fs::read(dir.join(restart_name(step)))?)?)
}

fn file_name(kind: &str, step: usize) -> String {
    format!("{kind}-{step:04}.vtu")
}

/// The triangles of all cracks.
fn surfaces(all: &[GrowingCrack]) -> Vec<u8> {
    let mut positions = vec![];
    let mut cells = Cells { cell_type: CellType::Triangle, points: vec![], sizes: vec![] };
    let mut index = vec![];
    for (c, crack) in all.iter().enumerate() {
        let first = positions.len() as u32;
        positions.extend(crack.vertices());
        cells.points.extend(crack.triangles().iter().flatten().map(|v| v + first));
        cells.sizes.extend(vec![3; crack.triangles().len()]);
        index.extend(vec![c as i64; crack.triangles().len()]);
    }
    spatial_grid(&positions, &cells, &[] as &[Array], &[Array::integers("crack", index)])
}

/// Removes the files of steps from `first` on, so that none of an earlier run passes for one of this.
fn remove_from(dir: &Path, first: usize) -> io::Result<()> {
    for folder in [dir.to_path_buf(), dir.join(RESTART_FOLDER)] {
        let Ok(entries) = fs::read_dir(&folder) else { continue };
        for entry in entries {
            let path = entry?.path();
            if step_of(&path).is_some_and(|step| step >= first) {
                remove_if_there(&path)?;
            }
        }
    }
    Ok(())
}

/// The step whose file this is.
fn step_of(path: &Path) -> Option<usize> {
    let stem = path.file_stem()?.to_str()?;
    let (kind, number) = stem.rsplit_once('-').or_else(|| stem.rsplit_once('_'))?;
    (KINDS.contains(&kind) || kind == "step").then(|| number.parse().ok())?
}
