//! Known solutions.

use super::outline::vector;
use super::report::Report;
use crate::case::schema::Exact;
use crate::exact::{Cantilever, CrackTipField, ExactField, LinearField, PlateWithHole};
use crate::math::Matrix2;
use std::sync::Arc;

/// The field; `None` if it has problems.
pub(super) fn exact(exact: &Exact, report: &mut Report) -> Option<Arc<dyn ExactField>> {
    Some(match exact {
        Exact::CrackTip(f) => Arc::new(CrackTipField {
            tip: vector(f.tip),
            angle: f.angle_deg.to_radians(),
            k1: f.K_I,
            k2: f.K_II,
            t_stress: f.T,
        }),
        Exact::PlateWithHole(f) => {
            report.positive("exact.plate-with-hole.radius", f.radius).then_some(())?;
            Arc::new(PlateWithHole { center: vector(f.center), radius: f.radius, stress: f.stress })
        }
        Exact::Cantilever(f) => {
            let length = report.positive("exact.cantilever.length", f.length);
            let height = report.positive("exact.cantilever.height", f.height);
            (length && height).then_some(())?;
            Arc::new(Cantilever { length: f.length, height: f.height, load: f.load })
        }
        Exact::Linear(f) => {
            let [[a, b], [c, d]] = f.gradient;
            Arc::new(LinearField { constant: vector(f.constant), gradient: Matrix2::new(a, b, c, d) })
        }
    })
}
