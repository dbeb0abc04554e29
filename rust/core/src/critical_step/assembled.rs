//! Largest frequency of the assembled matrix: sharper than the element bound.

use super::lanczos::{Largest, largest};
use crate::model::Model;

/// Relative error of the squared frequency that the upper bound allows for: half of it in the time step.
pub const EPSILON: f64 = 0.01;

/// Largest omega^2 (1/s^2) of M^-1 K over the free degrees of freedom.
pub fn largest_omega2(model: &Model) -> Largest {
    let scale = scale(model);
    largest(scale.len(), EPSILON, |x, out| apply(model, &scale, x, out))
}

/// M^-1/2 by degree of freedom; 0 where held.
pub(super) fn scale(model: &Model) -> Vec<f64> {
    model.inverse_mass.as_flattened().iter().map(|w| w.sqrt()).collect()
}

/// out = M^-1/2 K M^-1/2 x.
pub(super) fn apply(model: &Model, scale: &[f64], x: &[f64], out: &mut [f64]) {
    let (x, scale) = (x.as_chunks::<2>().0, scale.as_chunks::<2>().0);
    for (node, (out, own)) in out.as_chunks_mut::<2>().0.iter_mut().zip(scale).enumerate() {
        let mut sum = [0.0; 2];
        for (column, k) in model.stiffness.row(node) {
            let (u, s) = (x[column], scale[column]);
            let force = k.times([u[0] * s[0], u[1] * s[1]]);
            sum = [sum[0] + force[0], sum[1] + force[1]];
        }
        *out = [own[0] * sum[0], own[1] * sum[1]];
    }
}
