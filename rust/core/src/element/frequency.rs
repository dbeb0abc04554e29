//! Largest eigenfrequency over elements: it bounds that of the assembled mesh (Irons and Fried 1971).

use nalgebra::{DMatrix, SMatrix};

/// Relative margin of omega^2 within which an element counts as no faster than another: round-off.
const ROUND_OFF: f64 = 1e-12;

/// The larger of `omega` and an element's largest eigenfrequency `max eig(m^-1 K)^1/2` (rad/s), with its own lumped mass.
///
/// Most elements of a mesh are no faster than one seen before: `omega^2 m - K` is positive definite then, which costs a
/// fiftieth of the eigenvalues.
pub fn larger<const N: usize, const D: usize>(omega: f64, stiffness: &SMatrix<f64, D, D>, mass: &[f64; N]) -> f64 {
    let omega2 = omega * omega * (1.0 + ROUND_OFF);
    let shifted = SMatrix::from_fn(|i, j| if i == j { omega2 * mass[i / 2] } else { 0.0 } - stiffness[(i, j)]);
    if is_positive_definite::<D>(shifted) { omega } else { largest_frequency(stiffness, mass).max(omega) }
}

/// Largest eigenfrequency (rad/s) of one element: `max eig(m^-1/2 K m^-1/2)^1/2`.
pub fn largest_frequency<const N: usize, const D: usize>(stiffness: &SMatrix<f64, D, D>, mass: &[f64; N]) -> f64 {
    let scale = mass.map(|m| 1.0 / m.sqrt());
    let scaled = DMatrix::from_fn(D, D, |i, j| stiffness[(i, j)] * scale[i / 2] * scale[j / 2]);
    scaled.symmetric_eigenvalues().max().max(0.0).sqrt()
}

/// By elimination: all pivots positive.
fn is_positive_definite<const D: usize>(mut a: SMatrix<f64, D, D>) -> bool {
    for k in 0..D {
        let pivot = a[(k, k)];
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        for j in k + 1..D {
            let factor = a[(j, k)] / pivot;
            for i in j..D {
                a[(i, j)] -= factor * a[(i, k)];
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_of_many_is_found_whatever_their_order() {
        let element = |x: f64| {
            let b = SMatrix::<f64, 6, 6>::from_fn(|i, j| ((1 + i + 7 * j) as f64 * x).sin());
            (b.transpose() * b, [0.3 + 0.2 * x.cos(), 0.5, 0.4])
        };
        let all: Vec<_> = (0..200).map(|i| element(0.1 + 0.37 * f64::from(i))).collect();
        let exact = all.iter().map(|(k, m)| largest_frequency(k, m)).fold(0.0, f64::max);
        let forward = all.iter().fold(0.0, |omega, (k, m)| larger(omega, k, m));
        let backward = all.iter().rev().fold(0.0, |omega, (k, m)| larger(omega, k, m));
        assert!((forward / exact - 1.0).abs() < 1e-11 && (backward / exact - 1.0).abs() < 1e-11);
    }
}
