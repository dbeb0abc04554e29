//! Complementarity of coupled rows: `0 <= x _|_ W x + q >= 0`, W = G M^-1 G', by block principal pivoting.
//!
//! Rows are in (pressing) or out; with those in, one LDL' gives x, and all rows whose sign is wrong change sides at once
//! until none is (Judice and Pires 1994). Should that go round in circles, the last of them alone changes sides, which
//! ends for any positive definite matrix (Murty 1974); the tolerance on the diagonal makes W one, redundant rows or not.

use super::Rows;
use crate::error::{Error, Result};
use crate::mass_block::envelope::Envelope;
use crate::mass_block::ldl::factorise_and_solve;
use crate::outcome::Kind;

/// Changes of sides at once that may fail to leave fewer wrong signs.
const PATIENCE: u32 = 5;

/// Solver with buffers that grow and are never given back.
#[derive(Debug, Default)]
pub struct Complementarity {
    /// x: impulse of each row (N s per m).
    pub impulse: Vec<f64>,
    /// Factorisations that the last solution took.
    pub iterations: usize,
    envelope: Envelope,
    gram: Vec<f64>,
    inside: Vec<bool>,
    values: Vec<f64>,
    pivots: Vec<f64>,
    solution: Vec<f64>,
    rates: Vec<f64>,
}

impl Complementarity {
    /// Fills `impulse`; returns the multiplications it took. `q` is the gap rate (m/s) that rows without force would have.
    ///
    /// What is left of W x + q at a row with force is `tolerance` of the rate W_cc x_c that its own force makes; signs are
    /// right to `tolerance` of the largest rate in q.
    ///
    /// # Errors
    /// No end in sight: more factorisations than any set of rows should need.
    pub(super) fn solve(&mut self, of: Rows, tolerance: f64, q: &[f64]) -> Result<usize> {
        let (n, analyses) = (of.rows.len(), self.envelope.analyses);
        self.envelope.update(of.rows);
        self.envelope.gram(of.inverse_mass, of.rows, &mut self.gram);
        let scale = tolerance * q.iter().fold(0.0, |most: f64, q| most.max(q.abs()));
        if analyses != self.envelope.analyses {
            self.inside.clear();
            self.inside.extend(self.envelope.order.iter().map(|&row| q[row as usize] < 0.0));
        }
        for place in 0..n {
            // A row over held degrees of freedom only cannot be moved by any force; the others begin as they last were.
            let two_sided = (self.envelope.order[place] as usize) < of.two_sided;
            self.inside[place] = self.diagonal(place) > 0.0 && (two_sided || self.inside[place]);
        }
        let (mut fewest, mut patience, most) = (n + 1, PATIENCE, 50 + 10 * n);
        for iteration in 1..=most {
            self.press(q, tolerance);
            let (wrong, last) = self.wrong(of.two_sided, scale);
            let Some(last) = last else {
                self.iterations = iteration;
                self.finish(of.two_sided, n);
                return Ok(iteration * (self.envelope.operations + self.gram.len()));
            };
            if wrong < fewest {
                (fewest, patience) = (wrong, PATIENCE);
            } else {
                patience = patience.saturating_sub(1);
            }
            for place in if patience > 0 { 0 } else { last }..=last {
                if self.is_wrong(place, of.two_sided, scale) {
                    self.inside[place] = !self.inside[place];
                }
            }
        }
        Err(Error::Run(Kind::NotFinite, format!("contact forces of {n} rows not found in {most} factorisations")))
    }

    fn diagonal(&self, place: usize) -> f64 {
        self.gram[self.envelope.start[place + 1] as usize - 1]
    }

    /// x of the rows inside, `W x + q` of all of them; both by place.
    fn press(&mut self, q: &[f64], tolerance: f64) {
        let Envelope { order, first, start, .. } = &self.envelope;
        self.values.clone_from(&self.gram);
        self.pivots.clear();
        self.solution.clear();
        self.rates.clear();
        for place in 0..order.len() {
            let (from, to, first) = (start[place] as usize, start[place + 1] as usize - 1, first[place] as usize);
            let (inside, q) = (self.inside[place], q[order[place] as usize]);
            for (value, other) in self.values[from..to].iter_mut().zip(&self.inside[first..]) {
                *value = if inside && *other { *value } else { 0.0 };
            }
            if !inside {
                self.values[to] = 1.0;
            }
            self.pivots.push(if inside { tolerance * self.gram[to] } else { 0.0 });
            self.solution.push(if inside { -q } else { 0.0 });
            self.rates.push(q);
        }
        factorise_and_solve(&self.envelope, &mut self.values, &mut self.pivots, &mut self.solution);
        let Envelope { first, start, .. } = &self.envelope;
        for (place, &first) in first.iter().enumerate() {
            let row = &self.gram[start[place] as usize..start[place + 1] as usize];
            let (mut rate, x) = (0.0, self.solution[place]);
            for (w, other) in row.iter().zip(first as usize..place) {
                rate += w * self.solution[other];
                self.rates[other] += w * x;
            }
            self.rates[place] += rate + row[row.len() - 1] * x;
        }
    }

    /// True for a row inside that pulls, and for one outside that approaches.
    fn is_wrong(&self, place: usize, two_sided: usize, scale: f64) -> bool {
        let w = self.diagonal(place);
        if w <= 0.0 || (self.envelope.order[place] as usize) < two_sided {
            return false;
        }
        if self.inside[place] { self.solution[place] * w < -scale } else { self.rates[place] < -scale }
    }

    /// How many signs are wrong, and the last place of them.
    fn wrong(&self, two_sided: usize, scale: f64) -> (usize, Option<usize>) {
        let wrong = |place: &usize| self.is_wrong(*place, two_sided, scale);
        (0..self.inside.len()).filter(wrong).fold((0, None), |(count, _), place| (count + 1, Some(place)))
    }

    fn finish(&mut self, two_sided: usize, rows: usize) {
        self.impulse.clear();
        self.impulse.resize(rows, 0.0);
        for (&row, &x) in self.envelope.order.iter().zip(&self.solution) {
            // A pull within the tolerance is none; f64::max would swallow NaN.
            self.impulse[row as usize] = if x < 0.0 && row as usize >= two_sided { 0.0 } else { x };
        }
    }
}
