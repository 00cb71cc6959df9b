//! The report of a large run: what one step of 100,000 points costs, and the report of 100 of them.

#[path = "../tests/output/sample.rs"]
mod sample;

use criterion::{Criterion, criterion_group, criterion_main};
use riss::output::{OutputOptions, RESULTS_FILE, RunWriter, read_results, write_report};
use std::path::Path;
use std::time::Duration;

const N_STEPS: usize = 100;
/// Half the number of cells along each side: 317² points and some on the upper face of the crack.
const HALF_CELLS: usize = 158;

fn write_step(dir: &Path, options: OutputOptions) {
    let mut writer = RunWriter::new(dir, options).expect("a folder");
    writer.write_step(&sample::info(), &sample::result(HALF_CELLS), &[], None).expect("written");
}

/// Makes a run of one step one of a hundred.
fn repeat_step(dir: &Path) {
    let mut results = read_results(dir).expect("results");
    let first = results.steps[0].clone();
    for k in 1..N_STEPS {
        let mut step = first.clone();
        step.step = k;
        results.steps.push(step);
        for kind in ["fine", "coarse"] {
            let text = std::fs::read_to_string(dir.join(format!("report/{kind}_0000.json"))).expect("fields");
            let text = text.replacen("\"step\":0", &format!("\"step\":{k}"), 1);
            std::fs::write(dir.join(format!("report/{kind}_{k:04}.json")), text).expect("written");
        }
    }
    std::fs::write(dir.join(RESULTS_FILE), results.to_json()).expect("written");
}

fn report(c: &mut Criterion) {
    let dir = tempfile::tempdir().expect("a folder");
    let mut group = c.benchmark_group("report");
    group.sample_size(10).measurement_time(Duration::from_secs(20));
    let without = OutputOptions { fields: false, ..OutputOptions::default() };
    group.bench_function("files of a step without fields", |b| b.iter(|| write_step(dir.path(), without)));
    group.bench_function("files of a step", |b| b.iter(|| write_step(dir.path(), OutputOptions::default())));
    write_step(dir.path(), OutputOptions::default());
    repeat_step(dir.path());
    group.bench_function("report of 100 steps", |b| b.iter(|| write_report(dir.path()).expect("written")));
    group.finish();
    // Kept where the folder of the bench is asked for, to open it in a browser.
    if let Some(kept) = std::env::var_os("RISS_BENCH_REPORT") {
        std::fs::copy(dir.path().join("report.html"), kept).expect("copied");
    }
}

criterion_group!(benches, report);
criterion_main!(benches);
