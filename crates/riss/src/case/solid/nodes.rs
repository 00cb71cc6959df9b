//! Spacing of nodes and the other numerical choices for a solid.

use super::cracks::Cracks;
use super::schema::{Finer, SolidFile};
use crate::analysis::SolidSettings;
use crate::case::build::boxes::bounds;
use crate::case::build::report::Report;
use crate::crack::{CrackFront, CrackSurface};
use crate::geometry::surface::Surface;
use crate::math::Vector3;
use crate::model::{SolidModel, SurfaceConditions, VectorField};
use crate::nodes::solid::{
    MAX_SOLID_NODES, NodesOnFronts, Region, SolidSpacing, SpacingPlan, bend_regions, estimated_solid_nodes,
    load_regions, spread_load, support_regions, wall_regions,
};

/// Spacing over the cube root of the volume, if the case says none.
const BODY_FRACTION: f64 = 1.0 / 20.0;
/// Spacing at fronts over the size of the crack, if the case says none.
const FRONT_FRACTION: f64 = 1.0 / 30.0;
/// The same over the least radius of curvature of a front, and no less than this share of the size of the crack.
const BEND_FRACTION: f64 = 1.0 / 13.0;
const LEAST_FRACTION: f64 = 1.0 / 250.0;
/// Growth of the spacing, if the case says none.
const GROWTH: f64 = 0.15;
/// Least spacing over the size of the body; below it positions have too few digits left.
const LEAST_SPACING: f64 = 1e-6;

pub(super) fn settings(
    file: &SolidFile,
    body: &Surface,
    cracks: &Cracks,
    parts: &[SurfaceConditions<3>],
    report: &mut Report,
) -> Option<(SolidSettings, SpacingPlan)> {
    let nodes = &file.nodes;
    let (cohesive, cracks) = (cracks.cohesive.iter().map(Option::is_some), &cracks.surfaces[..]);
    let size = body.bounds().size().norm();
    let mut sound = true;
    let mut checked = |value: Option<f64>, key: &str, report: &mut Report| {
        if let Some(h) = value.filter(|h| !(*h > LEAST_SPACING * size && *h < size)) {
            let allowed = format!("above {:.3e} and below {size:.3e}, the size of the body", LEAST_SPACING * size);
            report.error(key, format!("{h} is no spacing for this body")).allow(allowed);
            sound = false;
        }
    };
    checked(nodes.spacing, "nodes.spacing", report);
    checked(nodes.front_spacing, "nodes.front_spacing", report);
    for (index, finer) in nodes.finer.iter().enumerate() {
        checked(Some(finer.spacing), &format!("nodes.finer[{index}].spacing"), report);
    }
    if !sound {
        return None;
    }
    let largest = nodes.spacing.unwrap_or_else(|| BODY_FRACTION * body.volume().cbrt());
    let at_front = |(crack, is_cohesive): (&CrackSurface, bool)| {
        let extent = crack.surface.bounds().size().norm() / 2f64.sqrt();
        if is_cohesive {
            let step = file.growth.as_ref().map_or(largest, |g| g.increment.abs());
            return nodes.front_spacing.unwrap_or(step.min(largest));
        }
        let by_size = (FRONT_FRACTION * extent).min(largest);
        let bend = crack.fronts.iter().map(CrackFront::largest_curvature).fold(f64::MIN_POSITIVE, f64::max);
        let by_bend = (BEND_FRACTION / bend).max(LEAST_FRACTION * extent);
        nodes.front_spacing.unwrap_or(by_size.min(by_bend))
    };
    let at_fronts: Vec<f64> = cracks.iter().zip(cohesive).map(at_front).collect();
    let mut regions = wall_regions(body, largest);
    regions.extend(bend_regions(body, largest));
    let tractions: Vec<&VectorField<3>> = parts.iter().map(|p| &p.traction).collect();
    regions.extend(load_regions(body, &tractions, cracks, largest));
    regions.extend(support_regions(body, parts, largest));
    for (index, finer) in nodes.finer.iter().enumerate() {
        regions.extend(finer_regions(finer, &format!("nodes.finer[{index}]"), body, report)?);
    }
    let with_front = cracks.iter().zip(&at_fronts).filter(|(c, _)| !c.fronts.is_empty()).map(|(_, h)| *h);
    let smallest = regions.iter().map(|r| r.1).chain(with_front).fold(largest, f64::min);
    let plan = SpacingPlan { largest, growth: nodes.growth.unwrap_or(GROWTH), at_fronts, regions };
    let spacing = plan.spacing(cracks, &(0..cracks.len()).collect::<Vec<_>>());
    let n = estimated_solid_nodes(body, &spacing);
    if !(n <= MAX_SOLID_NODES as f64) {
        let message = format!("the spacing asks for about {n:.1e} nodes, smallest spacing {smallest:.3e}");
        report.error("nodes", message).allow(format!("up to {MAX_SOLID_NODES} nodes"));
        return None;
    }
    let settings = SolidSettings {
        spacing,
        nodes_on_fronts: nodes.on_fronts.unwrap_or(NodesOnFronts::Single),
        collocation: file.collocation,
        points_on_front: file.fracture.points,
    };
    Some((settings, plan))
}

/// Loads act as nodes can take them.
pub(super) fn spread_loads(model: &mut SolidModel, spacing: &SolidSpacing) {
    let SolidModel { body, cracks, solid, .. } = model;
    for (part, conditions) in solid.parts.iter_mut().enumerate() {
        if let VectorField::Function(_) = conditions.traction
            && let Some(spread) = spread_load(body, part as u32, &conditions.traction, cracks, spacing)
        {
            conditions.traction = spread;
        }
    }
}

fn finer_regions(finer: &Finer, key: &str, body: &Surface, report: &mut Report) -> Option<Vec<(Region, f64)>> {
    let regions = match (&finer.part, &finer.cuboid, &finer.ball) {
        (Some(name), None, None) => {
            let on_part = |t: &u32| body.parts()[body.part_of(*t) as usize].name == *name;
            let triangles: Vec<u32> = (0..body.triangles().len() as u32).filter(on_part).collect();
            if triangles.is_empty() {
                let names = body.parts().iter().map(|p| p.name.as_str());
                report.error(format!("{key}.part"), "unknown part").one_of(name, names);
                return None;
            }
            triangles.iter().map(|t| Region::Triangle(body.corners(*t))).collect()
        }
        (None, Some(b), None) => vec![Region::Box(bounds(b.lower, b.upper, &format!("{key}.box"), report)?)],
        (None, None, Some(b)) => {
            report.positive(format!("{key}.ball.radius"), b.radius).then_some(())?;
            vec![Region::Ball { center: Vector3::from(b.center), radius: b.radius }]
        }
        _ => {
            report.error(key, "a region is one of several kinds").allow("one of `part`, `box`, `ball`");
            return None;
        }
    };
    Some(regions.into_iter().map(|r| (r, finer.spacing)).collect())
}
