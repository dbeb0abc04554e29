//! One step: the algorithm box, for all lanes.

use std::sync::Arc;

use crate::contact::search::Search;
use crate::contact::travel::Travel;
use crate::enforcement::complementarity::Complementarity;
use crate::enforcement::{Enforcement, Rows};
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
    /// Solver of multipliers.
    pub multipliers: Complementarity,
    /// Active rows, summed over the steps.
    pub row_steps: u64,
    /// Multiplications of factorisations for row forces, summed over the steps.
    pub block_operations: u64,
    /// Why the lane cannot go on, if so: it stands still then.
    pub fault: Option<Error>,
}

/// Central differences with bipenalty rows (THEORY: section 2), each lane from u_n, v_{n-1/2} to u_{n+1}, v_{n+1/2}.
///
/// Rows are those that penetrate at u_n, or, where the enforcement looks ahead, at u* where the bodies get without them.
/// A lane that cannot go on gets its `fault` and stays where it is, or, found only after the pass over K, goes without rows.
pub fn step(
    model: &Model,
    isa: Isa,
    threads: usize,
    pace: &mut Pace,
    travel: &mut Travel,
    state: &mut State,
    lanes: &mut [Stepping],
) {
    let ahead = lanes.iter().any(|lane| lane.method.enforcement.looks_ahead());
    travel.measure(isa, &state.displacement);
    for (number, lane) in lanes.iter_mut().enumerate() {
        lane.rows.clear();
        if !lane.method.enforcement.looks_ahead() {
            lane.fault = lane.find_rows(travel, &state.displacement, state.lanes, number).err();
            lane.measure_rates(state, number, |forces| &mut forces.before);
        }
    }
    pace.stop_at_faults(lanes);
    advance_nodes(model, isa, threads, pace, state);
    if ahead {
        travel.measure(isa, &state.other);
    }
    for (number, lane) in lanes.iter_mut().enumerate() {
        if lane.method.enforcement.looks_ahead() {
            lane.fault = lane.look_ahead(travel, state, number).err();
        }
        if lane.rows.is_empty() {
            continue;
        }
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
        Self {
            search: Search::new(&model.pairs),
            model,
            dt,
            method,
            rows: Vec::new(),
            forces: RowForces::default(),
            block: MassBlock::default(),
            multipliers: Complementarity::default(),
            row_steps: 0,
            block_operations: 0,
            fault: None,
        }
    }

    /// Rows active at a displacement, [node][axis][lane], with their penalties; there must be none yet.
    fn find_rows(&mut self, travel: &mut Travel, displacement: &[f64], lanes: usize, lane: usize) -> Result<()> {
        let (model, u) = (&self.model, Lane::new(displacement, lanes, lane));
        if self.search.keep(&model.pairs, &model.points, u, |pair| travel.of(pair, lane))? {
            travel.restart(lane, displacement);
        }
        for (i, linear) in model.linear.iter().enumerate() {
            self.rows.push(linear.row((model.contacts.len() + i) as u32, u));
        }
        for (pair, candidates) in model.pairs.iter().zip(&self.search.candidates) {
            pair.rows(candidates, travel.of(pair, lane), &model.points, u, &mut self.rows);
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

    /// Rows active at u*, and their rates `G v_{n-1/2} = G v* - dt G M^-1 (f - K u_n)` half a step before.
    fn look_ahead(&mut self, travel: &mut Travel, state: &State, lane: usize) -> Result<()> {
        let of = |values| Lane::new(values, state.lanes, lane);
        let (u, v, dt) = (of(&state.displacement), of(&state.velocity), self.dt);
        self.find_rows(travel, &state.other, state.lanes, lane)?;
        let (model, before) = (&self.model, &mut self.forces.before);
        let rate = |(node, g): (u32, [f64; 2])| {
            let (v, w) = (v.at(node), model.inverse_mass[node as usize]);
            let f = model.nodal_force(model.body_of(node), node, u);
            g[0] * (v[0] - dt * w[0] * f[0]) + g[1] * (v[1] - dt * w[1] * f[1])
        };
        before.clear();
        before.extend(self.rows.iter().map(|row| row.entries().map(rate).sum::<f64>()));
        Ok(())
    }

    /// `[M + G'PG] a = f - K u - G'(A_s g + A_d G v)`, solved for the row forces, or what the enforcement has instead.
    fn find_forces(&mut self) -> Result<()> {
        let (model, rows, dt) = (&self.model, &self.rows, self.dt);
        self.row_steps += rows.len() as u64;
        self.block_operations += if self.method.enforcement == Enforcement::Penalty {
            self.block.forces(&model.inverse_mass, rows, dt, &mut self.forces)?;
            self.block.operations
        } else {
            let of = Rows { inverse_mass: &model.inverse_mass, rows, two_sided: model.linear.len(), dt };
            self.method.enforcement.forces(of, &mut self.multipliers, &mut self.forces)?
        } as u64;
        let finite = self.forces.lambda.iter().all(|lambda| lambda.is_finite());
        if finite { Ok(()) } else { Err(Error::Run(Kind::NotFinite, "contact force is not finite".to_string())) }
    }

    /// `v += dt M^-1 G' lambda`, `u += dt^2 M^-1 G' lambda`.
    fn push_back(&mut self, state: &mut State, lane: usize) {
        for (row, lambda) in self.rows.iter().zip(&self.forces.lambda) {
            for (node, g) in row.entries() {
                let (w, impulse) = (self.model.inverse_mass[node as usize], self.dt * lambda);
                let dv = [impulse * g[0] * w[0], impulse * g[1] * w[1]];
                add_to(&mut state.velocity, state.lanes, lane, node, dv);
                add_to(&mut state.other, state.lanes, lane, node, dv.map(|dv| self.dt * dv));
            }
        }
        if self.method.enforcement.looks_ahead() {
            // From g(u*) to what is left at u_{n+1}, to first order: the predicted gap is no penetration of anything.
            let v = Lane::new(&state.velocity, state.lanes, lane);
            for (row, free) in self.rows.iter_mut().zip(&self.forces.free) {
                row.gap += self.dt * (row.along(v) - free);
            }
        }
    }
}
