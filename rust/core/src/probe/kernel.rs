//! The bare kernel on a model's matrix: a step without contact, supports of the model held.

use std::ops::Range;
use std::time::Instant;

use crate::critical_step::element_bound;
use crate::error::{Error, Result};
use crate::model::Model;
use crate::stiffness::kernel::{Pass, advance};
use crate::stiffness::{Aligned, Isa};

/// Seconds that `steps` passes over the nodes of `range` take with 1, 8 or 16 lanes.
///
/// The lanes start from small random displacements; dt is half the element bound, so that they stay bounded. A tenth as
/// many passes go before the clock starts.
///
/// # Errors
/// A number of lanes that there is no kernel for, no steps, an empty range or one beyond the nodes.
pub fn kernel(model: &Model, lanes: usize, isa: Isa, steps: u64, range: Range<usize>) -> Result<f64> {
    let bound = |quantity: &str, value: String, bound: &str, remedy: &str| {
        Err(Error::bound("kernel probe", quantity, value, bound, remedy))
    };
    if steps == 0 {
        return bound("number of steps", steps.to_string(), ">= 1", "take a few hundred");
    }
    if range.is_empty() || range.end > model.points.len() {
        let nodes = format!("not empty and within 0..{}", model.points.len());
        return bound("range of nodes", format!("{range:?}"), &nodes, "take all nodes");
    }
    match lanes {
        1 => Ok(seconds::<1>(model, isa, steps, range)),
        8 => Ok(seconds::<8>(model, isa, steps, range)),
        16 => Ok(seconds::<16>(model, isa, steps, range)),
        _ => bound("lanes", lanes.to_string(), "1, 8 or 16", "take one of these"),
    }
}

fn seconds<const L: usize>(model: &Model, isa: Isa, steps: u64, range: Range<usize>) -> f64 {
    let values = 2 * L * model.points.len();
    let mut u = Aligned::zeros(values);
    let mut seed = 1_u64;
    for x in u.iter_mut() {
        // A linear congruential generator (Knuth 1998, sec. 3.3.4): the values need be no more than irregular.
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        *x = 1e-6 * ((seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5);
    }
    let (mut other, mut velocity) = (u.clone(), Aligned::zeros(values));
    let dt = [0.5 * element_bound(model); L];
    let own = 2 * range.start..2 * range.end;
    let mut pass = || {
        let displacement = u.as_chunks().0;
        let (stiffness, inverse_mass, load) = (&model.stiffness, &model.inverse_mass, None);
        let pass = Pass { stiffness, inverse_mass, load, displacement, dt, elastic_dt: dt, load_dt: dt };
        let (v, next) = (velocity.as_chunks_mut().0, other.as_chunks_mut().0);
        advance::<L>(isa, &pass, range.clone(), &mut v[own.clone()], &mut next[own.clone()]);
        std::mem::swap(&mut u, &mut other);
    };
    (0..steps.div_ceil(10)).for_each(|_| pass());
    let start = Instant::now();
    (0..steps).for_each(|_| pass());
    let seconds = start.elapsed().as_secs_f64();
    std::hint::black_box((&u, &velocity));
    seconds
}
