//! Supports: degrees of freedom that do not move.
//!
//! A fixed degree of freedom is given infinite mass (inverse mass 0) instead of a penalty row: that is exact,
//! leaves the time step alone and costs nothing in the step.

use std::ops::Range;

use crate::error::{Error, Result};
use crate::order::Order;

/// Nodes of one body held in x, y or both.
#[derive(Debug, Clone)]
pub struct Support {
    /// Name of the body.
    pub body: String,
    /// Nodes in the numbers of the body's mesh.
    pub nodes: Vec<usize>,
    /// Which axes are held.
    pub fixed: [bool; 2],
}

impl Support {
    /// Sets the inverse masses of the held degrees of freedom to zero; `body` is the range of the body's nodes.
    ///
    /// # Errors
    /// A node the body does not have, no nodes, or no axis held.
    pub fn apply(&self, body: Range<usize>, order: &Order, inverse_mass: &mut [[f64; 2]]) -> Result<()> {
        let object = format!("support of \"{}\"", self.body);
        if self.nodes.is_empty() {
            return Err(Error::bound(&object, "number of nodes", 0, ">= 1", "name a boundary or list node numbers"));
        }
        if self.fixed == [false, false] {
            return Err(Error::bound(
                &object,
                "held axes",
                "none",
                "x, y or both",
                "remove the support or hold an axis",
            ));
        }
        for &node in &self.nodes {
            if node >= body.len() {
                let bound = format!("from 0 to {} (the body's nodes)", body.len() - 1);
                return Err(Error::bound(&object, "node", node, &bound, "number nodes from 0"));
            }
            for axis in (0..2).filter(|&a| self.fixed[a]) {
                inverse_mass[order.inner(body.start + node)][axis] = 0.0;
            }
        }
        Ok(())
    }
}
