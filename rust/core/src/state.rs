//! The state: displacement and velocity of every node, axis and lane.

use crate::model::Model;
use crate::start::Start;
use crate::stiffness::Aligned;

/// Displacement u_n and velocity v_{n-1/2} of one or many lanes, arrays [node][axis][lane].
#[derive(Debug, Clone)]
pub struct State {
    /// Lanes interleaved in the arrays.
    pub lanes: usize,
    /// Displacement u_n (m).
    pub displacement: Aligned,
    /// Displacement of the step before; the step writes the next one into it.
    pub other: Aligned,
    /// Velocity v_{n-1/2} (m/s).
    pub velocity: Aligned,
}

impl State {
    /// Empty lanes: everything at rest.
    pub fn new(nodes: usize, lanes: usize) -> Self {
        let zeros = || Aligned::zeros(2 * nodes * lanes);
        Self { lanes, displacement: zeros(), other: zeros(), velocity: zeros() }
    }

    /// Puts a lane at t = 0: u_0, and `v_{-1/2} = v_0 - dt/2 M^-1 (f - K u_0)`; `velocity` replaces a body's v_0.
    pub fn begin(&mut self, lane: usize, model: &Model, start: &Start, velocity: Option<&[Option<[f64; 2]>]>, dt: f64) {
        for (number, body) in model.bodies.iter().enumerate() {
            let uniform = velocity.and_then(|bodies| bodies[number]);
            for node in body.nodes.clone() {
                let (force, w) = (start.force(model, body, node), model.inverse_mass[node]);
                for axis in 0..2 {
                    let (from, to) = (2 * node + axis, (2 * node + axis) * self.lanes + lane);
                    let v = uniform.map_or(start.velocity[from], |v| v[axis]);
                    // A held degree of freedom has no velocity, whatever the body's initial one.
                    self.velocity[to] = if w[axis] == 0.0 { 0.0 } else { v - 0.5 * dt * w[axis] * force[axis] };
                    self.displacement[to] = start.displacement[from];
                    self.other[to] = start.displacement[from];
                }
            }
        }
    }

    /// Copies one lane over another.
    pub fn copy_lane(&mut self, from: usize, to: usize) {
        for values in [&mut self.displacement, &mut self.other, &mut self.velocity] {
            values.chunks_exact_mut(self.lanes).for_each(|lanes| lanes[to] = lanes[from]);
        }
    }

    /// Empties a lane, so that what diverged in it is gone.
    pub fn clear_lane(&mut self, lane: usize) {
        for values in [&mut self.displacement, &mut self.other, &mut self.velocity] {
            values.chunks_exact_mut(self.lanes).for_each(|lanes| lanes[lane] = 0.0);
        }
    }

    /// The same lanes in a state of another width: those beyond it are gone, new ones are empty.
    pub fn resized(&self, lanes: usize) -> Self {
        let resized = |values: &[f64]| {
            let mut new = Aligned::zeros(values.len() / self.lanes * lanes);
            new.copy_from_slice(&resized(values, self.lanes, lanes));
            new
        };
        let (displacement, other) = (resized(&self.displacement), resized(&self.other));
        Self { lanes, displacement, other, velocity: resized(&self.velocity) }
    }

    /// Makes the displacements that the step wrote the present ones.
    pub fn turn(&mut self) {
        std::mem::swap(&mut self.displacement, &mut self.other);
    }

    /// Nodal values of one lane, two a node.
    pub fn one(&self, values: &[f64], lane: usize) -> Vec<f64> {
        values.iter().skip(lane).step_by(self.lanes).copied().collect()
    }
}

/// Values [..][lane] of `from` lanes as those of `to` lanes: the first ones kept, new ones zero.
pub(crate) fn resized(values: &[f64], from: usize, to: usize) -> Vec<f64> {
    let (kept, mut new) = (from.min(to), vec![0.0; values.len() / from * to]);
    for (new, old) in new.chunks_exact_mut(to).zip(values.chunks_exact(from)) {
        new[..kept].copy_from_slice(&old[..kept]);
    }
    new
}
