//! The corpora of `fuzz/` and seeded changes of them, on any toolchain; see `fuzz/README.md`.

#[path = "../../../fuzz/src/lib.rs"]
mod targets;

use std::panic::catch_unwind;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// No small input takes longer.
const LONGEST: Duration = Duration::from_secs(5);
/// Longest input that is made.
const MOST_BYTES: usize = 20_000;
/// Bytes that often lie at the edge of something.
const WORDS: [&[u8]; 20] = [
    b"0",
    b"-1",
    b"1e308",
    b"1e-308",
    b"nan",
    b"inf",
    b"4294967296",
    b"18446744073709551615",
    b"-9223372036854775808",
    b"\n",
    b",",
    b"=",
    b"[",
    b"]]",
    b"\xff\xff\xff\xff",
    b"\0\0\0\0\0\0\0\0",
    b"\xff",
    b"*",
    b"$",
    b"\xc3",
];

/// A xorshift generator, the same everywhere.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % n.max(1) as u64) as usize
    }
}

fn corpus(target: &str) -> Vec<(PathBuf, Vec<u8>)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/corpus").join(target);
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(&folder).expect("a corpus").map(|e| e.expect("a file").path()).collect();
    files.sort();
    files.into_iter().map(|f| (f.clone(), std::fs::read(&f).expect("bytes"))).collect()
}

/// One to four changes of an input, some with pieces of another.
fn changed(input: &[u8], other: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = input.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len() + 1);
        let most = if random.below(4) == 0 { 200 } else { 8 };
        let length = 1 + random.below(most);
        let end = (at + length).min(bytes.len());
        match random.below(7) {
            0 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
            1 if at < bytes.len() => bytes[at] = random.below(256) as u8,
            2 => drop(bytes.drain(at..end)),
            3 => {
                let piece = bytes[at..end].to_vec();
                drop(bytes.splice(at..at, piece));
            }
            4 => {
                let word = WORDS[random.below(WORDS.len())];
                drop(bytes.splice(at..end.min(at + random.below(word.len() + 1)), word.iter().copied()));
            }
            5 => {
                let from = random.below(other.len() + 1);
                let piece = other[from..(from + length).min(other.len())].to_vec();
                drop(bytes.splice(at..end, piece));
            }
            // A digit for a digit.
            _ => {
                if let Some(k) = (at..bytes.len()).find(|k| bytes[*k].is_ascii_digit()) {
                    bytes[k] = b'0' + random.below(10) as u8;
                }
            }
        }
    }
    bytes.truncate(MOST_BYTES);
    bytes
}

/// Runs a target on its corpus and on `n` changes of it; a crash leaves its input in the folder of temporary files.
fn check(target: &str, run: fn(&[u8]), n: usize) {
    let corpus = corpus(target);
    assert!(!corpus.is_empty());
    let mut random = Random(0x005e_ed0f_f0ee ^ target.len() as u64);
    let replayed = corpus.iter().map(|(path, bytes)| (path.display().to_string(), bytes.clone()));
    let mut inputs: Vec<(String, Vec<u8>)> = replayed.collect();
    for k in 0..n {
        let (path, bytes) = &corpus[random.below(corpus.len())];
        let other = random.below(corpus.len());
        let name = path.file_name().expect("a file").to_string_lossy();
        inputs.push((format!("change {k} of {name}"), changed(bytes, &corpus[other].1, &mut random)));
    }
    for (name, bytes) in inputs {
        let start = Instant::now();
        let outcome = catch_unwind(|| run(&bytes));
        if outcome.is_err() || start.elapsed() > LONGEST {
            let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("crash-{target}"));
            let _ = std::fs::write(&kept, &bytes);
            panic!("{target}: {name} crashes, or took {:.1?}; it is in {}", start.elapsed(), kept.display());
        }
    }
}

#[test]
fn case_files() {
    check("case_file", targets::case_file, 700);
}

#[test]
fn meshes_of_gmsh() {
    check("msh", targets::msh, 3000);
}

#[test]
fn input_files_of_abaqus() {
    check("inp", targets::inp, 3000);
}

#[test]
fn stl_files() {
    check("stl", targets::stl, 3000);
}

#[test]
fn expressions() {
    check("expression", targets::expression, 700);
}

#[test]
fn polygons() {
    check("polygon", targets::polygon, 5000);
}

#[test]
fn predicates() {
    check("predicates", targets::predicates, 5000);
}

#[test]
fn quadtrees() {
    check("quadtree", targets::quadtree, 1500);
}

#[test]
fn surfaces_and_fronts() {
    check("surface", targets::surface, 1000);
}
