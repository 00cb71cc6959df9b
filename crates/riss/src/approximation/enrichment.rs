//! Where the basis holds the field of a crack tip, and how it fades into the plain one [EFG, sections 5.3, 5.4].

use super::detour::Jet;
use super::discontinuity::through_void;
use super::extra::Extra;
use super::global_functions::{GlobalFunctions, GlobalRegion};
use super::partition_of_unity::{ExtraFunctions, ExtraRegion};
use super::settings::{EnrichmentKind, EnrichmentSettings, Ramp};
use super::tip_functions::{LARGEST_TURN, MOST_FUNCTIONS, TipCoordinates, TipFunctions};
use crate::crack::{CrackPath, End, EndKind, TipId};
use crate::geometry::aabb::Aabb;
use crate::math::{Matrix2, Vector2, cross};
use crate::model::Model;
use crate::nodes::Nodes;
use crate::nodes::spacing::free_radius;
use rustc_hash::FxHashMap;

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
/// The cut follows the crack up to this multiple of the outer radius, for the same reason.
const CUT_REACH: f64 = 2.0;
/// Derivatives of the tip functions are held nearer to the tip than this, over the least support radius around it.
const CORE: f64 = 1e-5;

/// The enriched regions of a body, one at each tip; they do not overlap unless the functions are those of tips.
#[derive(Clone, Debug)]
pub struct Enrichment {
    functions: TipFunctions,
    form: Form,
    ramp: Ramp,
    regions: Vec<Region>,
}

/// How the functions enter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// In the basis [EFG, section 5.3].
    Intrinsic,
    /// Times the shape functions of nodes [EFG, section 5.2].
    OfNodes,
    /// As they are, less what moving least squares make of them [EFG, section 5.1].
    OfTips,
}

impl Form {
    /// Largest outer radius of the region around a tip, and that if nothing is said [length].
    ///
    /// - `clear`: where the functions begin to jump beside the crack
    fn outer_radii(self, model: &Model, id: TipId, clear: f64) -> [f64; 2] {
        let crack = &model.cracks[id.crack];
        let sharp = first_sharp_kink(crack, id.end);
        match self {
            Self::Intrinsic | Self::OfNodes => {
                let free = free_radius(model, id.crack, crack.end_position(id.end));
                [half_way(model, id).min(CLEARANCE * clear), sharp.min(OUTER_SHARE * free)]
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

/// A disk around a tip.
#[derive(Clone, Debug)]
struct Region {
    coordinates: TipCoordinates,
    /// Radius up to which the basis is enriched in full, and from which it is plain [length].
    radii: [f64; 2],
    /// Distance from which on the functions jump where no crack is [length].
    clear: f64,
    /// Values of the functions at nodes that may reach into the region.
    values: FxHashMap<u32, [f64; MOST_FUNCTIONS]>,
}

/// What the regions are to a point or a cell. A buffer.
#[derive(Clone, Debug, Default)]
pub(super) struct EnrichmentBuffer {
    /// Regions that may hold a point of the cell.
    near: Vec<u32>,
    /// The region whose values are in `values`.
    loaded: Option<u32>,
    /// Values of its functions at the candidates.
    values: Vec<[f64; MOST_FUNCTIONS]>,
}

/// A point in a region.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    region: u32,
    /// Share of the enriched shape functions (R of Eq. 53), with its derivatives.
    pub share: Jet,
}

impl Enrichment {
    /// The regions of a model, and a remark on each that had to be made smaller than asked for.
    pub fn of_model(model: &Model, settings: &EnrichmentSettings) -> (Option<Self>, Vec<String>) {
        let (functions, form) = match settings.kind {
            EnrichmentKind::None => return (None, vec![]),
            EnrichmentKind::IntrinsicFull => (TipFunctions::Full, Form::Intrinsic),
            EnrichmentKind::IntrinsicRadial => (TipFunctions::Radial, Form::Intrinsic),
            EnrichmentKind::ExtrinsicFull => (TipFunctions::Full, Form::OfNodes),
            EnrichmentKind::ExtrinsicRadial => (TipFunctions::Radial, Form::OfNodes),
            EnrichmentKind::ExtrinsicMls => (TipFunctions::Full, Form::OfTips),
        };
        let (mut regions, mut notes) = (vec![], vec![]);
        for (id, frame) in model.tips() {
            let clear = clear_radius(model, id);
            let [limit, automatic] = form.outer_radii(model, id, clear);
            let wanted = settings.r2.unwrap_or(automatic);
            let outer = wanted.min(limit);
            if settings.r2.is_some() && outer < wanted {
                notes.push(format!(
                    "the enriched region around the tip at ({:.6}, {:.6}) would meet another tip or a bend of its crack; its radius is {outer:.4} instead of {wanted:.4}",
                    frame.position.x, frame.position.y
                ));
            }
            let inner = settings.r1.unwrap_or(form.inner_radius(outer)).min(outer);
            let reach = match form {
                Form::Intrinsic | Form::OfTips => CUT_REACH * outer,
                Form::OfNodes => clear,
            };
            let coordinates = TipCoordinates::new(&model.cracks[id.crack], id.end, reach, 0.0);
            regions.push(Region { coordinates, radii: [inner, outer], clear, values: FxHashMap::default() });
        }
        ((!regions.is_empty()).then_some(Self { functions, form, ramp: settings.ramp, regions }), notes)
    }

    /// The functions.
    pub fn functions(&self) -> TipFunctions {
        self.functions
    }

    /// Tip, inner and outer radius of each region [length].
    pub fn regions(&self) -> impl Iterator<Item = (Vector2, [f64; 2])> + '_ {
        self.regions.iter().map(|r| (r.coordinates.tip(), r.radii))
    }

    /// Whether a node with the given support reaches into a region.
    pub fn is_reached(&self, position: Vector2, support: f64) -> bool {
        self.regions().any(|(tip, [_, outer])| (position - tip).norm() < outer + support)
    }

    /// Computes the values at the nodes.
    pub(super) fn visit_nodes(&mut self, nodes: &Nodes<2>) {
        for region in &mut self.regions {
            region.values.clear();
            let (tip, [_, outer]) = (region.coordinates.tip(), region.radii);
            let mut least = f64::INFINITY;
            for (i, (p, radii)) in nodes.positions.iter().zip(&nodes.support_radii).enumerate() {
                let (distance, support) = ((p - tip).norm(), radii.norm());
                if distance < support {
                    least = least.min(support);
                }
                if self.form == Form::Intrinsic && distance < outer + support {
                    region.values.insert(i as u32, region.coordinates.values(self.functions, *p, nodes.sights[i]));
                }
            }
            if least.is_finite() {
                region.coordinates.set_core(CORE * least);
            }
        }
    }

    /// Functions besides the shape functions of nodes; none if the basis is enriched.
    ///
    /// Call it after [`Self::visit_nodes`].
    pub(super) fn extra_functions(&self, nodes: &Nodes<2>) -> Option<Extra> {
        let of_nodes =
            |r: &Region| ExtraRegion { coordinates: r.coordinates.clone(), outer: r.radii[1], clear: r.clear };
        let of_tips = |r: &Region| GlobalRegion { coordinates: r.coordinates.clone(), radii: r.radii };
        match self.form {
            Form::Intrinsic => None,
            Form::OfNodes => {
                let regions = self.regions.iter().map(of_nodes).collect();
                Some(Extra::OfNodes(ExtraFunctions::new(self.functions, regions, nodes)))
            }
            Form::OfTips => {
                let regions = self.regions.iter().map(of_tips).collect();
                Some(Extra::OfTips(GlobalFunctions::new(self.ramp, regions, nodes)))
            }
        }
    }

    /// Looks up in which regions the basis is enriched at points in a box.
    pub(super) fn survey(&self, bounds: &Aabb<2>, buffer: &mut EnrichmentBuffer) {
        buffer.near.clear();
        buffer.loaded = None;
        if self.form != Form::Intrinsic {
            return;
        }
        for (i, region) in self.regions.iter().enumerate() {
            let reach = Aabb::around(region.coordinates.tip(), Vector2::repeat(region.radii[1]));
            if reach.intersects(bounds) {
                buffer.near.push(i as u32);
            }
        }
    }

    /// The region around a point.
    #[inline]
    pub(super) fn place(&self, at: Vector2, buffer: &EnrichmentBuffer) -> Option<Place> {
        buffer.near.iter().find_map(|&region| {
            let Region { coordinates, radii, .. } = &self.regions[region as usize];
            let share = ramp_share(self.ramp, *radii, coordinates.tip(), at)?;
            Some(Place { region, share })
        })
    }

    /// Values of the functions at neighbors less those at the point, neighbor by neighbor, and the derivatives at the
    /// point.
    ///
    /// - `candidates`: of the survey, ascending; `neighbors` are some of them
    pub(super) fn fill(
        &self,
        place: &Place,
        [at, sight]: [Vector2; 2],
        candidates: &[u32],
        neighbors: &[u32],
        buffer: &mut EnrichmentBuffer,
        tip: &mut TipPoint,
    ) {
        let region = &self.regions[place.region as usize];
        if buffer.loaded != Some(place.region) {
            buffer.loaded = Some(place.region);
            let value = |i: &u32| region.values.get(i).copied().unwrap_or([f64::NAN; MOST_FUNCTIONS]);
            buffer.values.clear();
            buffer.values.extend(candidates.iter().map(value));
        }
        let jet = region.coordinates.jet(self.functions, at, sight);
        tip.gradients = jet.gradients;
        tip.second_derivatives = jet.second_derivatives;
        tip.differences.clear();
        let mut k = 0;
        for &i in neighbors {
            while candidates[k] != i {
                k += 1;
            }
            tip.differences.push(std::array::from_fn(|f| buffer.values[k][f] - jet.values[f]));
            k += 1;
        }
    }
}

/// The tip functions around a point. A buffer.
#[derive(Clone, Debug, Default)]
pub(super) struct TipPoint {
    /// Values at the neighbors less those at the point.
    pub differences: Vec<[f64; MOST_FUNCTIONS]>,
    /// Gradients at the point.
    pub gradients: [Vector2; MOST_FUNCTIONS],
    /// Second derivatives at the point.
    pub second_derivatives: [Matrix2; MOST_FUNCTIONS],
}

/// Share of the enriched shape functions; nothing outside the region [EFG, Eq. 54].
pub(super) fn ramp_share(ramp: Ramp, [inner, outer]: [f64; 2], tip: Vector2, at: Vector2) -> Option<Jet> {
    let distance = Jet::distance(at, tip);
    let one = Jet { value: 1.0, ..Jet::ZERO };
    if distance.value >= outer {
        return None;
    }
    match ramp {
        Ramp::Abrupt => Some(one),
        Ramp::Linear | Ramp::Quintic if distance.value <= inner => Some(one),
        Ramp::Linear | Ramp::Quintic => {
            let width = outer - inner;
            let [value, slope, bend] = ramp.polynomial((distance.value - inner) / width);
            let (slope, bend) = (slope / width, bend / (width * width));
            let square: Matrix2 = distance.gradient * distance.gradient.transpose();
            Some(Jet { value, gradient: distance.gradient * slope, second: square * bend + distance.second * slope })
        }
    }
}

impl Ramp {
    /// Ramp and derivatives by its argument between 0 and 1 [EFG, Eq. 54].
    fn polynomial(self, x: f64) -> [f64; 3] {
        match self {
            Self::Abrupt => [1.0, 0.0, 0.0],
            Self::Linear => [1.0 - x, -1.0, 0.0],
            Self::Quintic => [
                1.0 + x * x * x * (-10.0 + x * (15.0 - 6.0 * x)),
                x * x * (-30.0 + x * (60.0 - 30.0 * x)),
                x * (-60.0 + x * (180.0 - 120.0 * x)),
            ],
        }
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
    fn ramps_fall_from_one_to_zero_and_have_the_derivatives_of_differences() {
        for ramp in [Ramp::Linear, Ramp::Quintic] {
            assert_eq!(ramp.polynomial(0.0)[0], 1.0);
            assert!(ramp.polynomial(1.0)[0].abs() < 1e-15);
            for x in [0.1, 0.5, 0.8] {
                let [_, slope, bend] = ramp.polynomial(x);
                let (ahead, behind) = (ramp.polynomial(x + 1e-5), ramp.polynomial(x - 1e-5));
                assert!(((ahead[0] - behind[0]) / 2e-5 - slope).abs() < 1e-8);
                assert!(((ahead[1] - behind[1]) / 2e-5 - bend).abs() < 1e-7);
            }
        }
        // The quintic ramp leaves no kink at its ends.
        assert!(Ramp::Quintic.polynomial(1.0)[1].abs() < 1e-15 && Ramp::Quintic.polynomial(1.0)[2].abs() < 1e-15);
    }

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
