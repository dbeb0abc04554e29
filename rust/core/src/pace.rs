//! The pace of each lane: what its time step makes of the one pass over K.

use crate::model::Model;
use crate::state::State;
use crate::step::Stepping;
use crate::stiffness::Isa;
use crate::stiffness::kernel::{Pass, advance};

/// Time steps of the lanes, and their products with each body's factors.
#[derive(Debug, Clone)]
pub struct Pace {
    /// Time step (s) of each lane; 0 where it is empty or stands still.
    dt: Vec<f64>,
    /// dt times the body's factor of K over its factor of M, lane by lane within a body.
    elastic_dt: Vec<f64>,
    /// dt over the body's factor of M, likewise.
    load_dt: Vec<f64>,
}

impl Pace {
    /// Lanes that stand still.
    pub fn new(bodies: usize, lanes: usize) -> Self {
        Self { dt: vec![0.0; lanes], elastic_dt: vec![0.0; bodies * lanes], load_dt: vec![0.0; bodies * lanes] }
    }

    /// Sets the pace of a lane by its model's factors.
    pub fn set(&mut self, lane: usize, model: &Model, dt: f64) {
        let lanes = self.dt.len();
        self.dt[lane] = dt;
        for (body, at) in model.bodies.iter().zip((lane..).step_by(lanes)) {
            self.elastic_dt[at] = dt * (body.young_factor / body.density_factor);
            self.load_dt[at] = dt / body.density_factor;
        }
    }

    /// Makes a lane stand still.
    pub fn stop(&mut self, lane: usize) {
        let lanes = self.dt.len();
        self.dt[lane] = 0.0;
        for values in [&mut self.elastic_dt, &mut self.load_dt] {
            values.iter_mut().skip(lane).step_by(lanes).for_each(|dt| *dt = 0.0);
        }
    }

    /// Makes the lanes with a fault stand still.
    pub fn stop_at_faults(&mut self, lanes: &[Stepping]) {
        for (number, _) in lanes.iter().enumerate().filter(|(_, lane)| lane.fault.is_some()) {
            self.stop(number);
        }
    }
}

/// `v += dt M^-1 (f - K u)`, and u + dt v into `other`: what the bodies do without rows.
pub fn advance_nodes(model: &Model, isa: Isa, pace: &Pace, state: &mut State) {
    match state.lanes {
        1 => pass::<1>(model, isa, pace, state),
        2 => pass::<2>(model, isa, pace, state),
        4 => pass::<4>(model, isa, pace, state),
        8 => pass::<8>(model, isa, pace, state),
        lanes => {
            debug_assert_eq!(lanes, 16);
            pass::<16>(model, isa, pace, state);
        }
    }
}

fn pass<const L: usize>(model: &Model, isa: Isa, pace: &Pace, state: &mut State) {
    let lanes = |values: &[f64]| -> [f64; L] { std::array::from_fn(|lane| values[lane]) };
    let (velocity, next) = (state.velocity.as_chunks_mut::<L>().0, state.other.as_chunks_mut::<L>().0);
    for (number, body) in model.bodies.iter().enumerate() {
        let (own, values) = (number * L..(number + 1) * L, 2 * body.nodes.start..2 * body.nodes.end);
        let pass = Pass {
            stiffness: &model.stiffness,
            inverse_mass: &model.inverse_mass,
            load: model.load.as_deref(),
            displacement: state.displacement.as_chunks::<L>().0,
            dt: lanes(&pace.dt),
            elastic_dt: lanes(&pace.elastic_dt[own.clone()]),
            load_dt: lanes(&pace.load_dt[own]),
        };
        advance(isa, &pass, body.nodes.clone(), &mut velocity[values.clone()], &mut next[values]);
    }
}
