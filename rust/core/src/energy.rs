//! Energies and momentum at a full step, from what the step leaves behind.

use crate::lane::Lane;
use crate::mass_block::RowForces;
use crate::model::Model;
use crate::row::Row;
use crate::state::State;

/// Energies (J per m of depth) and the largest displacement at t_n.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Energies {
    /// Kinetic energy `v_n' M v_n / 2`.
    pub kinetic: f64,
    /// Strain energy `u_n' K u_n / 2`.
    pub strain: f64,
    /// Energy stored in the stiffness penalties, `A_s g^2 / 2`.
    pub penalty: f64,
    /// Kinetic energy of the mass penalties, `A_m (G v_n)^2 / 2`.
    pub mass_penalty: f64,
    /// Potential of the body forces, `-u_n' f`.
    pub load_potential: f64,
    /// Largest nodal displacement (m).
    pub max_displacement: f64,
    /// `v_{n+1/2}' M v_{n+1/2} / 2 + u_n' K u_{n+1} / 2`: what central differences keep, up to the work of rows and loads.
    pub half_step: f64,
}

impl Energies {
    /// Sum of all energies.
    pub fn total(&self) -> f64 {
        self.kinetic + self.strain + self.penalty + self.mass_penalty + self.load_potential
    }
}

/// Energies at t_n just after the step from t_n: `before` is v_{n-1/2}, the state holds v_{n+1/2} and, in `other`, u_n.
///
/// The strain energy takes K u_n from the equation of motion, `K u = f + G' lambda - M (v+ - v-)/dt`, so that no
/// second product with K is needed. `momentum` receives each body's `sum m v_n`.
pub fn sample(
    model: &Model,
    dt: f64,
    state: &State,
    before: &[f64],
    rows: &[Row],
    forces: &RowForces,
    momentum: &mut [[f64; 2]],
) -> Energies {
    let (old, new) = (Lane::new(before, state.lanes, 0), Lane::new(&state.velocity, state.lanes, 0));
    let u = Lane::new(&state.other, state.lanes, 0);
    let mut e = Energies::default();
    let (mut kinetic, mut ahead, mut work, mut power, mut largest) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (body, p) in model.bodies.iter().zip(momentum) {
        *p = [0.0; 2];
        for node in body.nodes.clone() {
            let (m, a, b, x) = (model.mass[node], old.at(node as u32), new.at(node as u32), u.at(node as u32));
            let v = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            kinetic += m * (v[0] * v[0] + v[1] * v[1]);
            let jump = [b[0] - a[0], b[1] - a[1]];
            ahead += m * (b[0] * b[0] + b[1] * b[1]);
            work += m * (x[0] * jump[0] + x[1] * jump[1]);
            power += m * (b[0] * jump[0] + b[1] * jump[1]);
            *p = [p[0] + m * v[0], p[1] + m * v[1]];
            let size = x[0] * x[0] + x[1] * x[1];
            // Lets NaN through, unlike f64::max.
            largest = if size <= largest { largest } else { size };
        }
    }
    let (mut loads, mut free_loads, mut pushed) = (0.0, 0.0, 0.0);
    for (node, f) in model.load.iter().flatten().enumerate() {
        let (x, free) = (u.at(node as u32), model.free(node as u32, u.at(node as u32)));
        loads += f[0] * x[0] + f[1] * x[1];
        free_loads += f[0] * free[0] + f[1] * free[1];
        let v = new.at(node as u32);
        pushed += f[0] * v[0] + f[1] * v[1];
    }
    let mut contact = 0.0;
    for (row, lambda) in rows.iter().zip(&forces.lambda) {
        let rate = 0.5 * (row.along(old) + row.along(new));
        e.penalty += 0.5 * row.penalties.alpha_s * row.gap * row.gap;
        e.mass_penalty += 0.5 * row.penalties.alpha_m * rate * rate;
        let work = |(node, g): (u32, [f64; 2])| {
            let x = model.free(node, u.at(node));
            g[0] * x[0] + g[1] * x[1]
        };
        contact += lambda * row.entries().map(work).sum::<f64>();
        pushed += lambda * row.along(new);
    }
    // Where a support holds a displaced node there is no equation of motion: K u is computed there.
    let held: f64 = model.held.iter().map(|&node| model.held_work(node, u)).sum();
    e.kinetic = 0.5 * kinetic;
    e.strain = 0.5 * (contact + free_loads + held - work / dt);
    e.load_potential = -loads;
    // u_{n+1} = u_n + dt v, and K u_n as above: v is zero where a support holds.
    e.half_step = 0.5 * ahead + e.strain + 0.5 * (dt * pushed - power);
    e.max_displacement = largest.sqrt();
    e
}

/// Energies of a run that stops between samples: v_{n+1/2} stands for v_n, and the strain energy is computed outright.
pub fn at_the_end(model: &Model, state: &State, rows: &[Row], momentum: &mut [[f64; 2]]) -> Energies {
    let (u, v) = (Lane::new(&state.displacement, state.lanes, 0), Lane::new(&state.velocity, state.lanes, 0));
    let mut e = Energies::default();
    let mut largest = 0.0;
    for (body, p) in model.bodies.iter().zip(momentum) {
        *p = [0.0; 2];
        for node in body.nodes.clone() {
            let (m, x, v) = (model.mass[node], u.at(node as u32), v.at(node as u32));
            let load = model.load.as_ref().map_or([0.0; 2], |f| f[node]);
            let force = model.nodal_force(node as u32, u);
            e.kinetic += 0.5 * m * (v[0] * v[0] + v[1] * v[1]);
            e.strain += 0.5 * (x[0] * (load[0] - force[0]) + x[1] * (load[1] - force[1]));
            e.load_potential -= load[0] * x[0] + load[1] * x[1];
            *p = [p[0] + m * v[0], p[1] + m * v[1]];
            let size = x[0] * x[0] + x[1] * x[1];
            largest = if size <= largest { largest } else { size };
        }
    }
    for row in rows {
        let rate = row.along(v);
        e.penalty += 0.5 * row.penalties.alpha_s * row.gap * row.gap;
        e.mass_penalty += 0.5 * row.penalties.alpha_m * rate * rate;
    }
    e.max_displacement = largest.sqrt();
    e
}
