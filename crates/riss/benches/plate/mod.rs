//! The body of the benches: a plate with an edge crack under shear, of about the asked number of nodes.

#![allow(dead_code, reason = "no bench uses all of it")]

use riss::analysis::{Settings, Silent, discretize};
use riss::crack::CrackPath;
use riss::geometry::curve::Curve;
use riss::math::Vector2;
use riss::model::{BoundaryLoad, BoundarySupport, Direction, Domain, Model, PrescribedValue, TractionValue};
use riss::nodes::settings::{Graded, Layout};
use riss::system::Discretization;

/// The model and its discretization.
pub fn plate(n_nodes: usize) -> (Model, Discretization) {
    plate_with(n_nodes, Settings::default())
}

/// The same with settings that are not the default.
pub fn plate_with(n_nodes: usize, mut settings: Settings) -> (Model, Discretization) {
    let corners = [(0.0, 0.0), (7.0, 0.0), (7.0, 16.0), (0.0, 16.0)].map(|(x, y)| Vector2::new(x, y));
    let edges = (0..4).map(|i| Curve::Line { start: corners[i], end: corners[(i + 1) % 4] }).collect();
    let mut domain = Domain::new(edges, vec![]);
    let (bottom, top) = (domain.add_part("bottom", vec![0]), domain.add_part("top", vec![2]));
    let mut model = Model::plain(domain);
    let value = TractionValue::Components([1.0.into(), 0.0.into()]);
    model.loads.push(BoundaryLoad { part: Some(top), value });
    for direction in [Direction::X, Direction::Y] {
        model.supports.push(BoundarySupport { part: bottom, direction, value: PrescribedValue::Field(0.0.into()) });
    }
    model.cracks.push(CrackPath {
        name: "crack-1".into(),
        vertices: vec![Vector2::new(0.0, 8.0), Vector2::new(3.5, 8.0)],
        ends: [riss::crack::EndKind::Mouth, riss::crack::EndKind::Tip],
    });
    let spacing = (112.0 / n_nodes as f64).sqrt();
    settings.nodes.layout = Layout::Graded(Graded { spacing: Some(spacing), ..Graded::default() });
    let discrete = discretize(&model, &settings, &mut Silent).unwrap();
    (model, discrete)
}
