//! What the machine can do at best, for benchmarks to compare with: multiply-adds, bytes, and the bare kernel.

mod bandwidth;
mod fma;
mod kernel;

pub use bandwidth::{Bandwidth, bandwidth};
pub use fma::fma_rate;
pub use kernel::kernel;

/// Rounds of which the best counts: other work on the machine only ever slows one down.
const ROUNDS: usize = 7;

/// Seconds that a piece of work takes, the best of a few rounds after one that warms up.
#[inline(always)]
fn best(mut work: impl FnMut()) -> f64 {
    let mut least = f64::INFINITY;
    for round in 0..=ROUNDS {
        let start = std::time::Instant::now();
        work();
        if round > 0 {
            least = least.min(start.elapsed().as_secs_f64());
        }
    }
    least
}
