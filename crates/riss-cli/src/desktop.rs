//! The browser of the desktop.

use std::path::Path;
use std::process::{Command, Stdio};

/// The program that opens a file as a double click does.
#[cfg(target_os = "macos")]
const OPENER: &[&str] = &["open"];
#[cfg(windows)]
const OPENER: &[&str] = &["rundll32", "url.dll,FileProtocolHandler"];
#[cfg(not(any(target_os = "macos", windows)))]
const OPENER: &[&str] = &["xdg-open"];

/// Opens a file; where there is no desktop, says so and goes on.
pub fn open(path: &Path) {
    let path = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let mut command = Command::new(OPENER[0]);
    let quiet = command.args(&OPENER[1..]).arg(&path).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    // Not waited for: some openers stay as long as the browser.
    if quiet.spawn().is_err() {
        eprintln!(
            "note: {} cannot be opened from here ({} is missing); open it in a browser",
            path.display(),
            OPENER[0]
        );
    }
}
