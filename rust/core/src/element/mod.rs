//! Elements: stiffness and lumped mass of one element, one file a kind.

pub mod quad4;
pub mod quadrature;
pub mod tri3;

use nalgebra::{SMatrix, SVector};

/// Strain-displacement rows (xx, yy, 2xy) from the shape functions' gradients, degrees of freedom node by node.
pub(crate) fn strain_displacement<const N: usize, const D: usize>(gradients: &[[f64; 2]; N]) -> SMatrix<f64, 3, D> {
    let mut b = SMatrix::zeros();
    for (a, [dx, dy]) in gradients.iter().copied().enumerate() {
        b[(0, 2 * a)] = dx;
        b[(1, 2 * a + 1)] = dy;
        b[(2, 2 * a)] = dy;
        b[(2, 2 * a + 1)] = dx;
    }
    b
}

/// Signed area of a polygon (m^2), positive when counter-clockwise.
pub fn signed_area(points: &[[f64; 2]]) -> f64 {
    let origin = points[0];
    let from_origin = |p: [f64; 2]| [p[0] - origin[0], p[1] - origin[1]];
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    0.5 * points.windows(2).map(|w| cross(from_origin(w[0]), from_origin(w[1]))).sum::<f64>()
}

/// Largest eigenfrequency (rad/s) of one element with its own lumped mass: `max eig(m^-1/2 K m^-1/2)^1/2`.
///
/// The largest over all elements bounds that of the assembled mesh (Irons and Fried 1971; Hughes 1987, sec. 9.2).
pub fn largest_frequency<const N: usize, const D: usize>(stiffness: &SMatrix<f64, D, D>, mass: &[f64; N]) -> f64 {
    let scale = SVector::<f64, D>::from_fn(|i, _| 1.0 / mass[i / 2].sqrt());
    // Trace bounds every eigenvalue; power iteration on the scaled matrix would need a certificate, so take all.
    let scaled = SMatrix::<f64, D, D>::from_fn(|i, j| stiffness[(i, j)] * scale[i] * scale[j]);
    let dynamic = nalgebra::DMatrix::from_column_slice(D, D, scaled.as_slice());
    dynamic.symmetric_eigenvalues().max().max(0.0).sqrt()
}
