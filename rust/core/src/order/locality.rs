//! Whether the nodes of a mesh are in an order that the kernel can stream.

use super::front::front_order;
use super::neighbours::Neighbours;
use crate::mesh::Mesh;

/// Rows after which the displacements of a node may no longer be at hand.
const WINDOW: u32 = 256;

/// Jumps a node that are worth a renumbering: line by line of a regular mesh there are next to none, at random eight.
const MANY: f64 = 0.5;

/// Order in which the kernel had better take the nodes of a checked mesh: their old numbers; none to keep them.
pub(super) fn better(mesh: &Mesh) -> Option<Vec<u32>> {
    let count = mesh.points.len();
    if count <= WINDOW as usize {
        return None;
    }
    let neighbours = Neighbours::of(mesh);
    let present = jumps(&neighbours, &(0..count as u32).collect::<Vec<_>>());
    if present as f64 <= MANY * count as f64 {
        return None;
    }
    let order = front_order(&neighbours);
    (present > 2 * jumps(&neighbours, &order)).then_some(order)
}

/// How often a pass over the rows in this order fetches displacements neither at hand nor next to some that are: those
/// that follow each other, as along another line of a regular mesh, are there before they are asked for.
fn jumps(neighbours: &Neighbours, order: &[u32]) -> usize {
    let mut place = vec![0; order.len()];
    order.iter().enumerate().for_each(|(at, &node)| place[node as usize] = at);
    let (mut jumps, mut last) = (0, vec![None; order.len()]);
    for (row, &node) in (0..).zip(order) {
        for &other in neighbours.at(node) {
            let at = place[other as usize];
            let far = |before: Option<u32>| before.is_none_or(|before| row - before > WINDOW);
            let alone = at == 0 || far(last[at - 1]);
            jumps += usize::from(far(last[at].replace(row)) && alone);
        }
    }
    jumps
}
