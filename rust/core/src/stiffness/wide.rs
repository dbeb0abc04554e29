//! 8 and 16 lanes with explicit registers: neighbouring rows share what they read where there are sums enough.

mod registers;
mod update;

use std::arch::x86_64::{__m256d, __m512d};
use std::ops::Range;

use super::kernel::Pass;
use super::rows::{Nine, Rows};
use super::simd::Isa;
use registers::{Register, Sums, add};
use update::Update;

/// As [`super::kernel::advance`] for L = 8 or 16, with the same operations in the same order.
///
/// # Panics
/// Another number of lanes, or an instruction set without fused multiply-add or that the machine lacks.
pub(super) fn advance<const L: usize>(
    isa: Isa,
    pass: &Pass<L>,
    range: Range<usize>,
    velocity: &mut [[f64; L]],
    next: &mut [[f64; L]],
) {
    assert!(isa.is_here() && range.len() <= velocity.len().min(next.len()) / 2, "set at hand, arrays of the range");
    let sweep = Sweep { pass, range, velocity: velocity.as_chunks_mut().0, next: next.as_chunks_mut().0 };
    // SAFETY: the machine has the features of the set, and L is the number of lanes that each sweep is for.
    unsafe {
        match (L, isa) {
            (8, Isa::Avx512) => eight_512(sweep),
            (16, Isa::Avx512) => sixteen_512(sweep),
            (8 | 16, Isa::Avx2) => eights_256(sweep),
            _ => panic!("{L} lanes on {}", isa.name()),
        }
    }
}

#[target_feature(enable = "avx512f,fma")]
fn eight_512<const L: usize>(sweep: Sweep<L>) {
    // SAFETY: this function has the features.
    unsafe { sweep.run::<__m512d, 1, true>(0) }
}

#[target_feature(enable = "avx512f,fma")]
fn sixteen_512<const L: usize>(sweep: Sweep<L>) {
    // SAFETY: this function has the features.
    unsafe { sweep.run::<__m512d, 2, true>(0) }
}

/// Eight lanes at a time: their sums take half of the sixteen registers, so that rows cannot be paired.
#[target_feature(enable = "avx2,fma")]
fn eights_256<const L: usize>(mut sweep: Sweep<L>) {
    for first in (0..L).step_by(8) {
        // SAFETY: this function has the features.
        unsafe { sweep.by_ref().run::<__m256d, 2, false>(first) }
    }
}

struct Sweep<'a, const L: usize> {
    pass: &'a Pass<'a, L>,
    range: Range<usize>,
    velocity: &'a mut [[[f64; L]; 2]],
    next: &'a mut [[[f64; L]; 2]],
}

impl<const L: usize> Sweep<'_, L> {
    fn by_ref(&mut self) -> Sweep<'_, L> {
        Sweep { pass: self.pass, range: self.range.clone(), velocity: self.velocity, next: self.next }
    }

    /// All nodes of the range, in V registers from lane `first` on.
    // SAFETY: as for `Register`; `first` and V registers lie within the lanes.
    #[inline(always)]
    unsafe fn run<R: Register, const V: usize, const PAIRS: bool>(self, first: usize) {
        let Self { pass, range, velocity, next } = self;
        let rows = Rows::new(pass.stiffness, pass.displacement);
        let inverse_mass = &pass.inverse_mass[range.clone()];
        let load = pass.load.map(|load| &load[range.clone()]);
        let (velocity, next) = (&mut velocity[..range.len()], &mut next[..range.len()]);
        let elastic_dt = pass.elastic_dt.map(|dt| -dt);
        let mut at = 0;
        // SAFETY: as above.
        unsafe {
            let update = Update::<R, V>::new(&pass.dt, &elastic_dt, &pass.load_dt, first);
            while at < range.len() {
                let node = range.start + at;
                let mut sum = [[R::all(0.0); V]; 4];
                if PAIRS
                    && at + 1 < range.len()
                    && rows.paired(node)
                    && let (Some(a), Some(b)) = (rows.nine(node), rows.nine(node + 1))
                {
                    let mut other = [[R::all(0.0); V]; 4];
                    two(rows, a, b, &mut sum, &mut other, first);
                    let (w, f, x) = (inverse_mass[at], load.map(|load| load[at]), rows.at(node));
                    update.node(first, w, f, &sum, x, &mut velocity[at], &mut next[at]);
                    at += 1;
                    let (w, f, x) = (inverse_mass[at], load.map(|load| load[at]), rows.at(node + 1));
                    update.node(first, w, f, &other, x, &mut velocity[at], &mut next[at]);
                } else {
                    one(rows, node, &mut sum, first);
                    let (w, f, x) = (inverse_mass[at], load.map(|load| load[at]), rows.at(node));
                    update.node(first, w, f, &sum, x, &mut velocity[at], &mut next[at]);
                }
                at += 1;
            }
        }
    }
}

/// One row times u.
// SAFETY: as for `add`.
#[inline(always)]
unsafe fn one<R: Register, const L: usize, const V: usize>(
    rows: Rows<L>,
    node: usize,
    sum: &mut Sums<R, V>,
    first: usize,
) {
    // SAFETY: as above.
    unsafe {
        // Inner nodes of quads have nine blocks: a known number needs no loop.
        if let Some((blocks, columns)) = rows.nine(node) {
            for b in 0..9 {
                add(sum, &blocks[b], rows.column(columns[b]), first);
            }
        } else {
            let (blocks, columns) = rows.row(node);
            for (block, &column) in blocks.iter().zip(columns) {
                add(sum, block, rows.column(column), first);
            }
        }
    }
}

/// The rows of a pair times u: each displacement they share is read once, and twice as many sums hide the latency.
// SAFETY: as for `add`.
#[inline(always)]
unsafe fn two<R: Register, const L: usize, const V: usize>(
    rows: Rows<L>,
    (ka, ca): Nine,
    (kb, cb): Nine,
    a: &mut Sums<R, V>,
    b: &mut Sums<R, V>,
    first: usize,
) {
    // SAFETY: as above.
    unsafe {
        for t in 0..3 {
            add(a, &ka[3 * t], rows.column(ca[3 * t]), first);
            for s in 3 * t..3 * t + 2 {
                let shared = rows.column(cb[s]);
                add(a, &ka[s + 1], shared, first);
                add(b, &kb[s], shared, first);
            }
            add(b, &kb[3 * t + 2], rows.column(cb[3 * t + 2]), first);
        }
    }
}
