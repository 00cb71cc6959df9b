//! Numerical choices: what ranges alone do not tell.

use super::outline::vector;
use super::report::Report;
use crate::adaptivity::AccuracySettings;
use crate::analysis::Settings;
use crate::approximation::settings::{ApproximationSettings, Basis, CrackSmoothing, HoleSmoothing, SupportShape};
use crate::case::files::Files;
use crate::case::schema::{self, CaseFile, NodeFile};
use crate::integration::settings::{GradientCorrection, Scheme};
use crate::model::Domain;
use crate::nodes::generation::MAX_NODES;
use crate::nodes::settings::{Graded, Layout, Listed, NodeSettings, Star};
use crate::system::ConstraintMethod;
use std::collections::BTreeSet;

/// Node positions this close to the boundary, times the size of the body, are left to the boundary's own nodes.
const ON_BOUNDARY: f64 = 1e-6;
/// Most nodes of a star.
const MAX_STAR_NODES: usize = 10_000;
/// Least spacing at tips over the size of the body; below it positions have too few digits left.
const LEAST_SPACING: f64 = 1e-9;

/// The settings as far as they can be told without the body.
pub(super) fn settings(file: &CaseFile, files: &Files, report: &mut Report) -> Settings {
    check_approximation(file, report);
    if let Scheme::Cells { size } = file.integration.scheme {
        report.positive("integration.scheme.cells.size", size);
    }
    if matches!(file.integration.scheme, Scheme::Nodal { .. })
        && file.integration.gradient_correction == GradientCorrection::None
    {
        let message = "nodal integration takes means of the gradients, which need no correction and know none";
        report.error("integration.gradient_correction", message).suggest("leave it out");
    }
    match file.constraints {
        ConstraintMethod::Nitsche { factor } => report.positive("constraints.nitsche.factor", factor),
        ConstraintMethod::Penalty { factor } => report.positive("constraints.penalty.factor", factor),
        ConstraintMethod::LagrangeMultipliers
        | ConstraintMethod::ModifiedVariational
        | ConstraintMethod::FiniteElementCoupled => true,
    };
    if let Some(radii) = &file.fracture.radii {
        if radii.len() < 3 {
            let message = format!("{} radii, the spread over them needs 3", radii.len());
            report.error("fracture.radii", message).allow("at least 3, positive, ascending");
        } else {
            check_ascending(radii, "fracture.radii", report);
        }
    }
    Settings {
        method: file.method,
        nodes: nodes(&file.nodes, files, report),
        approximation: file.approximation,
        integration: file.integration,
        constraints: file.constraints,
        solver: file.solver,
        fracture: file.fracture.clone(),
        accuracy: accuracy(file, report),
    }
}

fn accuracy(file: &CaseFile, report: &mut Report) -> Option<AccuracySettings> {
    let accuracy = file.accuracy.as_ref()?;
    let wishes = [("K_percent", accuracy.k_percent), ("energy_percent", accuracy.energy_percent)];
    for (name, value) in wishes {
        if let Some(value) = value {
            report.positive(format!("accuracy.{name}"), value);
        }
    }
    if wishes.iter().all(|w| w.1.is_none()) {
        report.error("accuracy", "nothing says how accurate").allow("K_percent, energy_percent, or both");
    }
    if accuracy.k_percent.is_some() && file.crack.is_empty() && file.growth.is_none() {
        report.error("accuracy.K_percent", "there is no crack").suggest("add a [[crack]], or ask for `energy_percent`");
    }
    Some(accuracy.clone())
}

fn check_approximation(file: &CaseFile, report: &mut Report) {
    let least = match file.approximation.basis {
        Basis::Linear => 1.01,
        Basis::Quadratic => 2.0,
    };
    // The automatic one is large enough.
    if file.approximation.dilation.is_some_and(|d| d < least) {
        let message = "too few neighbors for the basis";
        report.error("approximation.dilation", message).allow(format!("{least} to 10"));
    }
    if let Some(distance) = file.approximation.finite_elements_beyond
        && report.positive("approximation.finite_elements_beyond", distance)
        && file.constraints == ConstraintMethod::LagrangeMultipliers
    {
        // Elements have one value at a corner, multipliers one for each side.
        let message = "multipliers are not unique at the corners of finite elements";
        report.error("constraints", message).suggest("use `finite-element-coupled` or `nitsche`");
    }
    let enrichment = &file.approximation.enrichment;
    if let Some(r2) = enrichment.r2
        && report.positive("approximation.enrichment.r2", r2)
        && enrichment.r1.is_some_and(|r1| r1 > r2)
    {
        report.error("approximation.enrichment.r1", "must not exceed `r2`");
    }
    check_smoothing(&file.approximation, report);
}

fn check_smoothing(approximation: &ApproximationSettings, report: &mut Report) {
    let key = "approximation.smoothing";
    let smoothing = &approximation.smoothing;
    if let CrackSmoothing::Transparency { kappa, .. } = smoothing.cracks() {
        report.positive(format!("{key}.cracks.transparency.kappa"), kappa);
    }
    if let HoleSmoothing::Diffraction { lambda } = smoothing.holes() {
        let (wanted, reason) = match smoothing.cracks() {
            CrackSmoothing::Diffraction { lambda } => (lambda, "the same as around cracks"),
            CrackSmoothing::Transparency { .. } => (1.0, "1, as cracks are transparent"),
            CrackSmoothing::Visibility | CrackSmoothing::SeeThrough => (lambda, ""),
        };
        if lambda != wanted {
            let message = format!("{lambda} around holes, {wanted} around cracks");
            report.error(format!("{key}.holes.diffraction.lambda"), message).allow(reason);
        }
    }
    let is_visibility = smoothing.cracks.is_none_or(|c| c == CrackSmoothing::Visibility)
        && smoothing.holes.is_none_or(|h| h == HoleSmoothing::Visibility);
    if approximation.support == SupportShape::Rectangular && !is_visibility {
        report.error(key, "rectangular supports know visibility only").suggest("use `support = \"circular\"`");
    }
}

fn check_ascending(radii: &[f64], key: &str, report: &mut Report) {
    if radii.first().is_none_or(|r| *r <= 0.0) || radii.windows(2).any(|w| w[1] <= w[0]) {
        report.error(key, "radii must be positive and ascending");
    }
}

fn nodes(nodes: &schema::Nodes, files: &Files, report: &mut Report) -> NodeSettings {
    let layout = match &nodes.layout {
        schema::Layout::Graded(graded) => {
            for (name, value) in [("spacing", graded.spacing), ("tip_spacing", graded.tip_spacing)] {
                if let Some(value) = value {
                    report.positive(format!("nodes.layout.graded.{name}"), value);
                }
            }
            if let (Some(spacing), Some(tip)) = (graded.spacing, graded.tip_spacing)
                && tip > spacing
            {
                report.error("nodes.layout.graded.tip_spacing", "must not exceed `spacing`");
            }
            Layout::Graded(graded.clone())
        }
        schema::Layout::Structured(grid) => Layout::Structured(grid.clone()),
        schema::Layout::Listed(listed) => Layout::Listed(listed.clone()),
        schema::Layout::File(file) => Layout::Listed(Listed { positions: read_nodes(file, files, report) }),
    };
    if let Some(Star { radii, .. }) = &nodes.star {
        check_ascending(radii, "nodes.star.radii", report);
    }
    NodeSettings { layout, star: nodes.star.clone() }
}

/// Positions from a file with `x,y` a line; `#` begins a comment, and a first line of names is passed over.
fn read_nodes(file: &NodeFile, files: &Files, report: &mut Report) -> Vec<[f64; 2]> {
    let key = "nodes.layout.file.path";
    let Some(text) = report.known(key, files.text(&file.path)) else { return vec![] };
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let mut positions = vec![];
    for (k, record) in reader.records().enumerate() {
        let record = match record {
            Ok(record) => record,
            Err(e) => {
                report.error(key, format!("{}: {e}", file.path));
                return vec![];
            }
        };
        let numbers: Vec<f64> = record.iter().map_while(|s| s.parse().ok()).filter(|v: &f64| v.is_finite()).collect();
        match (numbers.as_slice(), record.len()) {
            ([x, y], 2) => positions.push([*x, *y]),
            ([], 2) if k == 0 => {}
            _ => {
                let line = record.position().map_or(0, csv::Position::line);
                let text: String = record.iter().collect::<Vec<_>>().join(",").chars().take(40).collect();
                report.error(key, format!("{}:{line}: expected x,y, found `{text}`", file.path));
                return vec![];
            }
        }
    }
    if positions.is_empty() {
        report.error(key, format!("{} holds no positions", file.path));
    }
    positions
}

/// What the body says about spacings and positions, and that no number of nodes or cells is beyond reason.
pub(super) fn check_layout(settings: &mut Settings, file: &CaseFile, domain: &Domain, report: &mut Report) {
    match &settings.nodes.layout {
        Layout::Graded(graded) => check_spacings(graded, domain, report),
        Layout::Structured(grid) => {
            if grid.nx.saturating_mul(grid.ny) > MAX_NODES {
                let message = format!("{} times {} nodes are too many", grid.nx, grid.ny);
                report.error("nodes.layout.structured", message).allow(format!("up to {MAX_NODES} in all"));
            }
        }
        Layout::Listed(_) => check_positions(settings, file, domain, report),
    }
    if let Some(star) = &settings.nodes.star
        && star.radii.len().saturating_mul(star.nodes_per_ring) > MAX_STAR_NODES
    {
        let message = format!("{} rings of {} nodes are too many", star.radii.len(), star.nodes_per_ring);
        report.error("nodes.star", message).allow(format!("up to {MAX_STAR_NODES} nodes at a tip"));
    }
    if let Scheme::Cells { size } = settings.integration.scheme {
        let bounds = domain.aabb().size();
        let least = (bounds.x * bounds.y / MAX_NODES as f64).sqrt();
        if size > 0.0 && size < least {
            let message = format!("this asks for more than {MAX_NODES} cells");
            report.error("integration.scheme.cells.size", message).allow(format!("at least {least:.3e} for this body"));
        }
    }
}

fn check_spacings(graded: &Graded, domain: &Domain, report: &mut Report) {
    let least = (domain.area() / MAX_NODES as f64).sqrt();
    if graded.spacing.is_some_and(|h| h > 0.0 && h < least) {
        let message = format!("this asks for more than {MAX_NODES} nodes");
        report.error("nodes.layout.graded.spacing", message).allow(format!("at least {least:.3e} for this body"));
    }
    let least = LEAST_SPACING * domain.aabb().size().norm();
    if graded.tip_spacing.is_some_and(|h| h > 0.0 && h < least) {
        let message = "too small for the size of the body";
        report.error("nodes.layout.graded.tip_spacing", message).allow(format!("at least {least:.3e}"));
    }
}

/// Checks listed positions against the body; those on the boundary are left out.
fn check_positions(settings: &mut Settings, file: &CaseFile, domain: &Domain, report: &mut Report) {
    let Layout::Listed(listed) = &mut settings.nodes.layout else { return };
    let size = domain.aabb().size().norm();
    let is_file = matches!(file.nodes.layout, schema::Layout::File(_));
    let key = |k: usize| match is_file {
        true => "nodes.layout.file.path".to_string(),
        false => format!("nodes.layout.listed.positions[{k}]"),
    };
    let mut seen = BTreeSet::new();
    let mut on_boundary = 0;
    let mut inside = vec![];
    for (k, p) in listed.positions.iter().enumerate() {
        let at = vector(*p);
        // Adding zero turns -0 into 0.
        let is_new = seen.insert(p.map(|v| (v + 0.0).to_bits()));
        if !is_new {
            report.error(key(k), format!("the node at ({}, {}) is listed twice", at.x, at.y));
            return;
        }
        if domain.distance_to_boundary(at) <= ON_BOUNDARY * size {
            on_boundary += 1;
        } else if domain.contains(at) {
            inside.push(*p);
        } else {
            report.error(key(k), format!("the node at ({}, {}) lies outside the body", at.x, at.y));
            return;
        }
    }
    if on_boundary > 0 {
        let message = format!("{on_boundary} listed nodes lie on the boundary; the nodes along it take their place");
        report.note("nodes.layout", message);
    }
    listed.positions = inside;
}
