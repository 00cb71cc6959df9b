//! Files that a case names: they lie in the folder of the case, unless it says that they may lie anywhere.
//!
//! A case file from somebody else can then read nothing else on this machine, neither by `..`, nor by an absolute path,
//! nor through a symbolic link; `--set files=beside` holds even against a case that says otherwise.

use super::document::{Content, Document};
use super::problem::Problem;
use super::{MAX_MESH_BYTES, read_bytes};
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::{Component, Path, PathBuf};

/// Key of the case.
const KEY: &str = "files";

/// Where the files that a case names may lie.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(in crate::case) enum FileAccess {
    /// In the folder of the case or below.
    #[default]
    Beside,
    /// Anywhere.
    Anywhere,
}

/// Reads the files that a case names.
pub(super) struct Files {
    folder: PathBuf,
    access: FileAccess,
}

impl Files {
    /// Those of the case at `path`; what the document says about [`FileAccess`] counts even before it is checked.
    pub fn of(document: &Document, path: &Path) -> Self {
        let is_anywhere =
            matches!(document.root.get(KEY).map(|n| &n.content), Some(Content::Text(t)) if t == "anywhere");
        let access = if is_anywhere { FileAccess::Anywhere } else { FileAccess::Beside };
        Self { folder: path.parent().unwrap_or(Path::new("")).into(), access }
    }

    /// The bytes of a file, of at most 500 MB.
    pub fn bytes(&self, name: &str) -> Result<Vec<u8>, Box<Problem>> {
        let path = self.folder.join(name);
        // By name first, so that nothing is told about what is there.
        if self.access == FileAccess::Beside && !(self.lies_beside(name) && self.stays_beside(&path)) {
            return Err(outside(name));
        }
        // A pipe would be waited for without end.
        match std::fs::metadata(&path) {
            Ok(found) if !found.is_file() && !found.is_dir() => {
                Err(Box::new(Problem::new("", format!("cannot read {}: it is not a regular file", path.display()))))
            }
            Ok(_) | Err(_) => read_bytes(&path, MAX_MESH_BYTES),
        }
    }

    /// The text of a file.
    pub fn text(&self, name: &str) -> Result<String, Box<Problem>> {
        super::text_of(self.bytes(name)?)
    }

    /// Whether the name alone stays in the folder.
    fn lies_beside(&self, name: &str) -> bool {
        let name = Path::new(name);
        if name.is_absolute() {
            let Ok(folder) = self.real_folder() else { return false };
            let up = name.components().any(|c| c == Component::ParentDir);
            return !up && (name.starts_with(&folder) || (self.folder.is_absolute() && name.starts_with(&self.folder)));
        }
        is_below(name)
    }

    /// Whether what is there, links followed, lies in the folder; what is not there is refused when it is read.
    fn stays_beside(&self, path: &Path) -> bool {
        match (path.canonicalize(), self.real_folder()) {
            (Ok(real), Ok(folder)) => real.starts_with(folder),
            (Err(_), _) => true,
            (Ok(_), Err(_)) => false,
        }
    }

    fn real_folder(&self) -> std::io::Result<PathBuf> {
        let here = self.folder.as_os_str().is_empty();
        if here { Path::new(".").canonicalize() } else { self.folder.canonicalize() }
    }
}

/// Whether a relative path never climbs above where it starts, nor names a root or a drive.
pub(super) fn is_below(path: &Path) -> bool {
    let mut depth = 0usize;
    for component in path.components() {
        match component {
            Component::Normal(_) => depth += 1,
            Component::ParentDir if depth > 0 => depth -= 1,
            Component::CurDir => {}
            Component::ParentDir | Component::RootDir | Component::Prefix(_) => return false,
        }
    }
    true
}

#[cold]
fn outside(name: &str) -> Box<Problem> {
    let mut problem = Problem::new("", format!("{name} is outside the folder of the case"));
    problem.suggest("put it beside the case file, or allow it with files = \"anywhere\" (--set files=anywhere)");
    Box::new(problem)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_climb_are_told_apart() {
        for name in ["a.msh", "sub/a.msh", "./a.msh", "sub/../a.msh"] {
            assert!(is_below(Path::new(name)), "{name}");
        }
        for name in ["../a.msh", "sub/../../a.msh", "/etc/passwd", "..", "a/../../b/a.msh"] {
            assert!(!is_below(Path::new(name)), "{name}");
        }
    }

    /// What is refused of a file in a folder of its own, with another file and folder outside.
    #[test]
    fn files_beside_the_case_are_read_and_no_others() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("case");
        std::fs::create_dir_all(folder.join("sub")).unwrap();
        for file in ["case/a", "case/sub/b", "secret"] {
            std::fs::write(place.path().join(file), file).unwrap();
        }
        let absolute = |file: &str| place.path().join(file).canonicalize().unwrap().display().to_string();
        let files = |access| Files { folder: folder.clone(), access };
        let beside = files(FileAccess::Beside);
        let anywhere = files(FileAccess::Anywhere);
        for name in ["a", "sub/b", "sub/../a", &absolute("case/a"), &absolute("case/sub/b")] {
            assert!(beside.bytes(name).is_ok(), "{name}");
        }
        for name in ["../secret", "sub/../../secret", "../missing", &absolute("secret")] {
            let problem = beside.bytes(name).unwrap_err();
            assert_eq!(problem.message, format!("{name} is outside the folder of the case"));
            assert!(problem.suggestion.unwrap().contains("--set files=anywhere"));
        }
        assert_eq!(anywhere.bytes("../secret").unwrap(), b"secret");
        assert_eq!(anywhere.bytes(&absolute("secret")).unwrap(), b"secret");
        assert!(beside.bytes("missing").unwrap_err().message.contains("there is no such file"));
        assert!(beside.bytes("sub").unwrap_err().message.contains("a folder"));
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_before_they_are_judged() {
        use std::os::unix::fs::symlink;
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("case");
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(place.path().join("secret"), "s").unwrap();
        std::fs::write(folder.join("a"), "a").unwrap();
        symlink("../secret", folder.join("out")).unwrap();
        symlink("..", folder.join("up")).unwrap();
        symlink("a", folder.join("in")).unwrap();
        let beside = Files { folder: folder.clone(), access: FileAccess::Beside };
        for name in ["out", "up/secret", "up/case/../secret"] {
            assert!(beside.bytes(name).unwrap_err().message.contains("outside"), "{name}");
        }
        assert_eq!(beside.bytes("in").unwrap(), b"a");
        // The folder itself may be reached through a link.
        symlink("case", place.path().join("linked")).unwrap();
        let linked = Files { folder: place.path().join("linked"), access: FileAccess::Beside };
        assert_eq!(linked.bytes("a").unwrap(), b"a");
        assert_eq!(linked.bytes(&place.path().join("linked/a").display().to_string()).unwrap(), b"a");
    }

    #[cfg(unix)]
    #[test]
    fn devices_and_pipes_are_no_files() {
        let anywhere = Files { folder: "/dev".into(), access: FileAccess::Anywhere };
        assert!(anywhere.bytes("zero").unwrap_err().message.contains("not a regular file"));
    }
}
