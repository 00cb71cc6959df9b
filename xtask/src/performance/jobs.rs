//! The jobs of the targets.

use super::curves::{Sample, fastest_plate, plate_command, worst_factor};
use super::{CASE, CUBOID, STAGES, number, out_folder, processor_time, run_case};
use crate::{Outcome, target_dir};
use serde_json::Value;
use std::fmt::Write;
use std::path::Path;

/// Numbers of nodes among which one is good enough.
const GEOMETRY_TO_K: [f64; 7] = [250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0, 16_000.0];

/// Seconds of the fastest sample of a benchmark, for one pass, and elements in it. The mean depends more on what else runs.
fn bench(name: &str) -> Result<(f64, f64), String> {
    let folder = target_dir().join("criterion").join(name).join("new");
    let read = |file: &str| -> Result<Value, String> {
        let path = folder.join(file);
        let text = std::fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        serde_json::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))
    };
    let sample = read("sample.json")?;
    let list = |key: &str| sample[key].as_array().into_iter().flatten().filter_map(Value::as_f64).collect::<Vec<_>>();
    let time = list("times").iter().zip(list("iters")).map(|(t, n)| t / n * 1e-9).fold(f64::INFINITY, f64::min);
    let elements = read("benchmark.json")?["throughput"]["Elements"].as_f64().unwrap_or(1.0);
    Ok((time, elements))
}

pub(super) fn rows(program: &Path, reference: f64) -> Result<String, String> {
    let mut text = String::from(
        "\n## Against the targets\n\n| job | peer | target | measured | command |\n| --- | --- | --- | --- | --- |\n",
    );
    let points = "`cargo bench -p riss --bench shape_functions`";
    let mut row = |job: &str, peer: &str, target: &str, measured: String, command: &str| {
        writeln!(text, "| {job} | {peer} | {target} | {measured} | {command} |").expect("a string takes all");
    };
    for (job, name, peer, target) in [
        ("shape functions with gradients, 2D linear, one core", "cells/linear_in_batches", "2.2e5/s", "1e7/s"),
        ("the same one by one, as near cracks", "cells/linear_one_by_one", "", ""),
        ("2D quadratic", "cells/quadratic_in_batches", "1.5e5/s", "4e6/s"),
        ("the same one by one", "cells/quadratic_one_by_one", "", ""),
        ("2D with the full enriched basis", "shape_functions/full_quartic_20", "none", "3e6/s"),
    ] {
        let (time, n) = bench(name)?;
        row(job, peer, target, format!("{:.1e}/s", n / time), points);
    }
    let (time, n) = bench("collocation_15k/stencils")?;
    row(
        "3D cubic constrained MLS, 150 neighbors, all derivatives to second order, front functions in most",
        "5.0e3/s",
        "1.5e5/s",
        format!("{:.1e}/s", n / time),
        "`cargo bench -p riss --bench collocation -- stencils`",
    );
    let (time, n) = bench("assembly/assemble_10k")?;
    let per_unknown = format!("{:.2} µs", 1e6 * time / (2.0 * n));
    let command = "`cargo bench -p riss --bench assembly`";
    row("assembly, 10⁴ nodes, all threads, per unknown", "1 µs", "1 µs at 10⁵ nodes", per_unknown, command);
    // The coarsest plate that is good enough, as all finer ones are: an error may be small by chance.
    let mut samples = vec![];
    for n in GEOMETRY_TO_K {
        samples.push((fastest_plate(program, n, 1)?, n));
    }
    for (error, peer, target) in [(1e-3, "0.05 s", "0.015 s"), (1e-4, "0.08 s", "0.05 s")] {
        let is_good = |s: &Sample| (s.k1 / reference - 1.0).abs() <= error;
        let n_good = samples.iter().rev().take_while(|(s, _)| is_good(s)).count();
        let (measured, n) = match samples.len() - n_good {
            k if n_good > 0 => (format!("{:.3} s, {} nodes", samples[k].0.processor, samples[k].0.nodes), samples[k].1),
            _ => {
                let (last, n) = samples.last().expect("there are sizes");
                let by = (last.k1 / reference - 1.0).abs();
                (format!("not reached: {by:.1e} with {} nodes, {:.3} s", last.nodes, last.processor), *n)
            }
        };
        let job = format!("geometry to K of the shear edge crack, whole process, K_I to {error:.0e} of {reference}");
        row(&job, peer, target, measured, &plate_command(n, 1));
    }
    growth_row(program, &mut row)?;
    many_cracks_row(program, &mut row)?;
    cuboid_row(program, &mut row)?;
    Ok(text)
}

/// Writes a row: job, peer, target, what was measured, command.
type Row<'a> = dyn FnMut(&str, &str, &str, String, &str) + 'a;

fn growth_row(program: &Path, row: &mut Row) -> Outcome {
    for (spacing, error, peer, target) in [
        ("", "the error of the peers' 20,000 unknowns", "0.31 s", "0.04 s; later/first 0.15"),
        ("nodes.layout.graded.spacing=0.17", "a finer plate", "", ""),
    ] {
        let before = processor_time();
        let mut settings = vec!["growth.increment=0.3", "growth.steps=10"];
        settings.extend([spacing].iter().filter(|s| !s.is_empty()));
        let results = run_case(program, CASE, &settings, 1, &out_folder())?;
        let processor = processor_time() - before;
        let steps = results["steps"].as_array().map_or(&[][..], Vec::as_slice);
        let time = |step: &Value| STAGES.iter().filter_map(|s| step["stage_time_s"][*s].as_f64()).sum::<f64>();
        let times: Vec<f64> = steps.iter().map(time).collect();
        let later = times.iter().skip(1).sum::<f64>()
            / (times.len().max(2) - 1) as f64
            / times.first().copied().unwrap_or(f64::NAN);
        let step = processor / times.len() as f64;
        let k1 = number(&steps.last().unwrap_or(&Value::Null)["cracks"][0]["tips"][0]["K_I"]);
        row(
            &format!("growth step, shear plate, ten increments of 0.3, {error}"),
            peer,
            target,
            format!("{step:.3} s with its files; {later:.2}; {} nodes, last K_I {k1:.2}", results["nodes"]),
            &format!("`riss run cases/{CASE}/case.toml --set {} --threads 1`", settings.join(" --set ")),
        );
    }
    Ok(())
}

/// Steps that are run of a hundred, and the case: thirty cracks at fifteen holes.
const FEW_STEPS: usize = 3;
const MANY_CRACKS: &str = "multiple-site-damage";

fn many_cracks_row(program: &Path, row: &mut Row) -> Outcome {
    let steps = format!("growth.steps={FEW_STEPS}");
    let results = run_case(program, MANY_CRACKS, &[&steps], 2, &out_folder())?;
    let step = number(&results["wall_time_s"]) / (FEW_STEPS + 1) as f64;
    row(
        "100 growth steps, 10 cracks, plate with holes, 20,000 nodes",
        "none",
        "under 10 s",
        format!("{step:.2} s a step by the wall clock with 30 cracks, 15 holes, {} nodes", results["nodes"]),
        &format!("`riss run cases/{MANY_CRACKS}/case.toml --set {steps} --threads 2`"),
    );
    Ok(())
}

fn cuboid_row(program: &Path, row: &mut Row) -> Outcome {
    let results = run_case(program, CUBOID, &[], 2, &out_folder())?;
    let error = (worst_factor(&results) - 1.0).abs();
    row(
        "3D near-tip cuboid, K error of 0.5 %",
        "312,000 nodes, 27 s, 1.3 GB",
        "a tenth of the nodes, 5 s, 0.5 GB",
        format!(
            "{} nodes, {:.1} s by the wall clock, {:.2} GB, error {error:.0e}",
            results["nodes"],
            number(&results["wall_time_s"]),
            number(&results["peak_memory_bytes"]) / 1e9
        ),
        &format!("`riss run cases/{CUBOID}/case.toml --threads 2`"),
    );
    Ok(())
}
