//! Assembly: elements of one mesh into block rows, lumped mass and the element frequency bound.

use super::BlockCsr;
use crate::element::{frequency, quad4, tri3};
use crate::material::Material;
use crate::mesh::Mesh;

/// What one body contributes to the equation of motion.
#[derive(Debug, Clone)]
pub struct Assembled {
    /// Stiffness K (N/m), block rows in the mesh's own node numbers.
    pub stiffness: BlockCsr,
    /// Lumped mass (kg) a node.
    pub mass: Vec<f64>,
    /// Largest element eigenfrequency (rad/s).
    pub element_omega: f64,
}

/// Assembles a checked mesh of one material.
pub fn assemble(mesh: &Mesh, material: &Material, thickness: f64) -> Assembled {
    let mut out = Assembled { stiffness: pattern(mesh), mass: vec![0.0; mesh.points.len()], element_omega: 0.0 };
    let elasticity = material.elasticity();
    for nodes in &mesh.triangles {
        let points = nodes.map(|n| mesh.points[n]);
        let (k, m) = tri3::stiffness_and_mass(&points, &elasticity, thickness, material.density);
        out.element_omega = frequency::larger(out.element_omega, &k, &m);
        out.add(nodes, |i, j| k[(i, j)], &m);
    }
    for nodes in &mesh.quads {
        let points = nodes.map(|n| mesh.points[n]);
        let (k, m) = quad4::stiffness_and_mass(&points, &elasticity, thickness, material.density);
        out.element_omega = frequency::larger(out.element_omega, &k, &m);
        out.add(nodes, |i, j| k[(i, j)], &m);
    }
    out
}

impl Assembled {
    fn add(&mut self, nodes: &[usize], k: impl Fn(usize, usize) -> f64, mass: &[f64]) {
        for (a, &i) in nodes.iter().enumerate() {
            self.mass[i] += mass[a];
            let row = self.stiffness.row_start[i] as usize..self.stiffness.row_start[i + 1] as usize;
            for (b, &j) in nodes.iter().enumerate() {
                let columns = &self.stiffness.column[row.clone()];
                let at = row.start + columns.partition_point(|&c| (c as usize) < j);
                self.stiffness.block[at].add(|row, column| k(2 * a + row, 2 * b + column));
            }
        }
    }
}

/// Zero matrix whose pattern couples all nodes that share an element.
fn pattern(mesh: &Mesh) -> BlockCsr {
    let mut columns: Vec<Vec<u32>> = vec![Vec::with_capacity(16); mesh.points.len()];
    for (_, _, nodes) in mesh.elements() {
        nodes.iter().for_each(|&n| columns[n].extend(nodes.iter().map(|&m| m as u32)));
    }
    for columns in &mut columns {
        columns.sort_unstable();
        columns.dedup();
    }
    BlockCsr::zeros(&columns)
}
