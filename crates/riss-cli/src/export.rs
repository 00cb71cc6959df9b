//! `riss export`.

use crate::{BAD_CASE, DONE, STOPPED, results};
use clap::{Args, ValueEnum};
use riss::crack::End;
use riss::output::exports::{BetaReference, CrackFormat, afgrow_table, beta_table, cracks_as, tips};
use riss::output::solid_exports::{SolidCrackFormat, solid_cracks_as};
use riss::output::{AnyResults, Results, SolidResults, read_any_results, write_file};
use std::path::{Path, PathBuf};

/// Arguments of `riss export`.
#[derive(Args)]
#[command(after_help = "Examples:\n  riss export plate.riss-out --format stl --thickness 2\n  \
    riss export plate.riss-out --format easigrow --stress 100 --distance 50\n  \
    riss export plate.riss-out --format afgrow --stress 100")]
pub struct ExportArguments {
    /// Folder of results
    pub dir: PathBuf,
    /// What to write
    #[arg(long, value_enum)]
    pub format: Format,
    /// Step whose cracks to write [default: the last]
    #[arg(long, value_name = "N")]
    pub step: Option<usize>,
    /// Thickness of the sheet, for stl
    #[arg(long, value_name = "T", default_value_t = 1.0, value_parser = positive)]
    pub thickness: f64,
    /// Stress that beta factors refer to, for easigrow and afgrow
    #[arg(long, value_name = "S", required_if_eq_any([("format", "easigrow"), ("format", "afgrow")]), value_parser = positive)]
    pub stress: Option<f64>,
    /// Distance from where the crack began to the free edge ahead, for easigrow
    #[arg(long, value_name = "D", required_if_eq("format", "easigrow"), value_parser = positive)]
    pub distance: Option<f64>,
    /// Folder for the files [default: the folder of results]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// What can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// cracks.csv: the points of each crack; of solids those of its fronts, with their factors
    Csv,
    /// cracks.vtp: the cracks as lines, in solids as triangles, for ParaView
    Vtp,
    /// cracks.stl: the cracks as strips of the thickness of the sheet, in solids as they are
    Stl,
    /// beta_CRACK_END.txt for each tip: beta factors over crack length, for easigrow --beta file-1d:FILE
    Easigrow,
    /// beta_CRACK_END.tsv for each tip: crack length and beta factor, to paste into AFGROW's user-defined betas
    Afgrow,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("it must be a number above 0".into()),
    }
}

/// Writes the files; returns the exit code.
pub fn export(arguments: &ExportArguments) -> u8 {
    let dir = &arguments.dir;
    let read = match read_any_results(dir) {
        Ok(read) => read,
        Err(e) => {
            eprintln!("error: the results in {} cannot be read: {}", dir.display(), results::reason(&e));
            return BAD_CASE;
        }
    };
    let files = match &read {
        AnyResults::Plane(read) => contents(arguments, read),
        AnyResults::Solid(read) => solid_contents(arguments, read),
    };
    let files = match files {
        Ok(files) => files,
        Err(message) => {
            eprintln!("error: {message}");
            return BAD_CASE;
        }
    };
    let out: &Path = arguments.out.as_deref().unwrap_or(dir);
    for (name, content) in files {
        if let Err(e) = write_file(out, &name, &content) {
            eprintln!("error: cannot write to {}: {}", out.display(), results::reason(&e));
            return STOPPED;
        }
        crate::print(&format!("wrote {}\n", out.join(name).display()));
    }
    DONE
}

fn contents(arguments: &ExportArguments, results: &Results) -> Result<Vec<(String, Vec<u8>)>, String> {
    let format = match arguments.format {
        Format::Csv => ("cracks.csv", CrackFormat::Csv),
        Format::Vtp => ("cracks.vtp", CrackFormat::Vtp),
        Format::Stl => ("cracks.stl", CrackFormat::Stl { thickness: arguments.thickness }),
        Format::Easigrow => return easigrow_files(arguments, results),
        Format::Afgrow => return afgrow_files(arguments, results),
    };
    let step = match arguments.step {
        Some(step) => results.steps.iter().find(|s| s.step == step),
        None => results.steps.last(),
    };
    let step = step.ok_or_else(|| {
        let wanted = arguments.step.map_or("any step".into(), |s| format!("step {s}"));
        format!("{wanted} is not in {}, which has {} steps", arguments.dir.display(), results.steps.len())
    })?;
    let content = cracks_as(format.1, step).map_err(|e| e.to_string())?;
    Ok(vec![(format.0.into(), content)])
}

fn solid_contents(arguments: &ExportArguments, read: &SolidResults) -> Result<Vec<(String, Vec<u8>)>, String> {
    let dir = &arguments.dir;
    let (name, format) = match arguments.format {
        Format::Csv => ("cracks.csv", SolidCrackFormat::Csv),
        Format::Vtp => ("cracks.vtp", SolidCrackFormat::Vtp),
        Format::Stl => ("cracks.stl", SolidCrackFormat::Stl),
        Format::Easigrow | Format::Afgrow => {
            return Err(format!("beta factors are those of tips in the plane, but {} is a solid", dir.display()));
        }
    };
    let content = solid_cracks_as(format, dir, read, arguments.step)
        .map_err(|e| format!("the cracks in {} cannot be read: {}", dir.display(), results::reason(&e)))?;
    let wanted = arguments.step.map_or("any crack".into(), |s| format!("step {s}"));
    let content = content.ok_or_else(|| format!("{wanted} is not in {}", dir.display()))?;
    Ok(vec![(name.into(), content)])
}

fn easigrow_files(arguments: &ExportArguments, results: &Results) -> Result<Vec<(String, Vec<u8>)>, String> {
    let (Some(stress), Some(distance)) = (arguments.stress, arguments.distance) else {
        return Err("beta factors need --stress and --distance".into());
    };
    let reference = BetaReference { stress, distance };
    files_of_tips(arguments, results, "txt", |crack, end| beta_table(results, crack, end, &reference))
}

fn afgrow_files(arguments: &ExportArguments, results: &Results) -> Result<Vec<(String, Vec<u8>)>, String> {
    let Some(stress) = arguments.stress else {
        return Err("beta factors need --stress".into());
    };
    files_of_tips(arguments, results, "tsv", |crack, end| afgrow_table(results, crack, end, stress))
}

/// A file for each tip that has a table.
fn files_of_tips(
    arguments: &ExportArguments,
    results: &Results,
    extension: &str,
    table: impl Fn(&str, End) -> Option<String>,
) -> Result<Vec<(String, Vec<u8>)>, String> {
    let mut files: Vec<(String, Vec<u8>)> = vec![];
    for (crack, end) in tips(results) {
        let Some(table) = table(&crack, end) else { continue };
        let plain: String = crack.chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
        let end = if end == End::Start { "start" } else { "end" };
        let name = format!("beta_{plain}_{end}.{extension}");
        // Names of cracks may differ in signs that names of files do not have.
        let again = files.iter().filter(|f| f.0 == name).count();
        let name = if again == 0 { name } else { format!("beta_{plain}_{end}_{}.{extension}", files.len()) };
        files.push((name, table.into_bytes()));
    }
    if files.is_empty() {
        return Err(format!("no tip in {} has a stress intensity factor", arguments.dir.display()));
    }
    Ok(files)
}
