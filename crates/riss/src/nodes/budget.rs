//! Whether a spacing asks for too many nodes, found out before any is placed.

use super::generation::MAX_NODES;
use super::settings::{Layout, NodeSettings};
use super::spacing::SpacingField;
use crate::error::{Error, Result};
use crate::math::Vector2;
use crate::model::{Domain, Model};

/// Cells along each axis to begin with, and how often they may be split.
const GRID: usize = 16;
const MAX_SPLITS: u32 = 60;
/// The estimate is rough; only what exceeds the limit by this factor is refused.
const MARGIN: f64 = 2.0;

/// Refuses a spacing that would take more than about [`MAX_NODES`] nodes.
///
/// # Errors
/// [`Error::NodeGeneration`].
pub(super) fn check(domain: &Domain, spacing: &SpacingField) -> Result<()> {
    let n = estimated_nodes(domain, spacing);
    // Fails for NaN, too.
    if n <= MARGIN * MAX_NODES as f64 { Ok(()) } else { Err(too_many(Some(n))) }
}

/// The same for a spacing that is exceeded nowhere: no hole or thin part can hide what it asks for.
///
/// # Errors
/// [`Error::NodeGeneration`].
pub(super) fn check_everywhere(domain: &Domain, largest: f64) -> Result<()> {
    let n = domain.area() / largest.powi(2);
    if n <= MARGIN * MAX_NODES as f64 { Ok(()) } else { Err(too_many(Some(n))) }
}

/// The error, with the estimated number if there is one.
pub(super) fn too_many(n: Option<f64>) -> Error {
    let number = n.map_or(String::new(), |n| format!(", about {n:.0e}"));
    let reason =
        format!("the spacing asks for more than {MAX_NODES} nodes{number}; choose a larger one or a faster growth");
    Error::NodeGeneration { reason }
}

/// About how many nodes a layout asks for, without those of stars and crack tips on even grids.
pub fn estimated_layout(model: &Model, settings: &NodeSettings) -> f64 {
    match &settings.layout {
        Layout::Graded(graded) => {
            let everywhere = graded.spacing.map_or(0.0, |h| model.domain.area() / h.powi(2));
            let margin = 10.0 * MARGIN * MAX_NODES as f64;
            // What is absurd is not counted.
            if everywhere > margin {
                return everywhere;
            }
            estimated_nodes(&model.domain, &SpacingField::of_model(model, graded))
        }
        Layout::Structured(grid) => {
            let size = model.domain.aabb().size();
            grid.nx as f64 * grid.ny as f64 * model.domain.area() / (size.x * size.y)
        }
        Layout::Listed(listed) => listed.positions.len() as f64,
    }
}

/// About how many nodes a spacing asks for: the integral of 1 over its square. Stops counting where it is too much already.
pub fn estimated_nodes(domain: &Domain, spacing: &SpacingField) -> f64 {
    let bounds = domain.aabb();
    let size = bounds.size() / GRID as f64;
    let center = |i: usize, j: usize| bounds.lower + size.component_mul(&Vector2::new(i as f64 + 0.5, j as f64 + 0.5));
    let mut cells: Vec<(Vector2, Vector2, u32)> =
        (0..GRID * GRID).map(|k| (center(k % GRID, k / GRID), size, 0)).collect();
    let mut n = 0.0;
    while let Some((center, size, splits)) = cells.pop() {
        let h = spacing.at(center);
        // The spacing varies by no more than this over the cell.
        let variation = 0.5 * spacing.growth() * size.norm();
        if variation > 0.5 * h && splits < MAX_SPLITS {
            for (x, y) in [(-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25)] {
                cells.push((center + size.component_mul(&Vector2::new(x, y)), size * 0.5, splits + 1));
            }
        } else if domain.contains(center) {
            n += size.x * size.y / (h * h);
            if n > 10.0 * MARGIN * MAX_NODES as f64 {
                break;
            }
        }
    }
    n
}

#[cfg(test)]
mod tests {
    use super::super::generate;
    use super::super::settings::{Graded, Layout, NodeSettings};
    use super::*;
    use crate::case::Case;
    use crate::crack::CrackForm;

    fn case(spacing: &str) -> Case {
        let text = format!(
            "rigid_motion = 'mean-is-zero'
            material = {{ young = 1, poisson = 0.3, plane = 'strain' }}
            geometry.rectangle = {{ lower = [0, 0], upper = [2, 1] }}
            crack = [{{ path = [[0, 0.5], [0.5, 0.5]] }}]
            remote_stress.yy = 1
            nodes.layout.graded = {{ {spacing} }}"
        );
        Case::parse(&text, "case.toml".as_ref(), &[]).unwrap()
    }

    #[test]
    fn estimates_are_near_the_number_of_nodes() {
        for text in ["spacing = 0.05, tip_spacing = 0.05", "tip_spacing = 1e-3", "tip_spacing = 1e-8", "growth = 0.05"]
        {
            let case = case(text);
            let n = generate(&case.model, &case.settings.nodes, CrackForm::Path).unwrap().chains.positions.len() as f64;
            let Layout::Graded(graded) = &case.settings.nodes.layout else { panic!() };
            let estimated = estimated_nodes(&case.model.domain, &SpacingField::of_model(&case.model, graded));
            assert!(estimated / n > 0.5 && estimated / n < 1.5, "{text}: {estimated} for {n}");
        }
    }

    #[test]
    fn absurd_spacings_are_refused_at_once() {
        let model = case("spacing = 0.1").model;
        for spacing in [1e-9, 1e-200, 5e-4] {
            let graded = Graded { spacing: Some(spacing), tip_spacing: None, growth: None };
            let settings = NodeSettings { layout: Layout::Graded(graded), star: None };
            let error = generate(&model, &settings, CrackForm::Path).unwrap_err().to_string();
            assert!(error.contains("more than 2000000 nodes"), "{error}");
        }
        // Fine along a small part only, but over a long way.
        let field =
            SpacingField::of_model(&model, &Graded { spacing: None, tip_spacing: Some(1e-9), growth: Some(1e-3) });
        assert!(estimated_nodes(&model.domain, &field) > 2.0 * MAX_NODES as f64);
    }
}
