//! Candidates: the segments that a node may meet before the next search.

use parry2d_f64::bounding_volume::Aabb;
use parry2d_f64::math::Vector;
use parry2d_f64::partitioning::{Bvh, BvhNode};

use super::gap::{dot, project, unit_normal};
use super::pair::{Place, SurfaceNode, nearest, signed_gap};
use super::surface::{Surface, position};
use crate::lane::Lane;

/// Facing is less than this scalar product of a segment's unit normal and the sum of the node's two: flanks at a right
/// angle must not come and go with round-off.
const FACING: f64 = -1e-6;

/// A segment that a node may meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// Segment of the primary surface.
    pub segment: u32,
    /// Whether its normal opposes the node's own: a thin body has two sides, and only one is met.
    pub faces: bool,
}

/// Candidate segments of each secondary node that may come into contact before the next search.
#[derive(Debug, Clone, Default)]
pub struct Candidates {
    nodes: Vec<u32>,
    start: Vec<u32>,
    segments: Vec<Candidate>,
}

impl Candidates {
    /// Each candidate node with its segments.
    pub fn iter(&self) -> impl Iterator<Item = (u32, &[Candidate])> {
        let segments = |i: usize| &self.segments[self.start[i] as usize..self.start[i + 1] as usize];
        self.nodes.iter().enumerate().map(move |(i, &node)| (node, segments(i)))
    }

    /// Room for every node with a few segments.
    pub(super) fn with_room(nodes: usize) -> Self {
        let (start, segments) = (Vec::with_capacity(nodes + 1), Vec::with_capacity(8 * nodes));
        Self { nodes: Vec::with_capacity(nodes), start, segments }
    }

    pub(super) fn clear(&mut self) {
        self.nodes.clear();
        self.segments.clear();
        self.start.clear();
        self.start.push(0);
    }

    pub(super) fn push(&mut self, node: u32) {
        self.nodes.push(node);
        self.start.push(self.segments.len() as u32);
    }
}

/// What decides which segments of one surface a node may meet before the next search.
pub(super) struct Near<'a> {
    pub surface: &'a Surface,
    pub tree: &'a Bvh,
    pub points: &'a [[f64; 2]],
    pub displacement: Lane<'a>,
    pub skin: f64,
}

impl Near<'_> {
    /// Segments that can become the node's nearest, or its nearest facing one, while the skin lasts.
    pub(super) fn collect(&self, secondary: &SurfaceNode, near: &mut Vec<Candidate>, candidates: &mut Candidates) {
        let place = (position(secondary.node, self.points, self.displacement), self.points, self.displacement);
        self.around(secondary, place, near);
        let Some((closest, projection)) = nearest(self.surface, near.iter(), place) else { return };
        let gap = signed_gap(self.surface, closest.segment, projection, place);
        let distance = projection.distance2.sqrt();
        // An outside node farther than the skin cannot arrive; past the end of an open surface the side is unknown.
        if gap.is_none_or(|g| g.gap >= 0.0) && distance > self.skin {
            return;
        }
        let facing = nearest(self.surface, near.iter().filter(|c| c.faces), place);
        let Some((_, facing)) = facing else { return };
        let reach = distance + 2.0 * self.skin;
        let reach_facing = facing.distance2.sqrt() + 2.0 * self.skin;
        for &candidate in near.iter() {
            let [a, b] = self.surface.ends(candidate.segment, self.points, self.displacement);
            let distance = project(place.0, a, b).distance2.sqrt();
            if distance <= reach || (candidate.faces && distance <= reach_facing) {
                candidates.segments.push(candidate);
            }
        }
        candidates.push(secondary.node);
    }

    /// Segments whose box is within reach of the node.
    fn around(&self, secondary: &SurfaceNode, (p, ..): Place, near: &mut Vec<Candidate>) {
        let at = |node| position(node, self.points, self.displacement);
        let (n1, n2) = (unit_normal(at(secondary.before), p), unit_normal(p, at(secondary.after)));
        let normal = [n1[0] + n2[0], n1[1] + n2[1]];
        let reach = self.surface.reach() + self.skin;
        let (low, high) = (Vector::new(p[0] - reach, p[1] - reach), Vector::new(p[0] + reach, p[1] + reach));
        let around = BvhNode::leaf(Aabb::new(low, high), 0);
        near.clear();
        for segment in self.tree.leaves(|node| around.intersects(node)) {
            let n = self.surface.normal(segment, self.points, self.displacement);
            near.push(Candidate { segment, faces: dot(n, normal) < FACING });
        }
        near.sort_unstable_by_key(|c| c.segment);
    }
}
