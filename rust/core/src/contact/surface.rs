//! A surface: vertices joined by segments, of a body (its nodes) or of a rigid obstacle (fixed points).

use crate::lane::Lane;

use super::gap::from_to;

/// One segment with its neighbours along the surface.
#[derive(Debug, Clone, Copy)]
pub struct Segment {
    /// Vertices of its two ends; the body lies on the left of travel.
    pub ends: [u32; 2],
    /// Segment before it, unless the surface starts here.
    pub before: Option<u32>,
    /// Segment after it, unless the surface ends here.
    pub after: Option<u32>,
}

/// Where the vertices are.
#[derive(Debug, Clone)]
pub enum Vertices {
    /// Node numbers of the model: vertices move with them.
    Nodes(Vec<u32>),
    /// Fixed points (m) of a rigid obstacle, without degrees of freedom.
    Fixed(Vec<[f64; 2]>),
}

/// Vertices and the segments between them.
#[derive(Debug, Clone)]
pub struct Surface {
    /// Vertices.
    pub vertices: Vertices,
    /// Segments.
    pub segments: Vec<Segment>,
    /// `K A^2/V` (N/m) of the element behind each segment; empty for a rigid obstacle.
    pub element_stiffness: Vec<f64>,
    /// Mean length of the segments in the reference configuration (m).
    pub mean_length: f64,
    /// Smaller extent of the bounding box in the reference configuration (m).
    pub extent: f64,
    /// Larger extent of the bounding box (m).
    pub size: f64,
}

impl Surface {
    /// Surface over rings (or, when not closed, chains) of vertices; `points` are their reference positions.
    pub fn new(rings: &[Vec<u32>], closed: bool, points: &[[f64; 2]], vertices: Vertices) -> Self {
        let mut segments: Vec<Segment> = Vec::new();
        for ring in rings {
            let first = segments.len() as u32;
            let count = if closed { ring.len() } else { ring.len() - 1 } as u32;
            for i in 0..count {
                let ends = [ring[i as usize], ring[(i as usize + 1) % ring.len()]];
                let before = if i > 0 { Some(first + i - 1) } else { closed.then_some(first + count - 1) };
                let after = if i + 1 < count { Some(first + i + 1) } else { closed.then_some(first) };
                segments.push(Segment { ends, before, after });
            }
        }
        let at = |v: u32| match &vertices {
            Vertices::Nodes(nodes) => points[nodes[v as usize] as usize],
            Vertices::Fixed(fixed) => fixed[v as usize],
        };
        let length = |s: &Segment| {
            let t = from_to(at(s.ends[0]), at(s.ends[1]));
            t[0].hypot(t[1])
        };
        let mean_length = segments.iter().map(length).sum::<f64>() / segments.len() as f64;
        let [width, height] = [0, 1].map(|axis| {
            let values = || rings.iter().flatten().map(|&v| at(v)[axis]);
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
        });
        let (extent, size) = (width.min(height), width.max(height));
        Self { vertices, segments, element_stiffness: Vec::new(), mean_length, extent, size }
    }

    /// Deepest penetration (m) that the search still sees.
    pub fn reach(&self) -> f64 {
        (0.5 * self.extent).max(2.0 * self.mean_length)
    }

    /// Node of a vertex; none on a rigid obstacle.
    #[inline]
    pub fn node(&self, vertex: u32) -> Option<u32> {
        match &self.vertices {
            Vertices::Nodes(nodes) => Some(nodes[vertex as usize]),
            Vertices::Fixed(_) => None,
        }
    }

    /// Current position x = X + u of a vertex.
    #[inline]
    pub fn position(&self, vertex: u32, points: &[[f64; 2]], displacement: Lane) -> [f64; 2] {
        match &self.vertices {
            Vertices::Fixed(fixed) => fixed[vertex as usize],
            Vertices::Nodes(nodes) => position(nodes[vertex as usize], points, displacement),
        }
    }
}

/// Current position x = X + u of a node.
#[inline]
pub fn position(node: u32, points: &[[f64; 2]], displacement: Lane) -> [f64; 2] {
    let (x, u) = (points[node as usize], displacement.at(node));
    [x[0] + u[0], x[1] + u[1]]
}

impl Surface {
    /// True when every segment has neighbours on both sides.
    pub fn is_closed(&self) -> bool {
        self.segments.iter().all(|s| s.before.is_some() && s.after.is_some())
    }
}
