//! Elements: stiffness and lumped mass of one element, one file a kind.

pub mod frequency;
pub mod quad4;
pub mod quadrature;
pub mod tri3;

use nalgebra::SMatrix;

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
