//! Turns triangles so that neighbors agree, and closed shells so that their normals point out of the body.

use super::mesh::SurfaceDefect;
use crate::math::Vector3;
use std::f64::consts::PI;

/// Whether a rim is allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Closed,
    Open,
}

/// Turns the triangles.
pub(super) fn orient(
    vertices: &[Vector3],
    triangles: &mut [[u32; 3]],
    neighbors: &[[Option<u32>; 3]],
    kind: Kind,
) -> Result<(), SurfaceDefect> {
    let middle = |t: [u32; 3], k: usize| (vertices[t[k] as usize] + vertices[t[(k + 1) % 3] as usize]) * 0.5;
    if kind == Kind::Closed {
        for (t, row) in triangles.iter().zip(neighbors) {
            if let Some(k) = row.iter().position(Option::is_none) {
                return Err(SurfaceDefect::NotClosed { at: middle(*t, k) });
            }
        }
    }
    let shells = agree(vertices, triangles, neighbors)?;
    if kind == Kind::Closed {
        let pieces: Vec<Vec<[u32; 3]>> =
            shells.iter().map(|s| s.iter().map(|t| triangles[*t as usize]).collect()).collect();
        for (s, shell) in shells.iter().enumerate() {
            let inside_of = |o: &usize| *o != s && surrounds(vertices, &pieces[*o], vertices[pieces[s][0][0] as usize]);
            let is_void = (0..shells.len()).filter(inside_of).count() % 2 == 1;
            if (volume(vertices, &pieces[s]) < 0.0) != is_void {
                shell.iter().for_each(|t| triangles[*t as usize].swap(1, 2));
            }
        }
    }
    Ok(())
}

/// Turns triangles to agree with the first of their shell; returns the shells.
fn agree(
    vertices: &[Vector3],
    triangles: &mut [[u32; 3]],
    neighbors: &[[Option<u32>; 3]],
) -> Result<Vec<Vec<u32>>, SurfaceDefect> {
    let mut is_seen = vec![false; triangles.len()];
    let mut shells = vec![];
    for start in 0..triangles.len() {
        if is_seen[start] {
            continue;
        }
        is_seen[start] = true;
        let mut shell = vec![start as u32];
        let mut next = 0;
        while next < shell.len() {
            let t = shell[next] as usize;
            next += 1;
            for other in neighbors[t].iter().flatten() {
                let o = *other as usize;
                let is_same_way = shared_edge_runs_the_same_way(triangles[t], triangles[o]);
                if is_same_way && is_seen[o] {
                    return Err(SurfaceDefect::OneSided { at: vertices[triangles[o][0] as usize] });
                }
                if !is_seen[o] {
                    if is_same_way {
                        triangles[o].swap(1, 2);
                    }
                    is_seen[o] = true;
                    shell.push(*other);
                }
            }
        }
        shells.push(shell);
    }
    Ok(shells)
}

/// Whether two triangles with a common edge run along it in the same direction, so that their normals disagree.
fn shared_edge_runs_the_same_way(a: [u32; 3], b: [u32; 3]) -> bool {
    let edges = |t: [u32; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    edges(a).iter().any(|e| edges(b).contains(e))
}

fn volume(vertices: &[Vector3], shell: &[[u32; 3]]) -> f64 {
    let origin = vertices[shell[0][0] as usize];
    let six = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| vertices[v as usize] - origin);
        a.dot(&b.cross(&c))
    };
    shell.iter().map(six).sum::<f64>() / 6.0
}

/// Whether a closed shell winds around a point: sum of solid angles [VanOosterom1983].
fn surrounds(vertices: &[Vector3], shell: &[[u32; 3]], p: Vector3) -> bool {
    let solid_angle = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| vertices[v as usize] - p);
        let (x, y, z) = (a.norm(), b.norm(), c.norm());
        2.0 * a.dot(&b.cross(&c)).atan2(x * y * z + a.dot(&b) * z + a.dot(&c) * y + b.dot(&c) * x)
    };
    shell.iter().map(solid_angle).sum::<f64>().abs() > 2.0 * PI
}
