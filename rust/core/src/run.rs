//! A run: what is observed and watched of one lane, and how it ends.

use crate::contact::crossing;
use crate::due::Due;
use crate::energy::{self, After};
use crate::error::short;
use crate::history::{History, Record, Snapshot};
use crate::model::Model;
use crate::nodal_sums::NodalSums;
use crate::outcome::{Judge, Kind, Outcome};
use crate::run_spec::check_displacement_limit;
use crate::shape::first_inverted;
use crate::step::Stepping;
use crate::watch::{RUNAWAY, TOLERANCE, Watch};

pub use crate::run_spec::RunSpec;

/// Steps between two looks at displacements and energies, where they are not sampled more often: some 5 ns a node each.
const LOOK_EVERY: u64 = 50;

/// Steps between two looks at the shapes of the elements.
const SHAPE_EVERY: u64 = 100;

/// Observations of one lane and its outcome.
pub struct Run {
    /// Steps taken.
    pub steps: u64,
    /// Steps to take; the last of them is sampled.
    pub end: Option<u64>,
    /// Observations.
    pub history: History,
    /// What is being recorded.
    pub record: Record,
    /// How the run stands.
    pub outcome: Outcome,
    /// Work and frequencies of the rows.
    pub watch: Watch,
    /// Seconds of work, its share where lanes work together.
    pub seconds: f64,
    displacement_limit: f64,
    momentum: Vec<[f64; 2]>,
}

/// What a look at a lane finds: its sums over the nodes of each body, and whether an element has no area left.
pub struct Seen<'a> {
    /// Sums of all lanes, lane by lane within a body.
    pub sums: &'a [NodalSums],
    /// Number of lanes.
    pub width: usize,
    /// The lane looked at.
    pub lane: usize,
    /// An element has no area left.
    pub inverted: bool,
}

impl Run {
    /// A run that is to begin.
    pub fn new(model: &Model, spec: &RunSpec) -> Self {
        Self {
            steps: 0,
            end: spec.steps,
            history: History::default(),
            record: spec.record.clone(),
            outcome: Outcome::Running,
            watch: Watch::default(),
            seconds: 0.0,
            displacement_limit: spec.displacement_limit,
            momentum: vec![[0.0; 2]; model.bodies.len()],
        }
    }

    /// Ends the run from now on when a nodal displacement passes `limit` (m); infinite for no limit.
    ///
    /// # Errors
    /// A limit that is not positive.
    pub fn set_displacement_limit(&mut self, limit: f64) -> crate::error::Result<()> {
        check_displacement_limit(limit)?;
        self.displacement_limit = limit;
        Ok(())
    }

    /// True when no step is left, by an outcome or by the end.
    pub fn is_over(&self) -> bool {
        self.outcome != Outcome::Running || self.end.is_some_and(|end| self.steps >= end)
    }

    /// What is to be seen of the next step.
    pub fn due(&self) -> Due {
        let (n, last) = (self.steps, self.is_last());
        let every = self.record.energy_every;
        let sample = last || n == 0 || (every > 0 && n.is_multiple_of(every));
        let look = sample || n.is_multiple_of(LOOK_EVERY);
        let shapes = last || n.is_multiple_of(SHAPE_EVERY);
        Due { sample, look, shapes, snapshot: self.record.snapshots.binary_search(&n).is_ok() }
    }

    fn is_last(&self) -> bool {
        self.end == Some(self.steps + 1)
    }

    /// Takes in a step: rows and forces always, the state as far as it has been `seen`.
    pub fn observe(&mut self, lane: &Stepping, after: &After, due: Due, seen: Option<Seen>) {
        let (n, last) = (self.steps, self.is_last());
        self.steps += 1;
        if let Some(error) = &lane.fault {
            self.fail(lane, after, error.kind(), &error.to_string());
            return;
        }
        self.watch.step(&lane.model, lane.dt, &lane.rows, &lane.forces, after.velocity);
        let keep = self.record.every > 0 && (last || n.is_multiple_of(self.record.every));
        self.history.observe(&lane.model, n, lane.dt, &lane.rows, &lane.forces, keep);
        if let Some(seen) = seen.filter(|_| due.look) {
            let sums = seen.sums.iter().skip(seen.lane).step_by(seen.width);
            let e = energy::sample(&lane.model, lane.dt, sums, after, &lane.rows, &lane.forces, &mut self.momentum);
            if due.sample {
                self.history.sample(n, e, self.watch.damping_loss, &self.momentum);
            }
            self.watch.sample(&e);
            self.history.peaks.see_displacement(e.max_displacement);
            self.look_at(lane, after, e.max_displacement, due.shapes && seen.inverted);
        }
        if self.watch.passed(RUNAWAY) {
            self.fail(lane, after, Kind::EnergyMade, "energy ran away");
        }
    }

    /// Keeps displacement and velocity at t_n; the arrays have the scene's node numbers.
    pub fn snapshot(&mut self, displacement: Vec<f64>, before: &[f64], after: &[f64]) {
        let velocity = before.iter().zip(after).map(|(a, b)| 0.5 * (a + b)).collect();
        self.history.snapshots.push(Snapshot { step: self.steps, displacement, velocity });
    }

    fn look_at(&mut self, lane: &Stepping, after: &After, displacement: f64, inverted: bool) {
        if !displacement.is_finite() {
            self.fail(lane, after, Kind::NotFinite, "displacement is not finite");
        } else if displacement > self.displacement_limit {
            let (found, limit) = (short(displacement), short(self.displacement_limit));
            let seen = format!("displacement {found} m passed the limit {limit} m");
            self.fail(lane, after, Kind::DisplacementLimit, &seen);
        } else if let Some((step, most)) = too_fast(lane, after) {
            self.fail(lane, after, Kind::ContactMissed, &crossing::missed(step, most));
        } else if inverted {
            let element = first_inverted(&lane.model, after.displacement).unwrap_or_else(|| "an element".into());
            self.fail(lane, after, Kind::ElementInverted, &format!("{element} has no area left"));
        }
    }

    fn fail(&mut self, lane: &Stepping, after: &After, kind: Kind, seen: &str) {
        if self.outcome != Outcome::Running {
            return;
        }
        let n = self.steps.saturating_sub(1);
        if self.history.energy_steps.last() != Some(&n) {
            let (u, v) = (after.next, after.velocity);
            let e = energy::at_the_end(&lane.model, u, v, &lane.rows, &mut self.momentum);
            self.history.sample(n, e, self.watch.damping_loss, &self.momentum);
        }
        self.outcome = self.judge(lane).outcome(kind, seen);
    }

    /// How the run stands, and whether contact has made energy on the way.
    pub fn conclusion(&self, lane: &Stepping) -> Outcome {
        let judge = self.judge(lane);
        match &self.outcome {
            Outcome::Running if self.watch.passed(TOLERANCE) => judge.outcome(Kind::EnergyMade, ""),
            // Past a limit, and yet nothing has come of it so far, or nothing that contact did.
            Outcome::Running if judge.past_a_limit() => judge.outcome(Kind::SpectralInstability, ""),
            outcome => outcome.clone(),
        }
    }

    fn judge<'a>(&'a self, lane: &'a Stepping) -> Judge<'a> {
        let (dt, model) = (lane.dt, &*lane.model);
        let time = self.steps.saturating_sub(1) as f64 * dt;
        Judge {
            model,
            watch: &self.watch,
            time,
            dt,
            ratio: lane.method.ratio(dt),
            enforcement: lane.method.enforcement,
        }
    }
}

fn too_fast(lane: &Stepping, after: &After) -> Option<(f64, f64)> {
    let (displacement, velocity) = (after.displacement, after.velocity);
    let motion = crossing::Motion { points: &lane.model.points, displacement, velocity, dt: lane.dt };
    // One step beyond the next look.
    crossing::too_fast(&lane.model.pairs, &lane.search.candidates, motion, LOOK_EVERY as f64 + 1.0)
}
