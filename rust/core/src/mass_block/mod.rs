//! Row forces: what the penalties on mass and damping make of the active rows.
//!
//! With a_0 the acceleration without contact, the penalised equation of motion over the active rows becomes
//! `(1 + P W) lambda = -q` with `W = G M^-1 G'`, `P = A_m + dt/2 A_d` and `q = A_s g + A_d G v + P G a_0`: it needs no
//! more than gaps and gap rates. Two ways to solve it, by whichever is cheaper: see `choice`.

mod choice;
pub mod dual;
pub mod envelope;
pub mod ldl;
pub mod pattern;
pub mod primal;

pub use choice::Solver;

use crate::error::Result;
use crate::row::Row;
use dual::Dual;
use primal::Primal;

/// Solvers of the mass block, with buffers that last.
#[derive(Default)]
pub struct MassBlock {
    dual: Dual,
    primal: Primal,
    /// Which solver to use, unless the choice is left to the block.
    pub forced: Option<Solver>,
    /// Multiplications of the last factorisation; 0 where none was needed.
    pub operations: usize,
    used: Option<Solver>,
}

/// What the block takes and gives, row by row.
#[derive(Debug, Default)]
pub struct RowForces {
    /// Row force lambda (N per m), compression positive.
    pub lambda: Vec<f64>,
    /// Gap rate G v_{n-1/2} (m/s) half a step before.
    pub before: Vec<f64>,
    /// Gap rate (m/s) that the bodies would have half a step after, were there no rows.
    pub free: Vec<f64>,
}

impl MassBlock {
    /// Row forces of the active rows from their gaps and gap rates.
    ///
    /// Rows without mass or damping penalty need no block: `lambda = -A_s g`.
    ///
    /// # Errors
    /// A block that is not positive definite, which only non-finite input can bring about.
    pub fn forces(&mut self, inverse_mass: &[[f64; 2]], rows: &[Row], dt: f64, forces: &mut RowForces) -> Result<()> {
        forces.lambda.clear();
        self.operations = 0;
        if rows.iter().all(|row| row.penalties.inertia(dt) == 0.0) {
            forces.lambda.extend(rows.iter().map(|row| -row.penalties.alpha_s * row.gap));
            return Ok(());
        }
        self.dual.envelope.update(rows);
        let solver = self.forced.unwrap_or_else(|| choice::solver(rows.len(), self.dual.envelope.nodes));
        self.used = Some(solver);
        self.operations = match solver {
            Solver::Dual => {
                self.dual.solve(inverse_mass, rows, dt, forces);
                self.dual.envelope.operations
            }
            Solver::Primal => {
                self.primal.solve(inverse_mass, rows, dt, forces)?;
                self.primal.operations
            }
        };
        Ok(())
    }

    /// How often the pattern of the rows has changed and been analysed anew.
    pub fn analyses(&self) -> usize {
        self.dual.envelope.analyses
    }

    /// The solver used last; none so far if no row has had a mass or damping penalty.
    pub fn used(&self) -> Option<Solver> {
        self.used
    }
}
