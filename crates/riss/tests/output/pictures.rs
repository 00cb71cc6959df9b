//! Pictures: what they show, and how large they are.

use crate::sample;
use riss::analysis::{Settings, Silent, discretize, nearest_node, sample_node_function};
use riss::approximation::{CrackSmoothing, SmoothingSettings};
use riss::crack::{CrackPath, EndKind};
use riss::geometry::curve::Curve;
use riss::math::Vector2;
use riss::model::{
    BodyForce, BoundaryLoad, BoundarySupport, Direction, Domain, Model, PointLoad, PointSupport, PrescribedValue,
    RigidMotion, Spring, TractionValue,
};
use riss::output::{FieldQuantity, write_field_picture, write_model_picture, write_shape_pictures};

fn field_picture(n: usize, quantity: FieldQuantity) -> String {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("field.svg");
    write_field_picture(&path, &sample::result(n), quantity).unwrap();
    std::fs::read_to_string(path).unwrap()
}

/// A plate with a hole and two cracks, with every kind of symbol.
pub fn model() -> Model {
    let corner = |x, y| Vector2::new(x, y);
    let corners = [corner(0.0, 0.0), corner(4.0, 0.0), corner(4.0, 2.5), corner(0.0, 2.5)];
    let outline = (0..4).map(|k| Curve::Line { start: corners[k], end: corners[(k + 1) % 4] }).collect();
    let mut domain = Domain::new(outline, vec![vec![Curve::circle(corner(2.7, 1.2), 0.5)]]);
    let parts = ["bottom", "right", "top", "left", "hole"];
    let [bottom, right, top, left, hole] = [0, 1, 2, 3, 4].map(|k| domain.add_part(parts[k], vec![k]));
    let crack = |name: &str, vertices: &[(f64, f64)], start| CrackPath {
        name: name.into(),
        vertices: vertices.iter().map(|&(x, y)| corner(x, y)).collect(),
        ends: [start, EndKind::Tip],
    };
    let support =
        |part, direction, value: f64| BoundarySupport { part, direction, value: PrescribedValue::Field(value.into()) };
    Model {
        title: "Everything <at once>".into(),
        domain,
        material: sample::MATERIAL,
        thickness: 1.0,
        thickness_is_given: false,
        yield_stress: None,
        cracks: vec![
            crack("crack-1", &[(0.0, 1.0), (0.7, 1.0), (1.0, 1.3)], EndKind::Mouth),
            crack("b", &[(1.3, 1.9), (2.0, 1.7)], EndKind::Tip),
        ],
        loads: vec![
            BoundaryLoad { part: Some(top), value: TractionValue::Components([20.0.into(), 100.0.into()]) },
            BoundaryLoad { part: Some(hole), value: TractionValue::Pressure(50.0.into()) },
        ],
        crack_face_loads: vec![],
        cohesive: None,
        contact: None,
        body_force: Some(BodyForce([0.0.into(), (-9.81).into()])),
        point_loads: vec![PointLoad { at: corner(4.0, 2.5), force: corner(3.0, 0.0) }],
        supports: vec![
            support(bottom, Direction::X, 0.0),
            support(bottom, Direction::Y, 0.0),
            support(right, Direction::X, 0.01),
        ],
        point_supports: vec![PointSupport { at: corner(0.0, 2.5), displacement: [Some(0.0), None] }],
        springs: vec![Spring { part: left, direction: Direction::Normal, stiffness: 10.0.into() }],
        rigid_motion: RigidMotion::Supported,
        exact: None,
    }
}

/// Nodes and square cells at a spacing, over the bounding box.
pub fn grid(spacing: f64) -> (Vec<Vector2>, Vec<Vec<Vector2>>) {
    let (nx, ny) = ((4.0 / spacing).round() as usize, (2.5 / spacing).round() as usize);
    let at = |i: usize, j: usize| Vector2::new(i as f64, j as f64) * spacing;
    let nodes = (0..=ny).flat_map(|j| (0..=nx).map(move |i| at(i, j))).collect();
    let cells =
        (0..ny).flat_map(|j| (0..nx).map(move |i| vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
    (nodes, cells.collect())
}

fn model_picture(spacing: f64) -> String {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("model.svg");
    let (nodes, cells) = grid(spacing);
    write_model_picture(&path, &model(), &nodes, &cells).unwrap();
    std::fs::read_to_string(path).unwrap()
}

#[test]
fn field_picture_names_quantity_and_has_every_color() {
    let picture = field_picture(20, FieldQuantity::VonMises);
    assert!(picture.contains("von Mises stress, deformation × "));
    let fills: std::collections::BTreeSet<&str> =
        picture.lines().filter(|l| l.starts_with("<path fill=\"#")).map(|l| &l[..20]).collect();
    assert_eq!(fills.len(), 25, "24 colors and gray below them");
}

#[test]
fn pictures_of_many_triangles_nodes_and_cells_stay_small() {
    // 100,000 triangles; 640,000 nodes and cells.
    assert!(field_picture(112, FieldQuantity::MaxPrincipalStress).len() < 1_000_000);
    assert!(model_picture(0.004).len() < 5_000_000);
}

#[test]
fn noise_on_many_triangles_costs_colors_but_not_megabytes() {
    let mut result = sample::result(112);
    // Noise that is the same on every machine.
    let mut state = 1_u64;
    for value in &mut result.fields.error_indicator {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        *value = (state >> 40) as f64;
    }
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("noise.svg");
    write_field_picture(&path, &result, FieldQuantity::ErrorIndicator).unwrap();
    assert!(path.metadata().unwrap().len() < 5_000_000);
}

#[test]
fn model_picture_names_parts_and_cracks() {
    let picture = model_picture(0.1);
    for text in [">bottom<", ">left<", ">hole<", ">crack-1<", ">b<", ">Everything &lt;at once&gt;<"] {
        assert!(picture.contains(text), "{text}");
    }
}

/// Under the visibility criterion a node above a crack is nothing below it; its own side has its weight.
#[test]
fn sampled_functions_have_both_sides_of_a_crack() {
    let model = model();
    let mut settings = Settings::default();
    settings.approximation.smoothing = SmoothingSettings::VISIBILITY;
    let discrete = discretize(&model, &settings, &mut Silent).unwrap();
    // In the middle of the first segment of the edge crack, on its left.
    let middle = Vector2::new(0.35, 1.0);
    let node = nearest_node(&discrete, middle + Vector2::new(0.0, 1e-9));
    let function = sample_node_function(&discrete, node);
    assert!((function.position.y - 1.0).abs() < 1e-12 && discrete.approximation.nodes().sights[node].y > 1.0);
    let radius = function.support_radius;
    let (mut above, mut below) = (0.0f64, 0.0f64);
    for t in &function.triangles {
        let center = t.iter().map(|v| function.points[*v as usize]).sum::<Vector2>() / 3.0;
        for v in t.map(|v| v as usize) {
            let away = (function.points[v] - function.position).norm();
            // [EFG, Eq. 1].
            let s = (away / radius).min(1.0);
            let expected = 1.0 - 6.0 * s.powi(2) + 8.0 * s.powi(3) - 3.0 * s.powi(4);
            if center.y > 1.0 {
                assert!((function.weight[v] - expected).abs() < 1e-12, "{away} {}", function.weight[v]);
                above = above.max(function.shape[v]);
            } else {
                assert_eq!(function.weight[v], 0.0);
                below = below.max(function.shape[v].abs());
            }
        }
    }
    assert!(above > 0.2 && below == 0.0, "{above} {below}");
}

#[test]
fn functions_are_drawn_as_contours_and_surfaces() {
    let model = model();
    let mut settings = Settings::default();
    settings.approximation.smoothing.cracks = Some(CrackSmoothing::Diffraction { lambda: 1.0 });
    let discrete = discretize(&model, &settings, &mut Silent).unwrap();
    let node = nearest_node(&discrete, Vector2::new(1.0, 1.3));
    let dir = tempfile::tempdir().unwrap();
    let written = write_shape_pictures(dir.path(), &model, &sample_node_function(&discrete, node)).unwrap();
    assert_eq!(written.len(), 4);
    for path in written {
        let picture = std::fs::read_to_string(path).unwrap();
        assert!(picture.starts_with("<svg") && picture.ends_with("</svg>\n") && !picture.contains("NaN"));
        assert!((5_000..400_000).contains(&picture.len()), "{}", picture.len());
    }
}
