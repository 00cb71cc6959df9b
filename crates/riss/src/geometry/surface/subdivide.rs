//! A surface in smaller triangles, such as one evaluates and draws.

use super::Surface;
use crate::math::Vector3;
use rustc_hash::FxHashMap;

/// Splits of a triangle after which it stays as it is, whatever is asked for.
const MOST_SPLITS: u32 = 24;

impl Surface {
    /// Vertices and triangles of the surface with edges split until `split` asks for no more; neighbors stay joined.
    ///
    /// - `split`: where to split the edge between two points; none to leave it
    pub fn subdivided(&self, split: impl Fn(Vector3, Vector3) -> Option<Vector3>) -> (Vec<Vector3>, Vec<[u32; 3]>) {
        let mut vertices = self.vertices().to_vec();
        let mut middles: FxHashMap<[u32; 2], Option<u32>> = FxHashMap::default();
        let mut middle = |a: u32, b: u32, vertices: &mut Vec<Vector3>| {
            let [low, high] = [a.min(b), a.max(b)];
            *middles.entry([low, high]).or_insert_with(|| {
                let at = split(vertices[low as usize], vertices[high as usize])?;
                vertices.push(at);
                Some(vertices.len() as u32 - 1)
            })
        };
        let mut done = vec![];
        let mut left: Vec<([u32; 3], u32)> = self.triangles().iter().rev().map(|t| (*t, 0)).collect();
        while let Some((corners, splits)) = left.pop() {
            let between = match splits < MOST_SPLITS {
                true => [0, 1, 2].map(|k| middle(corners[k], corners[(k + 1) % 3], &mut vertices)),
                false => [None; 3],
            };
            // From the corner after the first edge that stays, so that two split edges always come first.
            let start = (0..3).find(|k| between[*k].is_none() && between[(k + 1) % 3].is_some()).map_or(0, |k| k + 1);
            let [a, b, c] = [0, 1, 2].map(|k| corners[(start + k) % 3]);
            let parts = match [0, 1, 2].map(|k| between[(start + k) % 3]) {
                [Some(ab), Some(bc), Some(ca)] => vec![[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]],
                [Some(ab), Some(bc), None] => vec![[ab, b, bc], [a, ab, bc], [a, bc, c]],
                [Some(ab), None, None] => vec![[a, ab, c], [ab, b, c]],
                [None, ..] | [Some(_), None, Some(_)] => {
                    done.push(corners);
                    continue;
                }
            };
            left.extend(parts.into_iter().rev().map(|t| (t, splits + 1)));
        }
        (vertices, done)
    }
}

#[cfg(test)]
mod tests {
    use super::super::makers::{ball, cuboid};
    use super::super::{Surface, TriangleMesh};
    use super::*;
    use crate::geometry::aabb::Aabb;
    use crate::geometry::triangle::area_vector;

    fn check_halved(mesh: TriangleMesh, longest: f64) {
        let surface = Surface::closed(mesh, 0.5).unwrap();
        let halved = |p: Vector3, q: Vector3| ((p - q).norm() > longest).then(|| 0.5 * (p + q));
        let (vertices, triangles) = surface.subdivided(halved);
        let corners = |t: &[u32; 3]| t.map(|v| vertices[v as usize]);
        let area: f64 = triangles.iter().map(|t| 0.5 * area_vector(corners(t)).norm()).sum();
        assert!((area - surface.area(None)).abs() < 1e-12 * area);
        let mut edges: FxHashMap<[u32; 2], i32> = FxHashMap::default();
        for t in &triangles {
            for k in 0..3 {
                let (a, b) = (t[k], t[(k + 1) % 3]);
                assert!((vertices[a as usize] - vertices[b as usize]).norm() <= longest);
                *edges.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
            }
        }
        assert!(edges.values().all(|n| *n == 0), "each edge is passed once each way");
        assert_eq!(vertices.len() + triangles.len() - edges.len(), 2, "Euler");
    }

    #[test]
    fn small_triangles_enclose_the_same_body() {
        check_halved(cuboid(Aabb { lower: Vector3::zeros(), upper: Vector3::new(1.0, 2.0, 7.0) }), 0.31);
        check_halved(ball(Vector3::new(1.0, 0.0, 0.0), 2.0, "ball"), 0.15);
    }

    #[test]
    fn edges_split_where_they_are_cut_end_there() {
        let surface =
            Surface::closed(cuboid(Aabb { lower: Vector3::zeros(), upper: Vector3::repeat(1.0) }), 0.5).unwrap();
        let level = 0.3;
        let cut = |p: Vector3, q: Vector3| {
            let s = (level - p.z) / (q.z - p.z);
            ((p.z - level) * (q.z - level) < -1e-12).then(|| p + s * (q - p))
        };
        let (vertices, triangles) = surface.subdivided(cut);
        for t in &triangles {
            let heights = t.map(|v| vertices[v as usize].z - level);
            assert!(heights.iter().all(|h| *h < 1e-9) || heights.iter().all(|h| *h > -1e-9), "{heights:?}");
        }
    }
}
