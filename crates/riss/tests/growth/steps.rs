//! Runs of crack growth, kept step by step.

use riss::analysis::{
    GrowthEnd, GrowthSettings, GrowthState, Observer, Settings, StaticResult, StepRecord, TipRecord, crack_growth,
};
use riss::crack::CrackPath;
use riss::model::Model;
use std::ops::ControlFlow;

/// Everything that growth reports, without fields.
#[derive(Debug, Default)]
pub struct Steps {
    pub records: Vec<StepRecord>,
    pub states: Vec<GrowthState>,
    /// Break off after this many steps.
    pub most: Option<usize>,
}

impl Observer for Steps {
    fn wants_fields(&self, _step: usize) -> bool {
        false
    }

    fn step(&mut self, result: &StaticResult, state: Option<&GrowthState>) -> ControlFlow<()> {
        self.records.push(result.step.clone());
        self.states.extend(state.cloned());
        match self.most {
            Some(most) if self.records.len() >= most => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    }
}

impl Steps {
    /// The cracks of the last step.
    pub fn cracks(&self) -> &[CrackPath] {
        &self.states.last().expect("there is a step").cracks
    }

    /// The first tip of a crack in a step.
    pub fn tip(&self, step: usize, crack: usize) -> &TipRecord {
        &self.records[step].cracks[crack].tips[0]
    }
}

/// Grows to the end.
pub fn grow(model: &Model, settings: &Settings, growth: &GrowthSettings) -> (Steps, GrowthEnd) {
    let mut steps = Steps::default();
    let end = crack_growth(model, settings, growth, None, &mut steps).expect("the first step can be solved");
    (steps, end.expect("nobody broke off"))
}
