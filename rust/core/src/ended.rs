//! What is left of a run: its history and a summary, without the buffers it ran in.

use crate::error::Error;
use crate::history::{History, Peaks};
use crate::outcome::{Kind, Outcome};
use crate::run::{Run, RunSpec};
use crate::step::Stepping;

/// Summary of a run.
#[derive(Debug, Clone)]
pub struct Summary {
    /// Steps taken.
    pub steps: u64,
    /// Steps it was to take; as many as it took where that was left open.
    pub planned: u64,
    /// Seconds of work.
    pub seconds: f64,
    /// How it stands, and whether contact made energy on the way.
    pub conclusion: Outcome,
    /// It ended before its time.
    pub stopped: bool,
    /// Peaks.
    pub peaks: Peaks,
    /// Energy at the last sample over that at the first, see `History::energy_ratio`.
    pub energy_ratio: f64,
    /// Most energy that contact had added, over what there was.
    pub energy_made: f64,
    /// Active rows, summed over the steps.
    pub row_steps: u64,
    /// Multiplications of factorisations for row forces, summed over the steps.
    pub block_operations: u64,
}

/// A run that is over.
#[derive(Debug, Clone)]
pub struct Ended {
    /// Summary.
    pub summary: Summary,
    /// Observations.
    pub history: History,
}

impl Summary {
    /// Of a run as it stands.
    pub fn of(run: &Run, lane: &Stepping) -> Self {
        let reference = run.watch.reference;
        Self {
            steps: run.steps,
            planned: run.end.unwrap_or(run.steps),
            seconds: run.seconds,
            conclusion: run.conclusion(lane),
            stopped: run.outcome != Outcome::Running,
            peaks: run.history.peaks,
            energy_ratio: run.history.energy_ratio(reference),
            energy_made: if reference > 0.0 { run.watch.gain() } else { 0.0 },
            row_steps: lane.row_steps,
            block_operations: lane.block_operations,
        }
    }

    fn unbegun(spec: &RunSpec, conclusion: Outcome) -> Self {
        let stopped = conclusion != Outcome::Running;
        Self {
            steps: 0,
            planned: spec.steps.unwrap_or(0),
            seconds: 0.0,
            conclusion,
            stopped,
            peaks: Peaks::default(),
            energy_ratio: f64::NAN,
            energy_made: 0.0,
            row_steps: 0,
            block_operations: 0,
        }
    }
}

impl Ended {
    /// A run taken out of its lane.
    pub fn new(run: Run, lane: &Stepping) -> Self {
        Self { summary: Summary::of(&run, lane), history: run.history }
    }

    /// A run that could not begin.
    pub fn refused(spec: &RunSpec, error: &Error) -> Self {
        let conclusion = Outcome::Failed(Kind::Refused, error.to_string());
        Self { summary: Summary::unbegun(spec, conclusion), history: History::default() }
    }

    /// A run whose turn has not come.
    pub fn waiting(spec: &RunSpec) -> Self {
        Self { summary: Summary::unbegun(spec, Outcome::Running), history: History::default() }
    }
}
