//! Every case folder that is not for `cargo xtask verify` only, run by the `riss` program, meets its reference values.

use riss_expected::{Comparison, Expected, RunBy, run_case};
use std::path::Path;
use xtask::verify::failure;

#[test]
fn every_case_meets_its_reference_values() {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cases");
    let mut failures = vec![];
    // One after the other: each run uses all cores.
    for folder in xtask::case_folders(&xtask::root()) {
        let case = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let riss = Path::new(env!("CARGO_BIN_EXE_riss"));
        let run = match Expected::read(&folder) {
            Ok(expected) if expected.run_by == RunBy::Verify => continue,
            Ok(expected) => run_case(riss, &folder, &expected, &out.join(&case)),
            Err(reason) => Err(reason),
        };
        match run {
            Ok(run) => {
                failures.extend(run.comparisons.iter().filter(|c| !Comparison::passed(c)).map(|c| failure(&case, c)))
            }
            Err(reason) => failures.push(format!("{case}: {reason}")),
        }
    }
    assert!(failures.is_empty(), "{} failures\n{}", failures.len(), failures.join("\n"));
}
