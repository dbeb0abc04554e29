//! Bodies that overlap before the run has begun: found by brute force, once.

use super::gap::{dot, from_to};
use super::pair::{Pair, Primary, SurfaceNode};
use super::posed::Posed;
use super::surface::{Surface, position};
use crate::error::{Error, Result};
use crate::lane::Lane;
use crate::model::Model;

/// Overlap tolerance over mean segment length, unless the contact states its own.
pub const TOLERANCE: f64 = 1e-6;

/// Where two bodies overlap most: a node, or a point of the body's inside, and its depth (m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Node; none for a point inside.
    pub node: Option<u32>,
    /// Depth inside the other body (m).
    pub depth: f64,
}

/// Deepest secondary node inside a pair's primary, or `inner`, a point inside the secondary body.
pub fn deepest(pair: &Pair, inner: [f64; 2], points: &[[f64; 2]], displacement: Lane) -> Option<Overlap> {
    match &pair.primary {
        Primary::Surface(surface) => deepest_in(surface, &pair.secondary, inner, points, displacement),
        Primary::HalfPlane { point, normal } => {
            let depth = |s: &SurfaceNode| -dot(from_to(*point, position(s.node, points, displacement)), *normal);
            most(pair.secondary.iter().map(|s| (Some(s.node), depth(s))))
        }
    }
}

/// Deepest of the nodes inside a surface, or of `inner`, a point inside their body.
pub fn deepest_in(
    surface: &Surface,
    nodes: &[SurfaceNode],
    inner: [f64; 2],
    points: &[[f64; 2]],
    displacement: Lane,
) -> Option<Overlap> {
    let posed = Posed { surface, points, displacement };
    let all = 0..surface.segments.len() as u32;
    // An open surface has no inside: what lies farther behind it than contact can see does not count.
    let seen = if surface.is_closed() { f64::INFINITY } else { surface.reach() };
    let depth = |p: [f64; 2]| {
        let found = posed.nearest(p, all.clone()).and_then(|nearest| posed.signed_gap(p, nearest));
        found.map_or(0.0, |gap| if -gap.gap <= seen { -gap.gap } else { 0.0 })
    };
    let at_nodes = nodes.iter().map(|s| (Some(s.node), depth(position(s.node, points, displacement))));
    most(at_nodes.chain([(None, depth(inner))]))
}

fn most(depths: impl Iterator<Item = (Option<u32>, f64)>) -> Option<Overlap> {
    let deepest = depths.filter(|(_, d)| *d > 0.0).max_by(|a, b| a.1.total_cmp(&b.1));
    deepest.map(|(node, depth)| Overlap { node, depth })
}

/// Checks that no bodies overlap by more than their contact allows.
///
/// # Errors
/// An overlap, with the place and the depth of the deepest.
pub fn check_overlap(model: &Model, displacement: Lane) -> Result<()> {
    for pair in &model.pairs {
        let contact = &model.contacts[pair.contact as usize];
        let body = &model.bodies[pair.secondary_body as usize];
        let (points, inner) = (&model.points, body.inner_point(&model.points, displacement));
        let mut found = deepest(pair, inner, points, displacement).map(|o| (body, o));
        if let Some(other) = pair.primary_body {
            // The other way round: a corner of the primary in a side of the secondary.
            let (other, surface) = (&model.bodies[other as usize], model.surface(pair.secondary_body));
            let (nodes, inner) = (other.surface_nodes(), other.inner_point(points, displacement));
            let theirs = deepest_in(&surface, &nodes, inner, points, displacement).map(|o| (other, o));
            let deeper = |a: &Option<(_, Overlap)>| a.as_ref().map_or(0.0, |(_, o)| o.depth);
            found = if deeper(&theirs) > deeper(&found) { theirs } else { found };
        }
        let Some((body, Overlap { node, depth })) = found else { continue };
        if depth > contact.overlap_tolerance {
            let [first, second] = &contact.names;
            let number = |n: u32| model.order.outer(n as usize) - body.nodes.start;
            let place = node.map_or("the inside".into(), |n| format!("node {}", number(n)));
            let what = format!("overlap at {place} of \"{}\"", body.name);
            let bound = format!("<= {:.3e} m at the start", contact.overlap_tolerance);
            let object = format!("contact \"{first}\" on \"{second}\"");
            let remedy = "move the bodies apart or raise the contact's overlap_tolerance";
            return Err(Error::bound(&object, &what, format!("{depth:.3e} m"), &bound, remedy));
        }
    }
    Ok(())
}
