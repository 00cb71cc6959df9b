//! `riss cases`: the gallery, which the program carries with it.

use crate::{BAD_CASE, DONE, results};
use clap::Args;
use riss_expected::Expected;
use std::fs::OpenOptions;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

include!(concat!(env!("OUT_DIR"), "/gallery.rs"));

/// A case of the gallery.
pub struct GalleryCase {
    /// Name of its folder.
    pub name: &'static str,
    /// Names and contents.
    files: &'static [(&'static str, &'static [u8])],
    /// `expected.json` and what it names.
    references: &'static [(&'static str, &'static [u8])],
}

/// Arguments of `riss cases`.
#[derive(Args)]
#[command(after_help = "Examples:\n  riss cases\n  riss cases hole\n  riss cases crack-near-hole\n  \
    riss cases crack-near-hole my-plate\n  riss run my-plate/case.toml")]
pub struct CasesArguments {
    /// Case to copy; part of a name lists the cases that hold it [default: list all]
    pub name: Option<String>,
    /// Folder to copy it to [default: NAME in the current folder]; existing files are left alone
    pub dir: Option<PathBuf>,
}

impl GalleryCase {
    /// The first line of its page.
    fn title(&self) -> String {
        let page = self.files.iter().find(|f| f.0 == "README.md").map_or(&b""[..], |f| f.1);
        let text = String::from_utf8_lossy(page);
        text.lines().next().unwrap_or("").trim_start_matches('#').trim().to_string()
    }

    /// Its reference values.
    ///
    /// # Errors
    /// What is not understood in them.
    pub fn expected(&self) -> Result<Expected, String> {
        let file = |name: &str| {
            let found = self.references.iter().find(|f| f.0 == name).ok_or_else(|| format!("{name} is missing"))?;
            String::from_utf8(found.1.to_vec()).map_err(|e| e.to_string())
        };
        Expected::parse(&file("expected.json")?, &file)
    }
}

/// All cases, by name.
pub fn gallery() -> &'static [GalleryCase] {
    CASES
}

/// Lists the gallery or copies one of its cases; returns the exit code.
pub fn cases(arguments: &CasesArguments) -> u8 {
    let Some(name) = &arguments.name else {
        crate::print(&list(CASES.iter()));
        return DONE;
    };
    if let Some(case) = CASES.iter().find(|c| c.name == name) {
        return copy(case, arguments.dir.as_deref().unwrap_or(Path::new(case.name)));
    }
    let alike: Vec<&GalleryCase> = CASES.iter().filter(|c| c.name.contains(name.as_str())).collect();
    if alike.is_empty() || arguments.dir.is_some() {
        eprintln!("error: there is no case `{name}`; `riss cases` lists all {}", CASES.len());
        return BAD_CASE;
    }
    crate::print(&list(alike.into_iter()));
    DONE
}

fn list<'c>(cases: impl Iterator<Item = &'c GalleryCase>) -> String {
    let width = CASES.iter().map(|c| c.name.len()).max().unwrap_or(0);
    cases.map(|c| format!("{:width$}  {}\n", c.name, c.title())).collect()
}

fn copy(case: &GalleryCase, dir: &Path) -> u8 {
    let taken = case.files.iter().map(|f| dir.join(f.0)).find(|p| p.exists());
    if let Some(path) = taken {
        eprintln!("error: {} exists and is left as it is; name another folder", path.display());
        return BAD_CASE;
    }
    match write(case, dir) {
        Ok(()) => {
            let file = dir.join("case.toml");
            crate::print(&format!("wrote {0}\nrun it with: riss run {0}\n", file.display()));
            DONE
        }
        Err(e) => {
            eprintln!("error: cannot write to {}: {}", dir.display(), results::reason(&e));
            BAD_CASE
        }
    }
}

/// Copies a case into a folder, which is made if needed.
pub fn write(case: &GalleryCase, dir: &Path) -> io::Result<()> {
    std::fs::create_dir_all(dir)?;
    for (name, content) in case.files {
        OpenOptions::new().write(true).create_new(true).open(dir.join(name))?.write_all(content)?;
    }
    Ok(())
}
