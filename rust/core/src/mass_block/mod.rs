//! Row forces: the bipenalty mass block `M + G'PG` over the degrees of freedom that the active rows touch.

pub mod pattern;
pub mod primal;

use crate::error::Result;
use crate::lane::Lane;
use crate::model::Model;
use crate::row::Row;
use primal::Primal;

/// Solver of the mass block, with buffers that last.
#[derive(Default)]
pub struct MassBlock {
    primal: Primal,
}

impl MassBlock {
    /// Row forces lambda (N per m of depth, compression positive) of the active rows.
    ///
    /// Rows without mass or damping penalty need no block: `lambda = -A_s g`.
    ///
    /// # Errors
    /// A block that is not positive definite, which only non-finite input can bring about.
    pub fn forces(
        &mut self,
        model: &Model,
        rows: &[Row],
        dt: f64,
        displacement: Lane,
        velocity: Lane,
        out: &mut RowForces,
    ) -> Result<()> {
        out.lambda.clear();
        out.before.clear();
        out.before.extend(rows.iter().map(|row| row.along(velocity)));
        if rows.iter().all(|row| row.penalties.inertia(dt) == 0.0) {
            out.lambda.extend(rows.iter().map(|row| -row.penalties.alpha_s * row.gap));
            return Ok(());
        }
        self.primal.solve(model, rows, dt, displacement, velocity)?;
        for (row, before) in rows.iter().zip(&out.before) {
            let p = &row.penalties;
            let force = p.alpha_s * row.gap + p.alpha_d * before + p.inertia(dt) * self.primal.along(row);
            out.lambda.push(-force);
        }
        Ok(())
    }

    /// How often the pattern has changed and been analysed anew.
    pub fn analyses(&self) -> usize {
        self.primal.analyses()
    }
}

/// What the block gives for each active row.
#[derive(Debug, Default)]
pub struct RowForces {
    /// Row force (N per m), compression positive.
    pub lambda: Vec<f64>,
    /// Gap rate G v_{n-1/2} (m/s) half a step before.
    pub before: Vec<f64>,
}
