//! Energies and momentum at a full step, from what the step leaves behind.

use crate::lane::Lane;
use crate::mass_block::RowForces;
use crate::model::Model;
use crate::nodal_sums::NodalSums;
use crate::row::Row;

/// One lane after a step.
#[derive(Clone, Copy)]
pub struct After<'a> {
    /// v_{n-1/2}.
    pub before: Lane<'a>,
    /// v_{n+1/2}.
    pub velocity: Lane<'a>,
    /// u_n.
    pub displacement: Lane<'a>,
    /// u_{n+1}.
    pub next: Lane<'a>,
}

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

/// Energies at t_n of one lane just after the step from t_n, from its sums over the nodes of each body.
///
/// The strain energy takes K u_n from the equation of motion, `K u = f + G' lambda - M (v+ - v-)/dt`, so that no
/// second product with K is needed. `momentum` receives each body's `sum m v_n`.
pub fn sample<'s>(
    model: &Model,
    dt: f64,
    sums: impl Iterator<Item = &'s NodalSums>,
    lane: &After,
    rows: &[Row],
    forces: &RowForces,
    momentum: &mut [[f64; 2]],
) -> Energies {
    let (old, new, u) = (lane.before, lane.velocity, lane.displacement);
    let mut e = Energies::default();
    let (mut kinetic, mut ahead, mut work, mut power, mut largest) = (0.0, 0.0, 0.0, 0.0, 0.0_f64);
    let mut loads = [0.0; 3];
    for ((body, p), sums) in model.bodies.iter().zip(momentum).zip(sums) {
        let r = body.density_factor;
        kinetic += r * sums.kinetic;
        ahead += r * sums.ahead;
        work += r * sums.work;
        power += r * sums.power;
        *p = sums.momentum.map(|mv| r * mv);
        // Lets NaN through, unlike f64::max.
        largest = if largest.is_nan() || sums.largest <= largest { largest } else { sums.largest };
        loads = [0, 1, 2].map(|k| loads[k] + sums.loads[k]);
    }
    let [loads, free_loads, mut pushed] = loads;
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
pub fn at_the_end(model: &Model, u: Lane, v: Lane, rows: &[Row], momentum: &mut [[f64; 2]]) -> Energies {
    let mut e = Energies::default();
    let mut largest = 0.0;
    for (body, p) in model.bodies.iter().zip(momentum) {
        *p = [0.0; 2];
        for node in body.nodes.clone() {
            let (m, x, v) = (model.mass[node], u.at(node as u32), v.at(node as u32));
            let load = model.load.as_ref().map_or([0.0; 2], |f| f[node]);
            let force = model.nodal_force(body, node as u32, u);
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
