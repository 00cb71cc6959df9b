//! Tests of constrained moving least squares.

use super::*;
use crate::approximation::front_functions::{FrontEnds, FrontLine};
use crate::approximation::settings::WeightFunction;
use crate::nodes::cloud::Place;

/// Nothing hides anything.
struct Clear;

impl<const D: usize> Opaque<D> for Clear {
    fn visible(&self, _: Vector<D>, _: Vector<D>) -> bool {
        true
    }
}

/// The crack `x_0 < 0, x_(D-1) = 0`.
struct HalfPlane;

impl<const D: usize> Opaque<D> for HalfPlane {
    fn visible(&self, a: Vector<D>, b: Vector<D>) -> bool {
        let (s, t) = (a[D - 1], b[D - 1]);
        s * t >= 0.0 || (a[0] * t - b[0] * s) / (t - s) > 0.0
    }
}

/// Nodes of a grid of spacing `h` in the cube from -1 to 1, moved by up to `jitter` of the spacing; seeded.
fn cloud<const D: usize>(n: usize, jitter: f64) -> Cloud<D> {
    let mut state = 0x9E37_79B9_7F4A_7C15u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let h = 2.0 / n as f64;
    let mut cloud = Cloud::default();
    for k in 0..n.pow(D as u32) {
        let p =
            Vector::<D>::from_fn(|d, _| -1.0 + h * ((k / n.pow(d as u32) % n) as f64 + 0.5 + 2.0 * jitter * random()));
        cloud.push(p, p, h, Place::Inside);
    }
    cloud
}

fn approximation<const D: usize>(order: usize, weight: CollocationWeight, jitter: f64) -> ConstrainedMls<D> {
    let settings = ConstrainedMlsSettings { order, weight, neighbors: None };
    ConstrainedMls::new(cloud::<D>(if D == 2 { 16 } else { 9 }, jitter), Arc::new(Clear), vec![], settings)
}

/// Sum of all monomials of the exponents up to `order`, shifted, with derivatives.
fn polynomial<const D: usize>(order: i32, x: Vector<D>) -> (f64, Vector<D>, Matrix<D>) {
    // A power of a linear function holds every monomial of its degree.
    let direction = Vector::<D>::from_fn(|d, _| [0.7, -0.5, 0.3][d]);
    let t = direction.dot(&x) + 0.4;
    let (m, d) = (order as f64, direction);
    (t.powi(order), d * (m * t.powi(order - 1)), d * d.transpose() * (m * (m - 1.0) * t.powi(order - 2)))
}

fn check_reproduction<const D: usize>(order: usize, weight: CollocationWeight) {
    let mls = approximation::<D>(order, weight, 0.2);
    let (mut buffer, mut shape) = Default::default();
    let values: Vec<f64> = mls.cloud().positions.iter().map(|p| polynomial(order as i32, *p).0).collect();
    let mut check = |at: Vector<D>, is_node: Option<u32>| {
        match is_node {
            Some(i) => mls.at_node(i, at, &mut buffer, &mut shape).unwrap(),
            None => mls.at_point(at, at, &mut buffer, &mut shape).unwrap(),
        };
        let (value, gradient, second) = polynomial(order as i32, at);
        let (mut v, mut g, mut s) = (0.0, Vector::<D>::zeros(), Matrix::<D>::zeros());
        for (k, &j) in shape.neighbors.iter().enumerate() {
            v += shape.values[k] * values[j as usize];
            g += shape.gradients[k] * values[j as usize];
            s += shape.second_derivatives[k] * values[j as usize];
        }
        assert!((v - value).abs() < 1e-12, "{v} {value}");
        assert!((g - gradient).norm() < 1e-11, "{g} {gradient}");
        assert!((s - second).norm() < 1e-9, "{s} {second}");
    };
    for i in (0..mls.cloud().len() as u32).step_by(7) {
        check(mls.cloud().positions[i as usize], Some(i));
        check(mls.cloud().positions[i as usize] * 0.9, None);
    }
}

#[test]
fn polynomials_are_reproduced_with_their_derivatives() {
    for order in 2..=4 {
        check_reproduction::<2>(order, CollocationWeight::NonSmooth);
        check_reproduction::<3>(order, CollocationWeight::NonSmooth);
    }
    check_reproduction::<2>(3, CollocationWeight::Smooth(WeightFunction::Gaussian));
    check_reproduction::<3>(3, CollocationWeight::Smooth(WeightFunction::QuarticSpline));
}

#[test]
fn support_holds_at_most_the_number_of_the_paper() {
    let mls = approximation::<3>(3, CollocationWeight::NonSmooth, 0.2);
    let (mut buffer, mut shape) = Default::default();
    let mut sizes = vec![];
    for i in 0..mls.cloud().len() as u32 {
        mls.at_node(i, mls.cloud().positions[i as usize], &mut buffer, &mut shape).unwrap();
        sizes.push(shape.neighbors.len());
    }
    assert_eq!(sizes.iter().max(), Some(&149));
    assert!(sizes.iter().all(|n| *n == 149));
}

fn check_enriched<const D: usize>() {
    let mut ahead = Vector::<D>::zeros();
    ahead[0] = 1.0;
    let mut normal = Vector::<D>::zeros();
    normal[D - 1] = 1.0;
    let frame = FrontFrame { position: Vector::zeros(), ahead, normal, curvature: 0.0, normal_curvature: 0.0 };
    let mut end = frame;
    end.position[1 % (D - 1)] = 1.0;
    let frames = if D == 2 {
        vec![frame]
    } else {
        let at = |y: f64| {
            let mut f = frame;
            f.position[1] = y;
            f
        };
        vec![at(-1.0), at(1.0)]
    };
    let front = EnrichedFront { line: FrontLine::new(frames, FrontEnds::Open), reach: 0.9, crack: None };
    let cloud = cloud::<D>(if D == 2 { 16 } else { 10 }, 0.2);
    let mls = ConstrainedMls::new(cloud, Arc::new(HalfPlane), vec![front], ConstrainedMlsSettings::default());
    let (mut buffer, mut shape) = Default::default();
    let mut compared = 0;
    for i in 0..mls.cloud().len() as u32 {
        let at = mls.cloud().positions[i as usize];
        let [r, _] = frame.polar(at, 0.0);
        if !(0.02..0.85).contains(&r) || at.iter().any(|x| x.abs() > 0.8) {
            continue;
        }
        mls.at_node(i, at, &mut buffer, &mut shape).unwrap();
        let jets = frame.jets(at, 0.0);
        for (k, jet) in jets.iter().enumerate() {
            let (mut g, mut s) = (Vector::<D>::zeros(), Matrix::<D>::zeros());
            for (n, &j) in shape.neighbors.iter().enumerate() {
                let p = mls.cloud().positions[j as usize];
                let value = frame.values(p, [1.0, 0.0])[k];
                g += shape.gradients[n] * value;
                s += shape.second_derivatives[n] * value;
            }
            let size = jet.gradient.norm() + jet.second_derivatives.norm();
            assert!((g - jet.gradient).norm() < 1e-9 * size, "{at} {k} {g} {}", jet.gradient);
            assert!((s - jet.second_derivatives).norm() < 1e-7 * size, "{at} {k} {s} {}", jet.second_derivatives);
        }
        compared += 1;
    }
    assert!(compared > 50, "{compared}");
}

#[test]
fn functions_of_a_front_are_reproduced_with_their_derivatives() {
    check_enriched::<2>();
    check_enriched::<3>();
}

#[test]
fn layers_too_few_for_a_term_name_the_node() {
    // One layer of nodes knows no second derivative across it.
    let mut flat = Cloud::<3>::default();
    for k in 0..400 {
        let p = Vector::<3>::new((k % 20) as f64, (k / 20) as f64 + 0.1 * (k % 3) as f64, 0.0);
        flat.push(p, p, 1.0, Place::Inside);
    }
    let mls = ConstrainedMls::new(flat, Arc::new(Clear), vec![], ConstrainedMlsSettings::default());
    let found = mls.at_node(7, mls.cloud().positions[7], &mut Default::default(), &mut Default::default());
    assert!(matches!(found, Err(Error::PoorStencil { node: Some(7), .. })), "{found:?}");
}
