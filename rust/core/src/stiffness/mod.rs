//! Stiffness matrix as block rows: assembly, and the kernel that uses it.

mod aligned;
pub mod assembly;
mod block;
pub mod kernel;
mod rows;
pub(crate) mod simd;
#[cfg(target_arch = "x86_64")]
mod single;
#[cfg(target_arch = "x86_64")]
mod wide;

pub use aligned::Aligned;
pub use block::Block;
pub use simd::Isa;

/// Square matrix of 2x2 blocks in compressed rows: one row a node, columns in ascending order.
///
/// Kept by its methods, and relied on by the kernel: `row_start` begins with 0, never falls and ends with the number of
/// blocks; there is one column a block, and each is a node of the matrix.
#[derive(Debug, Clone)]
pub struct BlockCsr {
    /// Start of each node's blocks; one entry more than nodes.
    row_start: Vec<u32>,
    /// Column node of each block.
    column: Vec<u32>,
    /// Blocks (N/m).
    block: Vec<Block>,
    /// True where a row and the next have nine blocks each and share six columns, two of every three.
    paired: Vec<bool>,
}

impl Default for BlockCsr {
    fn default() -> Self {
        Self { row_start: vec![0], column: Vec::new(), block: Vec::new(), paired: Vec::new() }
    }
}

impl BlockCsr {
    /// Zero matrix with the given columns in each row, in ascending order.
    ///
    /// # Panics
    /// A column that is not a node, or 2^32 blocks and more.
    pub(crate) fn zeros(rows: &[Vec<u32>]) -> Self {
        let mut out = Self::default();
        for row in rows {
            assert!(row.iter().all(|&column| (column as usize) < rows.len()), "column without a node");
            out.column.extend(row);
            out.row_start.push(u32::try_from(out.column.len()).expect("fewer than 2^32 blocks"));
        }
        out.block = vec![Block::default(); out.column.len()];
        out.paired = (0..rows.len()).map(|node| out.is_pair(node)).collect();
        out
    }

    /// Adds the rows of a matrix that couples only nodes of its own, after those there are.
    ///
    /// # Panics
    /// More than 2^32 blocks.
    pub(crate) fn append(&mut self, other: Self) {
        let (nodes, blocks) = (self.nodes() as u32, self.block.len() as u32);
        assert!(u32::try_from(self.block.len() + other.block.len()).is_ok(), "fewer than 2^32 blocks");
        self.row_start.extend(other.row_start[1..].iter().map(|start| start + blocks));
        self.column.extend(other.column.iter().map(|column| column + nodes));
        self.block.extend(other.block);
        // The last row of one matrix and the first of the other share no column.
        self.paired.extend(other.paired);
    }

    /// Number of block rows (nodes).
    pub fn nodes(&self) -> usize {
        self.row_start.len() - 1
    }

    /// Blocks of one row, with their columns.
    pub fn row(&self, node: usize) -> impl Iterator<Item = (usize, &Block)> {
        let range = self.row_start[node] as usize..self.row_start[node + 1] as usize;
        self.column[range.clone()].iter().map(|&c| c as usize).zip(&self.block[range])
    }

    /// The full matrix, for dense checks of small models.
    pub fn to_dense(&self) -> nalgebra::DMatrix<f64> {
        let n = 2 * self.nodes();
        let mut dense = nalgebra::DMatrix::zeros(n, n);
        for i in 0..self.nodes() {
            for (j, block) in self.row(i) {
                for (k, value) in block.entries() {
                    dense[(2 * i + k[0], 2 * j + k[1])] = value;
                }
            }
        }
        dense
    }

    /// Whether `node` and the next share columns as neighbours along a line of a regular mesh of quads do.
    fn is_pair(&self, node: usize) -> bool {
        let columns = |node: usize| {
            let row = *self.row_start.get(node)? as usize..*self.row_start.get(node + 1)? as usize;
            <&[u32; 9]>::try_from(&self.column[row]).ok()
        };
        let (Some(a), Some(b)) = (columns(node), columns(node + 1)) else { return false };
        [0, 3, 6].into_iter().all(|t| a[t + 1..t + 3] == b[t..t + 2])
    }
}
