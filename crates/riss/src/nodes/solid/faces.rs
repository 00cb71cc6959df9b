//! Nodes over the boundary and over crack faces, advancing from those on their edges [SlakKosec2019].

use super::CLOSENESS;
use super::sites::{Sites, Stand, scatter};
use crate::geometry::surface::makers::across;
use crate::geometry::surface::{Foot, Surface};
use crate::geometry::triangle::Feature;
use crate::math::Vector3;
use std::f64::consts::TAU;

/// Candidates around each point.
const CANDIDATES: usize = 12;

/// Places nodes over all surfaces.
pub(super) fn place(sites: &mut Sites<'_>) {
    for crack in 0..sites.cracks.len() as u32 {
        cover_crack(sites, crack);
    }
    for patch in 0..sites.body.n_patches() {
        cover_patch(sites, patch);
    }
}

fn cover_patch(sites: &mut Sites<'_>, patch: u32) {
    let body = sites.body;
    let triangles: Vec<u32> = (0..body.triangles().len() as u32).filter(|t| body.patch_of(*t) == patch).collect();
    let place = |sites: &mut Sites<'_>, p: Vector3, spacing: f64| {
        let foot = body.closest_where(p, spacing, |t| body.patch_of(t) == patch)?;
        let at = body.parts()[body.part_of(foot.triangle) as usize].shape.project(foot.position);
        let own = sites.spacing.at(at);
        if is_on_border(body, &foot) || !sites.is_clear(at, own, CLOSENESS) {
            return None;
        }
        let clearance = Sites::clearance(own);
        let is_free = sites.crack_distance(at, clearance) >= clearance && !sites.is_near_front(at, clearance);
        if is_free {
            sites.push(at, own, Stand::Boundary { foot, crack: None });
        }
        is_free.then_some(foot.triangle)
    };
    // All nodes whose place touches the patch.
    let touches = |stand: &Stand| match stand {
        Stand::Boundary { foot, .. } | Stand::Front { foot: Some(foot), .. } => touching_patch(body, foot, patch),
        Stand::Front { foot: None, .. } | Stand::Face { .. } | Stand::Inside { .. } => None,
    };
    let seeds = sites.list.iter().filter_map(|s| Some((s.position, s.spacing, touches(&s.stand)?))).collect();
    advance(sites, body, seeds, &triangles, place);
}

fn cover_crack(sites: &mut Sites<'_>, crack: u32) {
    let surface = &sites.cracks[crack as usize].surface;
    let place = |sites: &mut Sites<'_>, p: Vector3, spacing: f64| {
        let foot = surface.closest_within(p, spacing)?;
        let at = foot.position;
        let own = sites.spacing.at(at);
        let clearance = Sites::clearance(own);
        // Rounding may take a row along the front a little nearer.
        let near_front = sites.is_near_front(at, clearance * (1.0 - 1e-6));
        let near_fold = sites.is_near_fold(at, clearance * (1.0 - 1e-6));
        if near_front || near_fold || is_on_border(surface, &foot) || !sites.is_clear(at, own, CLOSENESS) {
            return None;
        }
        let is_inside = sites.body.signed_distance(at) <= -clearance;
        if is_inside {
            sites.push(at, own, Stand::Face { crack, foot });
        }
        is_inside.then_some(foot.triangle)
    };
    let mut seeds = vec![];
    for front in &sites.cracks[crack as usize].fronts {
        let mut s = 0.0;
        while s < front.length {
            let point = front.at(s);
            let h = sites.spacing.at(point.position);
            let behind = point.position - point.ahead * Sites::clearance(h);
            if let Some(triangle) = place(sites, behind, h) {
                seeds.push((behind, h, triangle));
            }
            s += h;
        }
    }
    let is_mouth = |stand: &Stand| matches!(stand, Stand::Boundary { crack: Some(c), .. } if *c == crack);
    for site in sites.list.iter().filter(|s| is_mouth(&s.stand)) {
        let foot = surface.closest(site.position);
        seeds.push((site.position, site.spacing, foot.triangle));
    }
    let triangles: Vec<u32> = (0..surface.triangles().len() as u32).collect();
    advance(sites, surface, seeds, &triangles, place);
}

/// Advances over a surface from seeds, then from wherever there is room.
fn advance(
    sites: &mut Sites<'_>,
    surface: &Surface,
    mut queue: Vec<(Vector3, f64, u32)>,
    triangles: &[u32],
    place: impl Fn(&mut Sites<'_>, Vector3, f64) -> Option<u32>,
) {
    let mut next = 0;
    let mut unvisited = triangles.iter();
    loop {
        while next < queue.len() {
            let (p, h, triangle) = queue[next];
            let normal = surface.normal_at(triangle, p);
            let [x, y] = across(normal);
            let start = scatter(sites.list.len(), 1);
            for k in 0..CANDIDATES {
                let angle = TAU * (start + k as f64 / CANDIDATES as f64);
                let (q, own) = sites.step(p, h, x * angle.cos() + y * angle.sin());
                if let Some(triangle) = place(sites, q, own) {
                    let at = sites.list[sites.list.len() - 1];
                    queue.push((at.position, at.spacing, triangle));
                }
            }
            next += 1;
        }
        // Pieces that no seed reaches, such as a sphere.
        let Some(t) = unvisited.next() else { return };
        let [a, b, c] = surface.corners(*t);
        let h = sites.spacing.at((a + b + c) / 3.0);
        let n = ((b - a).norm().max((c - a).norm()) / (0.7 * h)).ceil().clamp(1.0, 1e3) as usize;
        for i in 0..n {
            for j in 0..n - i {
                let share = |k: usize| (k as f64 + 1.0 / 3.0) / n as f64;
                let p = a + (b - a) * share(i) + (c - a) * share(j);
                if let Some(triangle) = place(sites, p, sites.spacing.at(p)) {
                    let at = sites.list[sites.list.len() - 1];
                    queue.push((at.position, at.spacing, triangle));
                }
            }
        }
    }
}

/// Whether a foot lies on the border of its patch, so that what it belongs to went beyond.
fn is_on_border(surface: &Surface, foot: &Foot) -> bool {
    match foot.feature {
        Feature::Face => false,
        Feature::Edge(k) => surface.is_sharp(foot.triangle, k),
        Feature::Corner(k) => {
            let vertex = surface.triangles()[foot.triangle as usize][k];
            let patch = surface.patch_of(foot.triangle);
            let own = surface.fan(vertex).iter().filter(|t| surface.patch_of(**t) == patch);
            let is_bound = |t: &u32| {
                let c = surface.triangles()[*t as usize];
                (0..3).any(|e| surface.is_sharp(*t, e) && (c[e] == vertex || c[(e + 1) % 3] == vertex))
            };
            own.into_iter().any(is_bound)
        }
    }
}

/// A triangle of the patch at a foot.
fn touching_patch(body: &Surface, foot: &Foot, patch: u32) -> Option<u32> {
    let in_patch = |t: &u32| body.patch_of(*t) == patch;
    match foot.feature {
        Feature::Face => Some(foot.triangle).filter(in_patch),
        Feature::Edge(k) => {
            [Some(foot.triangle), body.across(foot.triangle, k)].into_iter().flatten().find(|t| in_patch(t))
        }
        Feature::Corner(k) => {
            let vertex = body.triangles()[foot.triangle as usize][k];
            body.fan(vertex).iter().copied().find(|t| in_patch(t))
        }
    }
}
