//! Rate of multiply-adds that one core reaches from registers.

use std::hint::black_box;

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::{
    __m256d, __m512d, _mm256_fmadd_pd, _mm256_set1_pd, _mm256_storeu_pd, _mm512_fmadd_pd, _mm512_set1_pd,
    _mm512_storeu_pd,
};

use super::best;
use crate::stiffness::Isa;

/// Independent chains: more than two units with a latency of four need, fewer than there are registers.
const CHAINS: usize = 12;
/// Links of each chain in one round, a few milliseconds.
const LINKS: usize = 400_000;

/// Multiply-adds a second of one core, each lane of a register counted: independent chains, nothing read or written.
///
/// A set that the machine lacks is measured as the baseline, whose products and sums are two instructions.
pub fn fma_rate(isa: Isa) -> f64 {
    let (width, round): (usize, fn()) = match isa {
        // SAFETY: each is taken only where the machine has the features.
        #[cfg(target_arch = "x86_64")]
        Isa::Avx512 if isa.is_here() => (8, || unsafe { round_512() }),
        #[cfg(target_arch = "x86_64")]
        Isa::Avx2 if isa.is_here() => (4, || unsafe { round_256() }),
        _ => (2, round_plain),
    };
    (CHAINS * LINKS * width) as f64 / best(round)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,fma")]
fn round_512() {
    let (factor, term): (__m512d, __m512d) = (_mm512_set1_pd(black_box(0.5)), _mm512_set1_pd(black_box(1.0)));
    let mut chains = [term; CHAINS];
    for _ in 0..LINKS {
        for chain in &mut chains {
            *chain = _mm512_fmadd_pd(*chain, factor, term);
        }
    }
    let mut out = [[0.0; 8]; CHAINS];
    for (out, chain) in out.iter_mut().zip(chains) {
        // SAFETY: eight numbers; the store asks for no alignment.
        unsafe { _mm512_storeu_pd(out.as_mut_ptr(), chain) };
    }
    black_box(out);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn round_256() {
    let (factor, term): (__m256d, __m256d) = (_mm256_set1_pd(black_box(0.5)), _mm256_set1_pd(black_box(1.0)));
    let mut chains = [term; CHAINS];
    for _ in 0..LINKS {
        for chain in &mut chains {
            *chain = _mm256_fmadd_pd(*chain, factor, term);
        }
    }
    let mut out = [[0.0; 4]; CHAINS];
    for (out, chain) in out.iter_mut().zip(chains) {
        // SAFETY: four numbers; the store asks for no alignment.
        unsafe { _mm256_storeu_pd(out.as_mut_ptr(), chain) };
    }
    black_box(out);
}

fn round_plain() {
    let (factor, term) = (black_box(0.5), black_box(1.0));
    let mut chains = [[term; 2]; CHAINS];
    for _ in 0..LINKS {
        for chain in &mut chains {
            *chain = [chain[0] * factor + term, chain[1] * factor + term];
        }
    }
    black_box(chains);
}
