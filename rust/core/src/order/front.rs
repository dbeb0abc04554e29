//! Order of nodes by a front that moves through the mesh from one end to the other (Cuthill and McKee 1969).
//!
//! Within the front each node stands beside one of its neighbours where there is one: lines of a regular mesh of quads
//! come out in order, and the kernel can take their rows in pairs.

use super::neighbours::Neighbours;

/// All nodes, each once: old numbers in their new order.
pub(super) fn front_order(neighbours: &Neighbours) -> Vec<u32> {
    let count = neighbours.count();
    let (mut order, mut numbered) = (Vec::with_capacity(count), vec![false; count]);
    let mut level = vec![u32::MAX; count];
    // Parts of the mesh that hang together, one after the other.
    for seed in 0..count as u32 {
        if numbered[seed as usize] {
            continue;
        }
        let mut at = order.len();
        let start = far_end(neighbours, seed, &mut level);
        order.push(start);
        numbered[start as usize] = true;
        while at < order.len() {
            let parent = order[at];
            while let Some(next) = next_of_front(neighbours, parent, order[order.len() - 1], &numbered) {
                order.push(next);
                numbered[next as usize] = true;
            }
            at += 1;
        }
    }
    order
}

/// The neighbour of `parent` to come next: one beside the `last` if there is one, and of those one with the fewest
/// neighbours.
fn next_of_front(neighbours: &Neighbours, parent: u32, last: u32, numbered: &[bool]) -> Option<u32> {
    let open = neighbours.at(parent).iter().copied().filter(|&node| !numbered[node as usize]);
    open.min_by_key(|node| (!neighbours.at(last).contains(node), neighbours.at(*node).len(), *node))
}

/// A node at one end of the part that a node belongs to (Gibbs, Poole and Stockmeyer 1976).
fn far_end(neighbours: &Neighbours, seed: u32, level: &mut [u32]) -> u32 {
    let (mut start, mut reached) = farthest(neighbours, seed, level);
    loop {
        let (next, further) = farthest(neighbours, start, level);
        if further <= reached {
            return start;
        }
        (start, reached) = (next, further);
    }
}

/// Of the nodes farthest from another the one with the fewest neighbours, and how many nodes away it is.
///
/// `level` is scratch: the same value for all nodes of the part before and after.
fn farthest(neighbours: &Neighbours, from: u32, level: &mut [u32]) -> (u32, u32) {
    let unseen = std::mem::replace(&mut level[from as usize], 0);
    let (mut queue, mut at) = (vec![from], 0);
    while at < queue.len() {
        let node = queue[at];
        let next = level[node as usize] + 1;
        for &other in neighbours.at(node) {
            if level[other as usize] == unseen {
                level[other as usize] = next;
                queue.push(other);
            }
        }
        at += 1;
    }
    let most = level[queue[queue.len() - 1] as usize];
    let last = queue.iter().rev().copied().take_while(|&node| level[node as usize] == most);
    let end = last.min_by_key(|&node| (neighbours.at(node).len(), node)).unwrap_or(from);
    queue.iter().for_each(|&node| level[node as usize] = unseen);
    (end, most)
}
