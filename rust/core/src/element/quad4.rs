//! Four-node quadrilateral: bilinear, 2x2 Gauss points (Taig 1961; Irons 1966).

use nalgebra::{Matrix2, Matrix3, SMatrix, Vector2};

use super::quadrature::GAUSS_2X2;
use super::strain_displacement;

/// Signs of the reference corners, counter-clockwise.
const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// Stiffness `t sum B' C B det J` (N/m) and row-sum lumped mass `rho t sum N det J` (kg) of a convex quad.
pub fn stiffness_and_mass(
    points: &[[f64; 2]; 4],
    elasticity: &Matrix3<f64>,
    thickness: f64,
    density: f64,
) -> (SMatrix<f64, 8, 8>, [f64; 4]) {
    let (mut stiffness, mut mass) = (SMatrix::<f64, 8, 8>::zeros(), [0.0; 4]);
    for [xi, eta] in GAUSS_2X2 {
        let local = CORNERS.map(|[s, t]| Vector2::new(0.25 * s * (1.0 + eta * t), 0.25 * t * (1.0 + xi * s)));
        let mut jacobian = Matrix2::zeros();
        for (d, p) in local.iter().zip(points) {
            jacobian += Vector2::new(p[0], p[1]) * d.transpose();
        }
        let det = jacobian.determinant();
        // grad N = J^-T dN/dxi, with J^-T = cof(J) / det J.
        let cofactor = Matrix2::new(jacobian.m22, -jacobian.m21, -jacobian.m12, jacobian.m11);
        let gradients = local.map(|d| {
            let g = cofactor * d / det;
            [g.x, g.y]
        });
        let b = strain_displacement::<4, 8>(&gradients);
        stiffness += b.transpose() * elasticity * b * (thickness * det);
        for (m, [s, t]) in mass.iter_mut().zip(CORNERS) {
            *m += density * thickness * det * 0.25 * (1.0 + s * xi) * (1.0 + t * eta);
        }
    }
    (stiffness, mass)
}
