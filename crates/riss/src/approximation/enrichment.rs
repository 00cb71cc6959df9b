//! Where the basis holds the field of a crack tip, and how it fades into the plain one [EFG, sections 5.3, 5.4].

use super::detour::Jet;
use super::extra::Extra;
use super::global_functions::{GlobalFunctions, GlobalRegion};
use super::partition_of_unity::{ExtraFunctions, ExtraRegion};
pub use super::region_size::TipSpacing;
use super::region_size::{Form, RegionSize, wants_functions};
use super::settings::{
    ApproximationSettings, Basis, CrackSmoothing, EnrichmentKind, EnrichmentSettings, HoleSmoothing, Ramp,
    SmoothingSettings, SupportShape,
};
use super::tip_functions::{MOST_FUNCTIONS, TipCoordinates, TipFunctions};
use crate::geometry::aabb::Aabb;
use crate::math::{Matrix2, Vector2};
use crate::model::Model;
use crate::nodes::Nodes;
use rustc_hash::FxHashMap;

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

impl EnrichmentBuffer {
    /// Whether no region holds a point of the cell.
    pub fn is_empty(&self) -> bool {
        self.near.is_empty()
    }
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
    ///
    /// - `spacings`: at each tip, in the order of [`Model::tips`]
    pub fn of_model(
        model: &Model,
        settings: &EnrichmentSettings,
        spacings: &[TipSpacing],
    ) -> (Option<Self>, Vec<String>) {
        let (functions, form) = match settings.kind {
            EnrichmentKind::None => return (None, vec![]),
            EnrichmentKind::IntrinsicFull => (TipFunctions::Full, Form::Intrinsic),
            EnrichmentKind::IntrinsicRadial => (TipFunctions::Radial, Form::Intrinsic),
            EnrichmentKind::Automatic | EnrichmentKind::ExtrinsicFull => (TipFunctions::Full, Form::OfNodes),
            EnrichmentKind::ExtrinsicRadial => (TipFunctions::Radial, Form::OfNodes),
            EnrichmentKind::ExtrinsicMls => (TipFunctions::Full, Form::OfTips),
        };
        let (mut regions, mut notes) = (vec![], vec![]);
        for ((id, frame), spacing) in model.tips().into_iter().zip(spacings) {
            if settings.kind == EnrichmentKind::Automatic && !wants_functions(model, id, settings, *spacing) {
                continue;
            }
            let RegionSize { radii, wanted, clear } = RegionSize::new(model, id, form, settings, spacing.at_tip);
            let outer = radii[1];
            if settings.r2.is_some() && outer < wanted {
                notes.push(format!(
                    "the enriched region around the tip at ({:.6}, {:.6}) would meet another tip or a bend of its crack; its radius is {outer:.4} instead of {wanted:.4}",
                    frame.position.x, frame.position.y
                ));
            }
            let reach = match form {
                Form::Intrinsic | Form::OfTips => CUT_REACH * outer,
                Form::OfNodes => clear,
            };
            let coordinates = TipCoordinates::new(&model.cracks[id.crack], id.end, reach, 0.0);
            regions.push(Region { coordinates, radii, clear, values: FxHashMap::default() });
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

    /// Coordinates at the tip of each region.
    pub fn coordinates(&self) -> impl Iterator<Item = &TipCoordinates> {
        self.regions.iter().map(|r| &r.coordinates)
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

impl ApproximationSettings {
    /// These settings with automatic enrichment decided: the smoothing that goes with it, or none.
    ///
    /// - `spacings`: at each tip, in the order of [`Model::tips`]
    pub fn decided(&self, model: &Model, spacings: &[TipSpacing]) -> Self {
        const ROUND_TIPS: CrackSmoothing = CrackSmoothing::Diffraction { lambda: 1.0 };
        if self.enrichment.kind != EnrichmentKind::Automatic {
            return *self;
        }
        let around_holes = match self.smoothing.holes() {
            HoleSmoothing::Diffraction { lambda } => lambda == 1.0,
            HoleSmoothing::Visibility | HoleSmoothing::SeeThrough => true,
        };
        let suits = self.support == SupportShape::Circular
            && self.basis == Basis::Linear
            && around_holes
            && self.smoothing.cracks.is_none_or(|c| c == ROUND_TIPS);
        let tips = model.tips().into_iter().zip(spacings);
        let wants = |id, spacing: TipSpacing| wants_functions(model, id, &self.enrichment, spacing);
        if !suits || !tips.into_iter().any(|((id, _), spacing)| wants(id, *spacing)) {
            return self.without_automatic_enrichment();
        }
        Self { smoothing: SmoothingSettings { cracks: Some(ROUND_TIPS), ..self.smoothing }, ..*self }
    }

    /// These settings with no enrichment where it is left to choose.
    pub fn without_automatic_enrichment(&self) -> Self {
        let mut result = *self;
        if result.enrichment.kind == EnrichmentKind::Automatic {
            result.enrichment.kind = EnrichmentKind::None;
        }
        result
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
}
