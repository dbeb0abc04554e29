//! Candidates: the segments that a node may meet before the next search.

use parry2d_f64::bounding_volume::Aabb;
use parry2d_f64::math::Vector;
use parry2d_f64::partitioning::{Bvh, BvhNode};

use super::gap::project;
use super::pair::{SurfaceNode, faces};
use super::posed::Posed;

/// Secondary nodes that may come into contact before the next search, each with the segments it may meet.
#[derive(Debug, Clone, Default)]
pub struct Candidates {
    /// Places in the pair's list of secondary nodes.
    nodes: Vec<u32>,
    start: Vec<u32>,
    segments: Vec<u32>,
}

impl Candidates {
    /// Place of each candidate in the pair's list of secondary nodes, with its segments.
    pub fn iter(&self) -> impl Iterator<Item = (u32, &[u32])> {
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
    pub posed: Posed<'a>,
    pub tree: &'a Bvh,
    pub skin: f64,
}

impl Near<'_> {
    /// Segments that can become the node's nearest, or its nearest facing one, while the skin lasts.
    pub(super) fn collect(
        &self,
        index: u32,
        secondary: &SurfaceNode,
        near: &mut Vec<u32>,
        candidates: &mut Candidates,
    ) {
        let p = self.posed.node(secondary.node);
        self.around(p, self.posed.surface.reach(), near);
        let Some(nearest) = self.posed.nearest(p, near.iter().copied()) else { return };
        let (gap, distance) = (self.posed.signed_gap(p, nearest), nearest.1.distance2.sqrt());
        // An outside node farther than the skin cannot arrive; past the end of an open surface the side is unknown.
        if gap.is_none_or(|g| g.gap >= 0.0) && distance > self.skin {
            return;
        }
        let faces = faces(&self.posed, secondary);
        let mut facing = self.posed.nearest(p, near.iter().copied().filter(|s| faces(*s)));
        if facing.is_none() && self.posed.surface.is_closed() {
            // Past the middle of the body: the side it came from is farther away than that.
            self.around(p, self.posed.surface.size, near);
            facing = self.posed.nearest(p, near.iter().copied().filter(|s| faces(*s)));
        }
        let reach = distance + 2.0 * self.skin;
        let reach_facing = facing.map_or(0.0, |(_, f)| f.distance2.sqrt() + 2.0 * self.skin);
        for &segment in near.iter() {
            let [a, b] = self.posed.ends(segment);
            let distance = project(p, a, b).distance2.sqrt();
            if distance <= reach || (distance <= reach_facing && faces(segment)) {
                candidates.segments.push(segment);
            }
        }
        candidates.push(index);
    }

    /// Segments whose box is within reach of a point, and a skin more.
    fn around(&self, p: [f64; 2], reach: f64, near: &mut Vec<u32>) {
        let reach = reach + self.skin;
        let (low, high) = (Vector::new(p[0] - reach, p[1] - reach), Vector::new(p[0] + reach, p[1] + reach));
        let around = BvhNode::leaf(Aabb::new(low, high), 0);
        near.clear();
        near.extend(self.tree.leaves(|node| around.intersects(node)));
        near.sort_unstable();
    }
}
