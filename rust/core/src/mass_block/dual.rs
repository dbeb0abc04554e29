//! Dual solution of the mass block: `(P^-1 + G M^-1 G') lambda = -P^-1 q`, one unknown a row, by envelope LDL'.

use super::RowForces;
use super::envelope::Envelope;
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

/// Round-off that a pivot may carry, over the diagonal it came from.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;

impl Dual {
    /// Fills `forces.lambda` from gaps and gap rates; the envelope must be up to date with the rows.
    pub fn solve(&mut self, inverse_mass: &[[f64; 2]], rows: &[Row], dt: f64, forces: &mut RowForces) {
        self.assemble(inverse_mass, rows, dt, forces);
        self.factorise_and_solve();
        forces.lambda.resize(rows.len(), 0.0);
        for (&row, &x) in self.envelope.order.iter().zip(&self.solution) {
            forces.lambda[row as usize] = x;
        }
    }

    fn assemble(&mut self, inverse_mass: &[[f64; 2]], rows: &[Row], dt: f64, forces: &RowForces) {
        let envelope = &self.envelope;
        self.values.clear();
        self.values.resize(envelope.start[rows.len()] as usize, 0.0);
        for term in &envelope.terms {
            let [(a, ea), (b, eb)] = term.factors;
            let ((node, ga), (_, gb)) = (rows[a as usize].entry(ea), rows[b as usize].entry(eb));
            let w = inverse_mass[node as usize];
            self.values[term.slot as usize] += term.times * (w[0] * ga[0] * gb[0] + w[1] * ga[1] * gb[1]);
        }
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

    /// `values` become L below the diagonal, `pivot` D: every pivot is at least P^-1, however redundant the rows.
    fn factorise_and_solve(&mut self) {
        let Envelope { first, start, .. } = &self.envelope;
        for i in 0..first.len() {
            let (fi, si) = (first[i] as usize, start[i] as usize);
            let (done, current) = self.values.split_at_mut(si);
            for j in fi..i {
                let (fj, sj) = (first[j] as usize, start[j] as usize);
                let from = fi.max(fj);
                let (a, b) = (&current[from - fi..j - fi], &done[sj + from - fj..sj + j - fj]);
                current[j - fi] -= a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
            }
            let diagonal = current[i - fi];
            let (mut pivot, mut x) = (self.pivot[i] + diagonal, self.solution[i]);
            for j in fi..i {
                let scaled = current[j - fi] / self.pivot[j];
                pivot -= scaled * current[j - fi];
                x -= scaled * self.solution[j];
                current[j - fi] = scaled;
            }
            let least = self.pivot[i] + ROUND_OFF * diagonal;
            self.pivot[i] = if pivot > least { pivot } else { least };
            self.solution[i] = x;
        }
        for (x, pivot) in self.solution.iter_mut().zip(&self.pivot) {
            *x /= pivot;
        }
        for i in (0..first.len()).rev() {
            let (fi, si, x) = (first[i] as usize, start[i] as usize, self.solution[i]);
            for j in fi..i {
                self.solution[j] -= self.values[si + j - fi] * x;
            }
        }
    }
}
