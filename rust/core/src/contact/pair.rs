//! A contact pair: secondary nodes against a primary surface; the narrow phase and its rows.

use std::collections::HashMap;

use super::candidates::Candidates;
use super::gap::{Gap, dot, from_to, long_normal, unit_normal};
use super::posed::Posed;
use super::surface::{Surface, position};
use crate::lane::Lane;
use crate::order::Order;
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
    /// The scene's node numbers, for messages.
    pub order: Order,
}

impl Pair {
    /// Rows of the candidates that penetrate: gap below zero. Surfaces have travelled so far (m) since the search.
    pub fn rows(
        &self,
        candidates: &Candidates,
        travel: f64,
        points: &[[f64; 2]],
        displacement: Lane,
        rows: &mut Vec<Row>,
    ) {
        match &self.primary {
            Primary::HalfPlane { point, normal } => {
                for (index, _) in candidates.within(travel) {
                    let node = self.secondary[index as usize].node;
                    let gap = dot(from_to(*point, position(node, points, displacement)), *normal);
                    if gap < 0.0 {
                        rows.push(Row::new(&[(node, *normal)], self.contact, gap, self.behind(node, None)));
                    }
                }
            }
            Primary::Surface(surface) => {
                let posed = Posed { surface, points, displacement };
                for (index, segments) in candidates.within(travel) {
                    let secondary = &self.secondary[index as usize];
                    if let Some((segment, gap)) = penetration(&posed, secondary, segments) {
                        rows.push(self.row(surface, secondary.node, segment, gap));
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
pub(super) const ON_SURFACE: f64 = 1e-9;

/// Facing is less than this scalar product of a segment's unit normal and the sum of the node's two: flanks at a right
/// angle must not come and go with round-off.
const FACING: f64 = -1e-6;

/// True for segments whose normal opposes the node's own: a thin body has two sides, and only one is met.
#[inline]
pub(super) fn faces<'p>(posed: &'p Posed, secondary: &SurfaceNode) -> impl Fn(u32) -> bool + 'p {
    let [before, p, after] = [secondary.before, secondary.node, secondary.after].map(|n| posed.node(n));
    let (n1, n2) = (unit_normal(before, p), unit_normal(p, after));
    let normal = [n1[0] + n2[0], n1[1] + n2[1]];
    move |segment| dot(posed.normal(segment), normal) < FACING
}

/// Gap of a node to the nearest segment that faces it, if the node lies inside the primary.
///
/// The nearest of all segments tells inside from outside; the nearest that faces the node tells where to push it,
/// so that a node past the middle of a thin body goes back the way it came.
#[inline]
fn penetration(posed: &Posed, secondary: &SurfaceNode, segments: &[u32]) -> Option<(u32, Gap)> {
    let p = posed.node(secondary.node);
    // A point inside lies behind the line of its nearest segment: in front of all of them there is no contact.
    let behind = |&segment: &u32| {
        let [a, b] = posed.ends(segment);
        dot(from_to(a, p), long_normal(a, b)) < 0.0
    };
    if !segments.iter().any(behind) {
        return None;
    }
    let nearest = posed.nearest(p, segments.iter().copied())?;
    let gap = posed.signed_gap(p, nearest)?;
    if gap.gap > ON_SURFACE * posed.surface.size {
        return None;
    }
    let faces = faces(posed, secondary);
    let (segment, gap) = if faces(nearest.0) {
        (nearest.0, gap)
    } else {
        let facing = posed.nearest(p, segments.iter().copied().filter(|s| faces(*s)))?;
        (facing.0, posed.signed_gap(p, facing)?)
    };
    (gap.gap < 0.0).then_some((segment, gap))
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
