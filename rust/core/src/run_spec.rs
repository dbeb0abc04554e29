//! What tells one run of a model from another, and the checks before it starts.

use std::sync::Arc;

use crate::critical_step::{assembled_bound, element_bound};
use crate::error::{Error, Result};
use crate::history::Record;
use crate::model::Model;
use crate::penalty::Method;
use crate::start::Start;
use crate::variant::Variation;

/// What tells one run of a model from another; costs little to keep until the run has its turn.
#[derive(Debug, Clone)]
pub struct RunSpec {
    /// Penalty method.
    pub method: Method,
    /// Time step (s).
    pub dt: f64,
    /// Steps to take, the last of them sampled; none for as many as asked for later.
    pub steps: Option<u64>,
    /// Accept a time step above the limits of the mesh.
    pub allow_unstable: bool,
    /// Initial velocity v_0 and displacement u_0.
    pub start: Arc<Start>,
    /// Velocity (m/s) that replaces v_0 on all nodes of a body, one entry a body.
    pub velocity: Option<Vec<Option<[f64; 2]>>>,
    /// Bodies stiffer, denser or elsewhere.
    pub variation: Option<Variation>,
    /// End the run when a nodal displacement passes this (m); infinite for no limit.
    pub displacement_limit: f64,
    /// What to record.
    pub record: Record,
}

impl RunSpec {
    /// Contact at every step, energies at every tenth, no limit.
    pub fn new(method: Method, dt: f64, start: Arc<Start>) -> Self {
        let (record, displacement_limit) =
            (Record { every: 1, energy_every: 10, snapshots: Vec::new() }, f64::INFINITY);
        let (steps, velocity, variation) = (None, None, None);
        Self { method, dt, steps, allow_unstable: false, start, velocity, variation, displacement_limit, record }
    }

    /// The model the run is of: a variant where bodies vary.
    ///
    /// # Errors
    /// A method, time step, velocity or variation out of bounds, bodies that overlap.
    pub(crate) fn checked_model(&self, base: &Arc<Model>) -> Result<Arc<Model>> {
        self.method.check("method")?;
        check_displacement_limit(self.displacement_limit)?;
        let model = match &self.variation {
            Some(variation) => Arc::new(base.variant(variation)?),
            None => base.clone(),
        };
        check_step(&model, self)?;
        if let Some(bodies) = &self.velocity {
            if bodies.len() != model.bodies.len() {
                let bound = format!("{} (one a body)", model.bodies.len());
                let remedy = "give one a body";
                return Err(Error::bound("run", "length of velocity", bodies.len(), &bound, remedy));
            }
            if let Some(v) = bodies.iter().flatten().flatten().find(|v| !v.is_finite()) {
                return Err(Error::bound("run", "velocity", v, "finite", "give m/s"));
            }
        }
        let moved = self.variation.as_ref().is_some_and(|v| v.offset.iter().any(|x| *x != [0.0; 2]));
        self.start.check_overlap(&model, moved)?;
        Ok(model)
    }
}

pub(crate) fn check_displacement_limit(limit: f64) -> Result<()> {
    if limit > 0.0 {
        return Ok(());
    }
    Err(Error::bound("run", "displacement_limit", limit, "> 0", "leave it out for no limit"))
}

pub(crate) fn check_step(model: &Model, spec: &RunSpec) -> Result<()> {
    let dt = spec.dt;
    if !(dt > 0.0 && dt.is_finite()) {
        return Err(Error::bound("run", "dt", dt, "> 0 and finite", "leave it out to take it from the mesh"));
    }
    if dt <= element_bound(model) || spec.allow_unstable {
        return Ok(());
    }
    // The element bound is cheap and safe; past it the assembled matrix has the last word.
    let limit = assembled_bound(model);
    if dt > limit {
        let bound = format!("<= {limit:.6e} s (2/omega_max of the mesh)");
        return Err(Error::bound("run", "dt", format!("{dt:.6e} s"), &bound, "reduce it, or pass allow_unstable=True"));
    }
    Ok(())
}
