//! What loads on the boundary do: linear functions of the displacements, by integration.

use crate::analysis::cohesive::resultant;
use crate::approximation::{FitBuffer, ShapeFunctions};
use crate::error::Result;
use crate::geometry::triangle::area_vector;
use crate::integration::rules::triangle_rule;
use crate::math::{Matrix, Vector3};
use crate::model::{SolidModel, SurfaceConditions, SurfacePoint};
use crate::nodes::solid::SolidSpacing;
use crate::system::Collocation;
use rayon::prelude::*;

/// Longest edge of a triangle of integration over the spacing of nodes there.
pub(super) const EDGE: f64 = 1.0;
/// Depth from which points on the boundary look at nodes, over the spacing there.
const SIGHT: f64 = 1e-3;

/// Integrals over the boundary.
pub(super) struct Work {
    /// What unit loads do on each displacement [stress·length²].
    loads: Vec<Vector3>,
    /// Resultant of the loads: half of their sum of sizes where they balance [stress·length²].
    pub resultant: f64,
    /// Largest prescribed displacement [length].
    pub prescribed: f64,
    /// By component of the displacement of each node: what it adds to the integral of `u ⊗ n` in the directions that are
    /// free [area].
    outside: Vec<[Matrix<3>; 3]>,
    /// The same integral of what is prescribed, in the directions that are [length³].
    pub held: Matrix<3>,
}

/// What a point of integration adds.
struct Share {
    /// Shape functions.
    values: Vec<(u32, f64)>,
    /// Free directions, and the area with its normal.
    free: Matrix<3>,
    area: Vector3,
    force: Vector3,
    prescribed: Vector3,
}

impl Work {
    /// Integrates over the boundary.
    ///
    /// # Errors
    /// Those of the shape functions.
    pub fn new(model: &SolidModel, collocation: &Collocation<3>, spacing: &SolidSpacing) -> Result<Self> {
        let mut triangles = vec![];
        for t in 0..model.body.triangles().len() as u32 {
            let part = model.body.part_of(t);
            let normal = model.body.normals()[t as usize];
            model.body.for_each_piece(t, |p| EDGE * spacing.at(p), |piece| triangles.push((part, normal, piece)));
        }
        let rule = triangle_rule(2);
        let points: Vec<_> = triangles
            .iter()
            .flat_map(|(part, normal, corners)| {
                let area = 0.5 * area_vector(*corners).norm();
                rule.iter().map(move |(l, w)| {
                    let p = corners[0] * l[0] + corners[1] * l[1] + corners[2] * l[2];
                    (*part, *normal, p, w * area)
                })
            })
            .collect();
        let share = |(fit, shape): &mut (FitBuffer<3>, ShapeFunctions<3>),
                     (part, normal, position, weight): &(u32, Vector3, Vector3, f64)| {
            let conditions = &model.solid.parts[*part as usize];
            let sight = position - normal * (SIGHT * spacing.at(*position));
            let at = SurfacePoint { position: *position, normal: *normal, sight };
            let (free, moved) = split(conditions, &at);
            collocation.approximation.at_point(*position, sight, fit, shape)?;
            let values = shape.neighbors.iter().copied().zip(shape.values.iter().copied()).collect();
            let force = free * conditions.traction.value(&at) * *weight;
            Ok(Share { values, free, area: normal * *weight, force, prescribed: moved })
        };
        let shares = points.par_iter().map_init(Default::default, share).collect::<Result<Vec<_>>>()?;
        let n = collocation.cloud().len();
        let mut work = Self {
            loads: vec![Vector3::zeros(); n],
            resultant: 0.0,
            prescribed: 0.0,
            outside: vec![[Matrix::zeros(); 3]; n],
            held: Matrix::zeros(),
        };
        let (mut sum, mut sizes) = (Vector3::zeros(), 0.0);
        for share in shares {
            for (i, value) in share.values {
                work.loads[i as usize] += share.force * value;
                for (c, outside) in work.outside[i as usize].iter_mut().enumerate() {
                    *outside += share.free.column(c) * share.area.transpose() * value;
                }
            }
            sum += share.force;
            sizes += share.force.norm();
            work.held += share.prescribed * share.area.transpose();
            work.prescribed = work.prescribed.max(share.prescribed.norm());
        }
        work.resultant = resultant(sum.norm(), sizes);
        Ok(work)
    }

    /// Work of unit loads on displacements [stress·length³].
    pub fn of(&self, displacements: &[f64]) -> f64 {
        let at_node = |(load, u): (&Vector3, &[f64])| load.dot(&Vector3::from_column_slice(u));
        self.loads.iter().zip(displacements.chunks_exact(3)).map(at_node).sum()
    }

    /// The integral of `u ⊗ n` over the boundary, without the directions that are prescribed [length³].
    pub fn outside(&self, displacements: &[f64]) -> Matrix<3> {
        let of_node = |(own, u): (&[Matrix<3>; 3], &[f64])| own[0] * u[0] + own[1] * u[1] + own[2] * u[2];
        self.outside.iter().zip(displacements.chunks_exact(3)).map(of_node).sum()
    }
}

/// The projector on free directions, and the displacement prescribed in the others.
fn split(conditions: &SurfaceConditions<3>, at: &SurfacePoint<3>) -> (Matrix<3>, Vector3) {
    let (mut free, mut moved) = (Matrix::<3>::identity(), Vector3::zeros());
    for prescribed in &conditions.displacements {
        let direction = prescribed.unit(at.normal);
        let rest = free * direction;
        if let Some(unit) = rest.try_normalize(0.05) {
            let value = prescribed.value.value(at).dot(&direction) - moved.dot(&direction);
            moved += unit * (value / rest.norm());
            free -= unit * unit.transpose();
        }
    }
    (free, moved)
}
