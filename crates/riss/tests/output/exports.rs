//! Cracks and beta factors for other programs, read back.

use crate::sample;
use crate::vtk::arrays;
use riss::crack::{End, EndKind};
use riss::math::{Vector2, cross};
use riss::output::Results;
use riss::output::exports::{BetaReference, CrackFormat, afgrow_table, beta_table, cracks_as, tips};
use std::f64::consts::PI;

/// A run of three steps with a crack along `y = 0` from -1 on that grows by 0.25, of `K = k(a)`.
fn growing(k: impl Fn(f64) -> f64) -> Results {
    let mut results = Results::new(&sample::info(), &sample::result(2));
    let first = results.steps[0].clone();
    results.steps = (0..3)
        .map(|n| {
            let mut step = first.clone();
            step.step = n;
            let crack = &mut step.cracks[0];
            crack.path = (0..=n).map(|m| [0.25 * m as f64, 0.0]).collect();
            crack.path.insert(0, [-1.0, 0.0]);
            crack.tips[0].k1 = Some(k(1.0 + 0.25 * n as f64));
            step
        })
        .collect();
    results
}

/// Numbers of the lines that are no comment, as easigrow reads them: split at white space.
fn table(text: &str) -> Vec<Vec<f64>> {
    let lines = text.lines().filter(|l| !l.starts_with('#'));
    lines.map(|l| l.split_whitespace().map(|n| n.parse().unwrap()).collect()).collect()
}

fn check_rows(rows: Vec<Vec<f64>>, expected: &[[f64; 2]]) {
    assert_eq!(rows.len(), expected.len(), "{rows:?}");
    for (row, e) in rows.iter().zip(expected) {
        assert_eq!(row.len(), 2);
        assert!((row[0] - e[0]).abs() < 1e-12 && (row[1] - e[1]).abs() < 1e-12, "{rows:?}");
    }
}

#[test]
fn beta_factors_are_those_that_made_k() {
    // K = β(a) σ √(π a) with β = 1 + a/8 and σ = 40.
    let results = growing(|a| (1.0 + a / 8.0) * 40.0 * (PI * a).sqrt());
    let reference = BetaReference { stress: 40.0, distance: 5.0 };
    let text = beta_table(&results, "crack-1", End::End, &reference).unwrap();
    check_rows(table(&text), &[[0.2, 1.125], [0.25, 1.15625], [0.3, 1.1875]]);
    // The same over the length itself; nothing but numbers, with a tab between.
    let text = afgrow_table(&results, "crack-1", End::End, 40.0).unwrap();
    check_rows(table(&text), &[[1.0, 1.125], [1.25, 1.15625], [1.5, 1.1875]]);
    assert!(text.lines().all(|l| l.split('\t').count() == 2));
    assert_eq!(tips(&results), [("crack-1".to_string(), End::End)]);
    assert!(beta_table(&results, "crack-1", End::Start, &reference).is_none());
    assert!(beta_table(&results, "crack-2", End::End, &reference).is_none());
}

#[test]
fn a_crack_of_two_tips_counts_from_its_middle() {
    let mut results = growing(|_| 0.0);
    for step in &mut results.steps {
        let crack = &mut step.cracks[0];
        // From -1 to 0 at first; later 0.5 n to the left, 0.25 n to the right.
        let n = step.step as f64;
        crack.path.insert(0, [-1.0 - 0.5 * n, 0.0]);
        crack.path.dedup();
        crack.ends = [EndKind::Tip, EndKind::Tip];
        let mut start = crack.tips[0].clone();
        start.end = End::Start;
        start.k1 = Some((PI * (0.5 + 0.5 * n)).sqrt() * 2.0);
        crack.tips[0].k1 = Some((PI * (0.5 + 0.25 * n)).sqrt() * 3.0);
        crack.tips.insert(0, start);
    }
    let reference = BetaReference { stress: 1.0, distance: 1.0 };
    let of = |end| table(&beta_table(&results, "crack-1", end, &reference).unwrap());
    check_rows(of(End::Start), &[[0.5, 2.0], [1.0, 2.0], [1.5, 2.0]]);
    check_rows(of(End::End), &[[0.5, 3.0], [0.75, 3.0], [1.0, 3.0]]);
}

#[test]
fn lengths_without_a_factor_and_waiting_tips_are_left_out() {
    let mut results = growing(|a| (PI * a).sqrt());
    results.steps[1].cracks[0].tips[0].k1 = None;
    let mut waiting = results.steps[2].clone();
    waiting.cracks[0].tips[0].k1 = Some(9.0);
    results.steps.push(waiting);
    let text = beta_table(&results, "crack-1", End::End, &BetaReference { stress: 1.0, distance: 1.0 }).unwrap();
    check_rows(table(&text), &[[1.0, 1.0], [1.5, 1.0]]);
}

#[test]
fn csv_has_a_row_for_each_point() {
    let results = growing(|_| 1.0);
    let text = String::from_utf8(cracks_as(CrackFormat::Csv, &results.steps[1]).unwrap()).unwrap();
    assert_eq!(
        text,
        "crack,point,x,y,length\ncrack-1,0,-1.0,0.0,0.0\ncrack-1,1,0.0,0.0,1.0\ncrack-1,2,0.25,0.0,1.25\n"
    );
}

#[test]
fn vtp_has_a_line_for_each_crack() {
    let mut results = growing(|_| 1.0);
    let mut second = results.steps[2].cracks[0].clone();
    second.path = vec![[3.0, 1.0], [3.0, 2.0]];
    results.steps[2].cracks.push(second);
    let text = String::from_utf8(cracks_as(CrackFormat::Vtp, &results.steps[2]).unwrap()).unwrap();
    assert!(text.contains("<VTKFile type=\"PolyData\"") && text.contains("NumberOfPoints=\"6\""));
    let arrays = arrays(&text);
    assert_eq!(arrays["offsets"], [4.0, 6.0]);
    assert_eq!(arrays["connectivity"], [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    assert_eq!(arrays["length"], [0.0, 1.0, 1.25, 1.5, 0.0, 1.0]);
    assert_eq!(arrays["Points"][12..], [3.0, 1.0, 0.0, 3.0, 2.0, 0.0]);
    assert_eq!(arrays["crack"], [0.0, 1.0]);
}

#[test]
fn stl_is_a_strip_with_its_normals_to_the_left() {
    let results = growing(|_| 1.0);
    let stl = cracks_as(CrackFormat::Stl { thickness: 0.5 }, &results.steps[1]).unwrap();
    let text = String::from_utf8(stl).unwrap();
    assert!(text.starts_with("solid crack-1\nfacet normal ") && text.ends_with("endsolid crack-1\n"));
    let numbers = |prefix: &str| -> Vec<Vec<f64>> {
        let lines = text.lines().filter_map(|l| l.strip_prefix(prefix));
        lines.map(|l| l.split(' ').map(|n| n.parse().unwrap()).collect()).collect()
    };
    let (normals, vertices) = (numbers("facet normal "), numbers("vertex "));
    assert_eq!((normals.len(), vertices.len()), (4, 12));
    let mut area = 0.0;
    for (normal, v) in normals.iter().zip(vertices.chunks(3)) {
        // The path runs along x: sides and normals of the triangles lie in planes of constant y.
        assert_eq!(normal, &[0.0, 1.0, 0.0]);
        let corner = |k: usize| Vector2::new(v[k][0], v[k][2]);
        // The normal of corners in order along x and z is -y times this product.
        let twice = -cross(corner(1) - corner(0), corner(2) - corner(0));
        assert!(twice > 0.0, "{v:?}");
        area += 0.5 * twice;
    }
    assert!((area - 1.25 * 0.5).abs() < 1e-15);
}
