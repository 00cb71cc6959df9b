//! Softening of cohesive cracks: traction against opening [C3D, Eqs. 46 to 49].
//!
//! A pair of faces is tied until its traction reaches the strength. From then on the traction follows the softening curve of
//! the effective opening `δ = √(w_n² + β² |w_s|²)` [CamachoOrtiz1996] while that grows, and the secant to the origin while it
//! is below its largest value so far. Faces that overlap push each other apart by a penalty.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Share of `G_f/f_t` up to which an opened pair is as stiff as a tied one.
const FIRST_OPENING: f64 = 1e-7;
/// Stiffness of overlapping faces over `f_t²/G_f`.
const CONTACT: f64 = 1e3;
/// Kink of the bilinear curve of concrete, over `G_f/f_t` and over the strength [Petersson1981].
const KINK: [f64; 2] = [0.8, 1.0 / 3.0];

/// Shape of the softening curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Softening {
    /// `t = f_t exp(-f_t w/G_f)` [C3D, Eq. 49].
    #[default]
    Exponential,
    /// A straight line, to zero at `2 G_f/f_t`.
    Linear,
    /// Two straight lines, with a third of the strength at `0.8 G_f/f_t` and zero at `3.6 G_f/f_t` [Petersson1981].
    Bilinear,
}

/// Strength, fracture energy and softening of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CohesiveLaw {
    /// Tensile strength `f_t` [stress].
    pub strength: f64,
    /// Fracture energy `G_f` [stress·length].
    pub fracture_energy: f64,
    /// Shape of the curve.
    pub softening: Softening,
    /// Weight `β` of sliding against opening; 0: faces slide freely once they are open.
    pub shear_ratio: f64,
}

/// Which way the traction of an opened pair goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Branch {
    /// Along the softening curve, as the opening grows.
    Softening,
    /// Along the secant to the origin from the largest effective opening so far [length].
    Secant(f64),
}

/// Traction between opened faces and its derivative, by components: the normal one first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cohesion {
    /// Traction that pulls the faces together [stress].
    pub traction: [f64; 3],
    /// `tangent[i][j] = ∂t_i/∂w_j` [stress/length].
    pub tangent: [[f64; 3]; 3],
}

impl CohesiveLaw {
    /// `G_f/f_t` [length].
    pub fn opening_scale(&self) -> f64 {
        self.fracture_energy / self.strength
    }

    /// The largest opening of a pair that has just opened [length].
    pub fn first_opening(&self) -> f64 {
        FIRST_OPENING * self.opening_scale()
    }

    /// `E G_f/f_t²`, which the length of the fracture process zone is proportional to [length].
    pub fn characteristic_length(&self, young: f64) -> f64 {
        young * self.fracture_energy / (self.strength * self.strength)
    }

    /// Traction of a growing opening [stress], its derivative [stress/length] and the area below the curve up to there
    /// [stress·length].
    pub fn softening(&self, opening: f64) -> [f64; 3] {
        let (w, strength) = (opening / self.opening_scale(), self.strength);
        let slope = strength / self.opening_scale();
        let line = |from: [f64; 2], to: [f64; 2]| {
            let inclination = (to[1] - from[1]) / (to[0] - from[0]);
            let t = from[1] + inclination * (w - from[0]);
            [t, inclination, 0.5 * (from[1] + t) * (w - from[0])]
        };
        let [t, derivative, area] = match self.softening {
            Softening::Exponential => {
                let t = (-w).exp();
                [t, -t, -(-w).exp_m1()]
            }
            Softening::Linear if w < 2.0 => line([0.0, 1.0], [2.0, 0.0]),
            Softening::Bilinear if w < KINK[0] => line([0.0, 1.0], KINK),
            Softening::Bilinear if w < self.end() => {
                let [t, derivative, area] = line(KINK, [self.end(), 0.0]);
                [t, derivative, area + 0.5 * (1.0 + KINK[1]) * KINK[0]]
            }
            Softening::Linear | Softening::Bilinear => [0.0, 0.0, 1.0],
        };
        [strength * t, slope * derivative, self.fracture_energy * area]
    }

    /// Where a curve of straight lines ends, over `G_f/f_t`.
    fn end(&self) -> f64 {
        match self.softening {
            Softening::Exponential => f64::INFINITY,
            Softening::Linear => 2.0,
            Softening::Bilinear => KINK[0] + (2.0 - KINK[0] * (1.0 + KINK[1])) / KINK[1],
        }
    }

    /// Effective opening [length]; overlap does not count.
    pub fn effective(&self, opening: [f64; 3]) -> f64 {
        let [n, s, t] = opening;
        (n.max(0.0).powi(2) + self.shear_ratio.powi(2) * (s * s + t * t)).sqrt()
    }

    /// Derivative of the effective opening by the components of the opening.
    pub fn effective_gradient(&self, opening: [f64; 3]) -> [f64; 3] {
        let size = self.effective(opening).max(f64::MIN_POSITIVE);
        let [n, s, t] = opening;
        let weight = self.shear_ratio.powi(2) / size;
        [n.max(0.0) / size, s * weight, t * weight]
    }

    /// Share of its strength that a tied pair bears [1]; the traction's normal component comes first.
    pub fn exhaustion(&self, traction: [f64; 3]) -> f64 {
        let [n, s, t] = traction;
        if self.shear_ratio == 0.0 {
            return n / self.strength;
        }
        (n.max(0.0).powi(2) + (s * s + t * t) / self.shear_ratio.powi(2)).sqrt() / self.strength
    }

    /// Derivative of the exhaustion by the components of the traction [1/stress].
    pub fn exhaustion_gradient(&self, traction: [f64; 3]) -> [f64; 3] {
        if self.shear_ratio == 0.0 {
            return [1.0 / self.strength, 0.0, 0.0];
        }
        let size = (self.exhaustion(traction) * self.strength * self.strength).max(f64::MIN_POSITIVE);
        let [n, s, t] = traction;
        let weight = self.shear_ratio.powi(2).recip() / size;
        [n.max(0.0) / size, s * weight, t * weight]
    }

    /// Traction of an opening on a given branch: smooth, whatever the opening was before.
    ///
    /// - `opening`: component along the normal, then those across it [length]
    pub fn cohesion_on(&self, opening: [f64; 3], branch: Branch) -> Cohesion {
        let effective = self.effective(opening);
        let (secant, change) = match branch {
            Branch::Softening => {
                let at = effective.max(self.first_opening());
                let [t, derivative, _] = self.softening(at);
                // Also where round-off has it closed a little: it opens.
                (t / at, (derivative - t / at) / at)
            }
            Branch::Secant(largest) => (self.softening(largest)[0] / largest, 0.0),
        };
        let weight = |k: usize| if k == 0 { 1.0 } else { self.shear_ratio.powi(2) };
        let is_apart = opening[0] > 0.0;
        // The gradient of the effective opening, times itself.
        let pull = |k: usize| if k == 0 && !is_apart { 0.0 } else { weight(k) * opening[k] };
        let mut found = Cohesion::default();
        for i in 0..3 {
            found.traction[i] = secant * pull(i);
            found.tangent[i][i] = if i == 0 && !is_apart { 0.0 } else { weight(i) * secant };
            for j in 0..3 {
                if effective > 0.0 {
                    found.tangent[i][j] += change * pull(i) * pull(j) / effective;
                }
            }
        }
        if !is_apart {
            let stiffness = CONTACT * self.strength / self.opening_scale();
            found.traction[0] = stiffness * opening[0];
            found.tangent[0][0] = stiffness;
        }
        found
    }

    /// Energy dissipated up to a largest effective opening [stress·length]; `G_f` in the end.
    pub fn dissipated(&self, history: f64) -> f64 {
        let [t, _, area] = self.softening(history);
        area - 0.5 * t * history
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws() -> impl Iterator<Item = CohesiveLaw> {
        [Softening::Exponential, Softening::Linear, Softening::Bilinear].into_iter().flat_map(|softening| {
            [0.0, 0.7].map(|shear_ratio| CohesiveLaw { strength: 3.0, fracture_energy: 0.1, softening, shear_ratio })
        })
    }

    /// On the branch that a largest effective opening before leaves.
    fn cohesion(law: &CohesiveLaw, opening: [f64; 3], history: f64) -> Cohesion {
        let largest = history.max(law.first_opening());
        let is_loaded = law.effective(opening) >= largest;
        law.cohesion_on(opening, if is_loaded { Branch::Softening } else { Branch::Secant(largest) })
    }

    #[test]
    fn curves_begin_at_the_strength_and_enclose_the_fracture_energy() {
        for law in laws() {
            assert_eq!(law.softening(0.0)[0], 3.0);
            let (n, end) = (400_000, 40.0 * law.opening_scale());
            let h = end / n as f64;
            let mut area = 0.0;
            for k in 0..n {
                let w = (k as f64 + 0.5) * h;
                area += law.softening(w)[0] * h;
                if k % 40_000 == 0 {
                    assert!((law.softening(w + 0.5 * h)[2] - area).abs() < 1e-7);
                }
            }
            assert!((area / 0.1 - 1.0).abs() < 1e-6, "{law:?} {area}");
            assert!((law.dissipated(end) / 0.1 - 1.0).abs() < 1e-6);
        }
        let linear = CohesiveLaw { softening: Softening::Linear, ..laws().next().unwrap() };
        // Half of the way down: half the strength is left, and half of the elastic triangle below it is given back.
        assert!((linear.dissipated(0.1 / 3.0) - (0.075 - 0.025)).abs() < 1e-15);
    }

    #[test]
    fn tangents_are_derivatives() {
        let scale = 0.1 / 3.0;
        for law in laws() {
            for (opening, history) in [
                ([0.5, 0.2, -0.3], 0.0),
                ([0.3, 0.1, 0.2], 1.3),
                ([-0.2, 0.9, 0.1], 0.1),
                ([-0.1, 0.2, 0.3], 2.0),
                ([1.1, 0.0, 0.0], 0.2),
            ] {
                let (opening, history) = (opening.map(|w: f64| w * scale), history * scale);
                let found = cohesion(&law, opening, history);
                for j in 0..3 {
                    let step = 1e-6 * scale;
                    let shifted = |d: f64| {
                        let mut w = opening;
                        w[j] += d;
                        cohesion(&law, w, history).traction
                    };
                    let (after, before) = (shifted(step), shifted(-step));
                    for i in 0..3 {
                        let slope = (after[i] - before[i]) / (2.0 * step);
                        assert!(
                            (slope - found.tangent[i][j]).abs() < 1e-4 * 3.0 / scale,
                            "{law:?} {opening:?} {i} {j}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_pair_opens_at_its_strength_and_unloads_to_the_origin() {
        for law in laws() {
            let w = 0.6 * law.opening_scale();
            let loaded = cohesion(&law, [w, 0.0, 0.0], 0.0).traction[0];
            assert!((loaded / law.softening(w)[0] - 1.0).abs() < 1e-12);
            assert!((cohesion(&law, [0.5 * w, 0.0, 0.0], w).traction[0] - 0.5 * loaded).abs() < 1e-15);
            let first = cohesion(&law, [law.first_opening(), 0.0, 0.0], 0.0).traction[0];
            assert!((first / 3.0 - 1.0).abs() < 1e-6);
            assert!(cohesion(&law, [-w, 0.0, 0.0], w).traction[0] < -100.0);
            assert_eq!(law.exhaustion([3.0, 0.0, 0.0]), 1.0);
            let gradient = law.exhaustion_gradient([2.0, 0.5, 1.0]);
            let of_opening = law.effective_gradient([2.0, 0.5, 1.0]);
            for j in 0..3 {
                let mut t = [2.0, 0.5, 1.0];
                t[j] += 1e-6;
                let slope = (law.exhaustion(t) - law.exhaustion([2.0, 0.5, 1.0])) / 1e-6;
                assert!((slope - gradient[j]).abs() < 1e-5);
                let slope = (law.effective(t) - law.effective([2.0, 0.5, 1.0])) / 1e-6;
                assert!((slope - of_opening[j]).abs() < 1e-5);
            }
        }
    }
}
