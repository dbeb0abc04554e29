//! Node-to-segment gap and its gradient (Hallquist et al. 1985; Wriggers 2006, ch. 6).

use parry2d_f64::math::Vector;
use parry2d_f64::query::PointQueryWithLocation;
use parry2d_f64::shape::{Segment, SegmentPointLocation};

/// Where on a segment the closest point lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Location {
    /// Inside, at xi in (0, 1) from the first end.
    Inside(f64),
    /// At the first (0) or second (1) end.
    End(usize),
}

/// Projection of a point on one segment.
#[derive(Debug, Clone, Copy)]
pub struct Projection {
    /// Squared distance to the closest point (m^2).
    pub distance2: f64,
    /// Where the closest point lies.
    pub location: Location,
}

/// Gap with the weights of its gradient: `dg/dp = n`, `dg/dx_k = -w_k n` for the segment's ends k.
#[derive(Debug, Clone, Copy)]
pub struct Gap {
    /// Signed gap (m), negative inside the primary body.
    pub gap: f64,
    /// Outward unit normal of the primary surface at the closest point.
    pub normal: [f64; 2],
    /// Weights of the two ends.
    pub weights: [f64; 2],
}

/// Vector from a to b.
#[inline]
pub fn from_to(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [b[0] - a[0], b[1] - a[1]]
}

/// Scalar product.
#[inline]
pub fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Outward normal of a segment, as long as the segment: right of travel.
#[inline]
pub fn long_normal(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [b[1] - a[1], a[0] - b[0]]
}

/// Outward unit normal of a segment.
#[inline]
pub fn unit_normal(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let n = long_normal(a, b);
    let length = dot(n, n).sqrt();
    [n[0] / length, n[1] / length]
}

/// Closest point of the segment from a to b.
#[inline]
pub fn project(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> Projection {
    let vector = |x: [f64; 2]| Vector::new(x[0], x[1]);
    let segment = Segment::new(vector(a), vector(b));
    let (closest, location) = segment.project_local_point_and_get_location(vector(p), false);
    let location = match location {
        SegmentPointLocation::OnEdge(weights) => Location::Inside(weights[1]),
        SegmentPointLocation::OnVertex(end) => Location::End(end as usize),
    };
    Projection { distance2: (vector(p) - closest.point).length_squared(), location }
}

/// True when the foot of the perpendicular passes an end of the segment by no more than round-off.
#[inline]
pub fn is_at_end(p: [f64; 2], a: [f64; 2], b: [f64; 2], end: usize) -> bool {
    let t = from_to(a, b);
    let xi = dot(from_to(a, p), t) / dot(t, t);
    (xi - end as f64).abs() < 1e-9
}

/// Gap to the line of a segment whose closest point lies inside it.
#[inline]
pub fn gap_inside(p: [f64; 2], a: [f64; 2], b: [f64; 2], xi: f64) -> Gap {
    let normal = unit_normal(a, b);
    Gap { gap: dot(from_to(a, p), normal), normal, weights: [1.0 - xi, xi] }
}

/// Gap to a vertex that is the closest point of both segments that meet there, with unit normals n1 and n2.
///
/// The segment that d = p - vertex crosses more squarely tells the side. The normal lies along d, so that the
/// pair of forces has no moment; where d is nothing but round-off, the mean of the two normals.
#[inline]
pub fn gap_at_vertex(p: [f64; 2], vertex: [f64; 2], end: usize, n1: [f64; 2], n2: [f64; 2], length: f64) -> Gap {
    let d = from_to(vertex, p);
    let (s1, s2) = (dot(d, n1), dot(d, n2));
    let side = if s1.abs() >= s2.abs() { s1 } else { s2 };
    let distance = dot(d, d).sqrt();
    let gap = distance.copysign(side);
    let normal = if distance > 1e-12 * length {
        [d[0] / gap, d[1] / gap]
    } else {
        let sum = [n1[0] + n2[0], n1[1] + n2[1]];
        let norm = dot(sum, sum).sqrt();
        if norm > 0.0 { [sum[0] / norm, sum[1] / norm] } else { n1 }
    };
    let mut weights = [0.0; 2];
    weights[end] = 1.0;
    Gap { gap, normal, weights }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Central finite difference of the gap over all six coordinates against the weights.
    fn check_gradient(p: [f64; 2], a: [f64; 2], b: [f64; 2], gap: impl Fn([[f64; 2]; 3]) -> Gap) {
        let base = gap([p, a, b]);
        let weight = [1.0, -base.weights[0], -base.weights[1]];
        for (point, w) in weight.iter().enumerate() {
            for axis in 0..2 {
                let moved = |h: f64| {
                    let mut x = [p, a, b];
                    x[point][axis] += h;
                    gap(x).gap
                };
                let difference = (moved(1e-6) - moved(-1e-6)) / 2e-6;
                assert!((difference - w * base.normal[axis]).abs() < 1e-8, "point {point} axis {axis}");
            }
        }
    }

    #[test]
    fn gradient_inside_a_segment_matches_finite_differences() {
        for (p, a, b) in [([0.3, -0.1], [0.0, 0.0], [1.0, 0.2]), ([1.0, 2.0], [3.0, 1.0], [-1.0, 1.5])] {
            check_gradient(p, a, b, |[p, a, b]| match project(p, a, b).location {
                Location::Inside(xi) => gap_inside(p, a, b, xi),
                Location::End(_) => panic!("the projection must fall inside"),
            });
        }
    }

    #[test]
    fn gradient_at_a_reentrant_vertex_matches_finite_differences() {
        // Body above a notch: edges come down to (0, 0) from the left and rise to the right.
        let (n1, n2) = (unit_normal([1.0, 1.0], [0.0, 0.0]), unit_normal([0.0, 0.0], [-1.0, 1.0]));
        let inside = gap_at_vertex([0.05, -0.2], [0.0, 0.0], 1, n1, n2, 1.0);
        assert!(inside.gap > 0.0 || dot(inside.normal, n1) > 0.0);
        check_gradient([0.05, -0.2], [5.0, 5.0], [0.0, 0.0], |[p, _, b]| gap_at_vertex(p, b, 1, n1, n2, 1.0));
    }

    #[test]
    fn penetration_is_negative_on_the_left_of_travel() {
        let (a, b) = ([0.0, 0.0], [1.0, 0.0]);
        assert!(gap_inside([0.5, 0.1], a, b, 0.5).gap < 0.0);
        assert_eq!(gap_inside([0.5, -0.1], a, b, 0.5).normal, [0.0, -1.0]);
    }
}
