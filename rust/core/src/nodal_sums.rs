//! Sums over the nodes of each body, all lanes in one pass: what energies and momentum are made of.

use crate::model::Model;
use crate::stiffness::simd::{Isa, Loop, Madd, dispatch};

/// Sums over one body's nodes in one lane, at t_n just after the step from t_n; masses before the body's own factor.
#[derive(Debug, Clone, Copy, Default)]
pub struct NodalSums {
    /// `sum m v_n . v_n`.
    pub kinetic: f64,
    /// `sum m v_{n+1/2} . v_{n+1/2}`.
    pub ahead: f64,
    /// `sum m u_n . (v_{n+1/2} - v_{n-1/2})`.
    pub work: f64,
    /// `sum m v_{n+1/2} . (v_{n+1/2} - v_{n-1/2})`.
    pub power: f64,
    /// `sum m v_n`.
    pub momentum: [f64; 2],
    /// Largest u_n . u_n.
    pub largest: f64,
    /// `sum f . u_n`, the same over free degrees of freedom, and `sum f . v_{n+1/2}`.
    pub loads: [f64; 3],
}

/// Arrays [node][axis][lane] after a step: v_{n-1/2}, v_{n+1/2}, u_n.
pub struct After<'a> {
    /// v_{n-1/2}.
    pub before: &'a [f64],
    /// v_{n+1/2}.
    pub velocity: &'a [f64],
    /// u_n.
    pub displacement: &'a [f64],
}

/// Fills `sums`, lane by lane within a body.
pub fn nodal_sums(isa: Isa, model: &Model, lanes: usize, after: &After, sums: &mut Vec<NodalSums>) {
    sums.clear();
    match lanes {
        1 => dispatch(isa, Pass::<1> { model, after, sums }),
        2 => dispatch(isa, Pass::<2> { model, after, sums }),
        4 => dispatch(isa, Pass::<4> { model, after, sums }),
        8 => dispatch(isa, Pass::<8> { model, after, sums }),
        _ => dispatch(isa, Pass::<16> { model, after, sums }),
    }
}

struct Pass<'a, const L: usize> {
    model: &'a Model,
    after: &'a After<'a>,
    sums: &'a mut Vec<NodalSums>,
}

impl<const L: usize> Loop for Pass<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run<M: Madd>(self) {
        let Self { model, after, sums } = self;
        let (before, velocity) = (by_node::<L>(after.before), by_node::<L>(after.velocity));
        let displacement = by_node::<L>(after.displacement);
        for body in &model.bodies {
            let mut of_body = Sums::<L>::none();
            for node in body.nodes.clone() {
                of_body.add(model.mass[node], &before[node], &velocity[node], &displacement[node]);
            }
            if let Some(load) = &model.load {
                for node in body.nodes.clone() {
                    let (f, free) = (load[node], model.free(node as u32, load[node]));
                    of_body.add_load(f, free, &velocity[node], &displacement[node]);
                }
            }
            sums.extend((0..L).map(|lane| of_body.lane(lane)));
        }
    }
}

/// An array [node][axis][lane].
#[inline(always)]
pub(crate) fn by_node<const L: usize>(values: &[f64]) -> &[[[f64; L]; 2]] {
    values.as_chunks::<L>().0.as_chunks::<2>().0
}

struct Sums<const L: usize> {
    kinetic: [f64; L],
    ahead: [f64; L],
    work: [f64; L],
    power: [f64; L],
    momentum: [[f64; L]; 2],
    largest: [f64; L],
    loads: [[f64; L]; 3],
}

impl<const L: usize> Sums<L> {
    fn none() -> Self {
        let zero = [0.0; L];
        let (kinetic, ahead, work, power, largest) = (zero, zero, zero, zero, zero);
        Self { kinetic, ahead, work, power, momentum: [zero; 2], largest, loads: [zero; 3] }
    }

    #[inline(always)]
    fn add(&mut self, m: f64, before: &[[f64; L]; 2], after: &[[f64; L]; 2], u: &[[f64; L]; 2]) {
        for lane in 0..L {
            let (a, b, x) =
                ([before[0][lane], before[1][lane]], [after[0][lane], after[1][lane]], [u[0][lane], u[1][lane]]);
            let v = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            let jump = [b[0] - a[0], b[1] - a[1]];
            self.kinetic[lane] += m * (v[0] * v[0] + v[1] * v[1]);
            self.ahead[lane] += m * (b[0] * b[0] + b[1] * b[1]);
            self.work[lane] += m * (x[0] * jump[0] + x[1] * jump[1]);
            self.power[lane] += m * (b[0] * jump[0] + b[1] * jump[1]);
            self.momentum[0][lane] += m * v[0];
            self.momentum[1][lane] += m * v[1];
            let size = x[0] * x[0] + x[1] * x[1];
            self.largest[lane] = if size > self.largest[lane] { size } else { self.largest[lane] };
        }
    }

    #[inline(always)]
    fn add_load(&mut self, f: [f64; 2], free: [f64; 2], after: &[[f64; L]; 2], u: &[[f64; L]; 2]) {
        for lane in 0..L {
            self.loads[0][lane] += f[0] * u[0][lane] + f[1] * u[1][lane];
            self.loads[1][lane] += free[0] * u[0][lane] + free[1] * u[1][lane];
            self.loads[2][lane] += f[0] * after[0][lane] + f[1] * after[1][lane];
        }
    }

    fn lane(&self, lane: usize) -> NodalSums {
        NodalSums {
            kinetic: self.kinetic[lane],
            ahead: self.ahead[lane],
            work: self.work[lane],
            power: self.power[lane],
            momentum: self.momentum.map(|p| p[lane]),
            // A comparison passes over what is not a number; a sum does not.
            largest: if (self.kinetic[lane] + self.work[lane]).is_nan() { f64::NAN } else { self.largest[lane] },
            loads: self.loads.map(|f| f[lane]),
        }
    }
}
