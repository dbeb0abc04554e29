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

/// What is behind a row, for the rules that choose its penalties.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Behind {
    /// Young's modulus of the stiffer body (N/m^2).
    pub young: f64,
    /// `K A^2/V` of the element behind the primary segment (N/m), K its bulk modulus.
    pub element_stiffness: f64,
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
    /// What is behind it.
    pub behind: Behind,
    /// Penalties of the row; none until a rule has chosen them.
    pub penalties: Penalties,
}

impl Row {
    /// A row over the nodes given with their gradients.
    pub fn new(entries: &[(u32, [f64; 2])], source: u32, gap: f64, behind: Behind) -> Self {
        let (mut nodes, mut gradient) = ([0; MAX_NODES], [[0.0; 2]; MAX_NODES]);
        for (i, &(node, g)) in entries.iter().enumerate() {
            (nodes[i], gradient[i]) = (node, g);
        }
        let (count, penalties) = (entries.len() as u32, Penalties::default());
        Self { nodes, gradient, count, source, gap, behind, penalties }
    }

    /// Nodes and gradients dg/du of the row.
    #[inline]
    pub fn entries(&self) -> impl Iterator<Item = (u32, [f64; 2])> + '_ {
        (0..self.count as usize).map(|i| (self.nodes[i], self.gradient[i]))
    }

    /// One entry of the row.
    #[inline]
    pub fn entry(&self, number: u32) -> (u32, [f64; 2]) {
        (self.nodes[number as usize], self.gradient[number as usize])
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

    /// First node of the row: the secondary node of a contact.
    pub fn first_node(&self) -> u32 {
        self.nodes[0]
    }

    /// Frequency squared (1/s^2) of the row alone on its nodes: `alpha_s w / (1 + alpha_m w)`, w = G M^-1 G'.
    ///
    /// Below R for any row with a mass penalty (Hetherington, Rodriguez-Ferran and Askes 2012).
    pub fn omega2(&self, inverse_mass: &[[f64; 2]]) -> f64 {
        let w = self.inverse_mass(inverse_mass);
        self.penalties.alpha_s * w / (1.0 + self.penalties.alpha_m * w)
    }

    /// Smallest nodal mass (kg) of the row's free nodes; none free: 0.
    pub fn smallest_mass(&self, inverse_mass: &[[f64; 2]]) -> f64 {
        let largest = |(node, _): (u32, _)| inverse_mass[node as usize].into_iter().fold(0.0, f64::max);
        let inverse = self.entries().map(largest).fold(0.0, f64::max);
        if inverse > 0.0 { 1.0 / inverse } else { 0.0 }
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
