//! Block rows times u: four sums a row, one a block entry, in the order of the blocks whatever the number of lanes.

use super::simd::Madd;
use super::{Block, BlockCsr};

/// Force of one node by axis and lane.
pub(super) type Force<const L: usize> = [[f64; L]; 2];

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

    /// True when a node and the next can share the displacements of their neighbours.
    #[inline(always)]
    pub(super) fn paired(self, node: usize) -> bool {
        self.stiffness.paired[node]
    }

    /// Displacement of a column.
    #[inline(always)]
    fn column(self, column: u32) -> &'a [[f64; L]; 2] {
        // SAFETY: every column is a node of the matrix, and `new` has found at least as many nodes in u.
        unsafe { self.u.get_unchecked(column as usize) }
    }

    /// Blocks and columns of one row.
    #[inline(always)]
    fn row(self, node: usize) -> (&'a [Block], &'a [u32]) {
        let row = self.stiffness.row_start[node] as usize..self.stiffness.row_start[node + 1] as usize;
        // SAFETY: row starts never fall and end with the number of blocks, which is also that of the columns.
        unsafe { (self.stiffness.block.get_unchecked(row.clone()), self.stiffness.column.get_unchecked(row)) }
    }

    /// One row times u, as many lanes at a time as have their sums in registers.
    #[inline(always)]
    pub(super) fn one<M: Madd>(self, node: usize) -> Force<L> {
        match 2 * M::WIDTH {
            lanes if lanes >= L => self.lanes::<M, L>(node),
            8 => self.lanes::<M, 8>(node),
            _ => self.lanes::<M, 4>(node),
        }
    }

    #[inline(always)]
    fn lanes<M: Madd, const C: usize>(self, node: usize) -> Force<L> {
        let (blocks, columns) = self.row(node);
        let mut force = [[0.0; L]; 2];
        for first in (0..L).step_by(C) {
            let mut sum = [[0.0; C]; 4];
            let mut add = |block: &Block, column: u32| {
                let u = self.column(column);
                accumulate::<C, M>(&mut sum, block, std::array::from_fn(|axis| part(&u[axis], first)));
            };
            // Inner nodes of quads have nine blocks: a known number needs no loop.
            if let Some((blocks, columns)) = nine(blocks, columns) {
                (0..9).for_each(|b| add(&blocks[b], columns[b]));
            } else {
                blocks.iter().zip(columns).for_each(|(block, &column)| add(block, column));
            }
            for (force, total) in force.iter_mut().zip(total(&sum)) {
                force[first..first + C].copy_from_slice(&total);
            }
        }
        force
    }

    /// The rows of a pair: each displacement they share is loaded once.
    #[inline(always)]
    pub(super) fn two<M: Madd>(self, node: usize) -> [Force<L>; 2] {
        let [(ka, ca), (kb, cb)] = [self.row(node), self.row(node + 1)];
        let (mut a, mut b) = ([[0.0; L]; 4], [[0.0; L]; 4]);
        let (Some((ka, ca)), Some((kb, cb))) = (nine(ka, ca), nine(kb, cb)) else {
            return [self.one::<M>(node), self.one::<M>(node + 1)];
        };
        for t in [0, 3, 6] {
            accumulate::<L, M>(&mut a, &ka[t], self.column(ca[t]).each_ref());
            for s in [t, t + 1] {
                let shared = self.column(cb[s]).each_ref();
                accumulate::<L, M>(&mut a, &ka[s + 1], shared);
                accumulate::<L, M>(&mut b, &kb[s], shared);
            }
            accumulate::<L, M>(&mut b, &kb[t + 2], self.column(cb[t + 2]).each_ref());
        }
        [total(&a), total(&b)]
    }
}

/// Adds one block's four products in every lane.
#[inline(always)]
fn accumulate<const L: usize, M: Madd>(sum: &mut [[f64; L]; 4], block: &Block, u: [&[f64; L]; 2]) {
    for (entry, sum) in sum.iter_mut().enumerate() {
        for (sum, u) in sum.iter_mut().zip(u[entry % 2]) {
            *sum = M::madd(block.0[entry], *u, *sum);
        }
    }
}

/// xx + xy and yy + yx.
#[inline(always)]
fn total<const L: usize>([xx, yy, yx, xy]: &[[f64; L]; 4]) -> Force<L> {
    [std::array::from_fn(|lane| xx[lane] + xy[lane]), std::array::from_fn(|lane| yy[lane] + yx[lane])]
}

/// A row of nine blocks with its columns.
#[inline(always)]
fn nine<'a>(blocks: &'a [Block], columns: &'a [u32]) -> Option<(&'a [Block; 9], &'a [u32; 9])> {
    Some((blocks.try_into().ok()?, columns.try_into().ok()?))
}

/// `C` lanes from `first` on.
#[inline(always)]
fn part<const L: usize, const C: usize>(lanes: &[f64; L], first: usize) -> &[f64; C] {
    lanes[first..].first_chunk().expect("lanes come in whole parts")
}
