//! Largest eigenvalue of a symmetric operator by Lanczos iteration, with an upper bound that holds but for one in 1e10.
//!
//! From a random start, the largest Ritz value theta of k steps falls short of the largest eigenvalue lambda by more than
//! epsilon lambda with a probability of at most `1.648 sqrt(n) exp(-sqrt(epsilon) (2k - 1))`, whatever the spectrum of a
//! positive semi-definite operator (Kuczynski and Wozniakowski 1992, theorem 4.2). k is chosen to bring that below 1e-10.

use nalgebra::{DMatrix, DVector};

/// Probability that the upper bound does not hold.
pub const RISK: f64 = 1e-10;

/// Largest eigenvalue: what the iteration found, and what it cannot exceed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Largest {
    /// Largest Ritz value: a lower bound.
    pub found: f64,
    /// Upper bound, but for a risk of 1e-10.
    pub upper: f64,
    /// Products with the operator.
    pub products: usize,
}

/// Steps that bring the risk for relative error `epsilon` in n dimensions below `RISK`.
pub fn steps(n: usize, epsilon: f64) -> usize {
    let exponent = (1.648 * (n as f64).sqrt() / RISK).ln();
    (0.5 * (exponent / epsilon.sqrt() + 1.0)).ceil() as usize
}

/// Largest eigenvalue of `apply(x, out)`, a symmetric positive semi-definite operator on vectors of length n.
pub fn largest(n: usize, epsilon: f64, mut apply: impl FnMut(&[f64], &mut [f64])) -> Largest {
    let most = steps(n, epsilon);
    let (mut previous, mut product) = (DVector::zeros(n), DVector::zeros(n));
    let mut current = normal_vector(n);
    current.normalize_mut();
    let (mut diagonal, mut off): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    for _ in 0..most.min(n) {
        apply(current.as_slice(), product.as_mut_slice());
        let alpha = product.dot(&current);
        product.axpy(-alpha, &current, 1.0);
        product.axpy(-off.last().copied().unwrap_or(0.0), &previous, 1.0);
        diagonal.push(alpha);
        let beta = product.norm();
        // The Krylov space is exhausted: the Ritz values are eigenvalues.
        if beta <= 1e-14 * alpha.abs() || !beta.is_finite() {
            break;
        }
        off.push(beta);
        std::mem::swap(&mut previous, &mut current);
        current.copy_from(&product);
        current /= beta;
    }
    let k = diagonal.len();
    let entry = |i: usize, j: usize| match i.abs_diff(j) {
        0 => diagonal[i],
        1 => off[i.min(j)],
        _ => 0.0,
    };
    let found = DMatrix::from_fn(k, k, entry).symmetric_eigenvalues().max();
    Largest { found, upper: found / (1.0 - epsilon), products: k }
}

/// Independent normal deviates from a fixed seed, so that a limit is the same whenever it is asked for.
fn normal_vector(n: usize) -> DVector<f64> {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut uniform = || {
        // splitmix64 (Steele, Lea and Flood 2014).
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    };
    DVector::from_fn(n, |_, _| {
        let (radius, angle) = ((-2.0 * (1.0 - uniform()).ln()).sqrt(), std::f64::consts::TAU * uniform());
        radius * angle.cos()
    })
}
