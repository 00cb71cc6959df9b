//! Faces of cracks that are open and free from the beginning.

use crate::math::{Matrix, Vector3};
use crate::model::{SolidModel, SurfacePoint};

/// Pairs of nodes on them, with their areas lumped.
#[derive(Default)]
pub(super) struct FreeFaces(Vec<FreePair>);

struct FreePair {
    nodes: [usize; 2],
    /// Area times the unit normal of the crack [area].
    area: Vector3,
    /// Loads on both faces [stress·length²].
    forces: [Vector3; 2],
}

impl FreeFaces {
    /// Adds a pair.
    ///
    /// - `nodes`: on the positive and on the negative side
    /// - `normal`: unit normal of the crack
    pub fn push(
        &mut self,
        model: &SolidModel,
        crack: usize,
        nodes: [usize; 2],
        at: Vector3,
        normal: Vector3,
        area: f64,
    ) {
        let force = |outward: Vector3| {
            let point = SurfacePoint { position: at, normal: outward, sight: at };
            model.solid.faces[crack].value(&point) * area
        };
        self.0.push(FreePair { nodes, area: normal * area, forces: [force(-normal), force(normal)] });
    }

    /// Integral of `[u] ⊗ n` [length³].
    pub fn opened(&self, displacements: &[f64]) -> Matrix<3> {
        let of_pair =
            |p: &FreePair| (at(displacements, p.nodes[0]) - at(displacements, p.nodes[1])) * p.area.transpose();
        self.0.iter().map(of_pair).sum()
    }

    /// Work of the loads on these faces [stress·length³].
    pub fn work(&self, displacements: &[f64]) -> f64 {
        let of_pair =
            |p: &FreePair| -> f64 { p.nodes.iter().zip(p.forces).map(|(i, f)| f.dot(&at(displacements, *i))).sum() };
        self.0.iter().map(of_pair).sum()
    }
}

fn at(displacements: &[f64], node: usize) -> Vector3 {
    Vector3::from_column_slice(&displacements[3 * node..3 * node + 3])
}
