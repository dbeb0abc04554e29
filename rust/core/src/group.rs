//! A group: runs side by side in the lanes of one state, advanced by one pass over K.

use std::sync::Arc;

use crate::contact::travel::Travel;
use crate::crew::Crew;
use crate::due::Due;
use crate::energy::After;
use crate::error::Result;
use crate::lane::Lane;
use crate::model::Model;
use crate::nodal_sums::{self, NodalSums, nodal_sums};
use crate::pace::Pace;
use crate::run::{Run, RunSpec, Seen};
use crate::shape;
use crate::state::State;
use crate::step::{Stepping, step};
use crate::stiffness::{Aligned, Isa};

/// Widths that a group can have.
pub const WIDTHS: [usize; 5] = [1, 2, 4, 8, MOST];

/// Most lanes of a group.
pub const MOST: usize = 16;

/// Runs in lanes: run i is in lane i, lanes beyond the runs are empty.
pub struct Group {
    /// The model that all lanes share, or are variants of.
    pub model: Arc<Model>,
    /// Instruction set.
    pub isa: Isa,
    /// Threads that share each step.
    pub crew: Crew,
    /// Displacements and velocities.
    pub state: State,
    /// What each lane brings to the step.
    pub lanes: Vec<Stepping>,
    /// What is observed of each.
    pub runs: Vec<Run>,
    pace: Pace,
    travel: Travel,
    before: Aligned,
    sums: Vec<NodalSums>,
}

impl Group {
    /// A group without runs; `width` is one of `WIDTHS`.
    pub fn new(model: Arc<Model>, isa: Isa, width: usize) -> Self {
        let (state, pace) = (State::new(model.points.len(), width), Pace::new(model.bodies.len(), width));
        let (lanes, runs) = (Vec::with_capacity(width), Vec::with_capacity(width));
        let travel = Travel::new(&model.pairs, width);
        Self {
            model,
            isa,
            crew: Crew::default(),
            state,
            lanes,
            runs,
            pace,
            travel,
            before: Aligned::zeros(0),
            sums: Vec::new(),
        }
    }

    /// A run alone.
    ///
    /// # Errors
    /// As for `begin`.
    pub fn alone(model: Arc<Model>, isa: Isa, spec: &RunSpec) -> Result<Self> {
        let mut group = Self::new(model, isa, 1);
        group.begin(spec)?;
        Ok(group)
    }

    /// Number of lanes.
    pub fn width(&self) -> usize {
        self.state.lanes
    }

    /// Begins a run in the first empty lane; there must be one.
    ///
    /// # Errors
    /// A specification out of its bounds, bodies that overlap.
    pub fn begin(&mut self, spec: &RunSpec) -> Result<()> {
        debug_assert!(self.runs.len() < self.width());
        let (model, lane) = (spec.checked_model(&self.model)?, self.runs.len());
        self.state.begin(lane, &model, &spec.start, spec.velocity.as_deref(), spec.dt);
        self.pace.set(lane, &model, spec.dt);
        self.runs.push(Run::new(&model, spec));
        self.lanes.push(Stepping::new(model, spec.dt, spec.method));
        Ok(())
    }

    /// Takes a run out; the last one moves to its lane.
    pub fn take(&mut self, lane: usize) -> (Run, Stepping) {
        let last = self.runs.len() - 1;
        let taken = (self.runs.swap_remove(lane), self.lanes.swap_remove(lane));
        if lane != last {
            self.state.copy_lane(last, lane);
            self.travel.copy_lane(last, lane);
            self.pace.set(lane, &self.lanes[lane].model, self.lanes[lane].dt);
        }
        self.state.clear_lane(last);
        self.pace.stop(last);
        taken
    }

    /// The narrowest width that holds a number of runs, those that are there at least.
    pub fn resize(&mut self, runs: usize) {
        let runs = runs.max(self.runs.len());
        let width = WIDTHS.into_iter().find(|width| *width >= runs).unwrap_or(MOST);
        if width == self.width() {
            return;
        }
        self.state = self.state.resized(width);
        self.travel = self.travel.resized(width);
        self.pace = Pace::new(self.model.bodies.len(), width);
        for (number, lane) in self.lanes.iter().enumerate() {
            self.pace.set(number, &lane.model, lane.dt);
        }
    }

    /// Takes up to `steps` steps, fewer if a run is over before or then; returns the steps taken.
    ///
    /// A failure ends its run with an outcome; it is not an error of this call.
    pub fn advance(&mut self, steps: u64) -> u64 {
        let crew = self.crew.clone();
        crew.work(|| self.take_steps(steps))
    }

    fn take_steps(&mut self, steps: u64) -> u64 {
        for taken in 0..steps {
            if self.runs.iter().any(Run::is_over) {
                return taken;
            }
            self.one_step();
        }
        steps
    }

    fn one_step(&mut self) {
        let all = self.runs.iter().map(Run::due).fold(Due::default(), Due::or);
        if all.look || all.snapshot {
            if self.before.len() != self.state.velocity.len() {
                self.before = Aligned::zeros(self.state.velocity.len());
            }
            self.before.copy_from_slice(&self.state.velocity);
        }
        step(
            &self.model,
            self.isa,
            self.crew.threads(),
            &mut self.pace,
            &mut self.travel,
            &mut self.state,
            &mut self.lanes,
        );
        let shapes = self.look(all.look, all.shapes);
        let width = self.width();
        for (number, (run, lane)) in self.runs.iter_mut().zip(&self.lanes).enumerate() {
            let of = |values| Lane::new(values, width, number);
            let (state, due) = (&self.state, run.due());
            let after = After {
                before: of(&self.before),
                velocity: of(&state.velocity),
                displacement: of(&state.other),
                next: of(&state.displacement),
            };
            if due.snapshot {
                let one = |values| lane.model.order.flat_outward(state.one(values, number));
                run.snapshot(one(&state.other), &one(&self.before), &one(&state.velocity));
            }
            let seen = all.look.then(|| Seen { sums: &self.sums, width, lane: number, inverted: shapes[number] });
            run.observe(lane, &after, due, seen);
        }
    }

    /// Sums over the nodes of all lanes, and which lanes have an inverted element, where any run wants them.
    fn look(&mut self, sums: bool, shapes: bool) -> [bool; MOST] {
        let state = &self.state;
        let after = nodal_sums::After { before: &self.before, velocity: &state.velocity, displacement: &state.other };
        if sums {
            nodal_sums(self.isa, &self.model, state.lanes, &after, &mut self.sums);
        }
        let mut inverted = [false; MOST];
        if shapes {
            shape::inverted(self.isa, &self.model, state.lanes, &state.other, &mut inverted);
        }
        inverted
    }
}
