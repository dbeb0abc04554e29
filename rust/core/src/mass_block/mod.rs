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
    /// Row forces lambda (N per m of depth, compression positive) and gap rates G v_n (m/s) of the active rows.
    ///
    /// Rows without mass or damping penalty need no block: `lambda = -A_s g`, and their rates are left at zero.
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
        out.rate.clear();
        if rows.iter().all(|row| row.penalties.inertia(dt) == 0.0) {
            out.lambda.extend(rows.iter().map(|row| -row.penalties.alpha_s * row.gap));
            out.rate.resize(rows.len(), 0.0);
            return Ok(());
        }
        self.primal.solve(model, rows, dt, displacement, velocity)?;
        for row in rows {
            let p = &row.penalties;
            let (before, acceleration) = (row.along(velocity), self.primal.along(row));
            let force = p.alpha_s * row.gap + p.alpha_d * before + p.inertia(dt) * acceleration;
            out.lambda.push(-force);
            out.rate.push(before + 0.5 * dt * acceleration);
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
    /// Gap rate G v_n (m/s) at the full step; zero where no penalty needs it.
    pub rate: Vec<f64>,
}
