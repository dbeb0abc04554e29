//! What a run has observed: contact at every step, energies at every few, snapshots at chosen ones.

use crate::energy::Energies;
use crate::mass_block::RowForces;
use crate::model::Model;
use crate::row::Row;

/// What to record.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Keep contact histories every so many steps; 0 keeps peaks only.
    pub every: u64,
    /// Sample energies every so many steps, besides the first and the last; 0 for those two alone.
    pub energy_every: u64,
    /// Steps at which displacement and velocity are kept.
    pub snapshots: Vec<u64>,
}

/// Peaks of the whole run, kept whatever else is recorded.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Peaks {
    /// Deepest penetration (m).
    pub penetration: f64,
    /// Largest total contact force (N/m).
    pub force: f64,
    /// Impulse of the total contact force (N s/m).
    pub impulse: f64,
    /// Largest displacement sampled (m).
    pub displacement: f64,
}

impl Peaks {
    /// Takes in the largest displacement (m) of an instant.
    pub fn see_displacement(&mut self, largest: f64) {
        // Lets NaN through, unlike f64::max.
        self.displacement = if largest <= self.displacement { self.displacement } else { largest };
    }
}

/// Displacement and velocity at one instant, in the scene's node numbers.
#[derive(Debug, Clone)]
pub struct Snapshot {
    /// Step.
    pub step: u64,
    /// Displacement u_n (m).
    pub displacement: Vec<f64>,
    /// Velocity v_n (m/s).
    pub velocity: Vec<f64>,
}

/// Steps that room is made for at once; a longer run makes more as it goes.
const MOST_RESERVED: u64 = 1 << 20;

/// Observations of one run.
#[derive(Debug, Clone, Default)]
pub struct History {
    /// Steps of the contact histories.
    pub steps: Vec<u64>,
    /// Total contact force (N/m), compression positive.
    pub force: Vec<f64>,
    /// Resultant (N/m) on each contact's first-named body, contact by contact within a step.
    pub force_on: Vec<[f64; 2]>,
    /// Deepest penetration (m).
    pub penetration: Vec<f64>,
    /// Number of active rows.
    pub active: Vec<u32>,
    /// Steps of the energy samples.
    pub energy_steps: Vec<u64>,
    /// Energies.
    pub energies: Vec<Energies>,
    /// Energy the damping penalties have taken out so far (J/m), at the energy samples.
    pub damping_loss: Vec<f64>,
    /// Momentum (N s/m) of each body, body by body within a sample.
    pub momentum: Vec<[f64; 2]>,
    /// Snapshots.
    pub snapshots: Vec<Snapshot>,
    /// Peaks.
    pub peaks: Peaks,
}

impl History {
    /// Makes room for a number of further steps, so that recording does not allocate.
    pub fn reserve(&mut self, model: &Model, record: &Record, steps: u64) {
        // A run of unknown length, ended by hand, must not ask for all the memory it might come to need.
        let steps = steps.min(MOST_RESERVED);
        let kept = steps.checked_div(record.every).map_or(0, |n| n as usize + 1);
        let sampled = steps.checked_div(record.energy_every).unwrap_or(0) as usize + 3;
        self.steps.reserve(kept);
        self.force.reserve(kept);
        self.force_on.reserve(kept * model.contacts.len());
        self.penetration.reserve(kept);
        self.active.reserve(kept);
        self.energy_steps.reserve(sampled);
        self.energies.reserve(sampled);
        self.damping_loss.reserve(sampled);
        self.momentum.reserve(sampled * model.bodies.len());
    }

    /// Takes in the rows of a step and their forces; `keep` adds them to the histories too.
    pub fn observe(&mut self, model: &Model, step: u64, dt: f64, rows: &[Row], forces: &RowForces, keep: bool) {
        let contacts = model.contacts.len();
        let first = self.force_on.len();
        if keep {
            self.force_on.resize(first + contacts, [0.0; 2]);
        }
        let (mut total, mut deepest, mut active) = (0.0, 0.0_f64, 0);
        for (row, lambda) in rows.iter().zip(&forces.lambda) {
            let source = row.source as usize;
            if source >= contacts {
                continue;
            }
            total += lambda;
            deepest = deepest.max(-row.gap);
            active += 1;
            if keep {
                let nodes = &model.bodies[model.contacts[source].body as usize].nodes;
                let on = &mut self.force_on[first + source];
                for (_, g) in row.entries().filter(|(node, _)| nodes.contains(&(*node as usize))) {
                    *on = [on[0] + lambda * g[0], on[1] + lambda * g[1]];
                }
            }
        }
        self.peaks.penetration = self.peaks.penetration.max(deepest);
        self.peaks.force = self.peaks.force.max(total);
        self.peaks.impulse += dt * total;
        if keep {
            self.steps.push(step);
            self.force.push(total);
            self.penetration.push(deepest);
            self.active.push(active);
        }
    }

    /// Takes in an energy sample.
    pub fn sample(&mut self, step: u64, energies: Energies, damping_loss: f64, momentum: &[[f64; 2]]) {
        self.energy_steps.push(step);
        self.energies.push(energies);
        self.damping_loss.push(damping_loss);
        self.momentum.extend_from_slice(momentum);
        self.peaks.see_displacement(energies.max_displacement);
    }

    /// Energy at the last sample over that at the first, with the work of the body forces taken out, in units of the
    /// most energy (kinetic and strain) that has been there without contact's doing; NaN before any sample.
    pub fn energy_ratio(&self, reference: f64) -> f64 {
        match (self.energies.first(), self.energies.last()) {
            (Some(first), Some(last)) if reference > 0.0 => 1.0 + (last.total() - first.total()) / reference,
            (Some(_), Some(_)) => 1.0,
            _ => f64::NAN,
        }
    }
}
