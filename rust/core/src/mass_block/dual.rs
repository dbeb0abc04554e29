//! Dual solution of the mass block: `(P^-1 + G M^-1 G') lambda = -P^-1 q`, one unknown a row, by envelope LDL'.

use super::RowForces;
use super::envelope::Envelope;
use super::ldl::factorise_and_solve;
use crate::row::Row;

/// Envelope and values of the factorisation; they grow and are never given back.
#[derive(Debug, Default)]
pub struct Dual {
    /// Order of the rows.
    pub envelope: Envelope,
    values: Vec<f64>,
    pivot: Vec<f64>,
    solution: Vec<f64>,
}

impl Dual {
    /// Fills `forces.lambda` from gaps and gap rates; the envelope must be up to date with the rows.
    pub fn solve(&mut self, inverse_mass: &[[f64; 2]], rows: &[Row], dt: f64, forces: &mut RowForces) {
        self.assemble(inverse_mass, rows, dt, forces);
        factorise_and_solve(&self.envelope, &mut self.values, &mut self.pivot, &mut self.solution);
        forces.lambda.resize(rows.len(), 0.0);
        for (&row, &x) in self.envelope.order.iter().zip(&self.solution) {
            forces.lambda[row as usize] = x;
        }
    }

    fn assemble(&mut self, inverse_mass: &[[f64; 2]], rows: &[Row], dt: f64, forces: &RowForces) {
        let envelope = &self.envelope;
        envelope.gram(inverse_mass, rows, &mut self.values);
        self.pivot.clear();
        self.solution.clear();
        for &row in &envelope.order {
            let (row, before, free) = (&rows[row as usize], forces.before[row as usize], forces.free[row as usize]);
            let (p, inertia) = (&row.penalties, row.penalties.inertia(dt));
            // A row without penalties has no force, and P^-1 = inf says so.
            self.pivot.push(1.0 / inertia);
            let push = (p.alpha_s * row.gap + p.alpha_d * before) / inertia + (free - before) / dt;
            self.solution.push(if inertia > 0.0 { -push } else { 0.0 });
        }
    }
}
