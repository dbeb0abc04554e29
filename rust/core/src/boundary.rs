//! Outward boundary loops: the body on the left, the outward normal on the right of travel.

use crate::element::signed_area;
use crate::error::{Error, Result};
use crate::material::Material;
use crate::mesh::Mesh;

/// Closed loops of node numbers; the edge from `loop[i]` to `loop[i + 1]` has the body on its left.
///
/// # Errors
/// An edge that belongs to more than two elements, or a node where the boundary touches itself.
pub fn boundary_loops(mesh: &Mesh) -> Result<Vec<Vec<usize>>> {
    let next = outgoing_edges(mesh)?;
    let mut visited = vec![false; mesh.points.len()];
    let mut loops = Vec::new();
    for start in (0..next.len()).filter(|node| next[*node].is_some()) {
        if visited[start] {
            continue;
        }
        let (mut ring, mut node) = (Vec::new(), start);
        while !visited[node] {
            visited[node] = true;
            ring.push(node);
            node = next[node].ok_or_else(|| open_boundary(node, "leads nowhere"))?;
        }
        if node != start {
            return Err(open_boundary(node, "is entered twice"));
        }
        loops.push(ring);
    }
    Ok(loops)
}

/// `K A^2/V` (N/m) of the element behind each boundary edge, loop by loop: bulk modulus K, area A of the edge times the
/// thickness, volume V of the element (Hallquist, Goudreau and Benson 1985).
pub fn edge_stiffness(mesh: &Mesh, loops: &[Vec<usize>], material: &Material, thickness: f64) -> Vec<f64> {
    let mut next = vec![usize::MAX; mesh.points.len()];
    let edges = || loops.iter().flat_map(|ring| (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])));
    edges().for_each(|(a, b)| next[a] = b);
    // One edge leaves each boundary node, so its element is known by that node.
    let mut area_behind = vec![0.0; mesh.points.len()];
    for (_, _, nodes) in mesh.elements() {
        for (a, _) in ring_of(nodes).filter(|(a, b)| next[*a] == *b) {
            area_behind[a] = polygon_area(mesh, nodes);
        }
    }
    let stiffness = |(a, b): (usize, usize)| {
        let (p, q) = (mesh.points[a], mesh.points[b]);
        let length2 = (q[0] - p[0]).powi(2) + (q[1] - p[1]).powi(2);
        material.bulk_modulus() * thickness * length2 / area_behind[a]
    };
    edges().map(stiffness).collect()
}

fn polygon_area(mesh: &Mesh, nodes: &[usize]) -> f64 {
    let points: Vec<[f64; 2]> = nodes.iter().map(|&n| mesh.points[n]).collect();
    signed_area(&points)
}

/// Edges of an element, counter-clockwise.
fn ring_of(nodes: &[usize]) -> impl Iterator<Item = (usize, usize)> + '_ {
    (0..nodes.len()).map(|i| (nodes[i], nodes[(i + 1) % nodes.len()]))
}

/// By node, the second node of the edge that leaves it and that one element has to itself.
fn outgoing_edges(mesh: &Mesh) -> Result<Vec<Option<usize>>> {
    let mut edges: Vec<([usize; 2], usize)> = Vec::with_capacity(4 * (mesh.triangles.len() + mesh.quads.len()));
    for (_, _, nodes) in mesh.elements() {
        edges.extend(ring_of(nodes).map(|(a, b)| ([a.min(b), a.max(b)], a)));
    }
    edges.sort_unstable();
    let mut next = vec![None; mesh.points.len()];
    for same in edges.chunk_by(|a, b| a.0 == b.0) {
        let ([low, high], from) = same[0];
        if same.len() > 2 {
            let what = format!("number of elements on the edge between nodes {low} and {high}");
            return Err(Error::bound("mesh", &what, same.len(), "<= 2", "remove overlapping elements"));
        }
        if same.len() == 1 && next[from].replace(low + high - from).is_some() {
            return Err(open_boundary(from, "has two edges that leave it: the body touches itself there"));
        }
    }
    Ok(next)
}

fn open_boundary(node: usize, why: &str) -> Error {
    Error::Input(format!(
        "mesh: boundary is not closed loops, node {node} {why}; every boundary node must have one edge in and one out: \
         split the node in two, or join the parts by a whole edge"
    ))
}
