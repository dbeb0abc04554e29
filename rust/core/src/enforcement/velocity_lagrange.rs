//! CD-Lagrange (Fekak, Brun, Gravouil and Depale 2017): complementarity of impulse and velocity.
//!
//! Over the rows with g_n < 0: `0 <= lambda _|_ G v_{n+1/2} >= 0`, `G v_{n+1/2} = G v* + W dt lambda`, v* the velocity
//! without rows. The gap itself is not corrected: a node stays as deep as the step in which it arrived took it.

use super::Rows;
use super::complementarity::Complementarity;
use crate::error::Result;
use crate::mass_block::RowForces;

pub(super) fn forces(of: Rows, tolerance: f64, solver: &mut Complementarity, forces: &mut RowForces) -> Result<usize> {
    let operations = solver.solve(of, tolerance, &forces.free)?;
    forces.lambda.clear();
    forces.lambda.extend(solver.impulse.iter().map(|impulse| impulse / of.dt));
    Ok(operations)
}
