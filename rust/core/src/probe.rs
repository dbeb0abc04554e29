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
fn best(mut work: impl FnMut()) -> f64 {
    let mut timed = || {
        let start = std::time::Instant::now();
        work();
        start.elapsed().as_secs_f64()
    };
    timed();
    (0..ROUNDS).map(|_| timed()).fold(f64::INFINITY, f64::min)
}
