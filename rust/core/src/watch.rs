//! The watch: what the active rows do to the energy of the bodies, and how fast they swing. Rows only, every step.

use crate::energy::Energies;
use crate::lane::Lane;
use crate::mass_block::RowForces;
use crate::model::Model;
use crate::row::Row;

/// Share of the reference energy that contact may add before a run is said to make energy.
pub const TOLERANCE: f64 = 0.05;

/// Multiple of the reference energy at which a run has run away and stops.
pub const RUNAWAY: f64 = 100.0;

/// Work and frequencies of the rows so far.
#[derive(Debug, Clone, Default)]
pub struct Watch {
    /// Work of the rows on the bodies (J/m), `dt sum lambda G v_n`: exact for central differences.
    pub work: f64,
    /// Most that the work has been.
    pub most: f64,
    /// Energy the damping penalties have taken out (J/m).
    pub damping_loss: f64,
    /// Energy of the bodies had the rows done no work (J/m), the most of all samples.
    pub reference: f64,
    /// Kinetic and strain energy of the last sample (J/m).
    pub present: f64,
    /// Largest frequency squared of a single row (1/s^2).
    pub row_omega2: f64,
    /// Rows of the step whose frequencies squared had the largest sum: the set that swings fastest together.
    pub stiffest: Vec<Row>,
    stiffest_sum: f64,
}

impl Watch {
    /// Takes in the rows of a step; `after` is v_{n+1/2}.
    pub fn step(&mut self, model: &Model, dt: f64, rows: &[Row], forces: &RowForces, after: Lane) {
        let mut sum = 0.0;
        for ((row, lambda), before) in rows.iter().zip(&forces.lambda).zip(&forces.before) {
            let rate = 0.5 * (before + row.along(after));
            self.work += dt * lambda * rate;
            self.damping_loss += dt * row.penalties.alpha_d * rate * rate;
            let omega2 = row.omega2(&model.inverse_mass);
            self.row_omega2 = self.row_omega2.max(omega2);
            sum += omega2;
        }
        if sum > self.stiffest_sum {
            self.stiffest_sum = sum;
            self.stiffest.clear();
            self.stiffest.extend_from_slice(rows);
        }
        // Lets NaN through, unlike f64::max.
        self.most = if self.work <= self.most { self.most } else { self.work };
    }

    /// Takes in a sample of the bodies' energies.
    pub fn sample(&mut self, energies: &Energies) {
        self.reference = self.reference.max(energies.half_step - self.work);
        self.present = energies.kinetic + energies.strain;
    }

    /// True when contact has added more than `share` of the reference energy, or when that is not a number.
    pub fn passed(&self, share: f64) -> bool {
        self.reference > 0.0 && (self.most.is_nan() || self.most > share * self.reference)
    }

    /// True when the bodies have much more energy than they had and contact gave them: the mesh itself is unstable.
    pub fn swollen(&self) -> bool {
        let known = 2.0 * (self.reference + self.most);
        self.present.is_nan() || self.present > known
    }

    /// Energy added by the rows over the reference.
    pub fn gain(&self) -> f64 {
        self.most / self.reference
    }
}
