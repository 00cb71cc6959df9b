//! `report.html`: one file that shows a run in any browser, without a network.
//!
//! Reading order: [`step_fields`] (what is kept of each step, as a file of its own), with `thinning` and `quantize` below
//! it, for solids [`solid_scene`] with `boundary`; then this file, which puts page, script and data together. What the user wrote is escaped, always.

mod boundary;
pub(super) mod chart;
pub(super) mod loading;
mod quantize;
pub mod solid_scene;
mod step_fields;
mod thinning;

use super::color_map::VIRIDIS;
use super::results::Results;
use super::run_writer::read_results;
use super::solid_files::read_solid_results;
use super::solid_report::solid_report;
use super::whole_file::{read_if_there, write_whole};
use crate::analysis::Fields;
use loading::loading_section;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};
use step_fields::Detail;

/// Name of the report.
pub const REPORT_FILE: &str = "report.html";
/// Folder of what the report is made of beside `results.json`.
pub const REPORT_FOLDER: &str = "report";
/// Where the run says what it ran.
const SOURCE_FILE: &str = "report/run.json";
/// Bytes of all fields in a report: with the rest it stays below 20 MB, which opens at once and passes as an attachment.
const MOST_BYTES: u64 = 18_000_000;

const PAGE: &str = include_str!("report.html");
const STYLE: [&str; 2] = [include_str!("vendor/uPlot.min.css"), include_str!("report.css")];
/// In this order; each file names what it offers to those after it.
const SCRIPT: [&str; 11] = [
    include_str!("js/format.js"),
    include_str!("js/copy.js"),
    include_str!("js/colors.js"),
    include_str!("js/fields.js"),
    include_str!("js/raster.js"),
    include_str!("js/map.js"),
    include_str!("js/pointer.js"),
    include_str!("js/steps.js"),
    include_str!("js/curves.js"),
    include_str!("js/tables.js"),
    include_str!("js/page.js"),
];
/// With its licence, which goes wherever the library goes.
const CURVE_LIBRARY: [&str; 4] =
    ["/*\n", include_str!("vendor/uPlot.LICENSE"), "*/\n", include_str!("vendor/uPlot.iife.min.js")];

/// The view of a solid, and its scripts in order.
pub(super) const SOLID_VIEW: &str = include_str!("solid_view.html");
const SOLID_SCRIPT: [&str; 8] = [
    include_str!("js/format.js"),
    include_str!("js/copy.js"),
    include_str!("js/colors.js"),
    include_str!("js/fields.js"),
    include_str!("js/solid_fields.js"),
    include_str!("js/solid_view.js"),
    include_str!("js/solid.js"),
    include_str!("js/solid_controls.js"),
];
const SPACE_LIBRARY: [&str; 4] =
    ["/*\n", include_str!("vendor/twgl.LICENSE"), "*/\n", include_str!("vendor/twgl.iife.min.js")];

/// What was run, for the reader of a report.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunSource {
    /// Name of the case file.
    pub case_file: String,
    /// Its text.
    pub case_text: String,
    /// Keys that were set beside it.
    pub overrides: Vec<String>,
    /// Operating system and processor.
    pub platform: String,
    /// Number of threads.
    pub threads: usize,
    /// Begin of the run, in seconds since 1970.
    pub started_unix_s: u64,
    /// Key and value of every setting, defaults filled in.
    #[serde(default)]
    pub settings: Vec<[String; 2]>,
}

impl RunSource {
    /// That of a run which begins now.
    ///
    /// - `program`: what runs it, beside system and processor
    pub fn begun(
        case_file: &Path,
        case_text: &str,
        overrides: &[String],
        settings: Vec<[String; 2]>,
        program: &str,
    ) -> Self {
        let since_1970 = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        Self {
            case_file: case_file.file_name().map_or(String::new(), |n| n.to_string_lossy().into_owned()),
            case_text: case_text.into(),
            overrides: overrides.to_vec(),
            platform: format!("{} on {}{program}", std::env::consts::OS, std::env::consts::ARCH),
            threads: rayon::current_num_threads(),
            started_unix_s: since_1970.as_secs(),
            settings,
        }
    }
}

/// Makes the report of a finished or interrupted run again from its folder; returns its path.
///
/// # Errors
/// What the system says; `InvalidData` if the results there are none of ours.
pub fn write_report(dir: &Path) -> io::Result<PathBuf> {
    let page = match read_solid_results(dir) {
        Some(results) => solid_report(&results, &solid_scene::Scenes::read(dir)?),
        None => report(dir, &read_results(dir)?)?,
    };
    let path = dir.join(REPORT_FILE);
    write_whole(&path, page.as_bytes())?;
    Ok(path)
}

/// Files of one step, by name.
pub(super) fn step_files(step: usize, fields: &Fields) -> Vec<(String, Vec<u8>)> {
    let levels = step_fields::pack(step, fields);
    levels.into_iter().map(|(detail, text)| (step_file_name(detail, step), text.into_bytes())).collect()
}

/// Says in the folder what is run, or forgets what was run there before.
pub(super) fn write_source(dir: &Path, source: Option<&RunSource>) -> io::Result<()> {
    let path = dir.join(SOURCE_FILE);
    match source {
        Some(source) => {
            fs::create_dir_all(dir.join(REPORT_FOLDER))?;
            write_whole(&path, &serde_json::to_vec_pretty(source)?)
        }
        None if path.exists() => fs::remove_file(path),
        None => Ok(()),
    }
}

/// Says in a folder what is run there, for the report of a solid.
///
/// # Errors
/// What the system says.
pub fn describe_run(dir: &Path, source: &RunSource) -> io::Result<()> {
    write_source(dir, Some(source))
}

/// What was run in a folder, if it is told there.
fn read_source(dir: &Path) -> io::Result<Option<RunSource>> {
    read_if_there(&dir.join(SOURCE_FILE))
}

/// Names of the files that the report is made of beside those of `step` and `results.json`.
pub(super) fn files_before(dir: &Path, step: usize) -> Vec<String> {
    let of_steps =
        [Detail::Coarse, Detail::Fine].into_iter().flat_map(|d| (0..step).map(move |s| step_file_name(d, s)));
    of_steps.chain([SOURCE_FILE.into()]).filter(|name| dir.join(name).is_file()).collect()
}

fn step_file_name(detail: Detail, step: usize) -> String {
    let name = match detail {
        Detail::Fine => "fine",
        Detail::Coarse => "coarse",
    };
    format!("{REPORT_FOLDER}/{name}_{step:04}.json")
}

/// The page itself.
pub(super) fn report(dir: &Path, results: &Results) -> io::Result<String> {
    let source = read_source(dir)?;
    let steps: Vec<usize> = results.steps.iter().map(|s| s.step).collect();
    let chosen = choose(dir, &steps, MOST_BYTES);
    let mut fields = String::new();
    for (step, path) in &chosen {
        let text = fs::read_to_string(path)?;
        push_data(&mut fields, &format!("fields-{step}"), &text);
    }
    let with_fields: Vec<usize> = chosen.iter().map(|c| c.0).collect();
    let run = json!({ "source": source, "stepsWithFields": with_fields, "viridis": VIRIDIS });
    let mut data = String::new();
    push_data(&mut data, "results", &serde_json::to_string(results)?);
    push_data(&mut data, "run", &run.to_string());
    push_data(&mut data, "units", &serde_json::to_string(&results.units)?);
    data.push_str(&fields);
    Ok(fill(PAGE, |mark| match mark {
        "title" => html(&results.case),
        "style" => STYLE.concat(),
        "load curve" => loading_section(results.loading.as_ref(), &results.load_curve),
        "curve library" => CURVE_LIBRARY.concat(),
        "script" => SCRIPT.concat(),
        "data" => std::mem::take(&mut data),
        other => unreachable!("the page has no part `{other}`"),
    }))
}

/// Which file to take for each step, so that together they have at most `most_bytes`: all fine ones, or coarse ones with
/// the last step fine, or those of every second, third, ... step.
fn choose(dir: &Path, steps: &[usize], most_bytes: u64) -> Vec<(usize, PathBuf)> {
    let length = |path: &Path| fs::metadata(path).ok().filter(|m| m.is_file()).map(|m| m.len());
    let file = |detail, step| {
        let path = dir.join(step_file_name(detail, step));
        length(&path).map(|bytes| (step, path, bytes))
    };
    let fine: Vec<_> = steps.iter().filter_map(|s| file(Detail::Fine, *s)).collect();
    let coarse: Vec<_> = fine.iter().map(|f| file(Detail::Coarse, f.0).unwrap_or_else(|| f.clone())).collect();
    let total = |files: &[(usize, PathBuf, u64)]| files.iter().map(|f| f.2).sum::<u64>();
    let mut chosen = if total(&fine) <= most_bytes { fine.clone() } else { coarse };
    if let (Some(last), Some(fine)) = (chosen.last().cloned(), fine.last())
        && total(&chosen) - last.2 + fine.2 <= most_bytes
    {
        chosen.pop();
        chosen.push(fine.clone());
    }
    // From the last step backwards: it is the one to look at.
    let every =
        (1..).find(|n| chosen.iter().rev().step_by(*n).map(|f| f.2).sum::<u64>() <= most_bytes || *n > steps.len());
    let mut kept: Vec<_> = chosen.into_iter().rev().step_by(every.unwrap_or(1)).map(|f| (f.0, f.1)).collect();
    kept.reverse();
    kept
}

/// Library and script of the view of a solid.
pub(super) fn push_solid_script(page: &mut String) {
    let [library, script] = [SPACE_LIBRARY.concat(), SOLID_SCRIPT.concat()];
    page.push_str(&format!(
        "<script>\n{library}</script>\n<script>\n\"use strict\";\n(() => {{\n{script}}})();\n</script>\n"
    ));
}

/// A block of data that the browser does not run.
pub(super) fn push_data(page: &mut String, id: &str, json: &str) {
    page.push_str(&format!("<script type=\"application/json\" id=\"{id}\">"));
    push_json(page, json);
    page.push_str("</script>\n");
}

/// JSON that no HTML parser and no script takes for anything else.
fn push_json(page: &mut String, json: &str) {
    let mut rest = json;
    while let Some(at) = rest.find(['<', '>', '&', '\u{2028}', '\u{2029}']) {
        let (before, from) = rest.split_at(at);
        page.push_str(before);
        let letter = from.chars().next().unwrap_or_default();
        page.push_str(&format!("\\u{:04x}", u32::from(letter)));
        rest = &from[letter.len_utf8()..];
    }
    page.push_str(rest);
}

/// Text that stands for itself in a page.
pub(super) fn html(text: &str) -> String {
    let escaped = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;");
    escaped.replace('\u{2028}', "&#x2028;").replace('\u{2029}', "&#x2029;")
}

/// Puts a text in the place of each mark `{{ name }}`.
fn fill(template: &str, mut part: impl FnMut(&str) -> String) -> String {
    let mut page = String::new();
    let mut rest = template;
    while let Some((before, (mark, after))) = rest.split_once("{{ ").and_then(|(b, r)| Some((b, r.split_once(" }}")?)))
    {
        page.push_str(before);
        page.push_str(&part(mark));
        rest = after;
    }
    page.push_str(rest);
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_stays_json_and_holds_no_markup() {
        let text = "</script><!-- & \u{2028} \u{2029} é \"";
        let mut page = String::new();
        push_json(&mut page, &serde_json::to_string(text).unwrap());
        assert!(!page.contains(['<', '>', '&', '\u{2028}', '\u{2029}']), "{page}");
        assert_eq!(serde_json::from_str::<String>(&page).unwrap(), text);
    }

    #[test]
    fn fields_fit_into_the_report() {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir(dir.path().join(REPORT_FOLDER)).unwrap();
        let write = |detail, step, bytes| {
            fs::write(dir.path().join(step_file_name(detail, step)), vec![b'x'; bytes]).unwrap();
        };
        for step in 0..5 {
            write(Detail::Fine, step, 100);
            write(Detail::Coarse, step, 10);
        }
        // No coarse file: it is small as it is. Step 6 has no fields.
        write(Detail::Fine, 5, 12);
        let steps = [0, 1, 2, 3, 4, 5, 6];
        let check_chosen = |most: u64, expected: &[(usize, Detail)]| {
            let expected: Vec<_> =
                expected.iter().map(|(s, d)| (*s, dir.path().join(step_file_name(*d, *s)))).collect();
            assert_eq!(choose(dir.path(), &steps, most), expected, "{most}");
        };
        let all = |d: Detail| (0..5).map(|s| (s, d)).chain([(5, Detail::Fine)]).collect::<Vec<_>>();
        check_chosen(512, &all(Detail::Fine));
        check_chosen(511, &all(Detail::Coarse));
        check_chosen(62, &all(Detail::Coarse));
        check_chosen(61, &[(1, Detail::Coarse), (3, Detail::Coarse), (5, Detail::Fine)]);
        check_chosen(5, &[(5, Detail::Fine)]);
        fs::remove_file(dir.path().join(step_file_name(Detail::Fine, 5))).unwrap();
        let last_fine: Vec<_> = (0..4).map(|s| (s, Detail::Coarse)).chain([(4, Detail::Fine)]).collect();
        check_chosen(140, &last_fine);
    }

    #[test]
    fn every_mark_of_the_page_is_filled() {
        let mut marks = vec![];
        let page = fill(PAGE, |mark| {
            marks.push(mark.to_string());
            String::new()
        });
        assert_eq!(marks, ["title", "style", "title", "load curve", "data", "curve library", "script"]);
        assert!(!page.contains("{{"));
    }
}
