//! Outward boundary loops: the body on the left, the outward normal on the right of travel.

use std::collections::HashMap;

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
    let mut starts: Vec<usize> = next.keys().copied().collect();
    starts.sort_unstable();
    let mut visited = vec![false; mesh.points.len()];
    let mut loops = Vec::new();
    for start in starts {
        if visited[start] {
            continue;
        }
        let (mut ring, mut node) = (Vec::new(), start);
        while !visited[node] {
            visited[node] = true;
            ring.push(node);
            node = *next.get(&node).ok_or_else(|| open_boundary(node, "leads nowhere"))?;
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
    let mut area_behind = HashMap::new();
    for (_, _, nodes) in mesh.elements() {
        let points: Vec<[f64; 2]> = nodes.iter().map(|&n| mesh.points[n]).collect();
        let area = signed_area(&points);
        area_behind.extend((0..nodes.len()).map(|i| ((nodes[i], nodes[(i + 1) % nodes.len()]), area)));
    }
    let edges = loops.iter().flat_map(|ring| (0..ring.len()).map(|i| (ring[i], ring[(i + 1) % ring.len()])));
    let stiffness = |(a, b): (usize, usize)| {
        let (p, q) = (mesh.points[a], mesh.points[b]);
        let length2 = (q[0] - p[0]).powi(2) + (q[1] - p[1]).powi(2);
        material.bulk_modulus() * thickness * length2 / area_behind[&(a, b)]
    };
    edges.map(stiffness).collect()
}

/// Edges that one element has to itself, as the map from their first to their second node.
fn outgoing_edges(mesh: &Mesh) -> Result<HashMap<usize, usize>> {
    let mut count: HashMap<(usize, usize), u32> = HashMap::new();
    let edges = || mesh.elements().flat_map(|(_, _, n)| (0..n.len()).map(move |i| (n[i], n[(i + 1) % n.len()])));
    edges().for_each(|(a, b)| *count.entry((a.min(b), a.max(b))).or_default() += 1);
    if let Some(((a, b), c)) = count.iter().find(|(_, c)| **c > 2) {
        let what = format!("number of elements on the edge between nodes {a} and {b}");
        return Err(Error::bound("mesh", &what, c, "<= 2", "remove overlapping elements"));
    }
    let mut next = HashMap::new();
    for (a, b) in edges().filter(|&(a, b)| count[&(a.min(b), a.max(b))] == 1) {
        if next.insert(a, b).is_some() {
            return Err(open_boundary(a, "has two edges that leave it: the body touches itself there"));
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
