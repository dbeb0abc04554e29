//! Three-node triangle: constant strain (Turner et al. 1956).

use nalgebra::{Matrix3, SMatrix};

use super::{signed_area, strain_displacement};

/// Stiffness `t A B' C B` (N/m) and lumped mass `rho t A / 3` a node (kg) of a counter-clockwise triangle.
///
/// `elasticity` is C of Voigt stress and strain (N/m^2), `thickness` t in m, `density` rho in kg/m^3.
pub fn stiffness_and_mass(
    points: &[[f64; 2]; 3],
    elasticity: &Matrix3<f64>,
    thickness: f64,
    density: f64,
) -> (SMatrix<f64, 6, 6>, [f64; 3]) {
    let area = signed_area(points);
    let [p, q, r] = points;
    let two_area = 2.0 * area;
    let gradients = [
        [(q[1] - r[1]) / two_area, (r[0] - q[0]) / two_area],
        [(r[1] - p[1]) / two_area, (p[0] - r[0]) / two_area],
        [(p[1] - q[1]) / two_area, (q[0] - p[0]) / two_area],
    ];
    let b = strain_displacement::<3, 6>(&gradients);
    (b.transpose() * elasticity * b * (thickness * area), [density * thickness * area / 3.0; 3])
}
