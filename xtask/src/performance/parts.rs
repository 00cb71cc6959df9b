//! Instructions of a run by part of the program.

use super::CASE;
use super::curves::{plate_command, plate_setting};
use crate::{instructions, target_dir};
use std::fmt::Write;
use std::path::Path;
use std::process::Command;

/// Parts of the program by what their files or functions are called; the first that fits counts.
const PARTS: [(&str, &[&str]); 12] = [
    // The assembly kernels of faer are all that has no names.
    ("dense kernels and sparse factorization (faer)", &["faer", "gemm", "???:0x"]),
    ("triangulation (spade)", &["spade", "robust"]),
    ("compression", &["miniz_oxide"]),
    ("`nodes`", &["riss/src/nodes/", "riss::nodes::"]),
    ("`geometry`", &["riss/src/geometry/", "riss::geometry::"]),
    ("`math/lanes`: vector registers", &["pulp", "core_arch", "riss/src/math/lanes"]),
    ("`approximation`", &["riss/src/approximation/", "riss::approximation::"]),
    ("`integration`", &["riss/src/integration/", "riss::integration::"]),
    ("`system`", &["riss/src/system/", "riss::system::"]),
    ("`fracture`", &["riss/src/fracture/", "riss::fracture::"]),
    ("`analysis`", &["riss/src/analysis/", "riss::analysis::"]),
    ("`case` and `output`", &["riss/src/case/", "riss/src/output/", "riss::case::", "riss::output::"]),
];

/// Instructions by part of the program, where valgrind is installed.
pub(super) fn part_table(program: &Path) -> Result<String, String> {
    let head = "\n## Instructions\n\n";
    if !instructions::can_count() {
        return Ok(format!("{head}Not measured: valgrind is not installed.\n"));
    }
    let (file, n) = (target_dir().join("performance.callgrind"), 1000.0);
    let set = plate_setting(n);
    instructions::count(program, &["run", &format!("cases/{CASE}/case.toml"), "--threads", "1", "--set", &set], &file)?;
    let annotate = Command::new("callgrind_annotate").args(["--auto=no", "--threshold=100"]).arg(&file).output();
    let table = String::from_utf8_lossy(&annotate.map_err(|e| format!("callgrind_annotate: {e}"))?.stdout).into_owned();
    let (counts, total) = count_parts(&table);
    let mut text = format!(
        "{head}{} under `valgrind --tool=callgrind`, which shows the program a processor with AVX2. They do not depend on \
         what else the machine does.\n\n| part | million instructions | share |\n| --- | ---: | ---: |\n",
        plate_command(n, 1)
    );
    for (part, count) in PARTS.iter().map(|p| p.0).chain(["the rest"]).zip(counts).chain([("all", total)]) {
        writeln!(text, "| {part} | {:.0} | {:.0} % |", count / 1e6, 100.0 * count / total).expect("a string takes all");
    }
    Ok(text)
}

/// Instructions of each part and of the rest, and of all, from lines such as `1,234 ( 5.67%)  file:function [object]`.
fn count_parts(table: &str) -> ([f64; PARTS.len() + 1], f64) {
    let (mut counts, mut total) = ([0.0; PARTS.len() + 1], 0.0);
    for line in table.lines() {
        let Some((number, rest)) = line.split_once('(') else { continue };
        let Ok(count) = number.trim().replace(',', "").parse::<f64>() else { continue };
        if rest.contains("PROGRAM TOTALS") {
            continue;
        }
        let part = PARTS.iter().position(|(_, names)| names.iter().any(|name| rest.contains(name)));
        counts[part.unwrap_or(PARTS.len())] += count;
        total += count;
    }
    (counts, total)
}

#[cfg(test)]
mod tests {
    #[test]
    fn instructions_go_to_their_part() {
        let table = "3,010 (100.0%)  PROGRAM TOTALS\n\n1,000 (33.3%)  /a/crates/riss/src/nodes/fill.rs:riss::nodes::fill [/b]\n\
                     1,000 (33.2%)  core/src/x.rs:faer::solve\n1,000 (33.2%)  ???:0x0000000000db6b80 []\n   10 ( 0.3%)  ???:malloc\n";
        let (counts, total) = super::count_parts(table);
        assert_eq!((counts[3], counts[0], counts[super::PARTS.len()], total), (1000.0, 2000.0, 10.0, 3010.0));
    }
}
