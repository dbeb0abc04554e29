//! A surface where it is now: segments at x = X + u, the one nearest to a point, and the signed gap to it.

use super::gap::{Gap, Location, Projection, gap_at_vertex, gap_inside, is_at_end, project, unit_normal};
use super::surface::{Surface, position};
use crate::lane::Lane;

/// A surface with the displacement that places it.
#[derive(Clone, Copy)]
pub struct Posed<'a> {
    /// Vertices and segments.
    pub surface: &'a Surface,
    /// Reference coordinates of the model's nodes (m).
    pub points: &'a [[f64; 2]],
    /// Displacement (m).
    pub displacement: Lane<'a>,
}

impl Posed<'_> {
    /// Position of a node of the model, on this surface or not.
    #[inline]
    pub fn node(&self, node: u32) -> [f64; 2] {
        position(node, self.points, self.displacement)
    }

    /// Ends of a segment.
    #[inline]
    pub fn ends(&self, segment: u32) -> [[f64; 2]; 2] {
        self.surface.segments[segment as usize].ends.map(|v| self.surface.position(v, self.points, self.displacement))
    }

    /// Outward unit normal of a segment.
    #[inline]
    pub fn normal(&self, segment: u32) -> [f64; 2] {
        let [a, b] = self.ends(segment);
        unit_normal(a, b)
    }

    /// Nearest of the segments, the first one of equals.
    #[inline]
    pub fn nearest(&self, p: [f64; 2], segments: impl Iterator<Item = u32>) -> Option<(u32, Projection)> {
        let mut best: Option<(u32, Projection)> = None;
        for segment in segments {
            let [a, b] = self.ends(segment);
            let projection = project(p, a, b);
            if best.is_none_or(|(_, other)| projection.distance2 < other.distance2) {
                best = Some((segment, projection));
            }
        }
        best
    }

    /// Signed gap to the closest point found; none past the end of an open surface.
    #[inline]
    pub fn signed_gap(&self, p: [f64; 2], (segment, projection): (u32, Projection)) -> Option<Gap> {
        let [a, b] = self.ends(segment);
        match projection.location {
            Location::Inside(xi) => Some(gap_inside(p, a, b, xi)),
            // Past an end by round-off only: the segment's own normal, not one made of round-off.
            Location::End(end) if is_at_end(p, a, b, end) => Some(gap_inside(p, a, b, end as f64)),
            Location::End(end) => {
                let this = self.surface.segments[segment as usize];
                let other = if end == 0 { this.before } else { this.after }?;
                let (own, next) = (self.normal(segment), self.normal(other));
                Some(gap_at_vertex(p, if end == 0 { a } else { b }, end, own, next, self.surface.mean_length))
            }
        }
    }
}
