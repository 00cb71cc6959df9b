//! `riss converge`.

use crate::claim::Claim;
use crate::memory::MemoryLimit;
use crate::progress::Progress;
use crate::table::{aligned, number};
use crate::{BAD_CASE, DONE, STOPPED, diagnostics, results, solid_converge};
use clap::Args;
use riss::analysis::{ConvergenceStudy, Limit, RunSize, Settings, SolidSettings, converge, converge_solid};
use riss::case::AnyCase;
use riss::crack::End;
use riss::output::{write_convergence, write_solid_convergence};
use std::path::PathBuf;

/// Spacings over that of the case, if none are given; those of solids stay near: half the spacing takes eight times the nodes.
const PLANE: [f64; 5] = [2.0, 1.4, 1.0, 0.7, 0.5];
const SOLID: [f64; 4] = [1.3, 1.15, 1.0, 0.85];

/// Arguments of `riss converge`.
#[derive(Args)]
#[command(
    after_help = "Examples:\n  riss converge plate.toml\n  riss converge plate.toml --factors 2,1,0.5,0.25 --out study\n  riss converge penny.toml --set fracture.points=4"
)]
pub struct ConvergeArguments {
    /// Case file; its cracks do not grow
    pub case: PathBuf,
    /// Node spacings of the solutions over that of the case, at least three [default: 2,1.4,1,0.7,0.5, of solids 1.3,1.15,1,0.85]
    #[arg(long, value_name = "F,...", value_delimiter = ',', value_parser = factor)]
    pub factors: Vec<f64>,
    /// Folder for the table and the picture [default: NAME.riss-out in the current folder]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Overrides a key of the case, such as material.young=70e9; may be given several times
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<String>,
    /// Refuses a study whose finest nodes need more memory, such as 12GB: `free` is what the machine has, `none` is no limit
    #[arg(long, value_name = "SIZE", default_value = "free", value_parser = MemoryLimit::parse)]
    pub memory_limit: MemoryLimit,
    /// Shows no progress and no notes
    #[arg(long, short)]
    pub quiet: bool,
}

fn factor(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if (0.05..=20.0).contains(&value) => Ok(value),
        _ => Err("it must be a number from 0.05 to 20".into()),
    }
}

/// Solves on nodes of several spacings and says where K goes; returns the exit code.
pub fn run(arguments: &ConvergeArguments) -> u8 {
    let case = match AnyCase::read(&arguments.case, &arguments.overrides) {
        Ok(case) => case,
        Err(errors) => {
            diagnostics::report_errors(&errors);
            return BAD_CASE;
        }
    };
    if let AnyCase::Plane(case) = &case
        && case.loading.is_some()
    {
        crate::fail("studies of cohesive cracks are made in space only: riss compare shows what other nodes change");
        return BAD_CASE;
    }
    let mut factors = arguments.factors.clone();
    if factors.is_empty() {
        factors = match &case {
            AnyCase::Plane(_) => PLANE.to_vec(),
            AnyCase::Solid(_) => SOLID.to_vec(),
        };
    }
    factors.sort_by(f64::total_cmp);
    factors.dedup();
    if factors.len() < 3 {
        eprintln!("error: a limit needs at least three different factors, {} given", factors.len());
        return BAD_CASE;
    }
    let size = match &case {
        AnyCase::Plane(case) => {
            let finest = case.settings.nodes.scaled(&case.model, factors[0]);
            let settings = finest.map(|nodes| Settings { nodes, ..case.settings.clone() });
            settings.map(|s| RunSize::of_plane(&case.model, &s, None))
        }
        AnyCase::Solid(case) => {
            let settings = SolidSettings { spacing: case.settings.spacing.scaled(factors[0]), ..case.settings.clone() };
            Some(RunSize::of_solid(&case.model, &settings))
        }
    };
    if let Some(reason) = size.and_then(|s| arguments.memory_limit.refusal(&s)) {
        crate::fail(&reason);
        return BAD_CASE;
    }
    let dir = arguments.out.clone().unwrap_or_else(|| results::default_folder(&arguments.case));
    let _claim = match Claim::of(&dir) {
        Ok(claim) => claim,
        Err(e) => {
            eprintln!("error: cannot write to {}: {}", dir.display(), results::reason(&e));
            return STOPPED;
        }
    };
    let mut progress = Progress::new(arguments.quiet);
    let outcome = match &case {
        AnyCase::Plane(case) => {
            let study = converge(&case.model, &case.settings, &factors, &mut progress);
            study.map(|s| (case.model.title.clone(), summary(&s), write_convergence(&dir, &s)))
        }
        AnyCase::Solid(case) => {
            if case.growth.is_some() && !arguments.quiet {
                eprintln!("note: cracks do not grow in a study; [growth] is left aside");
            }
            let loading = case.loading.as_ref();
            let study = converge_solid(&case.model, &case.settings, loading, &factors, &mut progress);
            study.map(|s| {
                let text = solid_converge::summary(&s);
                (case.model.title.clone(), text, write_solid_convergence(&dir, &s))
            })
        }
    };
    progress.finish();
    match outcome {
        Ok((title, text, Ok(paths))) => {
            let lines: String = paths.iter().map(|p| format!("wrote {}\n", p.display())).collect();
            crate::print(&format!("{title}\n\n{text}\n{lines}"));
            DONE
        }
        Ok((_, _, Err(e))) => {
            eprintln!("error: cannot write to {}: {}", dir.display(), results::reason(&e));
            STOPPED
        }
        Err(error) => {
            eprintln!("error: {error}");
            STOPPED
        }
    }
}

/// Tips one after the other: each solution, the limit, the order.
fn summary(study: &ConvergenceStudy) -> String {
    let n_tips = study.levels.first().map_or(0, |l| l.tips.len());
    let mut rows = vec![];
    for k in 0..n_tips {
        for level in &study.levels {
            let tip = &level.tips[k];
            let numbers = [tip.factors[0], tip.factors[1], tip.uncertainty].map(number);
            rows.push(row(&tip.crack, tip.end, &level.n_nodes.to_string(), numbers));
        }
        if let [Some(k1), Some(k2)] = study.limits[k] {
            let tip = &study.levels[0].tips[k];
            let numbers = [k1.value, k2.value, k1.uncertainty.max(k2.uncertainty)].map(number);
            rows.push(row(&tip.crack, tip.end, "limit", numbers));
            rows.push(row(&tip.crack, tip.end, "order", [order(&k1), order(&k2), String::new()]));
        }
    }
    if rows.is_empty() {
        let row = |l: &riss::analysis::convergence::Level| vec![l.n_nodes.to_string(), number(l.strain_energy)];
        return aligned(&["nodes", "strain energy"], &study.levels.iter().map(row).collect::<Vec<_>>(), &[]);
    }
    aligned(&["crack", "end", "nodes", "K_I", "K_II", "K_uncertainty"], &rows, &[0, 1])
}

/// Order of convergence; a value that hardly changes has none that can be told.
pub fn order(limit: &Limit) -> String {
    if limit.uncertainty > 1e-12 * limit.value.abs() { format!("{:.2}", limit.order) } else { "-".into() }
}

fn row(crack: &str, end: End, nodes: &str, numbers: [String; 3]) -> Vec<String> {
    let end = match end {
        End::Start => "start",
        End::End => "end",
    };
    [crack, end, nodes].map(String::from).into_iter().chain(numbers).collect()
}
