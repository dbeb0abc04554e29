//! Rate of multiply-adds that one core reaches from registers.

use std::hint::black_box;

use super::best;
use crate::stiffness::Isa;
use crate::stiffness::simd::{Loop, Madd, dispatch};

/// Independent chains: more than two units with a latency of four need, fewer than there are registers.
const CHAINS: usize = 12;
/// Links of each chain in one round, a few milliseconds.
const LINKS: usize = 400_000;

/// Multiply-adds a second of one core, each lane of a register counted: independent chains, nothing read or written.
pub fn fma_rate(isa: Isa) -> f64 {
    dispatch(isa, Chains)
}

struct Chains;

impl Loop for Chains {
    type Output = f64;

    #[inline(always)]
    fn run<M: Madd>(self) -> f64 {
        match M::WIDTH {
            8 => rate::<8, M>(),
            4 => rate::<4, M>(),
            _ => rate::<2, M>(),
        }
    }
}

#[inline(always)]
fn rate<const W: usize, M: Madd>() -> f64 {
    let seconds = best(
        #[inline(always)]
        || {
            let (factor, term) = (black_box([0.5; W]), black_box([1.0; W]));
            let mut chains = black_box([[0.0; W]; CHAINS]);
            for _ in 0..LINKS {
                for chain in &mut chains {
                    for lane in 0..W {
                        chain[lane] = M::madd(chain[lane], factor[lane], term[lane]);
                    }
                }
            }
            black_box(chains);
        },
    );
    (CHAINS * LINKS * W) as f64 / seconds
}
