//! A run: one state over a model, its history and its outcome.

use std::sync::Arc;

use crate::contact::crossing;
use crate::energy;
use crate::error::{Result, short};
use crate::history::{History, Record, Snapshot};
use crate::lane::Lane;
use crate::model::Model;
use crate::outcome::{Judge, Kind, Outcome};
use crate::run_spec::{check_displacement_limit, check_overlap, check_step};
use crate::state::State;
use crate::step::{Settings, Workspace, step};
use crate::stiffness::Isa;
use crate::watch::{RUNAWAY, TOLERANCE, Watch};

pub use crate::run_spec::RunSpec;

/// Steps between two looks at displacements and energies, where they are not sampled more often: some 5 ns a node each.
const LOOK_EVERY: u64 = 50;

/// Steps between two looks at the shapes of the elements.
const SHAPE_EVERY: u64 = 100;

/// One run.
pub struct Run {
    /// The model, shared between runs.
    pub model: Arc<Model>,
    /// Time step and penalties.
    pub settings: Settings,
    /// Displacement and velocity.
    pub state: State,
    /// Buffers of the step.
    pub work: Workspace,
    /// Observations.
    pub history: History,
    /// What is being recorded.
    pub record: Record,
    /// How the run stands.
    pub outcome: Outcome,
    /// Work and frequencies of the rows.
    pub watch: Watch,
    displacement_limit: f64,
    before: Vec<f64>,
    momentum: Vec<[f64; 2]>,
}

impl Run {
    /// Starts a run at t = 0.
    ///
    /// # Errors
    /// A method or time step out of bounds, an initial state that does not fit, bodies that overlap.
    pub fn new(model: Arc<Model>, spec: &RunSpec) -> Result<Self> {
        spec.method.check("method")?;
        check_step(&model, spec)?;
        check_displacement_limit(spec.displacement_limit)?;
        let state = State::new(&model, &spec.velocity, &spec.displacement, spec.dt)?;
        check_overlap(&model, Lane::new(&state.displacement, 1, 0))?;
        let settings = Settings { dt: spec.dt, method: spec.method, isa: Isa::detect() };
        Ok(Self {
            settings,
            before: vec![0.0; state.velocity.len()],
            state,
            work: Workspace::new(&model),
            history: History::default(),
            record: Record { every: 1, energy_every: 10, snapshots: Vec::new() },
            outcome: Outcome::Running,
            watch: Watch::default(),
            displacement_limit: spec.displacement_limit,
            momentum: vec![[0.0; 2]; model.bodies.len()],
            model,
        })
    }

    /// Ends the run from now on when a nodal displacement passes `limit` (m); infinite for no limit.
    ///
    /// # Errors
    /// A limit that is not positive.
    pub fn set_displacement_limit(&mut self, limit: f64) -> Result<()> {
        check_displacement_limit(limit)?;
        self.displacement_limit = limit;
        Ok(())
    }

    /// Time t_n (s).
    pub fn time(&self) -> f64 {
        self.state.steps as f64 * self.settings.dt
    }

    /// Takes up to `steps` steps, fewer if the run ends; the last of them is sampled when `last` says so.
    ///
    /// A failure ends the run with an outcome; it is not an error of this call.
    pub fn advance(&mut self, steps: u64, last: bool) {
        for i in 0..steps {
            if self.outcome != Outcome::Running {
                return;
            }
            if let Err(error) = self.one_step(last && i + 1 == steps) {
                self.fail(error.kind(), &error.to_string());
            }
        }
    }

    /// How the run stands, and whether contact has made energy on the way.
    pub fn conclusion(&self) -> Outcome {
        match &self.outcome {
            Outcome::Running if self.watch.passed(TOLERANCE) => self.judge().outcome(Kind::EnergyMade, ""),
            // Past a limit, and yet nothing has come of it so far, or nothing that contact did.
            Outcome::Running if self.judge().past_a_limit() => self.judge().outcome(Kind::SpectralInstability, ""),
            outcome => outcome.clone(),
        }
    }

    fn one_step(&mut self, last: bool) -> Result<()> {
        let n = self.state.steps;
        let snapshot = self.record.snapshots.binary_search(&n).is_ok();
        let sample = last || n.is_multiple_of(self.record.energy_every);
        // What is recorded is the caller's choice; what is watched is not.
        let look = sample || n.is_multiple_of(LOOK_EVERY);
        if look || snapshot {
            self.before.copy_from_slice(&self.state.velocity);
        }
        step(&self.model, &self.settings, &mut self.state, &mut self.work)?;

        let (rows, forces, dt) = (&self.work.rows, &self.work.forces, self.settings.dt);
        self.watch.step(&self.model, dt, rows, forces, Lane::new(&self.state.velocity, self.state.lanes, 0));
        let keep = self.record.every > 0 && (last || n.is_multiple_of(self.record.every));
        self.history.observe(&self.model, n, dt, rows, forces, keep);
        if snapshot {
            let velocity = self.before.iter().zip(&self.state.velocity).map(|(a, b)| 0.5 * (a + b)).collect();
            self.history.snapshots.push(Snapshot { step: n, displacement: self.state.other.clone(), velocity });
        }
        if look {
            let e = energy::sample(&self.model, dt, &self.state, &self.before, rows, forces, &mut self.momentum);
            self.watch.sample(&e);
            if sample {
                self.history.sample(n, e, self.watch.damping_loss, &self.momentum);
            }
            self.look_at(e.max_displacement, last || n.is_multiple_of(SHAPE_EVERY));
        }
        if self.watch.passed(RUNAWAY) {
            self.fail(Kind::EnergyMade, "energy ran away");
        }
        Ok(())
    }

    fn look_at(&mut self, displacement: f64, shapes: bool) {
        if !displacement.is_finite() {
            self.fail(Kind::NotFinite, "displacement is not finite");
        } else if displacement > self.displacement_limit {
            let (found, limit) = (short(displacement), short(self.displacement_limit));
            self.fail(Kind::DisplacementLimit, &format!("displacement {found} m passed the limit {limit} m"));
        } else if let Some((step, most)) = self.too_fast() {
            let (step, most) = (short(step), short(most));
            let seen = format!("surfaces moved {step} m in one step, contact follows {most} m: reduce dt or speed;");
            self.fail(Kind::ContactMissed, &seen);
        } else if let Some(element) = shapes.then(|| self.model.inverted(&self.state.other)).flatten() {
            self.fail(Kind::ElementInverted, &format!("{element} has no area left"));
        }
    }

    fn too_fast(&self) -> Option<(f64, f64)> {
        let lane = |values| Lane::new(values, self.state.lanes, 0);
        let motion = crossing::Motion {
            points: &self.model.points,
            displacement: lane(&self.state.other),
            velocity: lane(&self.state.velocity),
            dt: self.settings.dt,
        };
        // One step beyond the next look.
        crossing::too_fast(&self.model.pairs, &self.work.search.candidates, motion, LOOK_EVERY as f64 + 1.0)
    }

    fn fail(&mut self, kind: Kind, seen: &str) {
        if self.outcome != Outcome::Running {
            return;
        }
        let n = self.state.steps.saturating_sub(1);
        if self.history.energy_steps.last() != Some(&n) {
            let e = energy::at_the_end(&self.model, &self.state, &self.work.rows, &mut self.momentum);
            self.history.sample(n, e, self.watch.damping_loss, &self.momentum);
        }
        self.outcome = self.judge().outcome(kind, seen);
    }

    fn judge(&self) -> Judge<'_> {
        let dt = self.settings.dt;
        let time = self.state.steps.saturating_sub(1) as f64 * dt;
        Judge { model: &self.model, watch: &self.watch, time, dt, ratio: self.settings.method.mass.ratio(dt) }
    }
}
