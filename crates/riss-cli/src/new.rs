//! `riss new`.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::Path;

/// A case to start from.
pub const STARTER: &str = include_str!("starter.toml");

/// Writes the starter case, never over an existing file.
pub fn write(path: &Path) -> u8 {
    // Asking and creating in one step: nobody can put a file there in between.
    let written =
        OpenOptions::new().write(true).create_new(true).open(path).and_then(|mut f| f.write_all(STARTER.as_bytes()));
    match written {
        Ok(()) => {
            crate::print(&format!("wrote {0}\nrun it with: riss run {0}\n", path.display()));
            crate::DONE
        }
        Err(e) if e.kind() == std::io::ErrorKind::AlreadyExists => {
            eprintln!("error: {} exists and is left as it is; name another file", path.display());
            crate::BAD_CASE
        }
        Err(e) => {
            eprintln!("error: cannot write {}: {}", path.display(), crate::results::reason(&e));
            crate::BAD_CASE
        }
    }
}
