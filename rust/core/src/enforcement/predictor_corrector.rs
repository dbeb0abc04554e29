//! Predictor-corrector bipenalty (after Kolman et al. 2021; Kwon, Kim, Cho and Gonzalez 2025): no block to solve.
//!
//! The predictor takes the bodies to u* without contact. The corrector's acceleration `a_c = M^-1 G' lambda` is all that
//! the mass penalty acts on, row by row: `lambda = -(alpha_s g(u*) + alpha_m w lambda)`, w = G M^-1 G' of the row alone,
//! so that `lambda = -alpha_s g*/(1 + alpha_m w)` and `g_{n+1} = (1 - d) g*` with `d = alpha_s w dt^2/(1 + alpha_m w)`.
//!
//! A row of free nodes, held closed, goes `w' = (1 - d)w - d g`, `g' = (1 - d)(g + w)` in units of dt: stable for
//! d <= 4/3, dead beat for d = 1. On an elastic mesh the limit is d = 1 (spectral radius of two bars held together,
//! numerically, at 0.1 to 0.99 of the mesh's own limit): past it growth is slow, about (d - 1)/10 a step at 0.9 and a
//! thousandth of that at 0.1, past 4/3 it is not. With alpha_m = alpha_s dt^2/s2, d < s2. Rows that share nodes multiply
//! d by up to the largest eigenvalue of W over its own diagonal: 1 to 4/3 with one pass, 2 to 8/3 with two.

use super::Rows;
use crate::mass_block::RowForces;

/// Largest d at which a row on an elastic mesh is stable.
pub(super) const LIMIT: f64 = 1.0;

pub(super) fn forces(of: Rows, forces: &mut RowForces) {
    forces.lambda.clear();
    forces.lambda.extend(of.rows.iter().map(|row| {
        let inertia = row.penalties.alpha_m * row.inverse_mass(of.inverse_mass);
        -row.penalties.alpha_s * row.gap / (1.0 + inertia)
    }));
}
