//! One step: the algorithm box, for all lanes.

use std::sync::Arc;

use crate::contact::search::Search;
use crate::contact::travel::Travel;
use crate::error::{Error, Result};
use crate::lane::{Lane, add_to};
use crate::mass_block::{MassBlock, RowForces};
use crate::model::Model;
use crate::outcome::Kind;
use crate::pace::{Pace, advance_nodes};
use crate::penalty::{Known, Method};
use crate::row::Row;
use crate::state::State;
use crate::stiffness::Isa;

/// What one lane brings to the step: its model, time step and method, and the buffers of its rows.
///
/// The buffers grow with the active set and are never given back.
pub struct Stepping {
    /// The model, or the variant that the lane is of.
    pub model: Arc<Model>,
    /// Time step (s).
    pub dt: f64,
    /// Penalty method.
    pub method: Method,
    /// Candidate pairs of the broad phase.
    pub search: Search,
    /// Active rows.
    pub rows: Vec<Row>,
    /// Row forces.
    pub forces: RowForces,
    /// Mass block.
    pub block: MassBlock,
    /// Why the lane cannot go on, if so: it stands still then.
    pub fault: Option<Error>,
}

/// Central differences with bipenalty rows (THEORY: section 2), each lane from u_n, v_{n-1/2} to u_{n+1}, v_{n+1/2}.
///
/// A lane that cannot go on gets its `fault` and stays where it is.
pub fn step(
    model: &Model,
    isa: Isa,
    threads: usize,
    pace: &mut Pace,
    travel: &mut Travel,
    state: &mut State,
    lanes: &mut [Stepping],
) {
    travel.measure(isa, &state.displacement);
    for (number, lane) in lanes.iter_mut().enumerate() {
        lane.fault = lane.find_rows(state, travel, number).err();
        lane.measure_rates(state, number, |forces| &mut forces.before);
    }
    pace.stop_at_faults(lanes);
    advance_nodes(model, isa, threads, pace, state);
    for (number, lane) in lanes.iter_mut().enumerate().filter(|(_, lane)| !lane.rows.is_empty()) {
        lane.measure_rates(state, number, |forces| &mut forces.free);
        match lane.find_forces() {
            Ok(()) => lane.push_back(state, number),
            Err(fault) => lane.fault = Some(fault),
        }
    }
    state.turn();
}

impl Stepping {
    /// A lane at rest, without rows.
    pub fn new(model: Arc<Model>, dt: f64, method: Method) -> Self {
        let (search, block) = (Search::new(&model.pairs), MassBlock::default());
        Self { model, dt, method, search, rows: Vec::new(), forces: RowForces::default(), block, fault: None }
    }

    /// Rows active at u_n with their penalties.
    fn find_rows(&mut self, state: &State, travel: &mut Travel, lane: usize) -> Result<()> {
        let (model, u) = (&self.model, Lane::new(&state.displacement, state.lanes, lane));
        self.rows.clear();
        if self.search.keep(&model.pairs, &model.points, u, |body| travel.far(body, lane))? {
            travel.restart(lane, &state.displacement);
        }
        for (i, linear) in model.linear.iter().enumerate() {
            self.rows.push(linear.row((model.contacts.len() + i) as u32, u));
        }
        for (pair, candidates) in model.pairs.iter().zip(&self.search.candidates) {
            pair.rows(candidates, &model.points, u, &mut self.rows);
        }
        for row in &mut self.rows {
            let known = Known { row, inverse_mass: &model.inverse_mass, dt: self.dt };
            row.penalties = self.method.penalties(known);
        }
        Ok(())
    }

    /// `G v` of the rows, half a step before or after.
    fn measure_rates(&mut self, state: &State, lane: usize, rates: impl Fn(&mut RowForces) -> &mut Vec<f64>) {
        let (v, rates) = (Lane::new(&state.velocity, state.lanes, lane), rates(&mut self.forces));
        rates.clear();
        rates.extend(self.rows.iter().map(|row| row.along(v)));
    }

    /// `[M + G'PG] a = f - K u - G'(A_s g + A_d G v)`, solved for the row forces.
    fn find_forces(&mut self) -> Result<()> {
        self.block.forces(&self.model.inverse_mass, &self.rows, self.dt, &mut self.forces)?;
        let finite = self.forces.lambda.iter().all(|lambda| lambda.is_finite());
        if finite { Ok(()) } else { Err(Error::Run(Kind::NotFinite, "contact force is not finite".to_string())) }
    }

    /// `v += dt M^-1 G' lambda`, `u += dt^2 M^-1 G' lambda`.
    fn push_back(&self, state: &mut State, lane: usize) {
        for (row, lambda) in self.rows.iter().zip(&self.forces.lambda) {
            for (node, g) in row.entries() {
                let (w, impulse) = (self.model.inverse_mass[node as usize], self.dt * lambda);
                let dv = [impulse * g[0] * w[0], impulse * g[1] * w[1]];
                add_to(&mut state.velocity, state.lanes, lane, node, dv);
                add_to(&mut state.other, state.lanes, lane, node, dv.map(|dv| self.dt * dv));
            }
        }
    }
}
