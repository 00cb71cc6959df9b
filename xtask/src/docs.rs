//! `cargo xtask docs`: the generated pages of the book, and the book itself.

use crate::{Outcome, build_riss, gallery, reference, root};
use std::process::Command;

/// The generated page, from the root of the workspace.
pub const CASE_FILE_PAGE: &str = "docs/src/reference/case-file.md";

/// The page of all cases, from the root of the workspace.
pub const GALLERY_PAGE: &str = "docs/src/reference/gallery.md";

/// Writes the reference of the case file from `riss schema`, and the gallery; builds the book if `mdbook` is installed.
pub fn run() -> Outcome {
    let riss = build_riss()?;
    let output = Command::new(&riss).arg("schema").output().map_err(|e| format!("{} schema: {e}", riss.display()))?;
    let page = reference::page_of_schema_text(&String::from_utf8_lossy(&output.stdout))?;
    let path = root().join(CASE_FILE_PAGE);
    std::fs::write(&path, page).map_err(|e| format!("{}: {e}", path.display()))?;
    println!("wrote {CASE_FILE_PAGE}");
    let path = root().join(GALLERY_PAGE);
    std::fs::write(&path, gallery::page(&root())?).map_err(|e| format!("{}: {e}", path.display()))?;
    println!("wrote {GALLERY_PAGE}");
    match Command::new("mdbook").arg("build").arg(root().join("docs")).status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("mdbook ended with {status}")),
        Err(_) => {
            println!("mdbook is not installed: the book was not built");
            Ok(())
        }
    }
}
