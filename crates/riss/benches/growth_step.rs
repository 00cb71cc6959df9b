//! One step of crack growth: the first, the tenth and the hundredth of a sheared plate.

mod plate;

use criterion::{Criterion, criterion_group, criterion_main};
use plate::plate;
use riss::analysis::{GrowthSettings, GrowthState, Observer, Settings, StaticResult, crack_growth};
use riss::model::Model;
use std::hint::black_box;
use std::ops::ControlFlow;

/// Steps that are timed, from 0.
const STEPS: [(usize, &str); 3] = [(0, "first"), (9, "tenth"), (99, "hundredth")];

/// Breaks off after a number of steps and keeps their states.
#[derive(Default)]
struct Until {
    n_steps: usize,
    states: Vec<GrowthState>,
}

impl Observer for Until {
    fn wants_fields(&self, _step: usize) -> bool {
        false
    }

    fn step(&mut self, _result: &StaticResult, state: Option<&GrowthState>) -> ControlFlow<()> {
        self.states.extend(state.cloned());
        if self.states.len() >= self.n_steps { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

fn steps(model: &Model, growth: &GrowthSettings, start: Option<GrowthState>, n_steps: usize) -> Vec<GrowthState> {
    let mut until = Until { n_steps, states: vec![] };
    crack_growth(model, &Settings::default(), growth, start, &mut until).unwrap();
    until.states
}

fn bench(c: &mut Criterion) {
    let (model, _) = plate(1_000);
    // A hundred of them turn the crack upward and leave it inside the plate.
    let growth = GrowthSettings { increment: Some(0.03), steps: 100, ..GrowthSettings::default() };
    let states = steps(&model, &growth, None, 100);
    let mut group = c.benchmark_group("growth_step");
    group.sample_size(10);
    for (step, name) in STEPS {
        let start = states.get(step).expect("the crack grows on").clone();
        group.bench_function(name, |b| b.iter(|| black_box(steps(&model, &growth, Some(start.clone()), 1))));
    }
    group.finish();
}

criterion_group!(benches, bench);
criterion_main!(benches);
