//! What of a solid belongs to each node: the points that see no other node nearer by.

use crate::approximation::ConstrainedMls;
use crate::geometry::surface::Surface;
use crate::math::Vector3;
use crate::math::symmetric_eigen::symmetric_eigen;
use crate::nodes::solid::SolidSpacing;
use rayon::prelude::*;

/// Longest edge of a cube of sampling over the spacing of nodes there.
const CUBE: f64 = 0.7;
/// Points in a cube inside of the body, and in one that its boundary cuts.
const POINTS: [u32; 2] = [8, 24];
/// Fractions of the three powers of the inverse of the root of `x⁴ = x + 1` [Roberts2018]: multiples fill a cube evenly.
const STEPS: [f64; 3] = [0.819_172_513_396_164_5, 0.671_043_606_703_789_2, 0.549_700_477_901_970_2];

/// The cell of each node.
#[derive(Clone, Debug)]
pub struct NodeCells {
    /// Volumes [length³].
    pub volumes: Vec<f64>,
    /// From each node to the centroid of its cell [length].
    pub offsets: Vec<Vector3>,
    /// Vectors `a` with `Σ a aᵀ` the second moments about the centroid [length^(5/2)].
    pub spreads: Vec<[Vector3; 3]>,
}

/// Sums over points of sampling.
#[derive(Clone, Copy, Default)]
struct Moments {
    volume: f64,
    first: Vector3,
    /// xx, yy, zz, xy, xz, yz.
    second: [f64; 6],
}

impl NodeCells {
    /// Samples a body with cubes that are small against the spacing; the volumes add up to that of the body.
    pub fn new(body: &Surface, approximation: &ConstrainedMls<3>, spacing: &SolidSpacing) -> Self {
        let bounds = body.bounds();
        let edge = bounds.size().max();
        let mut cubes = vec![];
        divide(body, spacing, (bounds.lower + bounds.upper) * 0.5, edge, &mut cubes);
        let positions = &approximation.cloud().positions;
        let sample = |found: &mut Vec<(f64, u32)>, (k, cube): (usize, &Cube)| {
            let n = POINTS[usize::from(cube.is_cut)];
            let weight = cube.edge.powi(3) / f64::from(n);
            let mut samples = vec![];
            for j in 0..n {
                let number = (k as u64 * u64::from(POINTS[1]) + u64::from(j)) as f64 + 0.5;
                let unit = Vector3::from_fn(|d, _| (number * STEPS[d]).fract() - 0.5);
                let p = cube.center + unit * cube.edge;
                if (!cube.is_cut || body.contains(p))
                    && let Some(node) = approximation.nearest(p, found)
                {
                    samples.push((node, p - positions[node as usize], weight));
                }
            }
            samples
        };
        let samples: Vec<_> = cubes.par_iter().enumerate().map_init(Vec::new, |f, c| sample(f, (c.0, c.1))).collect();
        let mut moments = vec![Moments::default(); positions.len()];
        for (node, offset, weight) in samples.into_iter().flatten() {
            moments[node as usize].add(offset, weight);
        }
        let volume: f64 = moments.iter().map(|m| m.volume).sum();
        let factor = if volume > 0.0 { body.volume() / volume } else { 0.0 };
        let mut cells = Self { volumes: vec![], offsets: vec![], spreads: vec![] };
        for moment in moments {
            cells.volumes.push(moment.volume * factor);
            let (offset, spread) = moment.centroid_and_spread(factor);
            cells.offsets.push(offset);
            cells.spreads.push(spread);
        }
        cells
    }
}

impl Moments {
    fn add(&mut self, offset: Vector3, weight: f64) {
        self.volume += weight;
        self.first += offset * weight;
        let [x, y, z] = [offset.x, offset.y, offset.z];
        for (sum, product) in self.second.iter_mut().zip([x * x, y * y, z * z, x * y, x * z, y * z]) {
            *sum += product * weight;
        }
    }

    fn centroid_and_spread(&self, factor: f64) -> (Vector3, [Vector3; 3]) {
        if self.volume <= 0.0 {
            return (Vector3::zeros(), [Vector3::zeros(); 3]);
        }
        let c = self.first / self.volume;
        let [xx, yy, zz, xy, xz, yz] = self.second;
        let v = self.volume;
        let matrix = vec![
            vec![xx - v * c.x * c.x, xy - v * c.x * c.y, xz - v * c.x * c.z],
            vec![xy - v * c.x * c.y, yy - v * c.y * c.y, yz - v * c.y * c.z],
            vec![xz - v * c.x * c.z, yz - v * c.y * c.z, zz - v * c.z * c.z],
        ];
        let (values, vectors) = symmetric_eigen(&matrix);
        let along = |k: usize| Vector3::from_column_slice(&vectors[k]) * (values[k].max(0.0) * factor).sqrt();
        (c, [along(0), along(1), along(2)])
    }
}

struct Cube {
    center: Vector3,
    edge: f64,
    is_cut: bool,
}

fn divide(body: &Surface, spacing: &SolidSpacing, center: Vector3, edge: f64, cubes: &mut Vec<Cube>) {
    let reach = 0.5 * 3f64.sqrt() * edge;
    let distance = body.signed_distance(center);
    if distance > reach {
        return;
    }
    if edge > CUBE * spacing.at(center) {
        let quarter = 0.25 * edge;
        for k in 0..8 {
            let side = |bit: u32| if k >> bit & 1 == 0 { -quarter } else { quarter };
            let corner = center + Vector3::new(side(0), side(1), side(2));
            divide(body, spacing, corner, 0.5 * edge, cubes);
        }
        return;
    }
    cubes.push(Cube { center, edge, is_cut: distance > -reach });
}
