//! Every case folder is complete: a page, a case file and reference values.

use super::Findings;
use riss_expected::Expected;
use std::path::Path;

/// Checks all folders under `cases`.
pub fn check(root: &Path, findings: &mut Findings) {
    for folder in crate::case_folders(root) {
        let name = folder.strip_prefix(root).unwrap_or(&folder).to_path_buf();
        check_file(&name, &folder, "README.md", findings, |text| {
            text.starts_with("# ").then_some(()).ok_or_else(|| "the page must begin with a title".into())
        });
        check_file(&name, &folder, "case.toml", findings, |text| {
            text.parse::<toml::Table>().map(|_| ()).map_err(|e| e.to_string())
        });
        check_file(&name, &folder, "expected.json", findings, |_| Expected::read(&folder).map(|_| ()));
    }
}

fn check_file(
    name: &Path,
    folder: &Path,
    file: &str,
    findings: &mut Findings,
    parse: impl FnOnce(&str) -> Result<(), String>,
) {
    let path = name.join(file);
    match std::fs::read_to_string(folder.join(file)) {
        Err(e) => findings.error(&path, 1, format!("cannot be read: {e}")),
        Ok(text) => {
            if let Err(reason) = parse(&text) {
                findings.error(&path, 1, reason);
            }
        }
    }
}
