//! Surfaces that move so far in one step that a node may cross the primary body unseen.

use super::pair::{Pair, Primary};
use super::surface::Vertices;
use crate::lane::Lane;
use crate::model::Model;
use crate::state::State;

/// Movement a step (m) of the first pair that is too fast, and how far contact can follow (m): the thickness of a closed
/// primary, the reach of the search at an open one. A half-plane has no far side.
pub fn too_fast(model: &Model, state: &State, dt: f64) -> Option<(f64, f64)> {
    let velocity = Lane::new(&state.velocity, state.lanes, 0);
    model.pairs.iter().find_map(|pair| {
        let Primary::Surface(surface) = &pair.primary else { return None };
        let most = if surface.is_closed() { surface.extent } else { surface.reach() };
        let step = dt * relative_speed(pair, velocity);
        (step > most).then_some((step, most))
    })
}

/// Largest speed of a secondary node relative to any primary one, at most (m/s).
fn relative_speed(pair: &Pair, velocity: Lane) -> f64 {
    let nodes = match &pair.primary {
        Primary::Surface(surface) => match &surface.vertices {
            Vertices::Nodes(nodes) => nodes.as_slice(),
            Vertices::Fixed(_) => &[],
        },
        Primary::HalfPlane { .. } => &[],
    };
    let sum = nodes.iter().map(|&n| velocity.at(n)).fold([0.0; 2], |s, v| [s[0] + v[0], s[1] + v[1]]);
    let mean = sum.map(|s| s / nodes.len().max(1) as f64);
    let speed = |n: u32| {
        let v = velocity.at(n);
        (v[0] - mean[0]).hypot(v[1] - mean[1])
    };
    let fastest = |nodes: &mut dyn Iterator<Item = u32>| nodes.map(speed).fold(0.0, f64::max);
    fastest(&mut pair.secondary.iter().map(|s| s.node)) + fastest(&mut nodes.iter().copied())
}
