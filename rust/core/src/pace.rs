//! The pace of each lane: what its time step makes of the one pass over K.

use std::ops::Range;

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
///
/// Threads share the nodes; each node is the work of one of them, so that their number changes no bit.
pub fn advance_nodes(model: &Model, isa: Isa, threads: usize, pace: &Pace, state: &mut State) {
    match state.lanes {
        1 => pass::<1>(model, isa, threads, pace, state),
        2 => pass::<2>(model, isa, threads, pace, state),
        4 => pass::<4>(model, isa, threads, pace, state),
        8 => pass::<8>(model, isa, threads, pace, state),
        _ => pass::<16>(model, isa, threads, pace, state),
    }
}

fn pass<const L: usize>(model: &Model, isa: Isa, threads: usize, pace: &Pace, state: &mut State) {
    let lanes = |values: &[f64]| -> [f64; L] { std::array::from_fn(|lane| values[lane]) };
    let displacement = state.displacement.as_chunks::<L>().0;
    let (mut velocity, mut next) = (state.velocity.as_chunks_mut::<L>().0, state.other.as_chunks_mut::<L>().0);
    let pieces = model.bodies.iter().enumerate().flat_map(|(number, body)| {
        let own = number * L..(number + 1) * L;
        let pass = Pass {
            stiffness: &model.stiffness,
            inverse_mass: &model.inverse_mass,
            load: model.load.as_deref(),
            displacement,
            dt: lanes(&pace.dt),
            elastic_dt: lanes(&pace.elastic_dt[own.clone()]),
            load_dt: lanes(&pace.load_dt[own]),
        };
        shares(&body.nodes, threads).map(move |nodes| (pass, nodes))
    });
    let pieces = pieces.map(|(pass, nodes)| {
        // The nodes of all bodies follow each other: each piece takes the next stretch.
        let values = 2 * nodes.len();
        let own_velocity = velocity.split_off_mut(..values).unwrap_or_default();
        (pass, nodes, own_velocity, next.split_off_mut(..values).unwrap_or_default())
    });
    if threads <= 1 {
        pieces.for_each(|(pass, nodes, velocity, next)| advance(isa, &pass, nodes, velocity, next));
    } else {
        rayon::scope(|scope| {
            for (pass, nodes, velocity, next) in pieces {
                scope.spawn(move |_| advance(isa, &pass, nodes, velocity, next));
            }
        });
    }
}

/// A body's nodes in as many stretches as there are threads.
fn shares(nodes: &Range<usize>, threads: usize) -> impl Iterator<Item = Range<usize>> + use<> {
    let (first, count) = (nodes.start, nodes.len());
    (0..threads).map(move |i| first + count * i / threads..first + count * (i + 1) / threads)
}
