//! Irregular nodes inside the body, advancing from those on its surfaces [SlakKosec2019].

use super::sites::{Sites, Stand, scatter};
use super::spacing::SolidSpacing;
use crate::geometry::surface::Surface;
use crate::math::{Matrix, Vector3};
use nalgebra::{Quaternion, UnitQuaternion};
use std::f64::consts::PI;

/// Candidates around each point.
const CANDIDATES: usize = 18;
/// Steps between points over the spacing, and their least distance: with these a node stands for a cube of the spacing.
const STRIDE: f64 = 1.06;
const CLOSENESS: f64 = 0.85;
/// How far away surfaces are looked for, over the spacing.
const LOOK: f64 = 3.0;
/// Cells along each axis to begin an estimate with, and how often they may be split.
const GRID: usize = 12;
const MAX_SPLITS: u32 = 12;

/// Places nodes inside, no more than `limit` in all.
pub(super) fn place(sites: &mut Sites<'_>, limit: usize) {
    seed_fronts(sites);
    let directions = directions();
    let mut current = 0;
    while current < sites.list.len() && sites.list.len() < limit {
        let site = sites.list[current];
        let known = match site.stand {
            Stand::Inside { clearance } => clearance,
            Stand::Boundary { .. } | Stand::Face { .. } | Stand::Front { .. } => 0.0,
        };
        let turn = rotation(current);
        for d in &directions {
            let (p, h) = sites.step(site.position, site.spacing, turn * d * STRIDE);
            if sites.is_clear(p, h, CLOSENESS) {
                let bound = known - (p - site.position).norm();
                try_inside(sites, p, h, bound);
            }
        }
        current += 1;
    }
}

/// Adds a clear point if it is inside and far enough from surfaces, which are at least `bound` away.
fn try_inside(sites: &mut Sites<'_>, p: Vector3, h: f64, bound: f64) {
    let least = Sites::clearance(h);
    let mut clearance = bound;
    if clearance < least {
        let limit = LOOK * h;
        let Some(depth) = sites.depth(p, limit) else { return };
        clearance = sites.crack_distance(p, depth);
    }
    if clearance >= least * (1.0 - 1e-6) {
        sites.push(p, h, Stand::Inside { clearance });
    }
}

/// A row of nodes ahead of each front, so that it lies in the middle between nodes.
fn seed_fronts(sites: &mut Sites<'_>) {
    for crack in sites.cracks {
        for front in &crack.fronts {
            let mut s = 0.0;
            while s < front.length {
                let point = front.at(s);
                let h = sites.spacing.at(point.position);
                let p = point.position + point.ahead * Sites::clearance(h);
                if sites.is_clear(p, h, CLOSENESS) {
                    try_inside(sites, p, h, 0.0);
                }
                s += h;
            }
        }
    }
}

/// Unit vectors spread evenly (Fibonacci's lattice).
fn directions() -> Vec<Vector3> {
    let golden = PI * (3.0 - 5f64.sqrt());
    let one = |k: usize| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / CANDIDATES as f64;
        let (sin, cos) = (golden * k as f64).sin_cos();
        let r = (1.0 - z * z).sqrt();
        Vector3::new(r * cos, r * sin, z)
    };
    (0..CANDIDATES).map(one).collect()
}

/// A rotation for each point, from its index, so that runs repeat [Shoemake1992].
fn rotation(index: usize) -> Matrix<3> {
    let [u, v, w] = [1, 2, 3].map(|k| scatter(index, k));
    let (a, b) = ((1.0 - u).sqrt(), u.sqrt());
    let (p, q) = ((2.0 * PI * v).sin_cos(), (2.0 * PI * w).sin_cos());
    UnitQuaternion::new_unchecked(Quaternion::new(a * p.0, a * p.1, b * q.0, b * q.1)).to_rotation_matrix().into_inner()
}

/// About how many nodes a spacing asks for: the integral of 1 over its cube.
pub(super) fn estimate(body: &Surface, spacing: &SolidSpacing) -> f64 {
    let bounds = body.bounds();
    let size = bounds.size() / GRID as f64;
    let mut cells = vec![];
    for k in 0..GRID * GRID * GRID {
        let index = Vector3::new((k % GRID) as f64, (k / GRID % GRID) as f64, (k / GRID / GRID) as f64);
        cells.push((bounds.lower + size.component_mul(&(index + Vector3::repeat(0.5))), size, 0));
    }
    let mut n = 0.0;
    while let Some((center, size, splits)) = cells.pop() {
        let h = spacing.at(center);
        // The spacing varies by no more than this over the cell.
        let variation = 0.5 * spacing.growth() * size.norm();
        if variation > 0.5 * h && splits < MAX_SPLITS {
            for k in 0..8 {
                let corner = Vector3::from_fn(|d, _| if k >> d & 1 == 0 { -0.25 } else { 0.25 });
                cells.push((center + size.component_mul(&corner), size * 0.5, splits + 1));
            }
        } else if body.contains(center) {
            n += size.product() / h.powi(3);
            if n > 10.0 * super::MAX_SOLID_NODES as f64 {
                break;
            }
        }
    }
    n
}
