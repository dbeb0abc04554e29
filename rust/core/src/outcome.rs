//! How a run ended, and the sentence that says why.

use crate::error::short;

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

/// What a run's end is judged by.
pub(crate) struct Limits {
    /// Time of the end (s).
    pub time: f64,
    /// Time step (s).
    pub dt: f64,
    /// Largest element frequency (rad/s).
    pub element_omega: f64,
    /// Largest frequency of a single row so far (rad/s).
    pub row_omega: f64,
    /// True when every row with stiffness has a mass penalty too.
    pub mass_penalty: bool,
    /// Largest penalty ratio R (1/s^2).
    pub ratio: f64,
    /// Total energy over that at the start.
    pub energy_ratio: f64,
}

impl Limits {
    pub(crate) fn diverged(&self) -> String {
        format!("displacement not finite at t = {} s; {}", short(self.time), self.cause())
    }

    pub(crate) fn passed_displacement(&self, displacement: f64, limit: f64) -> String {
        let (displacement, limit, time) = (short(displacement), short(limit), short(self.time));
        format!("displacement {displacement} m passed the limit {limit} m at t = {time} s; {}", self.cause())
    }

    /// Spectral limit passed, or energy made while inside it.
    fn cause(&self) -> String {
        let (mesh, row) = (self.element_omega * self.dt, self.row_omega * self.dt);
        // A row raises omega^2 by no more than its own (rank-one bound) and to no less than it; with a mass penalty
        // the larger of omega_0^2 and R bounds it for any number of rows.
        let ratio = self.ratio.sqrt() * self.dt;
        let bound = if self.mass_penalty { mesh.max(ratio) } else { mesh.hypot(row) };
        let energy = short(self.energy_ratio);
        if mesh > 2.0 {
            format!("time step instability: omega dt = {} of the elements is above 2: reduce dt", short(mesh))
        } else if self.mass_penalty && ratio > 2.0 {
            let what = "of the penalty ratio, sqrt(R) dt,";
            format!("time step instability: omega dt = {} {what} is above 2: lower R to 4/dt^2", short(ratio))
        } else if bound > 2.0 {
            let which = if row > 2.0 { short(row) } else { format!("up to {}", short(bound)) };
            format!(
                "time step instability: omega dt = {which} with the contact rows is above 2: lower p_s or add a mass \
                 penalty"
            )
        } else {
            format!(
                "energy made by contact switching ({energy} times the initial energy) though omega dt = {} is within \
                 2: lower p_s or add damping",
                short(bound)
            )
        }
    }
}
