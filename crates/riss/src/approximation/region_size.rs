//! How large the enriched region around a tip is, and whether there is one.

use super::discontinuity::through_void;
use super::settings::EnrichmentSettings;
use super::tip_functions::LARGEST_TURN;
use crate::crack::{CrackPath, End, EndKind, TipId};
use crate::math::{Vector2, cross};
use crate::model::Model;
use crate::nodes::Nodes;
use crate::nodes::spacing::free_radius;

/// Outer radius of an automatic region over that of the disk around the tip that holds nothing but its crack.
const OUTER_SHARE: f64 = 0.5;
/// Inner radius of an automatic region over the outer one.
const INNER_SHARE: f64 = 0.5;
/// Automatic regions end at the first kink with more than this turn, around which the mapped field is a poor one [rad].
const SHARP_TURN: f64 = 1.0;
/// A region keeps this share of the distance to another tip, so that regions do not meet.
const SHARED: f64 = 0.499;
/// A region keeps this share of the distance from which on the cut of its functions leaves the crack: nodes beyond the
/// region reach into it.
const CLEARANCE: f64 = 0.65;
/// An automatic region is at least so many node spacings wide: a ramp takes its share, and the supports of the longer
/// basis are wide.
const SPACINGS_OF_BASIS: f64 = 6.0;
/// The same where nodes have functions of their own: with 1.5 spacings K is within a fifth of a percent.
const SPACINGS_OF_NODES: f64 = 2.0;
/// On nodes that are as far apart at a tip as elsewhere, polynomials alone follow its field with nodes so far apart or
/// less, over the free radius. On coarser ones K is off by half a percent, and soon by several percent.
const FINE: f64 = 1.0 / 100.0;
/// The same on nodes that are finer at the tip. The default is 1/300; error bars are calibrated up to 1/50.
const FINE_GRADED: f64 = 1.0 / 20.0;
/// Nodes are finer at a tip if their spacing is less than this part of what it is elsewhere.
const GRADED: f64 = 0.5;
/// Nodes of which this part is closer to each other tell the spacing elsewhere.
const ELSEWHERE: f64 = 0.9;
/// The least region that is worth it, in node spacings: a handful of nodes.
const LEAST_SPACINGS: f64 = 1.4;
/// Neighbors of a tip of whose spacings the median is taken: those beside a crack have fewer neighbors.
const NEAREST: usize = 7;

/// How the functions enter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// In the basis [EFG, section 5.3].
    Intrinsic,
    /// Times the shape functions of nodes [EFG, section 5.2].
    OfNodes,
    /// As they are, less what moving least squares make of them [EFG, section 5.1].
    OfTips,
}

impl Form {
    /// Least radius of an automatic region over the node spacing at the tip.
    fn spacings(self) -> f64 {
        match self {
            Self::Intrinsic => SPACINGS_OF_BASIS,
            Self::OfNodes => SPACINGS_OF_NODES,
            Self::OfTips => 0.0,
        }
    }

    /// Largest outer radius of the region around a tip, and that if nothing is said [length].
    ///
    /// - `clear`: where the functions begin to jump beside the crack
    /// - `spacing`: of the nodes at the tip
    fn outer_radii(self, model: &Model, id: TipId, clear: f64, spacing: f64) -> [f64; 2] {
        let crack = &model.cracks[id.crack];
        let sharp = first_sharp_kink(crack, id.end);
        match self {
            Self::Intrinsic | Self::OfNodes => {
                let free = free_radius(model, id.crack, crack.end_position(id.end));
                let wanted = (OUTER_SHARE * free).max(self.spacings() * spacing);
                [half_way(model, id).min(CLEARANCE * clear), sharp.min(wanted)]
            }
            // Regions may overlap, and no node has functions to lose. The nodes have to make up for the ramp: the wider
            // the better.
            Self::OfTips => [clear, sharp.min(clear)],
        }
    }

    /// Inner radius if nothing is said [length].
    fn inner_radius(self, outer: f64) -> f64 {
        match self {
            Self::Intrinsic | Self::OfNodes => INNER_SHARE * outer,
            Self::OfTips if outer.is_finite() => 0.0,
            Self::OfTips => outer,
        }
    }
}

/// Inner and outer radius of a region, and what limits it [length].
#[derive(Clone, Copy, Debug)]
pub(super) struct RegionSize {
    /// Radius up to which the basis is enriched in full, and from which it is plain.
    pub radii: [f64; 2],
    /// Outer radius that was asked for.
    pub wanted: f64,
    /// Distance from which on the functions jump where no crack is.
    pub clear: f64,
}

impl RegionSize {
    /// The size of the region around a tip.
    ///
    /// - `spacing`: of the nodes at the tip [length]
    pub fn new(model: &Model, id: TipId, form: Form, settings: &EnrichmentSettings, spacing: f64) -> Self {
        let clear = clear_radius(model, id);
        let [limit, automatic] = form.outer_radii(model, id, clear, spacing);
        let wanted = settings.r2.unwrap_or(automatic);
        let outer = wanted.min(limit);
        let inner = settings.r1.unwrap_or(form.inner_radius(outer)).min(outer);
        Self { radii: [inner, outer], wanted, clear }
    }
}

/// Whether nodes at a tip are too coarse for polynomials, and its region would hold a few.
pub(super) fn wants_functions(model: &Model, id: TipId, settings: &EnrichmentSettings, spacing: TipSpacing) -> bool {
    let free = free_radius(model, id.crack, model.cracks[id.crack].end_position(id.end));
    let region = RegionSize::new(model, id, Form::OfNodes, settings, spacing.at_tip);
    let finest = if spacing.at_tip < GRADED * spacing.elsewhere { FINE_GRADED } else { FINE };
    let spacing = spacing.at_tip;
    spacing > finest * free && region.radii[1] >= LEAST_SPACINGS * spacing
}

/// How far apart nodes are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TipSpacing {
    /// At a tip [length].
    pub at_tip: f64,
    /// Far from it, where nodes are coarsest [length].
    pub elsewhere: f64,
}

impl TipSpacing {
    /// At each tip, in the order of [`Model::tips`].
    ///
    /// - `dilation`: support radius of the nodes over their spacing
    pub fn of_tips(model: &Model, nodes: &Nodes<2>, dilation: f64) -> Vec<Self> {
        // The one in this place of an ascending list.
        let spacing = |radii: &mut [f64], place: usize| match place < radii.len() {
            true => *radii.select_nth_unstable_by(place, f64::total_cmp).1 / dilation,
            false => f64::INFINITY,
        };
        let mut radii: Vec<f64> = nodes.support_radii.iter().map(|r| r.max()).collect();
        let place = (ELSEWHERE * radii.len() as f64) as usize;
        let elsewhere = spacing(&mut radii, place);
        let at = |tip: Vector2| {
            let mut nearest: Vec<(f64, usize)> =
                nodes.positions.iter().enumerate().map(|(i, p)| ((p - tip).norm(), i)).collect();
            if nearest.len() > NEAREST {
                nearest.select_nth_unstable_by(NEAREST, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                nearest.truncate(NEAREST);
            }
            let mut radii: Vec<f64> = nearest.iter().map(|(_, i)| nodes.support_radii[*i].max()).collect();
            let middle = radii.len() / 2;
            Self { at_tip: spacing(&mut radii, middle), elsewhere }
        };
        model.tips().iter().map(|(_, frame)| at(frame.position)).collect()
    }
}

/// Half of the way from a tip to the nearest other one [length].
fn half_way(model: &Model, id: TipId) -> f64 {
    let tip = model.cracks[id.crack].end_position(id.end);
    let others = model.tips().into_iter().map(|(_, frame)| frame.position).filter(|p| *p != tip);
    others.map(|p| SHARED * (p - tip).norm()).fold(f64::INFINITY, f64::min)
}

/// Radius of the largest disk around a tip in which its functions jump across its own crack only [length].
fn clear_radius(model: &Model, id: TipId) -> f64 {
    let crack = &model.cracks[id.crack];
    let tip = crack.end_position(id.end);
    let far = match id.end {
        End::Start => End::End,
        End::End => End::Start,
    };
    // The cut goes on straight from the far end.
    let leaves = match crack.end_kind(far) {
        EndKind::Tip | EndKind::Junction => (crack.end_position(far) - tip).norm(),
        EndKind::Mouth => {
            let path = crack.from_end(far);
            let way = through_void(model, path[0], path[0] - path[1]);
            // That far there is no body left to jump in.
            let leaves_body = way.norm() > 0.999 * model.domain.aabb().size().norm();
            if leaves_body { f64::INFINITY } else { (path[0] + way - tip).norm() }
        }
    };
    leaves.min(first_fold(crack, id.end))
}

/// Distance from a tip to the first kink around which its functions cannot be mapped: one that turns too far, or that
/// has nearer parts of the crack behind its perpendicular [length].
fn first_fold(crack: &CrackPath, end: End) -> f64 {
    let path = crack.from_end(end);
    for k in 1..path.len() - 1 {
        let (ahead, on) = (path[k - 1] - path[k], path[k] - path[k + 1]);
        let turn = cross(on, ahead).atan2(on.dot(&ahead));
        if turn.abs() >= LARGEST_TURN || path[..k].iter().any(|p| (p - path[k]).dot(&ahead) < 0.0) {
            return (path[k] - path[0]).norm();
        }
    }
    f64::INFINITY
}

/// Distance from a tip to the first kink that is sharp [length].
fn first_sharp_kink(crack: &CrackPath, end: End) -> f64 {
    let path = crack.from_end(end);
    let is_sharp = |w: &&[Vector2]| {
        let (ahead, on) = (w[0] - w[1], w[1] - w[2]);
        cross(on, ahead).atan2(on.dot(&ahead)).abs() > SHARP_TURN
    };
    path.windows(3).find(is_sharp).map_or(f64::INFINITY, |w| (w[1] - path[0]).norm())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_end_where_the_crack_folds() {
        let crack = |points: &[(f64, f64)]| CrackPath {
            name: "c".into(),
            vertices: points.iter().map(|p| Vector2::new(p.0, p.1)).collect(),
            ends: [EndKind::Tip; 2],
        };
        let gentle = crack(&[(-2.0, 0.0), (-1.0, 0.0), (0.0, 0.5)]);
        assert_eq!(first_fold(&gentle, End::End), f64::INFINITY);
        let right_angle = crack(&[(-2.0, 0.0), (-1.0, 0.0), (-1.0, 0.5)]);
        assert_eq!(first_fold(&right_angle, End::End), 0.5);
        // Turns by 60° three times and goes on until the perpendicular at the first vertex passes before the tip.
        let hook = crack(&[(0.0, 0.0), (1.0, 0.0), (1.5, 3f64.sqrt() / 2.0), (1.0, 3f64.sqrt()), (-2.5, 3f64.sqrt())]);
        assert!((first_fold(&hook, End::End) - (hook.vertices[4] - hook.vertices[1]).norm()).abs() < 1e-12);
    }
}
