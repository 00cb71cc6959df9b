//! What meets at each node, and from where it looks; nodes on cracks become two.

use super::sites::{Site, Sites, Stand};
use super::{FacePair, SolidCloud};
use crate::crack::FrontPoint;
use crate::geometry::surface::{Foot, Surface, Wedge};
use crate::math::Vector3;
use crate::nodes::cloud::{Facet, Place, Side, SurfaceId};
use crate::nodes::triangulation::SIGHT_SHIFT;
use std::f64::consts::PI;

/// Where a surface bulges into the material, sights are lifted over the bulge: by this much over spacing² times
/// curvature, which clears the chord of four spacings, and no more than the second over the spacing.
const LIFT: f64 = 2.0;
const MOST_LIFT: f64 = 0.4;
/// Move along the surface over the lift.
const ALONG: f64 = 0.5;
/// Normals of cracks are means over this far around a node, over its spacing: where triangles are larger, those of the
/// plane triangles on which the nodes stand.
const AROUND: f64 = 0.25;
const AROUND_POINTS: usize = 8;
/// Sweeps in which sights get behind all facets of a node.
const SWEEPS: usize = 6;
/// Sine by which they then lie behind each: normals are means over surfaces that bend.
const BEHIND: f64 = 0.1;
/// Sectors narrower than this are no facets [rad].
const NARROW: f64 = 1e-6;

/// Makes the cloud; the first `on_surfaces` places are on surfaces.
pub(super) fn split(sites: &Sites<'_>, on_surfaces: usize) -> SolidCloud {
    let mut solid = SolidCloud::default();
    for site in &sites.list[..on_surfaces] {
        match site.stand {
            Stand::Boundary { foot, crack: None } => {
                let wedges = sites.body.wedges(&foot, site.position);
                let facets = boundary_facets(sites, site, &wedges, lift(sites.body, &foot, site, Along::Normal));
                push(&mut solid, site, facets);
            }
            Stand::Boundary { foot, crack: Some(crack) } => split_mouth(sites, site, &foot, crack, &mut solid),
            Stand::Face { crack, foot } => {
                let surface = &sites.cracks[crack as usize].surface;
                let wedges = surface.wedges(&foot, site.position);
                let first = solid.cloud.len() as u32;
                for (side, along) in [(Side::Positive, Along::Against), (Side::Negative, Along::Normal)] {
                    let facets = face_facets(surface, site, &wedges, crack, side, lift(surface, &foot, site, along));
                    push(&mut solid, site, facets);
                }
                solid.pairs.push(FacePair { crack, nodes: [first, first + 1] });
            }
            Stand::Front { crack, point, foot } => push_front(sites, site, crack, &point, foot, &mut solid),
            Stand::Inside { .. } => {}
        }
    }
    for site in &sites.list[on_surfaces..] {
        solid.cloud.push(site.position, site.position, site.spacing, Place::Inside);
    }
    solid
}

fn push(solid: &mut SolidCloud, site: &Site, facets: Vec<(Facet<3>, f64)>) {
    let (sight, facets) = finished(site, facets);
    solid.cloud.push(site.position, sight, site.spacing, Place::Surface(facets));
}

/// The sight of the node, between those of its facets.
fn finished(site: &Site, facets: Vec<(Facet<3>, f64)>) -> (Vector3, Vec<Facet<3>>) {
    let inward = facets.iter().map(|(f, _)| -f.normal).sum::<Vector3>();
    let inward = inward.try_normalize(1e-9).unwrap_or_else(|| facets.first().map_or(Vector3::zeros(), |f| -f.0.normal));
    let shift = facets.iter().map(|f| f.1).fold(0.0, f64::max);
    (site.position + inward * shift, facets.into_iter().map(|f| f.0).collect())
}

/// Which way the material lies from a surface.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Along {
    /// Behind it: the normal points out of the material.
    Normal,
    /// In front of it.
    Against,
}

/// How far a sight is moved off a surface [length].
fn lift(surface: &Surface, foot: &Foot, site: &Site, along: Along) -> f64 {
    let curvature = match along {
        Along::Normal => surface.hollowness(foot.triangle),
        Along::Against => surface.bulge(foot.triangle),
    };
    let h = site.spacing;
    SIGHT_SHIFT * h + (LIFT * curvature * h * h).min(MOST_LIFT * h)
}

/// Facets with the shift of their sights.
fn boundary_facets(sites: &Sites<'_>, site: &Site, wedges: &[Wedge], shift: f64) -> Vec<(Facet<3>, f64)> {
    let mut patches: Vec<u32> = vec![];
    wedges.iter().for_each(|w| {
        if !patches.contains(&w.patch) {
            patches.push(w.patch)
        }
    });
    let body = sites.body;
    let one = |patch: &u32| {
        let own: Vec<&Wedge> = wedges.iter().filter(|w| w.patch == *patch).collect();
        let (angle, inside) = spread(&own);
        if angle < NARROW {
            return None;
        }
        let part = own[0].part;
        let mean = own.iter().map(|w| w.normal * w.angle()).sum::<Vector3>();
        let mean = mean.try_normalize(0.0).unwrap_or(own[0].normal);
        let normal = body.parts()[part as usize].shape.normal(site.position, mean);
        // Along the surface too as it is lifted: at a concave edge it must not look past the other surface.
        let along = (ALONG * shift).max(SIGHT_SHIFT * site.spacing);
        let sight = site.position + inside * along - normal * shift;
        Some((Facet { surface: SurfaceId::Part(part), normal, sight, angle }, shift))
    };
    patches.iter().filter_map(one).collect()
}

/// Angle of some sectors, and the direction into them; zero if they go all around.
fn spread(wedges: &[&Wedge]) -> (f64, Vector3) {
    let angle: f64 = wedges.iter().map(|w| w.angle()).sum();
    let middle = wedges.iter().map(|w| (w.sides[0] + w.sides[1]).try_normalize(0.0).unwrap_or_default() * w.angle());
    let middle = middle.sum::<Vector3>();
    let is_all_around = angle > 2.0 * PI - 1e-6;
    (angle, if is_all_around { Vector3::zeros() } else { middle.try_normalize(1e-9).unwrap_or_default() })
}

/// The facets of one face of a crack: one for each side of a fold.
fn face_facets(
    surface: &Surface,
    site: &Site,
    wedges: &[Wedge],
    crack: u32,
    side: Side,
    shift: f64,
) -> Vec<(Facet<3>, f64)> {
    let sign = match side {
        Side::Positive => -1.0,
        Side::Negative => 1.0,
    };
    let mut pieces: Vec<(Vector3, Vec<&Wedge>)> = vec![];
    for wedge in wedges {
        let flat = wedge.flat_normal();
        match pieces.iter_mut().find(|p| is_one_face(&p.0, &flat)) {
            Some(piece) => piece.1.push(wedge),
            None => pieces.push((flat, vec![wedge])),
        }
    }
    let is_fold = pieces.len() > 1;
    let one = |(flat, own): (Vector3, Vec<&Wedge>)| {
        let (angle, inside) = spread(&own);
        let normal = if is_fold {
            own.iter().map(|w| w.flat_normal() * w.angle()).sum::<Vector3>().try_normalize(0.0)?
        } else {
            mean_normal(surface, flat, site)
        } * sign;
        let sight = site.position + inside * SIGHT_SHIFT * site.spacing - normal * shift;
        (angle >= NARROW).then_some((Facet { surface: SurfaceId::Face { crack, side }, normal, sight, angle }, shift))
    };
    pieces.into_iter().filter_map(one).collect()
}

/// Whether two normals are those of one face of a crack.
fn is_one_face(a: &Vector3, b: &Vector3) -> bool {
    a.cross(b).norm().atan2(a.dot(b)) <= super::FOLD
}

/// Normal of a crack around a node, which stands on a triangle with the normal `own`.
///
/// Normals that turn smoothly over whole triangles would turn faces that are plane: tractions on them would be wrong by
/// half of a fold, however far away that is.
fn mean_normal(surface: &Surface, own: Vector3, site: &Site) -> Vector3 {
    let radius = AROUND * site.spacing;
    let [x, y] = crate::geometry::surface::makers::across(own);
    let around = (0..AROUND_POINTS).filter_map(|k| {
        let (sin, cos) = (2.0 * PI * k as f64 / AROUND_POINTS as f64).sin_cos();
        let foot = surface.closest_within(site.position + (x * cos + y * sin) * radius, 2.0 * radius)?;
        Some(surface.normals()[foot.triangle as usize])
    });
    // Two sheets of a crack may come near each other; only what agrees belongs together.
    (own + around.filter(|n| n.dot(&own) > 0.0).sum::<Vector3>()).normalize()
}

/// The two nodes where a crack meets the boundary.
fn split_mouth(sites: &Sites<'_>, site: &Site, foot: &Foot, crack: u32, solid: &mut SolidCloud) {
    let surface = &sites.cracks[crack as usize].surface;
    let wedges = sites.body.wedges(foot, site.position);
    let on_crack = surface.closest(site.position);
    let normal = mean_normal(surface, surface.normals()[on_crack.triangle as usize], site);
    let first = solid.cloud.len() as u32;
    for (side, up, along) in [(Side::Positive, normal, Along::Against), (Side::Negative, -normal, Along::Normal)] {
        let above: Vec<Wedge> = wedges.iter().filter_map(|w| w.above(up)).collect();
        let mut facets = boundary_facets(sites, site, &above, lift(sites.body, foot, site, Along::Normal));
        let around = full_circle(normal);
        // The part of the crack behind all pieces of the boundary.
        let inside =
            wedges.iter().fold(around.to_vec(), |left, w| left.iter().filter_map(|c| c.above(-w.normal)).collect());
        // A mouth on a round wall is found up to some tolerance: the node itself may stand on the other side.
        let off = 4.0 * on_crack.distance;
        facets.extend(face_facets(surface, site, &inside, crack, side, lift(surface, &on_crack, site, along) + off));
        keep_behind(site, off, &mut facets);
        push(solid, site, facets);
    }
    solid.pairs.push(FacePair { crack, nodes: [first, first + 1] });
}

/// Moves the sights of facets behind all of them, by `least` or more: what one was lifted over may lie beyond another.
fn keep_behind(site: &Site, least: f64, facets: &mut [(Facet<3>, f64)]) {
    let normals: Vec<Vector3> = facets.iter().map(|f| f.0.normal).collect();
    for (facet, _) in facets {
        for _ in 0..SWEEPS {
            for normal in &normals {
                let inward = facet.sight - site.position;
                let behind = least.max(BEHIND * inward.norm());
                facet.sight -= normal * (inward.dot(normal) + behind).max(0.0);
            }
        }
    }
}

/// Four quarters of a plane.
fn full_circle(normal: Vector3) -> [Wedge; 4] {
    let [x, y] = crate::geometry::surface::makers::across(normal);
    [[x, y], [y, -x], [-x, -y], [-y, x]].map(|sides| Wedge { patch: 0, part: 0, normal, sides })
}

/// A single node of a front, which looks ahead.
fn push_front(
    sites: &Sites<'_>,
    site: &Site,
    crack: u32,
    point: &FrontPoint,
    foot: Option<Foot>,
    solid: &mut SolidCloud,
) {
    let shift = SIGHT_SHIFT * site.spacing;
    let face = |(side, normal): (Side, Vector3)| Facet {
        surface: SurfaceId::Face { crack, side },
        normal,
        sight: site.position - (point.ahead + normal) * shift,
        angle: PI,
    };
    let mut facets: Vec<Facet<3>> =
        [(Side::Positive, -point.normal), (Side::Negative, point.normal)].map(face).to_vec();
    let mut sight = point.ahead;
    if let Some(foot) = foot {
        let wedges = sites.body.wedges(&foot, site.position);
        let boundary = boundary_facets(sites, site, &wedges, shift);
        sight -= boundary.iter().map(|f| f.0.normal).sum::<Vector3>();
        facets.extend(boundary.into_iter().map(|f| f.0));
    }
    let sight = site.position + sight.normalize() * shift;
    solid.cloud.push(site.position, sight, site.spacing, Place::Front { crack, facets });
}
