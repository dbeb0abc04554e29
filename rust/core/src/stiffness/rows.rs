//! Block rows times u: four sums a row, one a block entry, in the order of the blocks whatever the number of lanes.

use super::simd::Madd;
use super::{Block, BlockCsr};

/// Force of one node by axis and lane.
pub(super) type Force<const L: usize> = [[f64; L]; 2];

/// Nine blocks and their columns.
pub(super) type Nine<'a> = (&'a [Block; 9], &'a [u32; 9]);

/// K and u of a pass, known to fit each other.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a, const L: usize> {
    stiffness: &'a BlockCsr,
    u: &'a [[[f64; L]; 2]],
}

impl<'a, const L: usize> Rows<'a, L> {
    /// # Panics
    /// Fewer nodes in u than in K.
    #[inline(always)]
    pub(super) fn new(stiffness: &'a BlockCsr, u: &'a [[f64; L]]) -> Self {
        let u = u.as_chunks().0;
        assert!(u.len() >= stiffness.nodes(), "displacement shorter than the matrix");
        Self { stiffness, u }
    }

    /// Displacement of a node.
    #[inline(always)]
    pub(super) fn at(self, node: usize) -> &'a [[f64; L]; 2] {
        &self.u[node]
    }

    /// True when the rows of a node and the next can share the displacements of their neighbours.
    #[inline(always)]
    pub(super) fn paired(self, node: usize) -> bool {
        self.stiffness.paired[node]
    }

    /// Displacement of a column.
    #[inline(always)]
    pub(super) fn column(self, column: u32) -> &'a [[f64; L]; 2] {
        // SAFETY: every column is a node of the matrix, and `new` has found at least as many nodes in u.
        unsafe { self.u.get_unchecked(column as usize) }
    }

    /// Blocks and columns of one row.
    #[inline(always)]
    pub(super) fn row(self, node: usize) -> (&'a [Block], &'a [u32]) {
        let row = self.stiffness.row_start[node] as usize..self.stiffness.row_start[node + 1] as usize;
        // SAFETY: row starts never fall and end with the number of blocks, which is also that of the columns.
        unsafe { (self.stiffness.block.get_unchecked(row.clone()), self.stiffness.column.get_unchecked(row)) }
    }

    /// A row of nine blocks with its columns; none for one of another length.
    #[inline(always)]
    pub(super) fn nine(self, node: usize) -> Option<Nine<'a>> {
        let (blocks, columns) = self.row(node);
        Some((blocks.try_into().ok()?, columns.try_into().ok()?))
    }

    /// One row times u, four lanes at a time: the registers of the baseline hold no more sums.
    #[inline(always)]
    pub(super) fn one<M: Madd>(self, node: usize) -> Force<L> {
        if L.is_multiple_of(4) { self.lanes::<M, 4>(node) } else { self.lanes::<M, 1>(node) }
    }

    #[inline(always)]
    fn lanes<M: Madd, const C: usize>(self, node: usize) -> Force<L> {
        let (blocks, columns) = self.row(node);
        let mut force = [[0.0; L]; 2];
        let mut first = 0;
        while first < L {
            let mut sum = [[0.0; C]; 4];
            for (block, &column) in blocks.iter().zip(columns) {
                let u = self.column(column);
                for entry in 0..4 {
                    let u = &u[entry % 2][first..first + C];
                    for lane in 0..C {
                        sum[entry][lane] = M::madd(block.0[entry], u[lane], sum[entry][lane]);
                    }
                }
            }
            for lane in 0..C {
                force[0][first + lane] = sum[0][lane] + sum[3][lane];
                force[1][first + lane] = sum[1][lane] + sum[2][lane];
            }
            first += C;
        }
        force
    }
}
