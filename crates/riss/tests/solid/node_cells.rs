//! Cells of nodes: they fill the body, and integrate what is linear and what is quadratic.

use riss::analysis::{solid_collocation, solid_nodes};
use riss::case::AnyCase;
use riss::integration::NodeCells;
use riss::math::Vector3;
use riss::nodes::solid::solid_obstacles;
use std::sync::Arc;

/// A box that a crack cuts in two: volume, first and second moments come out as those of the box, by halves too.
#[test]
fn cells_have_the_moments_of_the_body() {
    let text = "method = 'collocation'\nrigid_motion = 'mean-is-zero'\nmaterial = { young = 1, poisson = 0.2 }\n\
         geometry.box = { lower = [0, 0, 0], upper = [10, 12, 20] }\nnodes.spacing = 2\nremote_stress.zz = 1\n\
         crack = [{ polygon = [[0, 0, 7], [10, 0, 7], [10, 12, 7], [0, 12, 7]] }]";
    let case = AnyCase::parse(text, "case.toml".as_ref(), &[]).map_err(|e| e.to_string()).unwrap();
    let AnyCase::Solid(case) = case else { panic!("a solid") };
    let nodes = solid_nodes(&case.model, &case.settings).unwrap();
    let obstacles = Arc::new(solid_obstacles(&case.model.body, &case.model.cracks));
    let collocation = solid_collocation(&case.model, &nodes, obstacles, &case.settings);
    let cells = NodeCells::new(&case.model.body, &collocation.approximation, &case.settings.spacing);
    let (positions, sights) = (&collocation.cloud().positions, &collocation.cloud().sights);
    for (lower, upper) in [(0.0, 7.0), (7.0, 20.0)] {
        let own = (0..positions.len()).filter(|i| lower < sights[*i].z && sights[*i].z < upper);
        let (mut volume, mut first, mut second) = (0.0, Vector3::zeros(), Vector3::zeros());
        for i in own {
            let center = positions[i] + cells.offsets[i];
            let spread: Vector3 = cells.spreads[i].iter().map(|a| a.component_mul(a)).sum();
            volume += cells.volumes[i];
            first += center * cells.volumes[i];
            second += center.component_mul(&center) * cells.volumes[i] + spread;
        }
        let exact = 120.0 * (upper - lower);
        let (middle, size) = (Vector3::new(5.0, 6.0, 0.5 * (lower + upper)), Vector3::new(10.0, 12.0, upper - lower));
        let square = middle.component_mul(&middle) + size.component_mul(&size) / 12.0;
        assert!((volume / exact - 1.0).abs() < 5e-3, "{volume} {exact}");
        assert!((first / exact - middle).norm() < 5e-3 * size.norm(), "{first}");
        assert!((second / exact - square).norm() < 1e-2 * square.norm(), "{second}");
    }
}
