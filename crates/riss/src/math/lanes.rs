//! Numbers side by side in a vector register: as many as the processor has lanes, found when the program runs.

pub use pulp::{Arch, Simd, WithSimd};
use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

/// Lengths of arrays that are read as lanes are multiples of this: the lanes of the widest registers.
pub const GROUP: usize = 8;

/// The number in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Lanes<S: Simd>(S, S::f64s);

impl<S: Simd> Lanes<S> {
    /// Takes what a register holds.
    #[inline(always)]
    pub fn new(simd: S, numbers: S::f64s) -> Self {
        Self(simd, numbers)
    }

    /// What the register holds.
    #[inline(always)]
    pub fn get(self) -> S::f64s {
        self.1
    }

    /// The same number in all lanes.
    #[inline(always)]
    pub fn splat(simd: S, number: f64) -> Self {
        Self(simd, simd.splat_f64s(number))
    }

    /// The vector at `index` of a list of vectors.
    #[inline(always)]
    pub fn load(simd: S, numbers: &[f64], index: usize) -> Self {
        Self(simd, S::as_simd_f64s(numbers).0[index])
    }

    /// Writes to the vector at `index` of a list of vectors.
    #[inline(always)]
    pub fn store(self, numbers: &mut [f64], index: usize) {
        S::as_mut_simd_f64s(numbers).0[index] = self.1;
    }

    /// `self * factor + term`, rounded once where the processor can.
    #[inline(always)]
    pub fn mul_add(self, factor: Self, term: Self) -> Self {
        Self(self.0, self.0.mul_add_e_f64s(self.1, factor.1, term.1))
    }

    /// Square root.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self(self.0, self.0.sqrt_f64s(self.1))
    }

    /// Inverse.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        Self(self.0, self.0.div_f64s(self.0.splat_f64s(1.0), self.1))
    }

    /// `yes` in the lanes where `self < limit`, `no` in the others and for NaN.
    #[inline(always)]
    pub fn select_below(self, limit: Self, yes: Self, no: Self) -> Self {
        Self(self.0, self.0.select_f64s(self.0.less_than_f64s(self.1, limit.1), yes.1, no.1))
    }

    /// Sum of all lanes.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        self.0.reduce_sum_f64s(self.1)
    }
}

macro_rules! operator {
    ($trait:ident, $name:ident, $vector:ident) => {
        impl<S: Simd> $trait for Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Self(self.0, self.0.$vector(self.1, other.1))
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0, self.0.neg_f64s(self.1))
    }
}

impl<S: Simd> AddAssign for Lanes<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Simd> SubAssign for Lanes<S> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
