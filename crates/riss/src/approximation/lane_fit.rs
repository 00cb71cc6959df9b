//! The fit of moving least squares with a point in each lane; see [`super::point_batch`].
//!
//! Offsets are not scaled: the pivots over their diagonal entries do not change with the scale. No closures around lanes:
//! those are compiled for any processor, and each operation in them becomes a call.

use super::point_batch::{PointBatch, Wanted};
use super::settings::WeightFunction;
use crate::math::lanes::{Lanes, Simd};

/// Polynomials at an offset, and sums of their products, each product once.
pub(super) trait LaneBasis<S: Simd, const M: usize> {
    /// Different products of two polynomials, in the order of their degrees.
    type Products: Copy;

    /// The polynomials: 1, x, y, x², xy, y².
    fn at(simd: S, x: Lanes<S>, y: Lanes<S>) -> [Lanes<S>; M];
    /// Sums of no terms.
    fn none(simd: S) -> Self::Products;
    /// Adds the products times `w`.
    fn add(sums: &mut Self::Products, w: Lanes<S>, x: Lanes<S>, y: Lanes<S>);
    /// The lower triangle of the matrix of products.
    fn matrix(simd: S, sums: &Self::Products) -> [[Lanes<S>; M]; M];
    /// Sums of no terms.
    fn no_slopes(simd: S) -> Self::Slopes;
    /// Adds the polynomials times `f x` and `f y`.
    fn add_slopes(sums: &mut Self::Slopes, f: Lanes<S>, x: Lanes<S>, y: Lanes<S>);
    /// The polynomials times `f x`, and times `f y`.
    fn slopes(sums: &Self::Slopes) -> [[Lanes<S>; M]; 2];
    /// See [`Self::slopes`].
    type Slopes: Copy;
}

impl<S: Simd> LaneBasis<S, 3> for [(); 3] {
    type Products = [Lanes<S>; 6];
    type Slopes = [Lanes<S>; 5];

    #[inline(always)]
    fn at(simd: S, x: Lanes<S>, y: Lanes<S>) -> [Lanes<S>; 3] {
        [Lanes::splat(simd, 1.0), x, y]
    }

    #[inline(always)]
    fn none(simd: S) -> Self::Products {
        [Lanes::splat(simd, 0.0); 6]
    }

    #[inline(always)]
    fn add(sums: &mut Self::Products, w: Lanes<S>, x: Lanes<S>, y: Lanes<S>) {
        sums[0] += w;
        let (wx, wy) = (w * x, w * y);
        sums[1] += wx;
        sums[2] += wy;
        sums[3] = wx.mul_add(x, sums[3]);
        sums[4] = wx.mul_add(y, sums[4]);
        sums[5] = wy.mul_add(y, sums[5]);
    }

    #[inline(always)]
    fn matrix(simd: S, s: &Self::Products) -> [[Lanes<S>; 3]; 3] {
        let o = Lanes::splat(simd, 0.0);
        [[s[0], o, o], [s[1], s[3], o], [s[2], s[4], s[5]]]
    }

    #[inline(always)]
    fn no_slopes(simd: S) -> Self::Slopes {
        [Lanes::splat(simd, 0.0); 5]
    }

    #[inline(always)]
    fn add_slopes(sums: &mut Self::Slopes, f: Lanes<S>, x: Lanes<S>, y: Lanes<S>) {
        let (fx, fy) = (f * x, f * y);
        sums[0] += fx;
        sums[1] += fy;
        sums[2] = fx.mul_add(x, sums[2]);
        sums[3] = fx.mul_add(y, sums[3]);
        sums[4] = fy.mul_add(y, sums[4]);
    }

    #[inline(always)]
    fn slopes(s: &Self::Slopes) -> [[Lanes<S>; 3]; 2] {
        [[s[0], s[2], s[3]], [s[1], s[3], s[4]]]
    }
}

impl<S: Simd> LaneBasis<S, 6> for [(); 6] {
    type Products = [Lanes<S>; 15];
    type Slopes = [Lanes<S>; 9];

    #[inline(always)]
    fn at(simd: S, x: Lanes<S>, y: Lanes<S>) -> [Lanes<S>; 6] {
        [Lanes::splat(simd, 1.0), x, y, x * x, x * y, y * y]
    }

    #[inline(always)]
    fn none(simd: S) -> Self::Products {
        [Lanes::splat(simd, 0.0); 15]
    }

    #[inline(always)]
    fn add(sums: &mut Self::Products, w: Lanes<S>, x: Lanes<S>, y: Lanes<S>) {
        sums[0] += w;
        let (wx, wy) = (w * x, w * y);
        sums[1] += wx;
        sums[2] += wy;
        let (wxx, wxy, wyy) = (wx * x, wx * y, wy * y);
        sums[3] += wxx;
        sums[4] += wxy;
        sums[5] += wyy;
        let (wxxx, wxxy, wxyy, wyyy) = (wxx * x, wxx * y, wyy * x, wyy * y);
        sums[6] += wxxx;
        sums[7] += wxxy;
        sums[8] += wxyy;
        sums[9] += wyyy;
        sums[10] = wxxx.mul_add(x, sums[10]);
        sums[11] = wxxx.mul_add(y, sums[11]);
        sums[12] = wxxy.mul_add(y, sums[12]);
        sums[13] = wyyy.mul_add(x, sums[13]);
        sums[14] = wyyy.mul_add(y, sums[14]);
    }

    #[inline(always)]
    fn matrix(simd: S, s: &Self::Products) -> [[Lanes<S>; 6]; 6] {
        let o = Lanes::splat(simd, 0.0);
        [
            [s[0], o, o, o, o, o],
            [s[1], s[3], o, o, o, o],
            [s[2], s[4], s[5], o, o, o],
            [s[3], s[6], s[7], s[10], o, o],
            [s[4], s[7], s[8], s[11], s[12], o],
            [s[5], s[8], s[9], s[12], s[13], s[14]],
        ]
    }

    #[inline(always)]
    fn no_slopes(simd: S) -> Self::Slopes {
        [Lanes::splat(simd, 0.0); 9]
    }

    #[inline(always)]
    fn add_slopes(sums: &mut Self::Slopes, f: Lanes<S>, x: Lanes<S>, y: Lanes<S>) {
        let (fx, fy) = (f * x, f * y);
        sums[0] += fx;
        sums[1] += fy;
        let (fxx, fxy, fyy) = (fx * x, fx * y, fy * y);
        sums[2] += fxx;
        sums[3] += fxy;
        sums[4] += fyy;
        sums[5] = fxx.mul_add(x, sums[5]);
        sums[6] = fxx.mul_add(y, sums[6]);
        sums[7] = fyy.mul_add(x, sums[7]);
        sums[8] = fyy.mul_add(y, sums[8]);
    }

    #[inline(always)]
    fn slopes(s: &Self::Slopes) -> [[Lanes<S>; 6]; 2] {
        [[s[0], s[2], s[3], s[5], s[6], s[7]], [s[1], s[3], s[4], s[6], s[7], s[8]]]
    }
}

/// Weights and slopes `w'/s` at squared relative distances below one.
#[inline(always)]
fn weight<S: Simd>(simd: S, function: WeightFunction, s2: Lanes<S>) -> [Lanes<S>; 2] {
    macro_rules! c {
        ($number:expr) => {
            Lanes::splat(simd, $number)
        };
    }
    match function {
        WeightFunction::QuarticSpline => {
            let s = s2.sqrt();
            let inner = s2.mul_add(c!(-3.0), s.mul_add(c!(8.0), c!(-6.0)));
            [s2.mul_add(inner, c!(1.0)), s2.mul_add(c!(-12.0), s.mul_add(c!(24.0), c!(-12.0)))]
        }
        WeightFunction::CubicSpline => {
            let s = s2.sqrt();
            let t = c!(1.0) - s;
            let near = [s2.mul_add(s.mul_add(c!(4.0), c!(-4.0)), c!(2.0 / 3.0)), s.mul_add(c!(12.0), c!(-8.0))];
            let far = [c!(4.0 / 3.0) * t * t * t, c!(-4.0) * t * t * s.inverse()];
            let half = c!(0.5);
            // At 0.5 both branches are the same.
            [s.select_below(half, near[0], far[0]), s.select_below(half, near[1], far[1])]
        }
        WeightFunction::Gaussian => {
            // exp(-16 s²) is the sixteenth power of exp(-s²), a series around s² = 1/2.
            let z = c!(0.5) - s2;
            let mut e = c!(1.0);
            for k in (1..=14).rev() {
                e = (e * z).mul_add(c!(1.0 / k as f64), c!(1.0));
            }
            e = e * c!((-0.5f64).exp());
            for _ in 0..4 {
                e = e * e;
            }
            let rim = (-16.0f64).exp();
            let scale = 1.0 / (1.0 - rim);
            [(e - c!(rim)) * c!(scale), e * c!(-32.0 * scale)]
        }
    }
}

/// Lower Cholesky factor, its diagonal inverted.
pub(super) type Factor<S, const M: usize> = [[Lanes<S>; M]; M];

/// Position of the points of a group.
#[inline(always)]
fn position<S: Simd>(simd: S, batch: &PointBatch, group: usize) -> [Lanes<S>; 2] {
    [Lanes::load(simd, &batch.points[0], group), Lanes::load(simd, &batch.points[1], group)]
}

/// Lower triangle of the moment matrices [EFG, Eq. 8a], and the number of nodes in reach; keeps weights and slopes, or
/// counts the points that each node reaches.
#[inline(always)]
pub(super) fn moments<S: Simd, const M: usize>(
    simd: S,
    batch: &mut PointBatch,
    group: usize,
    function: WeightFunction,
    wanted: Wanted,
) -> ([[Lanes<S>; M]; M], Lanes<S>)
where
    [(); M]: LaneBasis<S, M>,
{
    let [px, py] = position(simd, batch, group);
    let (zero, one) = (Lanes::splat(simd, 0.0), Lanes::splat(simd, 1.0));
    let mut products = <[(); M]>::none(simd);
    let mut reached = zero;
    let buffers = batch.weights.iter_mut().zip(&mut batch.sums);
    for ([nx, ny, inverse], ([w_kept, slope_kept], [n_reached, _])) in batch.nodes.iter().zip(buffers) {
        let (x, y) = (Lanes::splat(simd, *nx) - px, Lanes::splat(simd, *ny) - py);
        let inverse = Lanes::splat(simd, *inverse);
        // In the order of the path for single points and without fused terms: both agree on who is in reach.
        let s2 = (x * x + y * y) * inverse;
        let [w, slope] = weight(simd, function, s2);
        let w = s2.select_below(one, w, zero);
        match wanted {
            Wanted::Quality => {
                let in_reach = s2.select_below(one, one, zero);
                reached += in_reach;
                (Lanes::load(simd, n_reached, 0) + in_reach).store(n_reached, 0);
            }
            Wanted::Fluxes => w.store(w_kept, 0),
            Wanted::Gradients => {
                w.store(w_kept, 0);
                (s2.select_below(one, slope, zero) * -inverse).store(slope_kept, 0);
            }
        }
        <[(); M]>::add(&mut products, w, x, y);
    }
    (<[(); M]>::matrix(simd, &products), reached)
}

/// Cholesky factors, and the least pivot over its diagonal entry; 0 or less, or NaN, where there is no factor.
#[inline(always)]
pub(super) fn factor<S: Simd, const M: usize>(simd: S, a: &[[Lanes<S>; M]; M]) -> (Factor<S, M>, Lanes<S>) {
    let mut l = *a;
    let (zero, mut least) = (Lanes::splat(simd, 0.0), Lanes::splat(simd, 1.0));
    for j in 0..M {
        let mut pivot = a[j][j];
        for k in 0..j {
            pivot -= l[j][k] * l[j][k];
        }
        let ratio = pivot * a[j][j].inverse();
        // NaN and what is not positive become zero.
        let ratio = zero.select_below(ratio, ratio, zero);
        least = ratio.select_below(least, ratio, least);
        let d = pivot.sqrt().inverse();
        l[j][j] = d;
        for i in j + 1..M {
            let mut s = l[i][j];
            for k in 0..j {
                s -= l[i][k] * l[j][k];
            }
            l[i][j] = s * d;
        }
    }
    (l, least)
}

/// Whether no lane is below a limit.
#[inline(always)]
pub(super) fn none_below<S: Simd>(simd: S, numbers: Lanes<S>, limit: f64) -> bool {
    let (one, zero) = (Lanes::splat(simd, 1.0), Lanes::splat(simd, 0.0));
    numbers.select_below(Lanes::splat(simd, limit), one, zero).sum() == 0.0
}

#[inline(always)]
fn solve<S: Simd, const M: usize>(l: &Factor<S, M>, b: [Lanes<S>; M]) -> [Lanes<S>; M] {
    let mut x = b;
    for i in 0..M {
        for k in 0..i {
            x[i] -= l[i][k] * x[k];
        }
        x[i] = x[i] * l[i][i];
    }
    for i in (0..M).rev() {
        for k in i + 1..M {
            x[i] -= l[k][i] * x[k];
        }
        x[i] = x[i] * l[i][i];
    }
    x
}

#[inline(always)]
fn dot<S: Simd, const M: usize>(p: &[Lanes<S>; M], gamma: &[Lanes<S>; M]) -> Lanes<S> {
    // The first polynomial is one.
    let mut sum = gamma[0];
    for i in 1..M {
        sum = p[i].mul_add(gamma[i], sum);
    }
    sum
}

/// `γ` with `A γ = p(0)`.
#[inline(always)]
fn unit<S: Simd, const M: usize>(simd: S, l: &Factor<S, M>, component: usize) -> [Lanes<S>; M] {
    let mut right = [Lanes::splat(simd, 0.0); M];
    right[component] = Lanes::splat(simd, 1.0);
    solve(l, right)
}

/// Adds `φ n` of the points of a group.
#[inline(always)]
pub(super) fn fluxes<S: Simd, const M: usize>(simd: S, batch: &mut PointBatch, group: usize, l: &Factor<S, M>)
where
    [(); M]: LaneBasis<S, M>,
{
    let [px, py] = position(simd, batch, group);
    let (normal_x, normal_y) = (Lanes::load(simd, &batch.points[2], group), Lanes::load(simd, &batch.points[3], group));
    let gamma = unit(simd, l, 0);
    let buffers = batch.weights.iter().zip(&mut batch.sums);
    for ([nx, ny, _], ([weights, _], sums)) in batch.nodes.iter().zip(buffers) {
        let p = <[(); M]>::at(simd, Lanes::splat(simd, *nx) - px, Lanes::splat(simd, *ny) - py);
        let value = Lanes::load(simd, weights, 0) * dot(&p, &gamma);
        let [sum_x, sum_y] = sums;
        value.mul_add(normal_x, Lanes::load(simd, sum_x, 0)).store(sum_x, 0);
        value.mul_add(normal_y, Lanes::load(simd, sum_y, 0)).store(sum_y, 0);
    }
}

/// Values and gradients of the points of a group, by `A γ_d = p_d - A_d γ` with the shift frozen.
#[inline(always)]
pub(super) fn gradients<S: Simd, const M: usize>(simd: S, batch: &mut PointBatch, group: usize, l: &Factor<S, M>)
where
    [(); M]: LaneBasis<S, M>,
{
    let [px, py] = position(simd, batch, group);
    let gamma = unit(simd, l, 0);
    let mut sums = <[(); M]>::no_slopes(simd);
    for ([nx, ny, _], [_, slopes]) in batch.nodes.iter().zip(&batch.weights) {
        let (x, y) = (Lanes::splat(simd, *nx) - px, Lanes::splat(simd, *ny) - py);
        let p = <[(); M]>::at(simd, x, y);
        <[(); M]>::add_slopes(&mut sums, Lanes::load(simd, slopes, 0) * dot(&p, &gamma), x, y);
    }
    let mut right = <[(); M]>::slopes(&sums);
    for d in 0..2 {
        for i in 0..M {
            right[d][i] = -right[d][i];
        }
        right[d][1 + d] += Lanes::splat(simd, 1.0);
    }
    let gamma_by = [solve(l, right[0]), solve(l, right[1])];
    let step = batch.stride() / S::F64_LANES;
    let [gx, gy] = &mut batch.gradients;
    for (k, ([nx, ny, _], [weights, slopes])) in batch.nodes.iter().zip(&batch.weights).enumerate() {
        let offset = [Lanes::splat(simd, *nx) - px, Lanes::splat(simd, *ny) - py];
        let p = <[(); M]>::at(simd, offset[0], offset[1]);
        let (w, slope) = (Lanes::load(simd, weights, 0), Lanes::load(simd, slopes, 0));
        let value = dot(&p, &gamma);
        let change = slope * value;
        let at = k * step + group;
        (w * value).store(&mut batch.values, at);
        w.mul_add(dot(&p, &gamma_by[0]), change * offset[0]).store(gx, at);
        w.mul_add(dot(&p, &gamma_by[1]), change * offset[1]).store(gy, at);
    }
}
