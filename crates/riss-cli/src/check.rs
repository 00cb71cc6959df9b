//! `riss check`.

use crate::claim::Claim;
use crate::table::number;
use crate::{BAD_CASE, DONE, STOPPED, diagnostics, results, solid};
use clap::Args;
use riss::analysis::{Silent, discretize};
use riss::case::AnyCase;
use riss::model::Model;
use std::path::PathBuf;

/// Arguments of `riss check`.
#[derive(Args)]
#[command(after_help = "Examples:\n  riss check case.toml\n  riss check case.toml --set crack[0].path[1]=[40,100]")]
pub struct CheckArguments {
    /// Case file
    pub case: PathBuf,
    /// Overrides a key of the case, such as material.young=70e9; may be given several times
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<String>,
    /// Folder for the picture of the model [default: NAME.riss-out in the current folder]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// Checks a case, says what it holds and draws it; returns the exit code.
pub fn check(arguments: &CheckArguments) -> u8 {
    let case = match AnyCase::read(&arguments.case, &arguments.overrides) {
        Ok(AnyCase::Plane(case)) => *case,
        Ok(AnyCase::Solid(case)) => return solid::check(&case, arguments.out.clone()),
        Err(errors) => {
            diagnostics::report_errors(&errors);
            return BAD_CASE;
        }
    };
    diagnostics::report_notes(&case);
    crate::print(&describe(&case.model));
    let discrete = match discretize(&case.model, &case.settings, &mut Silent) {
        Ok(discrete) => discrete,
        Err(error) => {
            eprintln!("error: {error}");
            return STOPPED;
        }
    };
    let n_points = discrete.cells.points.len();
    crate::print(&line("nodes", discrete.approximation.nodes().len().to_string()));
    crate::print(&line("cells", format!("{} with {n_points} integration points", discrete.cells.len())));
    let dir = arguments.out.clone().unwrap_or_else(|| results::default_folder(&arguments.case));
    match Claim::of(&dir).and_then(|_claim| results::write_picture(&dir, &case.model, &discrete)) {
        Ok(path) => {
            crate::print(&line("picture", path.display().to_string()));
            DONE
        }
        Err(e) => {
            eprintln!("error: cannot write a picture to {}: {}", dir.display(), results::reason(&e));
            STOPPED
        }
    }
}

/// A line of the description.
fn line(name: &str, value: String) -> String {
    format!("{name:<9}{value}\n")
}

fn describe(model: &Model) -> String {
    let mut text = String::new();
    text += &line("case", model.title.clone());
    let domain = &model.domain;
    let holes = match domain.loops.len() - 1 {
        0 => "no holes".to_string(),
        1 => "1 hole".into(),
        n => format!("{n} holes"),
    };
    text += &line("body", format!("area {}, {} edges, {holes}", number(domain.area()), domain.edges.len()));
    let parts: Vec<&str> = domain.parts.iter().map(|p| p.name.as_str()).collect();
    text += &line("parts", parts.join(", "));
    for crack in &model.cracks {
        let tips: Vec<String> = (crack.tip_ends())
            .map(|end| crack.frame(end).position)
            .map(|p| format!("({}, {})", number(p.x), number(p.y)))
            .collect();
        let tips = if tips.is_empty() { "no tips".into() } else { format!("tips at {}", tips.join(" and ")) };
        text += &line("crack", format!("{}: length {}, {tips}", crack.name, number(crack.length())));
    }
    let loads = model.loads.len() + model.point_loads.len() + usize::from(model.body_force.is_some());
    let supports = model.supports.len() + model.point_supports.len() + model.springs.len();
    text += &line("loads", loads.to_string());
    text += &line("supports", supports.to_string());
    text
}
