//! Stiffness matrix as block rows: assembly, and the kernel that uses it.

pub mod assembly;
pub mod kernel;
pub(crate) mod simd;

pub use simd::Isa;

/// Square matrix of 2x2 blocks in compressed rows: one row a node, columns in ascending order.
#[derive(Debug, Clone, Default)]
pub struct BlockCsr {
    /// Start of each node's blocks; one entry more than nodes.
    pub row_start: Vec<u32>,
    /// Column node of each block.
    pub column: Vec<u32>,
    /// Blocks by columns, so that one column meets one component of u: k_xx, k_yx, k_xy, k_yy (N/m).
    pub block: Vec<[f64; 4]>,
}

impl BlockCsr {
    /// Number of block rows (nodes).
    pub fn nodes(&self) -> usize {
        self.row_start.len().saturating_sub(1)
    }

    /// Blocks of one row, with their columns.
    pub fn row(&self, node: usize) -> impl Iterator<Item = (usize, &[f64; 4])> {
        let range = self.row_start[node] as usize..self.row_start[node + 1] as usize;
        self.column[range.clone()].iter().map(|&c| c as usize).zip(&self.block[range])
    }

    /// The full matrix, for dense checks of small models.
    pub fn to_dense(&self) -> nalgebra::DMatrix<f64> {
        let n = 2 * self.nodes();
        let mut dense = nalgebra::DMatrix::zeros(n, n);
        for i in 0..self.nodes() {
            for (j, b) in self.row(i) {
                for (k, value) in b.iter().enumerate() {
                    dense[(2 * i + k % 2, 2 * j + k / 2)] = *value;
                }
            }
        }
        dense
    }
}
