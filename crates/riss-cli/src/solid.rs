//! `riss run` and `riss check` of solids.

use crate::claim::Claim;
use crate::grow::Speech;
use crate::progress::{Progress, peak_memory_bytes};
use crate::run::RunArguments;
use crate::table::{number, units_line};
use crate::{BAD_CASE, DONE, STOPPED, desktop, diagnostics, interrupt, log, results, solid_grow, solid_loading};
use riss::analysis::{FrontRecord, RunSize, SolidResult, solid_nodes, solid_static};
use riss::case::SolidCase;
use riss::output::whole_file::write_whole;
use riss::output::{
    REPORT_FILE, RunInfo, RunStatus, SolidResults, solid_picture, write_solid_cloud, write_solid_results,
};
use std::io;
use std::path::{Path, PathBuf};

/// Solves a solid; returns the exit code.
pub fn run(arguments: &RunArguments, case: &SolidCase, dir: &Path) -> u8 {
    if !arguments.quiet {
        diagnostics::report_solid_notes(case);
    }
    let size = RunSize::of_solid(&case.model, &case.settings);
    log::begin(&case.path, &case.model.title, "collocation", &size);
    case.notes.iter().for_each(|n| tracing::warn!("{}: {n}", case.place(n)));
    if let Some(reason) = arguments.memory_limit.refusal(&size) {
        crate::fail(&reason);
        return BAD_CASE;
    }
    let _claim = match Claim::of(dir) {
        Ok(claim) => claim,
        Err(e) => return cannot_write("the results", dir, &e),
    };
    if let Err(e) = results::describe_solid(case, dir) {
        return cannot_write("the results", dir, &e);
    }
    let mut progress = Progress::new(arguments.quiet || arguments.log.is_on_terminal());
    if let (Some(cohesive), Some(loading)) = (&case.model.cohesive, &case.loading) {
        interrupt::listen();
        return solid_loading::load(arguments, case, cohesive, loading, dir, progress);
    }
    if let Some(growth) = &case.growth {
        interrupt::listen();
        let speech = if arguments.json { Speech::Json } else { Speech::Table };
        return solid_grow::grow(arguments, case, growth, dir, progress, speech);
    }
    let outcome = solid_static(&case.model, &case.settings, &mut progress);
    let wall_time_s = progress.finish();
    let result = match outcome {
        Ok(result) => result,
        Err(error) => return crate::fail(&error.to_string()),
    };
    log::solved_solid(&result);
    let info = RunInfo {
        title: case.model.title.clone(),
        method: "collocation".into(),
        units: case.units.clone(),
        status: RunStatus::Done,
        wall_time_s,
        stage_time_s: std::mem::take(&mut progress.stage_time_s),
        peak_memory_bytes: peak_memory_bytes(),
    };
    let written = write_solid_results(dir, &case.model, &info, &result);
    if arguments.json {
        let text = serde_json::to_string_pretty(&SolidResults::new(&case.model, &info, &result, vec![]));
        crate::print(&format!("{}\n", text.unwrap_or_default()));
    } else {
        crate::print(&summary(case, &result, wall_time_s));
    }
    match written {
        Ok(files) => {
            if !arguments.json {
                crate::print(&format!("\n{}", results::listed(&files)));
            }
            if arguments.open {
                desktop::open(&dir.join(REPORT_FILE));
            }
            DONE
        }
        Err(e) => cannot_write("the results", dir, &e),
    }
}

fn summary(case: &SolidCase, result: &SolidResult, wall_time_s: f64) -> String {
    let n = result.n_nodes;
    let effort = &result.effort;
    let units = units_line(case.units.as_ref());
    let mut text = format!("{}\n{units}{n} nodes, {} unknowns, {wall_time_s:.2} s", case.model.title, 3 * n);
    text += &format!(", {} with {} products\n", effort.method, effort.iterations);
    for front in &result.fronts {
        text += &front_table(&case.model.crack_names[front.crack], front);
    }
    if !result.warnings.is_empty() {
        text.push('\n');
    }
    for warning in &result.warnings {
        let place = warning.key.as_ref().map_or(String::new(), |key| format!("{}: ", case.place_of(key)));
        text += &format!("warning: {place}{warning}\n");
    }
    text
}

fn front_table(crack: &str, front: &FrontRecord) -> String {
    let ends = if front.is_closed { "closed" } else { "open" };
    let mut text = format!("\ncrack {crack}, front of length {}, {ends}\n", number(front.length));
    text += &format!("{:>12}", "s");
    ["K_I", "K_II", "K_III", "+-", "T", "J"].iter().for_each(|head| text += &format!("{head:>14}"));
    text.push('\n');
    for p in &front.points {
        let cell = |v: f64| format!("{:>14}", number(v));
        text += &format!("{:>12}", number(p.point.s));
        match &p.factors {
            Some(f) => {
                f.factors.iter().chain([&f.uncertainty, &f.t_stress, &f.j]).for_each(|v| text += &cell(*v));
                text.push('\n');
            }
            None => text += "   no disc fits here: the spacing is too large\n",
        }
    }
    text
}

/// Says what a case of a solid holds, places its nodes and draws them; returns the exit code.
pub fn check(case: &SolidCase, out: Option<PathBuf>) -> u8 {
    diagnostics::report_solid_notes(case);
    crate::print(&describe(case));
    let nodes = match solid_nodes(&case.model, &case.settings) {
        Ok(nodes) => nodes,
        Err(error) => {
            eprintln!("error: {error}");
            return STOPPED;
        }
    };
    crate::print(&line("nodes", format!("{}, {} pairs on crack faces", nodes.cloud.len(), nodes.pairs.len())));
    let dir = out.unwrap_or_else(|| results::default_folder(&case.path));
    let picture = dir.join("nodes.svg");
    let drawn = Claim::of(&dir)
        .and_then(|_| write_whole(&picture, solid_picture(&case.model, &nodes.cloud).as_bytes()))
        .and_then(|()| write_solid_cloud(&dir, &nodes.cloud));
    match drawn {
        Ok(path) => {
            crate::print(&line("picture", picture.display().to_string()));
            crate::print(&line("cloud", path.display().to_string()));
            DONE
        }
        Err(e) => cannot_write("a picture", &dir, &e),
    }
}

fn cannot_write(what: &str, dir: &Path, error: &io::Error) -> u8 {
    crate::fail(&format!("cannot write {what} to {}: {}", dir.display(), results::reason(error)))
}

/// A line of the description.
fn line(name: &str, value: String) -> String {
    format!("{name:<9}{value}\n")
}

fn describe(case: &SolidCase) -> String {
    let model = &case.model;
    let body = &model.body;
    let mut text = line("case", model.title.clone());
    text += &line("body", format!("volume {}, {} triangles", number(body.volume()), body.triangles().len()));
    for (k, part) in body.parts().iter().enumerate() {
        text += &line("part", format!("{}: area {}", part.name, number(body.area(Some(k as u32)))));
    }
    for (name, crack) in model.crack_names.iter().zip(&model.cracks) {
        let fronts: Vec<String> = crack
            .fronts
            .iter()
            .map(|f| format!("{} front of length {}", if f.is_closed { "closed" } else { "open" }, number(f.length)))
            .collect();
        let fronts = if fronts.is_empty() { "no front".into() } else { fronts.join(", ") };
        text += &line("crack", format!("{name}: {fronts}"));
    }
    text
}
