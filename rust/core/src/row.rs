//! A row is a row: gap, gradient and penalties of one constraint, whatever it models.

use crate::lane::Lane;

/// Most nodes that one row touches: two segments of a cohesive interface.
pub const MAX_NODES: usize = 4;

/// Penalties of one row, per metre of depth.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Penalties {
    /// Stiffness penalty (N/m per m).
    pub alpha_s: f64,
    /// Mass (inertia) penalty (kg per m).
    pub alpha_m: f64,
    /// Damping penalty (N s/m per m).
    pub alpha_d: f64,
}

impl Penalties {
    /// What stands in the mass block: `P = A_m + dt/2 A_d`.
    #[inline]
    pub fn inertia(&self, dt: f64) -> f64 {
        self.alpha_m + 0.5 * dt * self.alpha_d
    }
}

/// One constraint row `c`: gap g_c, gradient G_c = dg_c/du and penalties.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    nodes: [u32; MAX_NODES],
    gradient: [[f64; 2]; MAX_NODES],
    count: u32,
    /// Which constraint of the model made it.
    pub source: u32,
    /// Signed gap (m), negative in penetration.
    pub gap: f64,
    /// Penalties of the row.
    pub penalties: Penalties,
}

impl Row {
    /// A row over the nodes given with their gradients.
    pub fn new(entries: &[(u32, [f64; 2])], source: u32, gap: f64, penalties: Penalties) -> Self {
        let (mut nodes, mut gradient) = ([0; MAX_NODES], [[0.0; 2]; MAX_NODES]);
        for (i, &(node, g)) in entries.iter().enumerate() {
            (nodes[i], gradient[i]) = (node, g);
        }
        Self { nodes, gradient, count: entries.len() as u32, source, gap, penalties }
    }

    /// Nodes and gradients dg/du of the row.
    #[inline]
    pub fn entries(&self) -> impl Iterator<Item = (u32, [f64; 2])> + '_ {
        (0..self.count as usize).map(|i| (self.nodes[i], self.gradient[i]))
    }

    /// `G_c x` for a nodal vector field x: the gap rate when x is the velocity.
    #[inline]
    pub fn along(&self, field: Lane) -> f64 {
        let dot = |(node, g): (u32, [f64; 2])| {
            let x = field.at(node);
            g[0] * x[0] + g[1] * x[1]
        };
        self.entries().map(dot).sum()
    }

    /// Inverse effective mass `G M^-1 G'` (1/kg) of the row.
    #[inline]
    pub fn inverse_mass(&self, inverse_mass: &[[f64; 2]]) -> f64 {
        let term = |(node, g): (u32, [f64; 2])| {
            let w = inverse_mass[node as usize];
            g[0] * g[0] * w[0] + g[1] * g[1] * w[1]
        };
        self.entries().map(term).sum()
    }
}
