//! A contact pair: secondary nodes against a primary surface; the narrow phase and its rows.

use std::collections::HashMap;

use super::candidates::{Candidate, Candidates};
use super::gap::{Gap, Location, Projection, dot, from_to, gap_at_vertex, gap_inside, is_at_end, long_normal, project};
use super::surface::{Surface, position};
use crate::lane::Lane;
use crate::row::{Behind, Row};

/// A secondary node with its neighbours along its own surface.
#[derive(Debug, Clone, Copy)]
pub struct SurfaceNode {
    /// Node of the model.
    pub node: u32,
    /// Node before it on the loop.
    pub before: u32,
    /// Node after it on the loop.
    pub after: u32,
}

/// What the secondary nodes must not enter.
#[derive(Debug, Clone)]
pub enum Primary {
    /// Segments of a body or of a rigid polyline.
    Surface(Surface),
    /// Rigid half-plane: the body stays where (x - point) . normal >= 0.
    HalfPlane {
        /// A point of the line (m).
        point: [f64; 2],
        /// Unit normal out of the obstacle.
        normal: [f64; 2],
    },
}

/// Secondary nodes against one primary, in one direction.
#[derive(Debug, Clone)]
pub struct Pair {
    /// Which contact of the scene it serves; a contact of two passes has two pairs.
    pub contact: u32,
    /// True for the pair whose secondary nodes belong to the contact's first-named body.
    pub first_pass: bool,
    /// Body of the secondary nodes.
    pub secondary_body: u32,
    /// Body of the primary surface; none when rigid.
    pub primary_body: Option<u32>,
    /// Secondary nodes.
    pub secondary: Vec<SurfaceNode>,
    /// Mean length of the edges between secondary nodes in the reference configuration (m).
    pub secondary_length: f64,
    /// Primary surface.
    pub primary: Primary,
    /// Young's modulus of the stiffer body (N/m^2).
    pub young: f64,
    /// `K A^2/V` (N/m) of the elements behind the secondary nodes, kept where the primary has no elements.
    pub node_stiffness: HashMap<u32, f64>,
}

impl Pair {
    /// Rows of the candidates that penetrate: gap below zero.
    pub fn rows(&self, candidates: &Candidates, points: &[[f64; 2]], displacement: Lane, rows: &mut Vec<Row>) {
        match &self.primary {
            Primary::HalfPlane { point, normal } => {
                for (node, _) in candidates.iter() {
                    let gap = dot(from_to(*point, position(node, points, displacement)), *normal);
                    if gap < 0.0 {
                        rows.push(Row::new(&[(node, *normal)], self.contact, gap, self.behind(node, None)));
                    }
                }
            }
            Primary::Surface(surface) => {
                for (node, segments) in candidates.iter() {
                    let p = position(node, points, displacement);
                    if let Some((segment, gap)) = penetration(surface, segments, p, points, displacement) {
                        rows.push(self.row(surface, node, segment, gap));
                    }
                }
            }
        }
    }

    fn row(&self, surface: &Surface, node: u32, segment: u32, gap: Gap) -> Row {
        let mut entries = [(node, gap.normal), (0, [0.0; 2]), (0, [0.0; 2])];
        let mut count = 1;
        for (vertex, w) in surface.segments[segment as usize].ends.into_iter().zip(gap.weights) {
            if let Some(primary) = surface.node(vertex).filter(|_| w != 0.0) {
                entries[count] = (primary, [-w * gap.normal[0], -w * gap.normal[1]]);
                count += 1;
            }
        }
        Row::new(&entries[..count], self.contact, gap.gap, self.behind(node, Some((surface, segment))))
    }

    /// What is behind a row: the element of the primary segment, or the secondary node's own at a rigid obstacle.
    fn behind(&self, node: u32, primary: Option<(&Surface, u32)>) -> Behind {
        let segment = primary.and_then(|(surface, segment)| surface.element_stiffness.get(segment as usize).copied());
        let own = || self.node_stiffness.get(&node).copied().unwrap_or(0.0);
        Behind { young: self.young, element_stiffness: segment.unwrap_or_else(own) }
    }
}

/// Outside by less than this share of the primary's extent counts as on the surface when the side is decided: a node
/// that slides along a flank must not come and go with round-off.
const ON_SURFACE: f64 = 1e-9;

/// Gap of a node to the nearest segment that faces it, if the node lies inside the primary.
///
/// The nearest of all segments tells inside from outside; the nearest that faces the node tells where to push it,
/// so that a node past the middle of a thin body goes back the way it came.
#[inline]
fn penetration(
    surface: &Surface,
    candidates: &[Candidate],
    p: [f64; 2],
    points: &[[f64; 2]],
    displacement: Lane,
) -> Option<(u32, Gap)> {
    // A point inside lies behind the line of its nearest segment: in front of all of them there is no contact.
    let behind = |c: &Candidate| {
        let [a, b] = surface.ends(c.segment, points, displacement);
        dot(from_to(a, p), long_normal(a, b)) < 0.0
    };
    if !candidates.iter().any(behind) {
        return None;
    }
    let place = (p, points, displacement);
    let (closest, projection) = nearest(surface, candidates.iter(), place)?;
    let gap = signed_gap(surface, closest.segment, projection, place)?;
    if gap.gap > ON_SURFACE * surface.size {
        return None;
    }
    let (segment, gap) = if closest.faces {
        (closest.segment, gap)
    } else {
        let (facing, projection) = nearest(surface, candidates.iter().filter(|c| c.faces), place)?;
        (facing.segment, signed_gap(surface, facing.segment, projection, place)?)
    };
    (gap.gap < 0.0).then_some((segment, gap))
}

/// Position of a node, with what places the segments: reference points and displacement.
pub(super) type Place<'a> = ([f64; 2], &'a [[f64; 2]], Lane<'a>);

/// Nearest of the segments, the first one of equals.
pub(super) fn nearest<'c>(
    surface: &Surface,
    candidates: impl Iterator<Item = &'c Candidate>,
    (p, points, displacement): Place,
) -> Option<(Candidate, Projection)> {
    let mut best: Option<(Candidate, Projection)> = None;
    for &candidate in candidates {
        let [a, b] = surface.ends(candidate.segment, points, displacement);
        let projection = project(p, a, b);
        if best.is_none_or(|(_, other)| projection.distance2 < other.distance2) {
            best = Some((candidate, projection));
        }
    }
    best
}

/// Signed gap to the closest point found; none past the end of an open surface.
pub(super) fn signed_gap(
    surface: &Surface,
    segment: u32,
    projection: Projection,
    (p, points, displacement): Place,
) -> Option<Gap> {
    let [a, b] = surface.ends(segment, points, displacement);
    match projection.location {
        Location::Inside(xi) => Some(gap_inside(p, a, b, xi)),
        // Past an end by round-off only: the segment's own normal, not one made of round-off.
        Location::End(end) if is_at_end(p, a, b, end) => Some(gap_inside(p, a, b, end as f64)),
        Location::End(end) => {
            let this = surface.segments[segment as usize];
            let other = if end == 0 { this.before } else { this.after }?;
            let own = surface.normal(segment, points, displacement);
            let next = surface.normal(other, points, displacement);
            Some(gap_at_vertex(p, if end == 0 { a } else { b }, end, own, next, surface.mean_length))
        }
    }
}

impl Pair {
    /// Deepest penetration (m) that the search still sees: half the smaller extent of the primary, two segments at
    /// least; a half-plane has no far side.
    pub fn reach(&self) -> f64 {
        match &self.primary {
            Primary::Surface(surface) => surface.reach(),
            Primary::HalfPlane { .. } => f64::INFINITY,
        }
    }

    /// Mean segment length of the primary surface; of the secondary one against a half-plane (m).
    pub fn segment_length(&self) -> f64 {
        match &self.primary {
            Primary::Surface(surface) => surface.mean_length,
            Primary::HalfPlane { .. } => self.secondary_length,
        }
    }
}
