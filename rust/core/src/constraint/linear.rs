//! Rows that never change: a linear constraint G u + g_0 = 0 that is always active.

use crate::lane::Lane;
use crate::row::{Behind, Row};

/// A linear row over at most four nodes, active whatever the sign of its gap.
#[derive(Debug, Clone)]
pub struct Linear {
    /// Nodes of the model with their gradients.
    pub entries: Vec<(u32, [f64; 2])>,
    /// Gap (m) of the undeformed model.
    pub offset: f64,
    /// Young's modulus that scales its penalties (N/m^2).
    pub young: f64,
}

impl Linear {
    /// The row at a displacement.
    pub fn row(&self, source: u32, displacement: Lane) -> Row {
        let behind = Behind { young: self.young, ..Behind::default() };
        let mut row = Row::new(&self.entries, source, 0.0, behind);
        row.gap = self.offset + row.along(displacement);
        row
    }
}
