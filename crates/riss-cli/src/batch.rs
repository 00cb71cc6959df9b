//! `riss run` of several cases, or of one over a range of values: side by side, with one table of all results.

use crate::claim::Claim;
use crate::grow::{self, Speech};
use crate::progress::{Progress, peak_memory_bytes};
use crate::results::{self, RunRecord};
use crate::resume::{self, Obstacle};
use crate::run::RunArguments;
use crate::sweep::{MOST_RUNS, combinations};
use crate::table::{aligned, number};
use crate::{BAD_CASE, DONE, STOPPED, diagnostics, interrupt, plane_loading, solid_grow, solid_loading};
use riss::analysis::{RunSize, linear_static, solid_static};
use riss::case::{AnyCase, Case, SolidCase};
use riss::output::run_table::{RowStatus, RunRow, end_name, fronts, keys, table_csv, tips};
use riss::output::{
    Results, RunInfo, RunStatus, SolidResults, read_results, solid_files::read_solid_results, write_file,
    write_solid_results,
};
use std::collections::HashSet;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The table of all runs, in the folder above theirs.
const TABLE_FILE: &str = "table.csv";

/// One run that is to be done.
struct Job {
    case: AnyCase,
    name: String,
    set: Vec<(String, String)>,
    folder: PathBuf,
}

/// Runs all cases with all values; returns the exit code.
pub fn run(arguments: &RunArguments) -> u8 {
    let folder = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.cases));
    let jobs = match jobs(arguments, &folder) {
        Ok(jobs) => jobs,
        Err(code) => return code,
    };
    let mut claims = vec![];
    for dir in jobs.iter().map(|j| &j.folder).chain([&folder]) {
        match Claim::of(dir) {
            Ok(claim) => claims.push(claim),
            Err(e) => return cannot_write(dir, &e),
        }
    }
    interrupt::listen();
    let rows = match run_all(&jobs, &folder, arguments.quiet) {
        Ok(rows) => rows,
        Err(e) => return cannot_write(&folder, &e),
    };
    if arguments.json {
        let text = serde_json::to_string_pretty(&rows).expect("plain values");
        crate::print(&format!("{text}\n"));
    } else {
        crate::print(&format!("{}\nwrote {}\n", describe(&rows), folder.join(TABLE_FILE).display()));
    }
    if rows.len() == jobs.len() && rows.iter().all(|r| r.status == RowStatus::Done) { DONE } else { STOPPED }
}

fn cannot_write(dir: &Path, error: &io::Error) -> u8 {
    crate::fail(&format!("cannot write the results to {}: {}", dir.display(), results::reason(error)))
}

/// `NAME.riss-sweep` for one case, `riss-out` for several.
fn default_folder(cases: &[PathBuf]) -> PathBuf {
    match cases {
        [case] => PathBuf::from(format!("{}.riss-sweep", results::name(case))),
        _ => PathBuf::from("riss-out"),
    }
}

/// Reads every case with every combination of values; all mistakes are reported before anything runs.
fn jobs(arguments: &RunArguments, folder: &Path) -> Result<Vec<Job>, u8> {
    let sets = combinations(&arguments.sweeps).map_err(|message| refuse(&message))?;
    if sets.len() * arguments.cases.len() > MOST_RUNS {
        return Err(refuse(&format!("these are more than {MOST_RUNS} runs")));
    }
    let mut jobs = vec![];
    let mut names = HashSet::new();
    let mut is_sound = true;
    for path in &arguments.cases {
        let name = unique(results::name(path), &mut names);
        let mut folders = HashSet::new();
        for set in &sets {
            let values = set.iter().map(|(key, value)| format!("{key}={value}"));
            let overrides: Vec<String> = arguments.overrides.iter().cloned().chain(values).collect();
            match AnyCase::read(path, &overrides) {
                Ok(case) => {
                    let size = match &case {
                        AnyCase::Plane(case) => RunSize::of_plane(&case.model, &case.settings, case.growth.as_ref()),
                        AnyCase::Solid(case) => RunSize::of_solid(&case.model, &case.settings),
                    };
                    if let Some(reason) = arguments.memory_limit.refusal(&size) {
                        return Err(refuse(&format!("{}: {reason}", path.display())));
                    }
                    match &case {
                        _ if arguments.quiet || set != &sets[0] => {}
                        AnyCase::Plane(case) => diagnostics::report_notes(case),
                        AnyCase::Solid(case) => diagnostics::report_solid_notes(case),
                    }
                    let below = if arguments.cases.len() == 1 { folder.to_path_buf() } else { folder.join(&name) };
                    let own = if set.is_empty() { below } else { below.join(unique(folder_name(set), &mut folders)) };
                    jobs.push(Job { case, name: name.clone(), set: set.clone(), folder: own });
                }
                Err(errors) => {
                    diagnostics::report_errors(&errors);
                    is_sound = false;
                    // The other values would mostly repeat it.
                    break;
                }
            }
        }
    }
    if is_sound { Ok(jobs) } else { Err(BAD_CASE) }
}

fn refuse(message: &str) -> u8 {
    crate::fail(message);
    BAD_CASE
}

/// `a=1.5,b=2` from the last steps of the keys, without signs that names of files do not have.
fn folder_name(set: &[(String, String)]) -> String {
    let plain = |text: &str| -> String {
        let kept = |c: char| c.is_alphanumeric() || "+-._".contains(c);
        text.chars().map(|c| if kept(c) { c } else { '_' }).take(60).collect()
    };
    let parts: Vec<String> = set.iter().map(|(key, value)| format!("{}={}", plain(key), plain(value))).collect();
    parts.join(",").chars().take(200).collect()
}

fn unique(name: String, taken: &mut HashSet<String>) -> String {
    let numbered = |k: usize| if k == 1 { name.clone() } else { format!("{name}-{k}") };
    let free = (1..).map(numbered).find(|n| !taken.contains(n)).unwrap_or(name);
    taken.insert(free.clone());
    free
}

/// Runs the jobs on as many threads as the analyses may use; the table is written again after each.
fn run_all(jobs: &[Job], folder: &Path, is_quiet: bool) -> io::Result<Vec<RunRow>> {
    let next = AtomicUsize::new(0);
    let done: Mutex<Vec<Option<RunRow>>> = Mutex::new(vec![None; jobs.len()]);
    let failure: Mutex<Option<io::Error>> = Mutex::new(None);
    // Plain threads: a thread of the pool that waits for one run would take up parts of another.
    let work = || {
        while let Some((index, job)) = Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|k| Some((k, jobs.get(k)?)))
        {
            let row = run_one(job);
            let mut done = done.lock().unwrap_or_else(|e| e.into_inner());
            if !is_quiet {
                let n = 1 + done.iter().flatten().count();
                eprintln!("{n} of {}: {}", jobs.len(), line(&row));
            }
            done[index] = Some(row);
            let rows: Vec<RunRow> = done.iter().flatten().cloned().collect();
            if let Err(e) = write_file(folder, TABLE_FILE, table_csv(&rows).as_bytes()) {
                *failure.lock().unwrap_or_else(|e| e.into_inner()) = Some(e);
                next.store(jobs.len(), Ordering::Relaxed);
            }
            if interrupt::is_asked() {
                next.store(jobs.len(), Ordering::Relaxed);
            }
        }
    };
    let n_workers = rayon::current_num_threads().min(jobs.len());
    std::thread::scope(|scope| (0..n_workers).for_each(|_| drop(scope.spawn(work))));
    match failure.into_inner().unwrap_or_else(|e| e.into_inner()) {
        Some(error) => Err(error),
        None => Ok(done.into_inner().unwrap_or_else(|e| e.into_inner()).into_iter().flatten().collect()),
    }
}

fn run_one(job: &Job) -> RunRow {
    let folder = job.folder.display().to_string();
    let row = match &job.case {
        AnyCase::Plane(case) => run_plane(case, &job.folder).map(|r| RunRow::new(&job.name, &job.set, &folder, &r)),
        AnyCase::Solid(case) => {
            run_solid(case, &job.folder).map(|r| RunRow::of_solid(&job.name, &job.set, &folder, &r))
        }
    };
    row.unwrap_or_else(|reason| RunRow::failed(&job.name, &job.set, &folder, &reason))
}

fn run_plane(case: &Case, folder: &Path) -> Result<Results, String> {
    match &case.growth {
        _ if case.loading.is_some() => load(case, folder)?,
        None => run_static(case, folder)?,
        Some(growth) => {
            let beginning = resume::begin(case, folder).map_err(Obstacle::message)?;
            grow::follow(case, growth, beginning, folder, Progress::new(true), Speech::Nothing)?;
        }
    }
    read_results(folder).map_err(|e| format!("the results cannot be read: {e}"))
}

fn load(case: &Case, folder: &Path) -> Result<(), String> {
    let loading = case.loading.unwrap_or_default();
    match plane_loading::follow(case, &loading, None, folder, Progress::new(true))? {
        Some(_) => Ok(()),
        None => Err("stopped before the end".into()),
    }
}

fn run_solid(case: &SolidCase, folder: &Path) -> Result<SolidResults, String> {
    results::describe_solid(case, folder).map_err(|e| results::reason(&e))?;
    let mut progress = Progress::new(true);
    if let (Some(cohesive), Some(loading)) = (&case.model.cohesive, &case.loading) {
        let followed = solid_loading::follow(case, cohesive, loading, None, folder, progress)?;
        return followed.map(|f| f.results).ok_or_else(|| "stopped before the end".into());
    }
    if let Some(growth) = &case.growth {
        let (writer, state) = solid_grow::begin(case, folder)?;
        solid_grow::follow(case, growth, writer, state, progress, Speech::Nothing)?;
        return read_solid_results(folder).ok_or_else(|| "the results cannot be read".into());
    }
    let outcome = solid_static(&case.model, &case.settings, &mut progress);
    let wall_time_s = progress.finish();
    let result = outcome.map_err(|e| e.to_string())?;
    let info = RunInfo {
        title: case.model.title.clone(),
        method: "collocation".into(),
        units: case.units.clone(),
        status: RunStatus::Done,
        wall_time_s,
        stage_time_s: std::mem::take(&mut progress.stage_time_s),
        peak_memory_bytes: peak_memory_bytes(),
    };
    write_solid_results(folder, &case.model, &info, &result).map_err(|e| results::reason(&e))?;
    Ok(SolidResults::new(&case.model, &info, &result, vec![]))
}

fn run_static(case: &Case, folder: &Path) -> Result<(), String> {
    let mut progress = Progress::new(true);
    let outcome = linear_static(&case.model, &case.settings, &mut progress);
    let wall_time_s = progress.finish();
    let result = outcome.map_err(|e| e.to_string())?;
    let stage_time_s = std::mem::take(&mut progress.stage_time_s);
    let run = RunRecord { wall_time_s, stage_time_s, peak_memory_bytes: peak_memory_bytes() };
    results::write(folder, case, &run, &result).map(drop).map_err(|e| results::reason(&e))
}

/// A run in one line.
fn line(row: &RunRow) -> String {
    let set: Vec<String> = row.set.iter().map(|(key, value)| format!("{key} = {value}")).collect();
    let what = if set.is_empty() { row.case.clone() } else { format!("{} with {}", row.case, set.join(", ")) };
    match &row.reason {
        Some(reason) => format!("{what}: {}: {reason}", row.status.name()),
        None => format!("{what}: {}", row.status.name()),
    }
}

/// The table on the terminal: what differs between the runs, and K of every tip.
fn describe(rows: &[RunRow]) -> String {
    let (keys, tips, fronts) = (keys(rows), tips(rows), fronts(rows));
    let has_cycles = rows.iter().any(|r| r.cycles.is_some());
    let many_cases = rows.iter().any(|r| r.case != rows[0].case);
    let mut head: Vec<String> = vec![];
    let mut left = vec![];
    if many_cases {
        left.push(head.len());
        head.push("case".into());
    }
    head.extend(keys.iter().cloned());
    for (crack, end) in &tips {
        let of = if tips.len() == 1 { String::new() } else { format!(" {crack} {}", end_name(*end)) };
        head.extend([format!("K_I{of}"), format!("K_II{of}")]);
    }
    for name in &fronts {
        let of = if fronts.len() == 1 { String::new() } else { format!(" {name}") };
        head.extend([format!("K_I min{of}"), format!("K_I max{of}")]);
    }
    if has_cycles {
        head.push("cycles".into());
    }
    left.extend([head.len(), head.len() + 1]);
    head.extend(["status".into(), "folder".into()]);
    let known = |v: Option<f64>| v.map_or("-".to_string(), number);
    let cells = |row: &RunRow| {
        let mut cells = if many_cases { vec![row.case.clone()] } else { vec![] };
        cells.extend(keys.iter().map(|k| row.value(k).unwrap_or("-").to_string()));
        for (crack, end) in &tips {
            let tip = row.tip(crack, *end);
            cells.extend([tip.and_then(|t| t.k1), tip.and_then(|t| t.k2)].map(known));
        }
        for name in &fronts {
            let front = row.front(name);
            cells.extend([front.and_then(|f| f.k1_min), front.and_then(|f| f.k1_max)].map(known));
        }
        if has_cycles {
            cells.push(known(row.cycles));
        }
        cells.extend([row.status.name().into(), row.folder.clone()]);
        cells
    };
    let lines: Vec<Vec<String>> = rows.iter().map(cells).collect();
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    aligned(&head, &lines, &left)
}
