//! Bodies that overlap before the run has begun: found by brute force, once.

use super::gap::{dot, from_to, project};
use super::pair::{Pair, Primary};
use super::surface::{Surface, position};
use crate::lane::Lane;

/// Overlap tolerance over mean segment length, unless the contact states its own.
pub const TOLERANCE: f64 = 1e-6;

/// Deepest secondary node inside the primary at the start: node and depth (m), if any lies inside.
pub fn deepest(pair: &Pair, points: &[[f64; 2]], displacement: Lane) -> Option<(u32, f64)> {
    let at = |node| position(node, points, displacement);
    let depth = |node: u32| match &pair.primary {
        Primary::HalfPlane { point, normal } => -dot(from_to(*point, at(node)), *normal),
        Primary::Surface(surface) if surface.is_closed() => depth_inside(surface, at(node), points, displacement),
        Primary::Surface(_) => 0.0,
    };
    let nodes = pair.secondary.iter().map(|s| (s.node, depth(s.node)));
    nodes.filter(|&(_, d)| d > 0.0).max_by(|a, b| a.1.total_cmp(&b.1))
}

/// Distance to the surface of a point inside a closed one (even-odd rule); 0 outside.
fn depth_inside(surface: &Surface, p: [f64; 2], points: &[[f64; 2]], displacement: Lane) -> f64 {
    let (mut inside, mut nearest) = (false, f64::INFINITY);
    for s in 0..surface.segments.len() as u32 {
        let [a, b] = surface.ends(s, points, displacement);
        if (a[1] > p[1]) != (b[1] > p[1]) {
            let crossing = a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
            inside ^= p[0] < crossing;
        }
        nearest = nearest.min(project(p, a, b).distance2);
    }
    if inside { nearest.sqrt() } else { 0.0 }
}
