//! The state: displacement and velocity of every node, axis and lane.

use crate::error::{Error, Result};
use crate::model::Model;

/// Displacement u_n, velocity v_{n-1/2} and time of one or many lanes, arrays [node][axis][lane].
#[derive(Debug, Clone)]
pub struct State {
    /// Lanes interleaved in the arrays.
    pub lanes: usize,
    /// Displacement u_n (m).
    pub displacement: Vec<f64>,
    /// Displacement of the step before; the step writes the next one into it.
    pub other: Vec<f64>,
    /// Velocity v_{n-1/2} (m/s).
    pub velocity: Vec<f64>,
    /// Steps taken.
    pub steps: u64,
}

impl State {
    /// One lane at t = 0 with initial velocity v_0 and displacement u_0; `v_{-1/2} = v_0 - dt/2 M^-1 (f - K u_0)`.
    ///
    /// # Errors
    /// Arrays of the wrong length, values that are not finite, motion prescribed at a support.
    pub fn new(model: &Model, velocity: &[f64], displacement: &[f64], dt: f64) -> Result<Self> {
        for (name, values) in [("velocity", velocity), ("displacement", displacement)] {
            if values.len() != 2 * model.points.len() {
                let bound = format!("{} (two a node)", 2 * model.points.len());
                return Err(Error::bound(
                    "initial state",
                    &format!("length of {name}"),
                    values.len(),
                    &bound,
                    "resize it",
                ));
            }
            if let Some(i) = values.iter().position(|x| !x.is_finite()) {
                let what = format!("{name} of node {}", i / 2);
                return Err(Error::bound("initial state", &what, values[i], "finite", "mend the array"));
            }
        }
        let mut velocity = velocity.to_vec();
        let u = crate::lane::Lane::new(displacement, 1, 0);
        for (node, w) in model.inverse_mass.iter().enumerate() {
            let force = model.nodal_force(node as u32, u);
            for axis in 0..2 {
                let v = &mut velocity[2 * node + axis];
                // A held degree of freedom has no velocity, whatever the body's initial one.
                *v = if w[axis] == 0.0 { 0.0 } else { *v - 0.5 * dt * w[axis] * force[axis] };
            }
        }
        let (displacement, other) = (displacement.to_vec(), displacement.to_vec());
        Ok(Self { lanes: 1, displacement, other, velocity, steps: 0 })
    }
}
