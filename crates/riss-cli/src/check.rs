//! `riss check`.

use crate::table::number;
use crate::{BAD_CASE, DONE, diagnostics};
use clap::Args;
use riss::case::Case;
use riss::model::Model;
use std::fmt::Write;
use std::path::PathBuf;

/// Arguments of `riss check`.
#[derive(Args)]
pub struct CheckArguments {
    /// Case file
    pub case: PathBuf,
    /// Overrides a key of the case, such as material.young=70e9; may be given several times
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<String>,
}

/// Checks a case and says what it holds; returns the exit code.
pub fn check(arguments: &CheckArguments) -> u8 {
    match Case::read(&arguments.case, &arguments.overrides) {
        Ok(case) => {
            diagnostics::report_notes(&case);
            crate::print(&describe(&case.model));
            DONE
        }
        Err(errors) => {
            diagnostics::report_errors(&errors);
            BAD_CASE
        }
    }
}

fn describe(model: &Model) -> String {
    let mut text = String::new();
    let mut line = |name: &str, value: String| writeln!(text, "{name:<9}{value}").expect("a string takes all");
    line("case", model.title.clone());
    let domain = &model.domain;
    let holes = domain.loops.len() - 1;
    line("body", format!("area {}, {} edges, {holes} holes", number(domain.area()), domain.edges.len()));
    let parts: Vec<&str> = domain.parts.iter().map(|p| p.name.as_str()).collect();
    line("parts", parts.join(", "));
    for crack in &model.cracks {
        let tips: Vec<String> = (crack.tip_ends())
            .map(|end| crack.frame(end).position)
            .map(|p| format!("({}, {})", number(p.x), number(p.y)))
            .collect();
        let tips = if tips.is_empty() { "no tips".into() } else { format!("tips at {}", tips.join(" and ")) };
        line("crack", format!("{}: length {}, {tips}", crack.name, number(crack.length())));
    }
    let loads = model.loads.len() + model.point_loads.len() + usize::from(model.body_force.is_some());
    let supports = model.supports.len() + model.point_supports.len() + model.springs.len();
    line("loads", loads.to_string());
    line("supports", supports.to_string());
    text
}
