//! Registers of several lanes, and what the wide kernel does with them: products of a block, the update of a node.
//!
//! Everything is inlined by force: as a call of its own it would pass its registers through memory.
#![expect(clippy::needless_range_loop, reason = "one index counts registers in several arrays")]

use std::arch::x86_64::{
    __m256d, __m512d, _mm256_add_pd, _mm256_fmadd_pd, _mm256_loadu_pd, _mm256_mul_pd, _mm256_set1_pd, _mm256_storeu_pd,
    _mm512_add_pd, _mm512_fmadd_pd, _mm512_loadu_pd, _mm512_mul_pd, _mm512_set1_pd, _mm512_storeu_pd,
};

use crate::stiffness::Block;

/// A register of an instruction set with fused multiply-add.
// SAFETY of all methods: to be called on a machine with the instruction set; addresses hold WIDTH numbers.
pub(super) trait Register: Copy {
    /// Numbers in a register.
    const WIDTH: usize;
    unsafe fn all(value: f64) -> Self;
    unsafe fn load(from: *const f64) -> Self;
    unsafe fn store(self, to: *mut f64);
    unsafe fn times(self, other: Self) -> Self;
    unsafe fn plus(self, other: Self) -> Self;
    /// `self factor + term`, rounded once.
    unsafe fn madd(self, factor: Self, term: Self) -> Self;
}

impl Register for __m512d {
    const WIDTH: usize = 8;
    #[inline(always)]
    unsafe fn all(value: f64) -> Self {
        // SAFETY: as for the trait, here and below.
        unsafe { _mm512_set1_pd(value) }
    }
    #[inline(always)]
    unsafe fn load(from: *const f64) -> Self {
        unsafe { _mm512_loadu_pd(from) }
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut f64) {
        unsafe { _mm512_storeu_pd(to, self) }
    }
    #[inline(always)]
    unsafe fn times(self, other: Self) -> Self {
        unsafe { _mm512_mul_pd(self, other) }
    }
    #[inline(always)]
    unsafe fn plus(self, other: Self) -> Self {
        unsafe { _mm512_add_pd(self, other) }
    }
    #[inline(always)]
    unsafe fn madd(self, factor: Self, term: Self) -> Self {
        unsafe { _mm512_fmadd_pd(self, factor, term) }
    }
}

impl Register for __m256d {
    const WIDTH: usize = 4;
    #[inline(always)]
    unsafe fn all(value: f64) -> Self {
        // SAFETY: as for the trait, here and below.
        unsafe { _mm256_set1_pd(value) }
    }
    #[inline(always)]
    unsafe fn load(from: *const f64) -> Self {
        unsafe { _mm256_loadu_pd(from) }
    }
    #[inline(always)]
    unsafe fn store(self, to: *mut f64) {
        unsafe { _mm256_storeu_pd(to, self) }
    }
    #[inline(always)]
    unsafe fn times(self, other: Self) -> Self {
        unsafe { _mm256_mul_pd(self, other) }
    }
    #[inline(always)]
    unsafe fn plus(self, other: Self) -> Self {
        unsafe { _mm256_add_pd(self, other) }
    }
    #[inline(always)]
    unsafe fn madd(self, factor: Self, term: Self) -> Self {
        unsafe { _mm256_fmadd_pd(self, factor, term) }
    }
}

/// The four sums of a row, one a block entry, in V registers each.
pub(super) type Sums<R, const V: usize> = [[R; V]; 4];

/// Adds one block's four products in the V registers from lane `first` on.
// SAFETY: as for `Register`; `first` and V registers lie within the lanes.
#[inline(always)]
pub(super) unsafe fn add<R: Register, const L: usize, const V: usize>(
    sum: &mut Sums<R, V>,
    block: &Block,
    u: &[[f64; L]; 2],
    first: usize,
) {
    let [k0, k1, k2, k3] = block.0;
    // SAFETY: as above.
    unsafe {
        let (k0, k1, k2, k3) = (R::all(k0), R::all(k1), R::all(k2), R::all(k3));
        for part in 0..V {
            let lane = first + R::WIDTH * part;
            let (ux, uy) = (R::load(u[0].as_ptr().add(lane)), R::load(u[1].as_ptr().add(lane)));
            sum[0][part] = k0.madd(ux, sum[0][part]);
            sum[1][part] = k1.madd(uy, sum[1][part]);
            sum[2][part] = k2.madd(ux, sum[2][part]);
            sum[3][part] = k3.madd(uy, sum[3][part]);
        }
    }
}
