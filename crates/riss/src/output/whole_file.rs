//! Files that appear whole or not at all.

use serde::de::DeserializeOwned;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Writes `content` to `path` by way of a temporary file in the same folder; an older file stays until the new one
/// is complete.
///
/// # Errors
/// What the system says, with the path; the temporary file is removed.
pub fn write_whole(path: &Path, content: &[u8]) -> io::Result<()> {
    // The process in the name keeps two runs apart that write into the same folder.
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let temporary = path.with_file_name(format!(".{name}.{}.tmp", std::process::id()));
    let written = write_synced(&temporary, content).and_then(|()| fs::rename(&temporary, path));
    written.map_err(|e| {
        // The first error is the one to report.
        let _ = fs::remove_file(&temporary);
        io::Error::new(e.kind(), format!("cannot write {}: {e}", path.display()))
    })
}

/// Removes a file; none there is fine.
///
/// # Errors
/// What the system says.
pub(super) fn remove_if_there(path: &Path) -> io::Result<()> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(e),
        _ => Ok(()),
    }
}

/// Removes the temporary files that killed runs have left in a folder; one without the folder is fine.
///
/// # Errors
/// What the system says.
pub fn remove_leftovers(dir: &Path) -> io::Result<()> {
    let Ok(entries) = fs::read_dir(dir) else { return Ok(()) };
    for entry in entries {
        let entry = entry?;
        if is_temporary(&entry.file_name().to_string_lossy()) {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

/// Whether [`write_whole`] makes such names: `.results.json.1234.tmp`.
fn is_temporary(name: &str) -> bool {
    let process = name.strip_prefix('.').and_then(|n| n.strip_suffix(".tmp")).and_then(|n| n.rsplit_once('.'));
    process.is_some_and(|(name, id)| !name.is_empty() && !id.is_empty() && id.bytes().all(|b| b.is_ascii_digit()))
}

fn write_synced(path: &Path, content: &[u8]) -> io::Result<()> {
    let mut file: File = OpenOptions::new().write(true).create(true).truncate(true).open(path)?;
    file.write_all(content)?;
    file.sync_all()
}

/// What a JSON file says; none if it is not there.
///
/// # Errors
/// What the system says; `InvalidData` if the file says something else.
pub(super) fn read_if_there<T: DeserializeOwned>(path: &Path) -> io::Result<Option<T>> {
    match fs::read(path) {
        Ok(text) => Ok(Some(serde_json::from_slice(&text)?)),
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(e) => Err(e),
    }
}

/// Writes files of a folder one after the other, each by its name; returns their paths.
///
/// # Errors
/// What the system says of the first that cannot be written.
pub(super) fn write_all(dir: &Path, files: &[(String, Vec<u8>)]) -> io::Result<Vec<PathBuf>> {
    let write = |(name, content): &(String, Vec<u8>)| {
        let path = dir.join(name);
        write_whole(&path, content).map(|()| path)
    };
    files.iter().map(write).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_temporary_files_are_leftovers() {
        let dir = tempfile::tempdir().unwrap();
        let mine = [".hidden", "a.7.tmp", ".a.tmp", ".a.b.tmp", ".riss.lock", "results.json"];
        mine.iter()
            .chain(&[".results.json.123.tmp", ".a.7.tmp"])
            .for_each(|n| fs::write(dir.path().join(n), "").unwrap());
        remove_leftovers(dir.path()).unwrap();
        remove_leftovers(&dir.path().join("nowhere")).unwrap();
        let mut left: Vec<_> = fs::read_dir(dir.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
        left.sort();
        let mut mine = mine.to_vec();
        mine.sort();
        assert_eq!(left, mine);
    }

    #[test]
    fn replaces_whole_files_and_leaves_nothing_else() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.txt");
        write_whole(&path, b"one").unwrap();
        write_whole(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
        // A folder of that name cannot be replaced; the temporary file goes away.
        fs::create_dir(dir.path().join("b")).unwrap();
        fs::write(dir.path().join("b/keep"), b"").unwrap();
        let error = write_whole(&dir.path().join("b"), b"x").unwrap_err();
        assert!(error.to_string().starts_with("cannot write "), "{error}");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 2);
    }
}
