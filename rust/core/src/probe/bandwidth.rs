//! Bytes a second between one core and the level of memory that holds a working set.

use std::hint::black_box;

use super::best;
use crate::error::{Error, Result};
use crate::stiffness::simd::{Loop, Madd, dispatch};
use crate::stiffness::{Aligned, Isa};

/// Bytes that one round moves at least.
const MOVED: usize = 16 << 20;
/// Lanes of the loops: two registers of the widest set.
const LANES: usize = 16;

/// Bytes a second, as the loops name them: what a store reads first is not counted.
#[derive(Debug, Clone, Copy)]
pub struct Bandwidth {
    /// Of a sum over one array.
    pub read: f64,
    /// Of `a = b + s c` over three arrays.
    pub triad: f64,
}

/// Bandwidth of one core over a working set of `bytes`, with the widest instruction set.
///
/// # Errors
/// Fewer bytes than make three arrays of 32 numbers, or more than 8 GB.
pub fn bandwidth(bytes: usize) -> Result<Bandwidth> {
    let (least, most) = (3 * 8 * 2 * LANES, 1 << 33);
    if !(least..=most).contains(&bytes) {
        let bound = format!("in [{least}, {most}] bytes");
        return Err(Error::bound("bandwidth probe", "working set", bytes, &bound, "take the size of a cache"));
    }
    let rounds = MOVED.div_ceil(bytes);
    let filled = |numbers: usize| {
        let mut array = Aligned::zeros(numbers / (2 * LANES) * (2 * LANES));
        array.fill(1.0);
        array
    };
    let one = filled(bytes / 8);
    let read = (8 * one.len() * rounds) as f64 / best(|| (0..rounds).for_each(|_| dispatch(Isa::detect(), Read(&one))));
    let [mut a, b, c] = std::array::from_fn(|_| filled(bytes / 24));
    let work = || (0..rounds).for_each(|_| dispatch(Isa::detect(), Triad(&mut a, &b, &c)));
    Ok(Bandwidth { read, triad: (24 * b.len() * rounds) as f64 / best(work) })
}

struct Read<'a>(&'a [f64]);

impl Loop for Read<'_> {
    type Output = ();

    #[inline(always)]
    fn run<M: Madd>(self) {
        // Several rows of sums: one alone would wait for its own additions.
        let (mut a, mut b) = ([0.0; LANES], [0.0; LANES]);
        for [x, y] in black_box(self.0).as_chunks::<LANES>().0.as_chunks::<2>().0 {
            for lane in 0..LANES {
                a[lane] += x[lane];
                b[lane] += y[lane];
            }
        }
        for lane in 0..LANES {
            a[lane] += b[lane];
        }
        black_box(a);
    }
}

struct Triad<'a>(&'a mut [f64], &'a [f64], &'a [f64]);

impl Loop for Triad<'_> {
    type Output = ();

    #[inline(always)]
    fn run<M: Madd>(self) {
        let (a, b, c) = (black_box(self.0), black_box(self.1), black_box(self.2));
        let s = black_box(0.5);
        let (b, c) = (b.as_chunks::<LANES>().0, c.as_chunks::<LANES>().0);
        for (a, (b, c)) in a.as_chunks_mut::<LANES>().0.iter_mut().zip(b.iter().zip(c)) {
            for lane in 0..LANES {
                a[lane] = M::madd(s, c[lane], b[lane]);
            }
        }
    }
}
