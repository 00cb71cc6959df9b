//! Load histories as lists of cycles, in factors on the loads of the case.

use super::{FieldProblem, Problems, rainflow};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the loads vary in time; every history repeats for ever. Factors multiply all loads of the case at once.
///
/// Cycles do not act on each other: no retardation after overloads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum LoadSpectrum {
    /// The same cycle again and again.
    ConstantAmplitude {
        /// Smallest over largest load, R, below 1.
        #[serde(default)]
        stress_ratio: f64,
        /// Factor at the largest load, positive.
        #[serde(default = "default_maximum")]
        maximum: f64,
    },
    /// Blocks of equal cycles, one after the other.
    Blocks {
        /// The blocks, at least one. Between blocks nothing is counted.
        blocks: Vec<Block>,
    },
    /// A history of factors, cycles counted by the rainflow method for repeating histories [ASTME1049, section 5.4.5].
    Sequence {
        /// Peaks and valleys, or a record of which they are taken; at least two different values.
        values: Vec<f64>,
    },
}

fn default_maximum() -> f64 {
    1.0
}

impl Default for LoadSpectrum {
    fn default() -> Self {
        Self::ConstantAmplitude { stress_ratio: 0.0, maximum: default_maximum() }
    }
}

/// Equal load cycles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Block {
    /// Factor at the smallest load.
    pub minimum: f64,
    /// Factor at the largest load, above `minimum`.
    pub maximum: f64,
    /// How many there are, positive; 0.5 is half a cycle.
    pub cycles: f64,
}

/// Equal cycles of a history.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadCycle {
    /// Factor on the loads at the smallest load.
    pub minimum: f64,
    /// Factor on the loads at the largest load.
    pub maximum: f64,
    /// How many there are in one repetition.
    pub count: f64,
}

impl LoadSpectrum {
    /// The cycles of one repetition, equal ones together, largest maximum first.
    pub fn cycles(&self) -> Vec<LoadCycle> {
        let cycles = match self {
            Self::ConstantAmplitude { stress_ratio, maximum } => {
                vec![LoadCycle { minimum: stress_ratio * maximum, maximum: *maximum, count: 1.0 }]
            }
            Self::Blocks { blocks } => {
                blocks.iter().map(|b| LoadCycle { minimum: b.minimum, maximum: b.maximum, count: b.cycles }).collect()
            }
            Self::Sequence { values } => rainflow::count_repeating(values),
        };
        merged(cycles)
    }

    /// Everything that keeps the spectrum from being used, empty if it is sound.
    pub fn problems(&self) -> Vec<FieldProblem> {
        match self {
            Self::ConstantAmplitude { stress_ratio, maximum } => {
                let mut problems = Problems::of("constant-amplitude");
                problems.demand("stress_ratio", *stress_ratio, "below 1", |v| v < 1.0);
                problems.positive("maximum", *maximum);
                problems.found
            }
            Self::Blocks { blocks } => block_problems(blocks),
            Self::Sequence { values } => {
                let mut problems = Problems::of("sequence");
                for (i, value) in values.iter().enumerate() {
                    problems.finite(format!("values[{i}]"), *value);
                }
                if problems.found.is_empty() && values.windows(2).all(|pair| pair[0] == pair[1]) {
                    problems.report("values", "the load does not vary", "at least two different values");
                }
                if problems.found.is_empty() && values.iter().all(|v| *v <= 0.0) {
                    problems.report("values", "the load never acts", "at least one positive value");
                }
                problems.found
            }
        }
    }
}

fn block_problems(blocks: &[Block]) -> Vec<FieldProblem> {
    let mut problems = Problems::of("blocks");
    if blocks.is_empty() {
        problems.report("blocks", "is empty", "at least one block");
    }
    for (i, block) in blocks.iter().enumerate() {
        problems.finite(format!("blocks[{i}].minimum"), block.minimum);
        problems.finite(format!("blocks[{i}].maximum"), block.maximum);
        problems.positive(format!("blocks[{i}].cycles"), block.cycles);
        if block.maximum <= block.minimum {
            problems.report(format!("blocks[{i}].maximum"), format!("is {}", block.maximum), "above `minimum`");
        }
    }
    if problems.found.is_empty() && blocks.iter().all(|b| b.maximum <= 0.0) {
        problems.report("blocks", "the load never acts", "at least one positive `maximum`");
    }
    problems.found
}

fn merged(mut cycles: Vec<LoadCycle>) -> Vec<LoadCycle> {
    cycles.sort_by(|a, b| b.maximum.total_cmp(&a.maximum).then(a.minimum.total_cmp(&b.minimum)));
    let mut merged: Vec<LoadCycle> = vec![];
    for cycle in cycles {
        match merged.last_mut() {
            Some(last) if last.maximum == cycle.maximum && last.minimum == cycle.minimum => last.count += cycle.count,
            Some(_) | None => merged.push(cycle),
        }
    }
    merged
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_cycles_are_counted_together() {
        let block = |minimum, maximum, cycles| Block { minimum, maximum, cycles };
        let blocks = vec![block(0.1, 0.8, 10.0), block(-0.5, 1.0, 2.0), block(0.1, 0.8, 5.0), block(0.3, 0.8, 1.0)];
        let cycle = |minimum, maximum, count| LoadCycle { minimum, maximum, count };
        let expected = [cycle(-0.5, 1.0, 2.0), cycle(0.1, 0.8, 15.0), cycle(0.3, 0.8, 1.0)];
        assert_eq!(LoadSpectrum::Blocks { blocks }.cycles(), expected);
        assert_eq!(LoadSpectrum::default().cycles(), [cycle(0.0, 1.0, 1.0)]);
        let reversed = LoadSpectrum::ConstantAmplitude { stress_ratio: -1.0, maximum: 2.0 };
        assert_eq!(reversed.cycles(), [cycle(-2.0, 2.0, 1.0)]);
        let sequence = LoadSpectrum::Sequence { values: vec![0.0, 0.4, 1.0, 0.0, 1.0, 0.2, 0.5, 0.2, 0.5] };
        assert_eq!(sequence.cycles(), [cycle(0.0, 1.0, 2.0), cycle(0.2, 0.5, 2.0)]);
    }

    fn check_problems(spectrum: LoadSpectrum, fields: &[&str]) {
        let problems = spectrum.problems();
        let found: Vec<_> = problems.iter().map(|p| p.field.as_str()).collect();
        assert_eq!(found, fields, "{spectrum:?}");
    }

    #[test]
    fn all_bad_fields_are_reported() {
        let constant = |stress_ratio, maximum| LoadSpectrum::ConstantAmplitude { stress_ratio, maximum };
        check_problems(constant(-1.0, 1.0), &[]);
        check_problems(constant(1.0, -1.0), &["constant-amplitude.stress_ratio", "constant-amplitude.maximum"]);
        let blocks = |list: &[(f64, f64, f64)]| LoadSpectrum::Blocks {
            blocks: list.iter().map(|&(minimum, maximum, cycles)| Block { minimum, maximum, cycles }).collect(),
        };
        check_problems(blocks(&[]), &["blocks.blocks"]);
        check_problems(blocks(&[(-2.0, -1.0, 1.0)]), &["blocks.blocks"]);
        let bad = [(0.0, 1.0, 0.0), (0.5, 0.5, 1.0), (f64::NAN, 1.0, 1.0)];
        let fields = ["blocks.blocks[0].cycles", "blocks.blocks[1].maximum", "blocks.blocks[2].minimum"];
        check_problems(blocks(&bad), &fields);
        let sequence = |values: &[f64]| LoadSpectrum::Sequence { values: values.to_vec() };
        check_problems(sequence(&[0.0, 1.0]), &[]);
        check_problems(sequence(&[1.0, 1.0]), &["sequence.values"]);
        check_problems(sequence(&[]), &["sequence.values"]);
        check_problems(sequence(&[-1.0, 0.0]), &["sequence.values"]);
        check_problems(sequence(&[0.0, f64::INFINITY]), &["sequence.values[1]"]);
    }
}
