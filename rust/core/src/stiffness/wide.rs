//! 8 and 16 lanes with 512-bit registers: V registers a component, neighbouring rows share what they read.

mod registers;

use std::arch::x86_64::_mm512_setzero_pd;
use std::ops::Range;

use super::kernel::Pass;
use super::rows::{Nine, Rows};
use registers::{Sums, Update, WIDTH, add};

/// As [`super::kernel::advance`] for L = 8 V, with the same operations in the same order, on a machine with AVX-512.
pub(super) fn advance<const L: usize, const V: usize>(
    pass: &Pass<L>,
    range: Range<usize>,
    velocity: &mut [[f64; L]],
    next: &mut [[f64; L]],
) {
    assert!(L == WIDTH * V && is_x86_feature_detected!("avx512f"), "whole registers of AVX-512");
    let (velocity, next) = (velocity.as_chunks_mut().0, next.as_chunks_mut().0);
    // SAFETY: the machine has just been asked for the feature.
    unsafe {
        if pass.load.is_some() {
            sweep::<L, V, true>(pass, range, velocity, next);
        } else {
            sweep::<L, V, false>(pass, range, velocity, next);
        }
    }
}

#[target_feature(enable = "avx512f")]
fn sweep<const L: usize, const V: usize, const LOADED: bool>(
    pass: &Pass<L>,
    range: Range<usize>,
    velocity: &mut [[[f64; L]; 2]],
    next: &mut [[[f64; L]; 2]],
) {
    let rows = Rows::new(pass.stiffness, pass.displacement);
    // SAFETY: this function has the feature that the call asks for.
    let update = unsafe { Update::<V>::new(&pass.dt, &pass.elastic_dt.map(|dt| -dt), &pass.load_dt) };
    let inverse_mass = &pass.inverse_mass[range.clone()];
    let (velocity, next) = (&mut velocity[..range.len()], &mut next[..range.len()]);
    let f = |node: usize| if LOADED { pass.load.map(|load| load[node]) } else { None };
    let mut at = 0;
    while at < range.len() {
        let node = range.start + at;
        // SAFETY: this function has the feature that the calls ask for.
        unsafe {
            if at + 1 < range.len()
                && rows.paired(node)
                && let (Some(a), Some(b)) = (rows.nine(node), rows.nine(node + 1))
            {
                let (mut sum_a, mut sum_b) = ([[_mm512_setzero_pd(); V]; 4], [[_mm512_setzero_pd(); V]; 4]);
                two(rows, a, b, &mut sum_a, &mut sum_b);
                update.node(inverse_mass[at], f(node), &sum_a, rows.at(node), &mut velocity[at], &mut next[at]);
                at += 1;
                update.node(inverse_mass[at], f(node + 1), &sum_b, rows.at(node + 1), &mut velocity[at], &mut next[at]);
            } else {
                let mut sum = [[_mm512_setzero_pd(); V]; 4];
                one(rows, node, &mut sum);
                update.node(inverse_mass[at], f(node), &sum, rows.at(node), &mut velocity[at], &mut next[at]);
            }
        }
        at += 1;
    }
}

/// One row times u.
// SAFETY: to be called with AVX-512 only.
#[inline(always)]
unsafe fn one<const L: usize, const V: usize>(rows: Rows<L>, node: usize, sum: &mut Sums<V>) {
    // SAFETY: as above.
    unsafe {
        // Inner nodes of quads have nine blocks: a known number needs no loop.
        if let Some((blocks, columns)) = rows.nine(node) {
            for b in 0..9 {
                add(sum, &blocks[b], rows.column(columns[b]));
            }
        } else {
            let (blocks, columns) = rows.row(node);
            for (block, &column) in blocks.iter().zip(columns) {
                add(sum, block, rows.column(column));
            }
        }
    }
}

/// The rows of a pair times u: each displacement they share is read once, and twice as many sums hide the latency.
// SAFETY: to be called with AVX-512 only.
#[inline(always)]
unsafe fn two<const L: usize, const V: usize>(
    rows: Rows<L>,
    (ka, ca): Nine,
    (kb, cb): Nine,
    a: &mut Sums<V>,
    b: &mut Sums<V>,
) {
    // SAFETY: as above.
    unsafe {
        for t in 0..3 {
            add(a, &ka[3 * t], rows.column(ca[3 * t]));
            for s in 3 * t..3 * t + 2 {
                let shared = rows.column(cb[s]);
                add(a, &ka[s + 1], shared);
                add(b, &kb[s], shared);
            }
            add(b, &kb[3 * t + 2], rows.column(cb[3 * t + 2]));
        }
    }
}
