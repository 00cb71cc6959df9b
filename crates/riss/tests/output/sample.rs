//! A result made from an exact field: a square with an edge crack up to its middle.

use riss::analysis::{
    CrackFaces, CrackRecord, Fields, NodeRecord, RefinementRecord, StaticResult, StepRecord, TipRecord, TipStatus,
    Warning,
};
use riss::crack::{End, EndKind};
use riss::exact::{CrackTipField, ExactField};
use riss::material::{Elasticity, PlaneState};
use riss::math::Vector2;
use riss::output::{RunInfo, RunStatus};

pub const MATERIAL: Elasticity = Elasticity { young: 100.0, poisson: 0.3, plane: PlaneState::Strain };
const FIELD: CrackTipField = CrackTipField { tip: Vector2::new(0.0, 0.0), angle: 0.0, k1: 3.0, k2: 1.0, t_stress: 0.5 };
/// Offset to a side of the crack.
const SIDE: f64 = 1e-12;

pub fn info() -> RunInfo {
    RunInfo {
        title: "square, \"edge\" crack".into(),
        method: "efg".into(),
        units: None,
        status: RunStatus::Done,
        wall_time_s: 1.5,
        stage_time_s: vec![("nodes".into(), 0.25), ("solve".into(), 0.5), ("solve".into(), 0.25)],
        peak_memory_bytes: None,
    }
}

/// The square [-1, 1]² in `2 n` columns and rows of cells, two triangles each.
pub fn result(n: usize) -> StaticResult {
    let fields = fields(n);
    StaticResult {
        step: StepRecord {
            step: 0,
            load_factor: 1.0,
            cycles: None,
            cycles_range: None,
            stability: None,
            end: None,
            cracks: vec![crack()],
            reactions: vec![("bottom".into(), Vector2::new(0.0, -2.0))],
        },
        n_nodes: 4,
        n_unknowns: 11,
        n_integration_points: 2,
        strain_energy: 0.125,
        energy_error: Some(f64::NAN),
        residual: 1e-14,
        refinements: vec![RefinementRecord {
            n_nodes: 4,
            error_estimate: 0.25,
            energy_error: None,
            k_error: Some(0.125),
            factors: vec![[FIELD.k1, f64::INFINITY]],
        }],
        extra_parameters: vec![],
        nodes: fields
            .positions
            .iter()
            .zip(&fields.displacement)
            .map(|(&position, &parameters)| NodeRecord { position, support_radius: 0.5, parameters })
            .collect(),
        integration_points: vec![(Vector2::new(0.5, 0.25), 0.75), (Vector2::new(-0.5, 0.25), 0.5)],
        fields,
        warnings: vec![Warning { key: None, message: "few nodes".into() }],
    }
}

fn crack() -> CrackRecord {
    CrackRecord {
        name: "crack-1".into(),
        path: vec![Vector2::new(-1.0, 0.0), Vector2::zeros()],
        ends: [EndKind::Mouth, EndKind::Tip],
        tips: vec![TipRecord {
            end: End::End,
            position: FIELD.tip,
            angle: 0.0,
            k1: Some(FIELD.k1),
            k2: Some(f64::INFINITY),
            k_uncertainty: Some(0.01),
            k1_direct: None,
            k2_direct: None,
            j: Some(0.125),
            j_uncertainty: Some(0.001),
            t_stress: None,
            t_uncertainty: None,
            configurational_force: Some(Vector2::new(0.125, f64::NAN)),
            kink_angle: Some(-std::f64::consts::FRAC_PI_4),
            k_equivalent: None,
            increment: None,
            growth_rate: None,
            reason: None,
            status: TipStatus::Stationary,
            radii: vec![0.25, 0.5],
        }],
    }
}

fn fields(n: usize) -> Fields {
    let mut fields = Fields::default();
    let width = 2 * n + 1;
    for row in 0..=2 * n {
        for column in 0..width {
            let at = |k: usize| k as f64 / n as f64 - 1.0;
            push_vertex(&mut fields, n, Vector2::new(at(column), at(row)), -SIDE);
        }
    }
    // The upper face has vertices of its own.
    let upper = fields.positions.len();
    for column in 0..n {
        let position = fields.positions[n * width + column];
        push_vertex(&mut fields, n, position, SIDE);
    }
    for row in 0..2 * n {
        for c in 0..2 * n {
            let below = if row == n && c < n { upper } else { row * width };
            let below_right = if row == n && c + 1 < n { upper } else { row * width };
            let [a, b] = [below + c, below_right + c + 1].map(|v| v as u32);
            let [d, e] = [(row + 1) * width + c, (row + 1) * width + c + 1].map(|v| v as u32);
            fields.triangles.extend([[a, b, e], [a, e, d]]);
        }
    }
    let positions: Vec<_> = (0..=8).map(|k| Vector2::new(k as f64 / 8.0 - 1.0, 0.0)).collect();
    let face =
        |side| positions.iter().map(|p| FIELD.displacement(&MATERIAL, p + Vector2::new(0.0, side))).collect::<Vec<_>>();
    fields.crack_faces.push(CrackFaces { left: face(SIDE), right: face(-SIDE), positions, traction: vec![] });
    fields
}

/// The vertex itself is exact; the field is taken a little to its side of the crack, and ahead of the tip.
fn push_vertex(fields: &mut Fields, n: usize, position: Vector2, side: f64) {
    let mut at = position;
    if position.y == 0.0 {
        at.y = side;
        at.x += if position.x == 0.0 { 0.25 / n as f64 } else { 0.0 };
    }
    let stress = FIELD.stress(&MATERIAL, at);
    fields.positions.push(position);
    fields.displacement.push(FIELD.displacement(&MATERIAL, at));
    fields.stress.push(stress);
    fields.strain.push(MATERIAL.strain(&stress));
    fields.out_of_plane_stress.push(MATERIAL.out_of_plane_stress(&stress));
    fields.out_of_plane_strain.push(MATERIAL.out_of_plane_strain(&stress));
    fields.von_mises.push(MATERIAL.von_mises(&stress));
    fields.error_indicator.push(position.norm());
}
