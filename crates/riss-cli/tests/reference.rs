//! The generated page of the book agrees with the program.

use std::process::Command;
use xtask::docs::{CASE_FILE_PAGE, GALLERY_PAGE};

#[test]
fn reference_of_the_case_file_is_current() {
    let output = Command::new(env!("CARGO_BIN_EXE_riss")).arg("schema").output().expect("riss runs");
    let page = xtask::reference::page_of_schema_text(&String::from_utf8_lossy(&output.stdout)).expect("a schema");
    let written = std::fs::read_to_string(xtask::root().join(CASE_FILE_PAGE)).unwrap_or_default();
    assert!(page == written, "{CASE_FILE_PAGE} is not current: run `cargo xtask docs`");
}

#[test]
fn gallery_is_current() {
    let page = xtask::gallery::page(&xtask::root()).expect("complete cases");
    let written = std::fs::read_to_string(xtask::root().join(GALLERY_PAGE)).unwrap_or_default();
    assert!(page == written, "{GALLERY_PAGE} is not current: run `cargo xtask docs`");
}
