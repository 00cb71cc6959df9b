//! `riss shape`.

use crate::claim::Claim;
use crate::table::number;
use crate::{BAD_CASE, DONE, STOPPED, diagnostics, results};
use clap::{ArgGroup, Args};
use riss::analysis::{Silent, discretize, nearest_node, sample_node_function};
use riss::case::Case;
use riss::math::Vector2;
use riss::output::write_shape_pictures;
use std::path::PathBuf;

/// Arguments of `riss shape`.
#[derive(Args)]
#[command(
    group = ArgGroup::new("which").required(true),
    after_help = "Examples:\n  riss shape case.toml --at 30,100\n  riss shape case.toml --node 57 --set approximation.dilation=3"
)]
pub struct ShapeArguments {
    /// Case file
    pub case: PathBuf,
    /// Number of the node, from 0
    #[arg(long, value_name = "N", group = "which")]
    pub node: Option<usize>,
    /// The node nearest to a point; beside a crack the one on the point's side
    #[arg(long, value_name = "X,Y", group = "which", allow_hyphen_values = true, value_parser = point)]
    pub at: Option<Vector2>,
    /// Overrides a key of the case, such as approximation.dilation=3; may be given several times
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub overrides: Vec<String>,
    /// Folder for the pictures [default: NAME.riss-out in the current folder]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

fn point(text: &str) -> Result<Vector2, String> {
    let numbers: Vec<f64> = text.split(',').filter_map(|s| s.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y] if x.is_finite() && y.is_finite() && text.split(',').count() == 2 => Ok(Vector2::new(x, y)),
        _ => Err("expected two numbers, such as 3.5,8".into()),
    }
}

/// Draws the weight and the shape function of a node; returns the exit code.
pub fn shape(arguments: &ShapeArguments) -> u8 {
    let case = match Case::read(&arguments.case, &arguments.overrides) {
        Ok(case) => case,
        Err(errors) => {
            diagnostics::report_errors(&errors);
            return BAD_CASE;
        }
    };
    let discrete = match discretize(&case.model, &case.settings, &mut Silent) {
        Ok(discrete) => discrete,
        Err(error) => {
            eprintln!("error: {error}");
            return STOPPED;
        }
    };
    let at = || nearest_node(&discrete, arguments.at.unwrap_or_default());
    let node = arguments.node.unwrap_or_else(at);
    let n_nodes = discrete.n_nodes();
    if node >= n_nodes {
        eprintln!("error: there is no node {node}; the case has nodes 0 to {}", n_nodes.saturating_sub(1));
        return BAD_CASE;
    }
    let function = sample_node_function(&discrete, node);
    let p = function.position;
    let radius = number(function.support_radius);
    crate::print(&format!("node {node} at ({}, {}), support radius {radius}\n", number(p.x), number(p.y)));
    let dir = arguments.out.clone().unwrap_or_else(|| results::default_folder(&arguments.case));
    match Claim::of(&dir).and_then(|_claim| write_shape_pictures(&dir, &case.model, &function)) {
        Ok(paths) => {
            crate::print(&paths.iter().map(|p| format!("wrote {}\n", p.display())).collect::<String>());
            DONE
        }
        Err(e) => {
            eprintln!("error: cannot write pictures to {}: {}", dir.display(), results::reason(&e));
            STOPPED
        }
    }
}
