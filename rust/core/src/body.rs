//! One body within the model: its nodes, elements and surface.

use std::ops::Range;

use crate::contact::pair::SurfaceNode;
use crate::contact::surface::position;
use crate::lane::Lane;

/// One body within the model.
#[derive(Debug, Clone)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Its nodes.
    pub nodes: Range<usize>,
    /// Young's modulus (N/m^2).
    pub young: f64,
    /// Its triangles in the model's node numbers.
    pub triangles: Vec<[u32; 3]>,
    /// Its quads in the model's node numbers.
    pub quads: Vec<[u32; 4]>,
    /// Outward boundary loops in the model's node numbers.
    pub loops: Vec<Vec<u32>>,
    /// `K A^2/V` (N/m) of the element behind each boundary edge, loop by loop.
    pub edge_stiffness: Vec<f64>,
    /// Largest element eigenfrequency (rad/s).
    pub element_omega: f64,
    /// Factor of its K in a variant of the model; 1 otherwise.
    pub young_factor: f64,
    /// Factor of its density in a variant of the model, already in the masses; 1 otherwise.
    pub density_factor: f64,
}

impl Body {
    /// Boundary nodes with their neighbours.
    pub fn surface_nodes(&self) -> Vec<SurfaceNode> {
        let of_ring = |ring: &Vec<u32>| -> Vec<SurfaceNode> {
            let n = ring.len();
            let node =
                |i: usize| SurfaceNode { node: ring[i], before: ring[(i + n - 1) % n], after: ring[(i + 1) % n] };
            (0..n).map(node).collect()
        };
        self.loops.iter().flat_map(of_ring).collect()
    }

    /// A point inside the body: the centre of its first element.
    pub fn inner_point(&self, points: &[[f64; 2]], displacement: Lane) -> [f64; 2] {
        let nodes = self.triangles.first().map(|t| t.as_slice()).or(self.quads.first().map(|q| q.as_slice()));
        let nodes = nodes.unwrap_or_default();
        let sum =
            nodes.iter().map(|&n| position(n, points, displacement)).fold([0.0; 2], |s, x| [s[0] + x[0], s[1] + x[1]]);
        sum.map(|s| s / nodes.len() as f64)
    }
}
