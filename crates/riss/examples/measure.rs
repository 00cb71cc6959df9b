//! Scratch.
use riss::analysis::*;
use riss::approximation::*;
use riss::crack::*;
use riss::exact::CrackTipField;
use riss::fracture::TipDomainShape;
use riss::geometry::curve::Curve;
use riss::integration::*;
use riss::material::*;
use riss::math::Vector2;
use riss::model::*;
use riss::nodes::settings::*;
use std::sync::Arc;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let get = |k: &str| args.iter().find_map(|a| a.strip_prefix(&format!("{k}=")).map(|s| s.to_string()));
    let f = |k: &str, d: f64| get(k).map_or(d, |s| s.parse().unwrap());
    let (k1, k2) = (f("k1", 1.0), f("k2", 0.0));
    let field = CrackTipField { tip: Vector2::zeros(), angle: 0.0, k1, k2, t_stress: f("t", 0.0) };
    let c = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|p| Vector2::new(p.0, p.1));
    let mut domain = Domain::new((0..4).map(|k| Curve::Line { start: c[k], end: c[(k + 1) % 4] }).collect(), vec![]);
    let part = domain.add_part("all", vec![0, 1, 2, 3]);
    let crack = CrackPath {
        name: "c".into(),
        vertices: vec![Vector2::new(-1.0, 0.0), Vector2::zeros()],
        ends: [EndKind::Mouth, EndKind::Tip],
    };
    let mut model = Model { cracks: vec![crack], exact: Some(Arc::new(field)), ..Model::plain(domain) };
    model.material = Elasticity { young: 30e6, poisson: 0.3, plane: PlaneState::Strain };
    for direction in [Direction::X, Direction::Y] {
        model.supports.push(BoundarySupport { part, direction, value: PrescribedValue::Exact(Arc::new(field)) });
    }
    for n in get("n").unwrap_or("9,17,25".into()).split(',') {
        let n: usize = n.parse().unwrap();
        let mut s = Settings::default();
        if n > 0 {
            s.nodes.layout = Layout::Structured(Structured { nx: n, ny: n });
        }
        s.approximation.weight_function = match get("w").as_deref() {
            Some("g") => WeightFunction::Gaussian,
            Some("c") => WeightFunction::CubicSpline,
            _ => WeightFunction::QuarticSpline,
        };
        s.approximation.dilation = get("d").map(|v| v.parse().unwrap());
        s.approximation.smoothing.cracks = match get("s").as_deref() {
            Some("v") => Some(CrackSmoothing::Visibility),
            Some("t") => Some(CrackSmoothing::Transparency { kappa: 1.0, lambda: 2.0 }),
            _ => Some(CrackSmoothing::Diffraction { lambda: f("lambda", 1.0) }),
        };
        let e = &mut s.approximation.enrichment;
        e.kind = match get("e").as_deref() {
            Some("n") => EnrichmentKind::None,
            Some("r") => EnrichmentKind::IntrinsicRadial,
            _ => EnrichmentKind::IntrinsicFull,
        };
        e.r1 = get("r1").map(|v| v.parse().unwrap());
        e.r2 = get("r2").map(|v| v.parse().unwrap());
        e.dilation = get("ed").map(|v| v.parse().unwrap());
        e.ramp = match get("ramp").as_deref() {
            Some("l") => Ramp::Linear,
            Some("a") => Ramp::Abrupt,
            _ => Ramp::Quintic,
        };
        s.integration.points = f("p", 4.0) as usize;
        s.integration.tip_points = f("tp", 9.0) as usize;
        s.integration.tip_rule =
            if get("rule").as_deref() == Some("p") { TipRule::Product } else { TipRule::Automatic };
        s.integration.gradient_correction =
            if get("gc").as_deref() == Some("n") { GradientCorrection::None } else { GradientCorrection::Cell };
        let (mut worst, mut text) = ([0.0f64; 2], String::new());
        let mut err = 0.0;
        let mut nn = 0;
        let t0 = std::time::Instant::now();
        for shape in [TipDomainShape::Disc, TipDomainShape::Square] {
            s.fracture.domain = shape;
            let m = if shape == TipDomainShape::Square { 0.69 } else { 0.95 };
            for r in [0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9] {
                if r > m {
                    continue;
                }
                s.fracture.radii = Some(vec![r]);
                let result = match linear_static(&model, &s, &mut Silent) {
                    Ok(r) => r,
                    Err(e) => {
                        println!("{n}: {e}");
                        return;
                    }
                };
                let tip = &result.step.cracks[0].tips[0];
                let d = [tip.k1.unwrap() - k1, tip.k2.unwrap() - k2];
                for i in 0..2 {
                    worst[i] = worst[i].max(d[i].abs());
                }
                if shape == TipDomainShape::Disc {
                    text += &format!(" {:.4}/{:.4}", 100.0 * d[0], 100.0 * d[1]);
                }
                err = result.energy_error.unwrap();
                nn = result.n_nodes;
            }
        }
        println!(
            "{n}: nodes {nn} worst K1 {:.4}% K2 {:.4}% energy {err:.5} t {:.2} |{text}",
            100.0 * worst[0],
            100.0 * worst[1],
            t0.elapsed().as_secs_f64()
        );
    }
}
