//! Supports: degrees of freedom that do not move.
//!
//! A fixed degree of freedom is given infinite mass (inverse mass 0) instead of a penalty row: that is exact,
//! leaves the time step alone and costs nothing in the step.

use crate::error::{Error, Result};

/// Nodes of one body held in x, y or both.
#[derive(Debug, Clone)]
pub struct Support {
    /// Name of the body.
    pub body: String,
    /// Nodes in the body's own numbers.
    pub nodes: Vec<usize>,
    /// Which axes are held.
    pub fixed: [bool; 2],
}

impl Support {
    /// Sets the inverse masses of the held degrees of freedom to zero; `inverse_mass` covers the body's nodes.
    ///
    /// # Errors
    /// A node the body does not have, no nodes, or no axis held.
    pub fn apply(&self, inverse_mass: &mut [[f64; 2]]) -> Result<()> {
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
            if node >= inverse_mass.len() {
                let bound = format!("from 0 to {} (the body's nodes)", inverse_mass.len() - 1);
                return Err(Error::bound(&object, "node", node, &bound, "number nodes from 0"));
            }
            for axis in (0..2).filter(|&a| self.fixed[a]) {
                inverse_mass[node][axis] = 0.0;
            }
        }
        Ok(())
    }
}
