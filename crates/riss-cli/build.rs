//! Puts the gallery into the program: of each case its page, its case file and the files that these name.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

fn main() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    println!("cargo::rerun-if-changed={}", cases.display());
    let mut folders: Vec<PathBuf> = list(&cases).into_iter().filter(|p| p.join("case.toml").is_file()).collect();
    folders.sort();
    let mut code = String::from("const CASES: &[GalleryCase] = &[\n");
    for folder in folders {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        writeln!(code, "    GalleryCase {{ name: {name:?}, files: &[").expect("a string takes all");
        for path in kept(&folder) {
            println!("cargo::rerun-if-changed={}", path.display());
            let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let path = path.canonicalize().expect("the file is there");
            writeln!(code, "        ({file:?}, include_bytes!({path:?})),").expect("a string takes all");
        }
        code += "    ] },\n";
    }
    code += "];\n";
    let out = std::env::var_os("OUT_DIR").expect("cargo sets it");
    fs::write(Path::new(&out).join("gallery.rs"), code).expect("the folder can be written");
}

/// The files of a case that go along: reference values serve tests only.
fn kept(folder: &Path) -> Vec<PathBuf> {
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap_or_default();
    let texts = read("case.toml") + &read("README.md");
    let is_kept = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        ["case.toml", "README.md"].contains(&name.as_str()) || (name != "expected.json" && texts.contains(&name))
    };
    let mut files: Vec<PathBuf> = list(folder).into_iter().filter(|p| p.is_file() && is_kept(p)).collect();
    files.sort();
    files
}

fn list(folder: &Path) -> Vec<PathBuf> {
    fs::read_dir(folder).map(|entries| entries.flatten().map(|e| e.path()).collect()).unwrap_or_default()
}
