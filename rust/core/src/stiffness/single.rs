//! One lane with 256-bit registers: one fused multiply-add a block.

use std::arch::x86_64::{
    __m128d, __m256d, _MM_HINT_T0, _mm_add_pd, _mm_fmadd_pd, _mm_loadu_pd, _mm_mul_pd, _mm_permute_pd, _mm_prefetch,
    _mm_set1_pd, _mm_storeu_pd, _mm256_castpd256_pd128, _mm256_extractf128_pd, _mm256_fmadd_pd, _mm256_load_pd,
    _mm256_set_m128d, _mm256_setzero_pd,
};
use std::ops::Range;

use super::kernel::Pass;
use super::{Block, BlockCsr};

/// Blocks ahead of the row that are asked for: about a kilobyte, since the hardware's own look-ahead is shorter.
const AHEAD: usize = 32;

/// As [`super::kernel::advance`] for L = 1, with the same operations in the same order, on a machine with AVX2 and FMA.
pub(super) fn advance<const L: usize>(pass: &Pass<L>, range: Range<usize>, velocity: &mut [f64], next: &mut [f64]) {
    assert!(L == 1 && is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma"), "one lane, AVX2 and FMA");
    let (velocity, next) = (velocity.as_chunks_mut().0, next.as_chunks_mut().0);
    // SAFETY: the machine has just been asked for the features.
    unsafe {
        if pass.load.is_some() {
            sweep::<L, true>(pass, range, velocity, next);
        } else {
            sweep::<L, false>(pass, range, velocity, next);
        }
    }
}

#[target_feature(enable = "avx2,fma")]
fn sweep<const L: usize, const LOADED: bool>(
    pass: &Pass<L>,
    range: Range<usize>,
    velocity: &mut [[f64; 2]],
    next: &mut [[f64; 2]],
) {
    let stiffness = pass.stiffness;
    let u: &[[f64; 2]] = pass.displacement.as_flattened().as_chunks().0;
    assert!(u.len() >= stiffness.nodes(), "displacement shorter than the matrix");
    let [dt, elastic_dt, load_dt] = [pass.dt[0], -pass.elastic_dt[0], pass.load_dt[0]].map(|x| _mm_set1_pd(x));
    let starts = stiffness.row_start[range.start..=range.end].array_windows::<2>();
    let own = u[range.clone()].iter().zip(&pass.inverse_mass[range.clone()]);
    let out = velocity[..range.len()].iter_mut().zip(&mut next[..range.len()]);
    for (node, (([start, end], (x, w)), (v, next))) in range.zip(starts.zip(own).zip(out)) {
        let force = product(stiffness, *start as usize..*end as usize, u);
        let w = load(w);
        let mut new = _mm_fmadd_pd(_mm_mul_pd(elastic_dt, w), force, load(v));
        if LOADED && let Some(f) = pass.load {
            new = _mm_fmadd_pd(_mm_mul_pd(load_dt, w), load(&f[node]), new);
        }
        store(v, new);
        store(next, _mm_fmadd_pd(dt, new, load(x)));
    }
}

/// One block row times u: the four sums in one register.
#[inline]
#[target_feature(enable = "avx2,fma")]
fn product(stiffness: &BlockCsr, row: Range<usize>, u: &[[f64; 2]]) -> __m128d {
    // SAFETY: row starts never fall and end with the number of blocks, which is also that of the columns.
    let (blocks, columns) =
        unsafe { (stiffness.block.get_unchecked(row.clone()), stiffness.column.get_unchecked(row)) };
    for line in (0..9).step_by(2) {
        // A prefetch may be given any address, beyond the last block too.
        _mm_prefetch::<_MM_HINT_T0>(blocks.as_ptr().wrapping_add(AHEAD + line).cast());
    }
    let mut sum = _mm256_setzero_pd();
    for (block, &column) in blocks.iter().zip(columns) {
        // SAFETY: every column is a node of the matrix, and `sweep` has found at least as many nodes in u.
        let x = load(unsafe { u.get_unchecked(column as usize) });
        sum = _mm256_fmadd_pd(load_block(block), _mm256_set_m128d(x, x), sum);
    }
    let cross = _mm256_extractf128_pd::<1>(sum);
    _mm_add_pd(_mm256_castpd256_pd128(sum), _mm_permute_pd::<0b01>(cross))
}

#[inline]
#[target_feature(enable = "avx2")]
fn load_block(block: &Block) -> __m256d {
    // SAFETY: a block is four numbers aligned to 32 bytes.
    unsafe { _mm256_load_pd(block.0.as_ptr()) }
}

#[inline]
#[target_feature(enable = "avx2")]
fn load(vector: &[f64; 2]) -> __m128d {
    // SAFETY: two numbers; the load asks for no alignment.
    unsafe { _mm_loadu_pd(vector.as_ptr()) }
}

#[inline]
#[target_feature(enable = "avx2")]
fn store(vector: &mut [f64; 2], value: __m128d) {
    // SAFETY: two numbers; the store asks for no alignment.
    unsafe { _mm_storeu_pd(vector.as_mut_ptr(), value) }
}
