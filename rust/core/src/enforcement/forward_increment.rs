//! Forward-increment Lagrange multipliers (Carpenter, Taylor and Katona 1991): multipliers of t_n, gaps of t_{n+1}.
//!
//! Over the rows with g(u*) < 0, u* = u_n + dt v* where the bodies get without them: `0 <= lambda _|_ g_{n+1} >= 0` with
//! `g_{n+1} = g(u*) + dt^2 W lambda`, linear in the correction from u*: direction and closest point are those at u*.

use super::Rows;
use super::complementarity::Complementarity;
use crate::error::Result;
use crate::mass_block::RowForces;

pub(super) fn forces(of: Rows, tolerance: f64, solver: &mut Complementarity, forces: &mut RowForces) -> Result<usize> {
    // As velocities, g/dt; lambda holds them until it is known.
    forces.lambda.clear();
    forces.lambda.extend(of.rows.iter().map(|row| row.gap / of.dt));
    let operations = solver.solve(of, tolerance, &forces.lambda)?;
    for (lambda, impulse) in forces.lambda.iter_mut().zip(&solver.impulse) {
        *lambda = impulse / of.dt;
    }
    Ok(operations)
}
