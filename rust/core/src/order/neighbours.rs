//! Neighbours of each node: the nodes that share an element with it, itself among them; the columns of its row of K.

use crate::mesh::Mesh;

/// Neighbours in compressed rows.
pub(super) struct Neighbours {
    start: Vec<u32>,
    nodes: Vec<u32>,
}

impl Neighbours {
    /// Of a checked mesh, in the order of its elements.
    pub(super) fn of(mesh: &Mesh) -> Self {
        let count = mesh.points.len();
        let (first, elements) = elements_of(mesh);
        // The row that last had a node: each is wanted once.
        let (mut seen, mut start, mut nodes) = (vec![u32::MAX; count], vec![0], Vec::with_capacity(9 * count));
        for node in 0..count {
            for &element in &elements[first[node] as usize..first[node + 1] as usize] {
                for &other in corners(mesh, element as usize) {
                    if seen[other] != node as u32 {
                        seen[other] = node as u32;
                        nodes.push(other as u32);
                    }
                }
            }
            start.push(nodes.len() as u32);
        }
        Self { start, nodes }
    }

    /// Number of nodes.
    pub(super) fn count(&self) -> usize {
        self.start.len() - 1
    }

    /// Neighbours of a node.
    pub(super) fn at(&self, node: u32) -> &[u32] {
        &self.nodes[self.start[node as usize] as usize..self.start[node as usize + 1] as usize]
    }
}

/// Nodes of an element; triangles come first.
fn corners(mesh: &Mesh, element: usize) -> &[usize] {
    let quad = |number: usize| mesh.quads[number].as_slice();
    mesh.triangles.get(element).map_or_else(|| quad(element - mesh.triangles.len()), |t| t.as_slice())
}

/// Elements at each node in compressed rows.
fn elements_of(mesh: &Mesh) -> (Vec<u32>, Vec<u32>) {
    let mut first = vec![0_u32; mesh.points.len() + 1];
    mesh.elements().flat_map(|(_, _, nodes)| nodes).for_each(|&node| first[node + 1] += 1);
    for node in 0..mesh.points.len() {
        first[node + 1] += first[node];
    }
    let (mut free, mut elements) = (first.clone(), vec![0; first[mesh.points.len()] as usize]);
    for (element, (_, _, nodes)) in mesh.elements().enumerate() {
        for &node in nodes {
            elements[free[node] as usize] = element as u32;
            free[node] += 1;
        }
    }
    (first, elements)
}
