//! Node numbers: the scene's own outside, the model's inside. They differ where a body's nodes were renumbered.

mod front;
mod locality;
mod neighbours;

use std::borrow::Cow;
use std::sync::Arc;

use crate::mesh::Mesh;

/// What the model's node numbers are in the scene's; cheap to copy, and empty while no body has been renumbered.
///
/// Each body keeps its range of nodes, so that a body's first node and number of nodes are the same in both.
#[derive(Debug, Clone, Default)]
pub struct Order {
    numbers: Option<Arc<Numbers>>,
}

#[derive(Debug, Clone, Default)]
struct Numbers {
    /// Model's number of each of the scene's nodes.
    inner: Vec<u32>,
    /// Scene's number of each of the model's nodes.
    outer: Vec<u32>,
}

impl Order {
    /// Adds a body whose nodes begin at `first`, and renumbers its checked mesh and its boundary loops if the kernel
    /// gains by that.
    pub(crate) fn add(&mut self, first: usize, mesh: &mut Mesh, loops: &mut [Vec<usize>]) {
        let (count, order) = (mesh.points.len(), locality::better(mesh));
        if self.is_kept() && order.is_none() {
            return;
        }
        let numbers = Arc::make_mut(self.numbers.get_or_insert_default());
        for numbers in [&mut numbers.inner, &mut numbers.outer] {
            // Bodies before the first that is renumbered, and this one until it is.
            numbers.extend(numbers.len() as u32..(first + count) as u32);
        }
        let Some(order) = order else { return };
        for (new, &old) in order.iter().enumerate() {
            numbers.inner[first + old as usize] = (first + new) as u32;
            numbers.outer[first + new] = first as u32 + old;
        }
        let own = |node: &mut usize| *node = numbers.inner[first + *node] as usize - first;
        mesh.points = order.iter().map(|&old| mesh.points[old as usize]).collect();
        mesh.triangles.as_flattened_mut().iter_mut().for_each(own);
        mesh.quads.as_flattened_mut().iter_mut().for_each(own);
        loops.iter_mut().flatten().for_each(own);
    }

    /// True when both numbers are the same throughout.
    pub fn is_kept(&self) -> bool {
        self.numbers.is_none()
    }

    /// Model's number of a node of the scene.
    ///
    /// # Panics
    /// A number that is not a node's.
    #[inline]
    pub fn inner(&self, node: usize) -> usize {
        self.numbers.as_ref().map_or(node, |numbers| numbers.inner[node] as usize)
    }

    /// Scene's number of a node of the model.
    ///
    /// # Panics
    /// A number that is not a node's.
    #[inline]
    pub fn outer(&self, node: usize) -> usize {
        self.numbers.as_ref().map_or(node, |numbers| numbers.outer[node] as usize)
    }

    /// Values of the scene's nodes, one each, as the model has them.
    pub fn inward<'v, T: Copy>(&self, values: &'v [T]) -> Cow<'v, [T]> {
        let Some(numbers) = &self.numbers else { return Cow::Borrowed(values) };
        numbers.outer.iter().map(|&node| values[node as usize]).collect()
    }

    /// Values of the model's nodes, one each, as the scene has them.
    pub fn outward<'v, T: Copy>(&self, values: &'v [T]) -> Cow<'v, [T]> {
        let Some(numbers) = &self.numbers else { return Cow::Borrowed(values) };
        numbers.inner.iter().map(|&node| values[node as usize]).collect()
    }

    /// Values of the scene's nodes, two each, as the model has them.
    pub(crate) fn flat_inward(&self, values: Vec<f64>) -> Vec<f64> {
        match self.inward(values.as_chunks::<2>().0) {
            Cow::Borrowed(_) => values,
            Cow::Owned(pairs) => pairs.into_flattened(),
        }
    }

    /// Values of the model's nodes, two each, as the scene has them.
    pub(crate) fn flat_outward(&self, values: Vec<f64>) -> Vec<f64> {
        match self.outward(values.as_chunks::<2>().0) {
            Cow::Borrowed(_) => values,
            Cow::Owned(pairs) => pairs.into_flattened(),
        }
    }
}
