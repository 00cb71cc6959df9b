//! The generated pages of the book agree with the program.

use std::process::Command;
use xtask::docs::{CASE_FILE_PAGES, GALLERY_PAGE};

#[test]
fn references_of_case_files_are_current() {
    for page in &CASE_FILE_PAGES {
        let output = Command::new(env!("CARGO_BIN_EXE_riss")).args(page.arguments).output().expect("riss runs");
        let schema = String::from_utf8_lossy(&output.stdout);
        let text = xtask::reference::page_of_schema_text(&schema, page.head).expect("a schema");
        let written = std::fs::read_to_string(xtask::root().join(page.path)).unwrap_or_default();
        assert!(text == written, "{} is not current: run `cargo xtask docs`", page.path);
    }
}

#[test]
fn gallery_is_current() {
    let page = xtask::gallery::page(&xtask::root()).expect("complete cases");
    let written = std::fs::read_to_string(xtask::root().join(GALLERY_PAGE)).unwrap_or_default();
    assert!(page == written, "{GALLERY_PAGE} is not current: run `cargo xtask docs`");
}
