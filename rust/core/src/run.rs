//! A run: one state over a model, its history and its outcome.

use std::sync::Arc;

use crate::contact::overlap;
use crate::critical_step::element_bound;
use crate::energy;
use crate::error::{Error, Result};
use crate::history::{History, Record, Snapshot};
use crate::lane::Lane;
use crate::model::Model;
use crate::outcome::{Limits, Outcome};
use crate::penalty::Method;
use crate::state::State;
use crate::step::{Settings, Workspace, step};
use crate::stiffness::Isa;

/// What tells one run of a model from another.
#[derive(Debug, Clone)]
pub struct RunSpec {
    /// Penalty method.
    pub method: Method,
    /// Time step (s).
    pub dt: f64,
    /// Accept a time step above the element bound.
    pub allow_unstable: bool,
    /// Initial velocity v_0 (m/s), two a node.
    pub velocity: Vec<f64>,
    /// Initial displacement u_0 (m), two a node.
    pub displacement: Vec<f64>,
    /// End the run when a nodal displacement passes this (m); infinite for no limit.
    pub displacement_limit: f64,
}

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
        let penalties = |young| spec.method.penalties(young, spec.dt);
        let settings = Settings {
            dt: spec.dt,
            pairs: model.pairs.iter().map(|p| penalties(p.young)).collect(),
            linear: model.linear.iter().map(|l| penalties(l.young)).collect(),
            isa: Isa::detect(),
        };
        Ok(Self {
            settings,
            before: vec![0.0; state.velocity.len()],
            state,
            work: Workspace::new(&model),
            history: History::default(),
            record: Record { every: 1, energy_every: 10, snapshots: Vec::new() },
            outcome: Outcome::Running,
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
                self.outcome = Outcome::Diverged(error.to_string());
            }
        }
    }

    fn one_step(&mut self, last: bool) -> Result<()> {
        let n = self.state.steps;
        let snapshot = self.record.snapshots.binary_search(&n).is_ok();
        let sample = last || n.is_multiple_of(self.record.energy_every);
        if sample || snapshot {
            self.before.copy_from_slice(&self.state.velocity);
        }
        step(&self.model, &self.settings, &mut self.state, &mut self.work)?;

        let (rows, forces, dt) = (&self.work.rows, &self.work.forces, self.settings.dt);
        let keep = self.record.every > 0 && (last || n.is_multiple_of(self.record.every));
        self.history.observe(&self.model, n, dt, rows, forces, keep);
        if snapshot {
            let velocity = self.before.iter().zip(&self.state.velocity).map(|(a, b)| 0.5 * (a + b)).collect();
            self.history.snapshots.push(Snapshot { step: n, displacement: self.state.other.clone(), velocity });
        }
        if sample {
            let e = energy::sample(&self.model, dt, &self.state, &self.before, rows, forces, &mut self.momentum);
            self.history.sample(n, e, &self.momentum);
            self.judge(n, e.max_displacement);
        }
        Ok(())
    }

    fn judge(&mut self, n: u64, displacement: f64) {
        let penalties = self.settings.pairs.iter().chain(&self.settings.linear);
        let limits = Limits {
            time: n as f64 * self.settings.dt,
            dt: self.settings.dt,
            element_omega: self.model.element_omega(),
            row_omega: self.history.peaks.row_omega2.sqrt(),
            // Without a mass penalty the frequencies of mesh and rows add up; with one, the larger of them and R rules.
            mass_penalty: penalties.clone().all(|p| p.alpha_s == 0.0 || p.alpha_m > 0.0),
            ratio: penalties.map(|p| p.alpha_s / p.alpha_m).fold(0.0, f64::max),
            energy_ratio: self.history.energy_ratio(),
        };
        if !displacement.is_finite() {
            self.outcome = Outcome::Diverged(limits.diverged());
        } else if displacement > self.displacement_limit {
            let reason = limits.passed_displacement(displacement, self.displacement_limit);
            self.outcome = Outcome::DisplacementLimit(reason);
        }
    }
}

fn check_displacement_limit(limit: f64) -> Result<()> {
    if limit > 0.0 {
        return Ok(());
    }
    Err(Error::bound("run", "displacement_limit", limit, "> 0", "leave it out for no limit"))
}

fn check_step(model: &Model, spec: &RunSpec) -> Result<()> {
    let (dt, limit) = (spec.dt, element_bound(model));
    if !(dt > 0.0 && dt.is_finite()) {
        return Err(Error::bound("run", "dt", dt, "> 0 and finite", "leave it out to take it from the mesh"));
    }
    if dt > limit && !spec.allow_unstable {
        let bound = format!("<= {limit:.6e} s (2/omega_max of the elements)");
        return Err(Error::bound("run", "dt", format!("{dt:.6e} s"), &bound, "reduce it, or pass allow_unstable=True"));
    }
    Ok(())
}

fn check_overlap(model: &Model, displacement: Lane) -> Result<()> {
    for pair in &model.pairs {
        let contact = &model.contacts[pair.contact as usize];
        let Some((node, depth)) = overlap::deepest(pair, &model.points, displacement) else {
            continue;
        };
        if depth > contact.overlap_tolerance {
            let [first, second] = &contact.names;
            let body = &model.bodies[pair.secondary_body as usize];
            let what = format!("overlap at node {} of \"{}\"", node as usize - body.nodes.start, body.name);
            let bound = format!("<= {:.3e} m at the start", contact.overlap_tolerance);
            let object = format!("contact \"{first}\" on \"{second}\"");
            let remedy = "move the bodies apart or raise the contact's overlap_tolerance";
            return Err(Error::bound(&object, &what, format!("{depth:.3e} m"), &bound, remedy));
        }
    }
    Ok(())
}
