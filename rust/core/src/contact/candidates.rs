//! Candidates: the segments that a node may meet before the next search.

use parry2d_f64::bounding_volume::Aabb;
use parry2d_f64::math::Vector;
use parry2d_f64::partitioning::{Bvh, BvhNode};

use super::gap::project;
use super::pair::{ON_SURFACE, SurfaceNode, faces};
use super::posed::Posed;

/// Secondary nodes that may come into contact before the next search, each with the segments it may meet.
#[derive(Debug, Clone, Default)]
pub struct Candidates {
    /// Places in the pair's list of secondary nodes.
    nodes: Vec<u32>,
    start: Vec<u32>,
    segments: Vec<u32>,
    /// How far (m) surfaces must travel before the node can be inside, by candidate.
    clear: Vec<f64>,
    /// Depth (m) of each secondary node at the last search, 0 outside.
    depth: Vec<f64>,
}

impl Candidates {
    /// Place of each candidate in the pair's list of secondary nodes, with its segments.
    pub fn iter(&self) -> impl Iterator<Item = (u32, &[u32])> {
        let segments = |i: usize| &self.segments[self.start[i] as usize..self.start[i + 1] as usize];
        self.nodes.iter().enumerate().map(move |(i, &node)| (node, segments(i)))
    }

    /// Those of them that may be inside after surfaces have travelled so far (m) since the search.
    pub fn within(&self, travel: f64) -> impl Iterator<Item = (u32, &[u32])> {
        // What is not a number passes nobody over.
        self.iter()
            .zip(&self.clear)
            .filter(move |(_, clear)| travel.is_nan() || **clear <= travel)
            .map(|(candidate, _)| candidate)
    }

    /// Room for every node with a few segments.
    pub(super) fn with_room(nodes: usize) -> Self {
        let (start, segments) = (Vec::with_capacity(nodes + 1), Vec::with_capacity(8 * nodes));
        let (depth, clear, nodes) = (vec![0.0; nodes], Vec::with_capacity(nodes), Vec::with_capacity(nodes));
        Self { nodes, start, segments, clear, depth }
    }

    pub(super) fn clear(&mut self) {
        self.nodes.clear();
        self.segments.clear();
        self.clear.clear();
        self.start.clear();
        self.start.push(0);
    }

    pub(super) fn push(&mut self, node: u32, clear: f64) {
        self.nodes.push(node);
        self.clear.push(clear);
        self.start.push(self.segments.len() as u32);
    }
}

/// What decides which segments of one surface a node may meet before the next search.
pub(super) struct Near<'a> {
    pub posed: Posed<'a>,
    pub tree: &'a Bvh,
    pub skin: f64,
    /// How far (m) surfaces have travelled since the search before; infinite at the first, and for an open surface, which
    /// can be entered round its ends.
    pub travel: f64,
    /// The surface is closed.
    pub closed: bool,
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
        let (p, surface) = (self.posed.node(secondary.node), self.posed.surface);
        // As deep as it can be by now, or as far outside as it may be to matter.
        let before = std::mem::take(&mut candidates.depth[index as usize]);
        let deepest = (before + self.travel).min(surface.reach());
        let mut radius = deepest.max(self.skin) + 2.0 * self.skin;
        self.around(p, radius, near);
        let Some(nearest) = self.posed.nearest(p, near.iter().copied()) else { return };
        let (gap, distance) = (self.posed.signed_gap(p, nearest), nearest.1.distance2.sqrt());
        // An outside node farther than the skin cannot arrive; past the end of an open surface the side is unknown.
        let outside = gap.is_none_or(|g| g.gap >= 0.0);
        if (outside && distance > self.skin) || distance > radius {
            return;
        }
        let faces = faces(&self.posed, secondary);
        let facing = |near: &[u32]| self.posed.nearest(p, near.iter().copied().filter(|s| faces(*s)));
        let mut found = facing(near).map(|(_, f)| f.distance2.sqrt()).filter(|d| *d <= radius);
        if found.is_none() && self.closed {
            // Past the middle of the body: the side it came from is farther away than that.
            radius = surface.size + self.skin;
            self.around(p, radius, near);
            found = facing(near).map(|(_, f)| f.distance2.sqrt());
        }
        let reach = distance + 2.0 * self.skin;
        let reach_facing = found.map_or(0.0, |d| d + 2.0 * self.skin);
        if reach.max(reach_facing) > radius {
            self.around(p, reach.max(reach_facing), near);
        }
        for &segment in near.iter() {
            let [a, b] = self.posed.ends(segment);
            let distance = project(p, a, b).distance2.sqrt();
            if distance <= reach || (distance <= reach_facing && faces(segment)) {
                candidates.segments.push(segment);
            }
        }
        candidates.depth[index as usize] = if outside { 0.0 } else { distance };
        // On the surface by round-off counts as inside when the side is decided.
        let clear = if gap.is_some_and(|g| g.gap >= 0.0) { distance - 2.0 * ON_SURFACE * surface.size } else { 0.0 };
        candidates.push(index, clear);
    }

    /// Segments whose box is within reach of a point.
    fn around(&self, p: [f64; 2], reach: f64, near: &mut Vec<u32>) {
        let (low, high) = (Vector::new(p[0] - reach, p[1] - reach), Vector::new(p[0] + reach, p[1] + reach));
        let around = BvhNode::leaf(Aabb::new(low, high), 0);
        near.clear();
        near.extend(self.tree.leaves(|node| around.intersects(node)));
        near.sort_unstable();
    }
}
