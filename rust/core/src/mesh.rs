//! Coordinates and connectivity of one body, checked.

use crate::element::signed_area;
use crate::error::{Error, Result};

/// Nodes and elements of one body. Elements run counter-clockwise.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// Reference coordinates X (m), one pair a node.
    pub points: Vec<[f64; 2]>,
    /// Three-node triangles.
    pub triangles: Vec<[usize; 3]>,
    /// Four-node quadrilaterals.
    pub quads: Vec<[usize; 4]>,
}

impl Mesh {
    /// Checks a mesh; a mesh that is clockwise throughout is turned round, and the flag says so.
    ///
    /// # Errors
    /// Empty or non-finite points, no elements, node numbers out of range or repeated within an element,
    /// inverted, non-convex or zero-area elements, nodes that no element uses.
    pub fn checked(mut self) -> Result<(Self, bool)> {
        if self.points.is_empty() {
            return Err(Error::bound("mesh", "number of points", 0, ">= 3", "give an (N, 2) array of coordinates"));
        }
        if let Some(i) = self.points.iter().position(|p| !(p[0].is_finite() && p[1].is_finite())) {
            let value = format!("({}, {})", self.points[i][0], self.points[i][1]);
            return Err(Error::bound("mesh", &format!("point {i}"), value, "finite", "mend the coordinates"));
        }
        if self.triangles.is_empty() && self.quads.is_empty() {
            return Err(Error::bound("mesh", "number of elements", 0, ">= 1", "give triangles or quads"));
        }
        self.check_connectivity()?;
        let turned = self.turn_if_clockwise();
        self.check_areas()?;
        self.check_all_used()?;
        Ok((self, turned))
    }

    /// Each element as a slice of node numbers, triangles first, with its kind and number for messages.
    pub fn elements(&self) -> impl Iterator<Item = (&'static str, usize, &[usize])> {
        let triangles = self.triangles.iter().enumerate().map(|(e, n)| ("triangle", e, n.as_slice()));
        triangles.chain(self.quads.iter().enumerate().map(|(e, n)| ("quad", e, n.as_slice())))
    }

    fn check_connectivity(&self) -> Result<()> {
        let count = self.points.len();
        for (kind, e, nodes) in self.elements() {
            if let Some(&bad) = nodes.iter().find(|&&n| n >= count) {
                let bound = format!("from 0 to {} (the mesh has {count} points)", count - 1);
                return Err(Error::bound("mesh", &format!("{kind} {e} node"), bad, &bound, "number nodes from 0"));
            }
            if (1..nodes.len()).any(|i| nodes[..i].contains(&nodes[i])) {
                let (what, remedy) = (format!("{kind} {e}"), "remove the collapsed element or make it a triangle");
                return Err(Error::bound("mesh", &what, format!("{nodes:?}"), "of distinct nodes", remedy));
            }
        }
        let mut seen: Vec<[usize; 4]> = self.elements().map(|(_, _, n)| sorted(n)).collect();
        seen.sort_unstable();
        match seen.windows(2).find(|pair| pair[0] == pair[1]) {
            None => Ok(()),
            Some(pair) => {
                let nodes: Vec<_> = pair[0].iter().filter(|n| **n != usize::MAX).collect();
                let value = format!("{nodes:?}");
                Err(Error::bound("mesh", "element with nodes", value, "listed once", "remove the repeated element"))
            }
        }
    }

    /// Smallest corner area decides: a quad must be convex, so every corner triangle counts.
    fn smallest_corner_area(&self, nodes: &[usize]) -> f64 {
        let n = nodes.len();
        let corner =
            |i: usize| signed_area(&[nodes[i], nodes[(i + 1) % n], nodes[(i + 2) % n]].map(|k| self.points[k]));
        (0..n).map(corner).fold(f64::INFINITY, f64::min)
    }

    fn turn_if_clockwise(&mut self) -> bool {
        let clockwise = self.triangles.iter().all(|t| signed_area(&t.map(|k| self.points[k])) < 0.0)
            && self.quads.iter().all(|q| signed_area(&q.map(|k| self.points[k])) < 0.0);
        if clockwise {
            self.triangles.iter_mut().for_each(|t| t.swap(1, 2));
            self.quads.iter_mut().for_each(|q| q.swap(1, 3));
        }
        clockwise
    }

    fn check_areas(&self) -> Result<()> {
        let mut extent = 0.0_f64;
        for axis in 0..2 {
            let low = self.points.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
            let high = self.points.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
            extent = extent.max(high - low);
        }
        // Round-off of an area made of differences of coordinates: anything smaller is zero.
        let zero = 1e-14 * extent * extent;
        for (kind, e, nodes) in self.elements() {
            let area = self.smallest_corner_area(nodes);
            if area <= zero {
                let what = format!("{kind} {e} (nodes {nodes:?}) smallest corner area");
                let remedy = "order its nodes counter-clockwise, keep it convex, and remove slivers of no area";
                return Err(Error::bound("mesh", &what, format!("{area:.3e} m^2"), "> 0", remedy));
            }
        }
        Ok(())
    }

    fn check_all_used(&self) -> Result<()> {
        let mut used = vec![false; self.points.len()];
        self.elements().for_each(|(_, _, nodes)| nodes.iter().for_each(|&n| used[n] = true));
        match used.iter().position(|u| !u) {
            None => Ok(()),
            Some(i) => {
                let count = used.iter().filter(|u| !**u).count();
                let what = format!("number of nodes that no element uses (first: node {i})");
                let remedy = "remove them: a node without elements has no mass";
                Err(Error::bound("mesh", &what, count, "0", remedy))
            }
        }
    }
}

/// Nodes of an element in ascending order; a triangle has no fourth.
fn sorted(nodes: &[usize]) -> [usize; 4] {
    let mut all = [usize::MAX; 4];
    all[..nodes.len()].copy_from_slice(nodes);
    all.sort_unstable();
    all
}
