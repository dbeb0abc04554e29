//! Nodes that move so far in one step that they may cross the primary body unseen.

use super::candidates::Candidates;
use super::gap::{dot, from_to};
use super::pair::{Pair, Primary};
use super::posed::Posed;
use super::surface::{Surface, Vertices};
use crate::error::short;
use crate::lane::Lane;

/// What moves, and from where: the displacement before a step and the velocity of the step.
#[derive(Clone, Copy)]
pub struct Motion<'a> {
    /// Reference coordinates (m).
    pub points: &'a [[f64; 2]],
    /// Displacement before the step (m).
    pub displacement: Lane<'a>,
    /// Velocity of the step (m/s).
    pub velocity: Lane<'a>,
    /// Time step (s).
    pub dt: f64,
}

/// What is said of surfaces that moved `step` (m) in one step where contact follows `most` (m).
pub fn missed(step: f64, most: f64) -> String {
    let (step, most) = (short(step), short(most));
    format!("surfaces moved {step} m in one step, contact follows {most} m: reduce dt or speed;")
}

/// Approach a step (m) of the first candidate that is too fast and may arrive within `steps` steps, and how far contact
/// can follow (m): the thickness of a closed primary, the reach of the search at an open one. A half-plane has no far
/// side.
pub fn too_fast(pairs: &[Pair], candidates: &[Candidates], motion: Motion, steps: f64) -> Option<(f64, f64)> {
    pairs.iter().zip(candidates).find_map(|(pair, candidates)| {
        let Primary::Surface(surface) = &pair.primary else { return None };
        let most = if surface.is_closed() { surface.extent } else { surface.reach() };
        candidates.iter().find_map(|(index, segments)| {
            let (gap, approach) = approach(surface, pair.secondary[index as usize].node, segments, motion)?;
            (approach > most && gap < steps * approach).then_some((approach, most))
        })
    })
}

/// Gap of a node to the nearest of its segments and how far a step brings it closer (m).
fn approach(surface: &Surface, node: u32, segments: &[u32], motion: Motion) -> Option<(f64, f64)> {
    let posed = Posed { surface, points: motion.points, displacement: motion.displacement };
    let p = posed.node(node);
    let nearest = posed.nearest(p, segments.iter().copied())?;
    let gap = posed.signed_gap(p, nearest)?;
    let ends = surface.segments[nearest.0 as usize].ends;
    let velocity = match &surface.vertices {
        Vertices::Nodes(nodes) => {
            let [a, b] = ends.map(|v| motion.velocity.at(nodes[v as usize]));
            [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]
        }
        Vertices::Fixed(_) => [0.0; 2],
    };
    let relative = from_to(velocity, motion.velocity.at(node));
    Some((gap.gap, -motion.dt * dot(relative, gap.normal)))
}
