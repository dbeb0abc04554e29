//! How a run ended, and the sentence that says why.

use crate::error::short;
use crate::history::History;

/// How a run stands or has ended; the text says which limit was passed, by how much, and what to change.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// Not over, or over without failure.
    Running,
    /// A displacement passed the limit given.
    DisplacementLimit(String),
    /// The state is no longer finite.
    Diverged(String),
}

impl Outcome {
    /// Short name for tables.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::DisplacementLimit(_) => "displacement limit passed",
            Self::Diverged(_) => "diverged",
        }
    }

    /// The sentence that says why; empty while nothing has failed.
    pub fn reason(&self) -> &str {
        match self {
            Self::Running => "",
            Self::DisplacementLimit(reason) | Self::Diverged(reason) => reason,
        }
    }
}

pub(crate) fn diverged(time: f64, dt: f64, element_omega: f64, history: &History) -> String {
    format!("displacement not finite at t = {} s; {}", short(time), cause(dt, element_omega, history))
}

pub(crate) fn passed_displacement_limit(
    (displacement, limit): (f64, f64),
    time: f64,
    dt: f64,
    element_omega: f64,
    history: &History,
) -> String {
    let cause = cause(dt, element_omega, history);
    let (displacement, limit, time) = (short(displacement), short(limit), short(time));
    format!("displacement {displacement} m passed the limit {limit} m at t = {time} s; {cause}")
}

/// Spectral limit passed, or energy made while inside it: judged by what the rows were when it happened.
fn cause(dt: f64, element_omega: f64, history: &History) -> String {
    let mesh = element_omega * dt;
    let row = history.peaks.row_omega2.sqrt() * dt;
    // Adding a row raises omega^2 by no more than the row's own (rank-one bound), and to no less than it.
    let together = mesh.hypot(row);
    let energy = short(history.energy_ratio());
    if mesh > 2.0 {
        format!("omega dt = {mesh:.3} of the elements is above 2: reduce dt")
    } else if row > 2.0 {
        format!(
            "time step instability: omega dt = {row:.3} of a contact row is above 2: lower p_s or add a mass penalty"
        )
    } else if together > 2.0 {
        format!(
            "time step instability: omega dt of elements and contact rows together reaches up to {together:.3}, above \
             2: lower p_s or add a mass penalty"
        )
    } else {
        format!(
            "energy made by contact switching ({energy} times the initial energy) though omega dt = \
             {together:.3} <= 2: lower p_s or add damping"
        )
    }
}
