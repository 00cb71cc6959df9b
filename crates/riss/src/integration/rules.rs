//! Integration rules on triangles.

use crate::math::gauss_legendre::gauss_legendre;

/// Points in barycentric coordinates with weights that sum to one.
///
/// `n` names the rule that matches `n`×`n` Gauss points in a quadrilateral of two triangles: symmetric rules with
/// 1, 3, 6, 7 and 12 points (degree 1, 2, 4, 5, 6) [Dunavant1985], from 6 on the collapsed `n`×`n` rule.
pub fn triangle_rule(n: usize) -> Vec<([f64; 3], f64)> {
    let third = 1.0 / 3.0;
    match n {
        0 | 1 => vec![([third; 3], 1.0)],
        2 => orbit3(1.0 / 6.0, third),
        3 => [
            orbit3(0.091_576_213_509_770_74, 0.109_951_743_655_321_87),
            orbit3(0.445_948_490_915_964_9, 0.223_381_589_678_011_47),
        ]
        .concat(),
        4 => {
            let root = 15f64.sqrt();
            let rule = vec![([third; 3], 9.0 / 40.0)];
            let pairs =
                [((6.0 - root) / 21.0, (155.0 - root) / 1200.0), ((6.0 + root) / 21.0, (155.0 + root) / 1200.0)];
            pairs.into_iter().fold(rule, |rule, (a, w)| [rule, orbit3(a, w)].concat())
        }
        5 => [
            orbit3(0.063_089_014_491_502_23, 0.050_844_906_370_206_82),
            orbit3(0.249_286_745_170_910_42, 0.116_786_275_726_379_37),
            orbit6(0.053_145_049_844_816_95, 0.310_352_451_033_784_4, 0.082_851_075_618_373_57),
        ]
        .concat(),
        _ => collapsed_rule(n),
    }
}

/// `n`×`n` Gauss points collapsed to the first corner: they crowd there, and integrate `1/r` at it well.
pub fn collapsed_rule(n: usize) -> Vec<([f64; 3], f64)> {
    let line = gauss_legendre(n);
    let mut rule = Vec::with_capacity(n * n);
    for &(s, ws) in &line {
        for &(t, wt) in &line {
            rule.push(([1.0 - s, s * (1.0 - t), s * t], 2.0 * s * ws * wt));
        }
    }
    rule
}

/// `n`×`n` points collapsed to the first corner, with squares of Gauss points away from it: exact for `r^(k/2)` up to
/// a high degree, from `k = -1` on [Duffy1982].
pub fn graded_rule(n: usize) -> Vec<([f64; 3], f64)> {
    let line = gauss_legendre(n);
    let mut rule = Vec::with_capacity(n * n);
    for &(s, ws) in &graded_line(n) {
        for &(t, wt) in &line {
            rule.push(([1.0 - s, s * (1.0 - t), s * t], 2.0 * s * ws * wt));
        }
    }
    rule
}

/// Points on `[0, 1]` with weights, the squares of Gauss points.
pub fn graded_line(n: usize) -> Vec<(f64, f64)> {
    gauss_legendre(n).into_iter().map(|(s, w)| (s * s, 2.0 * s * w)).collect()
}

fn orbit3(a: f64, w: f64) -> Vec<([f64; 3], f64)> {
    let b = 1.0 - 2.0 * a;
    vec![([b, a, a], w), ([a, b, a], w), ([a, a, b], w)]
}

fn orbit6(a: f64, b: f64, w: f64) -> Vec<([f64; 3], f64)> {
    let c = 1.0 - a - b;
    [[a, b, c], [a, c, b], [b, a, c], [b, c, a], [c, a, b], [c, b, a]].map(|l| (l, w)).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factorial(n: u32) -> f64 {
        (1..=n).map(f64::from).product()
    }

    #[test]
    fn graded_rules_are_exact_for_roots_of_the_distance_to_the_corner() {
        // ∫ r^(k/2) over the triangle (0, 0), (1, -1), (1, 1), over its area 1: ∫ cos^(-2-k/2) dφ / (2 + k/2).
        let exact = |k: i32| {
            let angular = |phi: f64| phi.cos().powf(-2.0 - 0.5 * k as f64);
            let n = 20_000;
            let h = 0.25 * std::f64::consts::PI / n as f64;
            let sum: f64 = (0..n).map(|i| angular((i as f64 + 0.5) * h)).sum();
            2.0 * sum * h / (2.0 + 0.5 * k as f64)
        };
        for k in [-2, -1, 0, 1, 3] {
            let r = |l: &[f64; 3]| (l[1] + l[2]).hypot(l[2] - l[1]);
            let sum: f64 = graded_rule(12).iter().map(|(l, w)| w * r(l).powf(0.5 * k as f64)).sum();
            assert!((sum - exact(k)).abs() < 1e-8, "{k}: {sum} {}", exact(k));
            let length: f64 = graded_line(4).iter().map(|(s, w)| w * s.powf(0.5 * k as f64)).sum();
            assert!(k == -2 || (length * (1.0 + 0.5 * k as f64) - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn rules_are_exact_to_their_degree() {
        for (n, degree) in [(1, 1), (2, 2), (3, 4), (4, 5), (5, 6), (6, 10), (9, 16)] {
            let rule = triangle_rule(n);
            for i in 0..=degree {
                for j in 0..=degree - i {
                    let sum: f64 = rule.iter().map(|(l, w)| w * l[0].powi(i as i32) * l[1].powi(j as i32)).sum();
                    let exact = 2.0 * factorial(i) * factorial(j) / factorial(i + j + 2);
                    assert!((sum - exact).abs() < 1e-14, "n = {n}, x^{i} y^{j}: {sum} instead of {exact}");
                }
            }
        }
    }
}
