//! Puts the gallery into the program: of each case its page, its case file and the files that these name; apart from them
//! its reference values.

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
        let [files, references] = [kept(&folder), references(&folder)].map(|paths| embedded(&paths));
        writeln!(code, "    GalleryCase {{ name: {name:?}, files: &[{files}], references: &[{references}] }},")
            .expect("a string takes all");
    }
    code += "];\n";
    let out = std::env::var_os("OUT_DIR").expect("cargo sets it");
    fs::write(Path::new(&out).join("gallery.rs"), code).expect("the folder can be written");
}

/// Names and contents, as code.
fn embedded(paths: &[PathBuf]) -> String {
    let mut code = String::new();
    for path in paths {
        println!("cargo::rerun-if-changed={}", path.display());
        let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let path = path.canonicalize().expect("the file is there");
        write!(code, "({file:?}, include_bytes!({path:?})), ").expect("a string takes all");
    }
    code
}

/// `expected.json` and the files that it names.
fn references(folder: &Path) -> Vec<PathBuf> {
    let text = fs::read_to_string(folder.join("expected.json")).unwrap_or_default();
    let is_named = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        name == "expected.json" || text.contains(&format!("\"{name}\""))
    };
    let mut files: Vec<PathBuf> = list(folder).into_iter().filter(|p| p.is_file() && is_named(p)).collect();
    files.sort();
    files
}

/// The files of a case that go along when it is copied.
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
