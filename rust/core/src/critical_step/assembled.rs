//! Largest frequency of the assembled matrix: sharper than the element bound.

use super::lanczos::{Largest, largest};
use crate::body::Body;
use crate::model::Model;

/// Relative error of the squared frequency that the upper bound allows for: half of it in the time step.
pub const EPSILON: f64 = 0.01;

/// Largest omega^2 (1/s^2) of M^-1 K over the free degrees of freedom of one body, before its own factors.
pub fn largest_omega2(model: &Model, body: &Body) -> Largest {
    let scale: Vec<f64> = scale(model)[2 * body.nodes.start..2 * body.nodes.end].to_vec();
    let factor = body.density_factor / body.young_factor;
    let found = largest(scale.len(), EPSILON, |x, out| apply(model, body, &scale, x, out));
    Largest { found: factor * found.found, upper: factor * found.upper, ..found }
}

/// M^-1/2 by degree of freedom; 0 where held.
pub(super) fn scale(model: &Model) -> Vec<f64> {
    model.inverse_mass.as_flattened().iter().map(|w| w.sqrt()).collect()
}

/// out = M^-1/2 K M^-1/2 x over the degrees of freedom of one body.
pub(super) fn apply(model: &Model, body: &Body, scale: &[f64], x: &[f64], out: &mut [f64]) {
    let (x, scale) = (x.as_chunks::<2>().0, scale.as_chunks::<2>().0);
    let first = body.nodes.start;
    for (i, (out, own)) in out.as_chunks_mut::<2>().0.iter_mut().zip(scale).enumerate() {
        let mut sum = [0.0; 2];
        for (column, k) in model.stiffness.row(first + i) {
            let (u, s) = (x[column - first], scale[column - first]);
            let force = k.times([u[0] * s[0], u[1] * s[1]]);
            sum = [sum[0] + force[0], sum[1] + force[1]];
        }
        *out = [0, 1].map(|axis| body.young_factor * own[axis] * sum[axis]);
    }
}
