//! Pattern of the mass block: which degrees of freedom the active rows touch and how they couple.

use crate::row::{MAX_NODES, Row};

/// Mark of a degree of freedom outside the block.
pub const NONE: u32 = u32::MAX;

/// Local numbering of the touched free degrees of freedom, and the upper triangle of the block by columns.
#[derive(Debug, Default)]
pub struct Pattern {
    /// Degrees of freedom in local order: node and axis.
    pub dofs: Vec<(u32, u8)>,
    /// Local number by node and axis; NONE elsewhere.
    local: Vec<[u32; 2]>,
    /// Touched degrees of freedom of the rows one after the other: what tells whether the pattern has changed.
    key: Vec<(u32, u8)>,
    next_key: Vec<(u32, u8)>,
    /// Column starts and row numbers of the upper triangle.
    pub column_start: Vec<u32>,
    pub row_index: Vec<u32>,
    pairs: Vec<(u32, u32)>,
    /// Place in `row_index` of each product of a row's entries, in the order `products` visits them.
    pub scatter: Vec<u32>,
    /// Place of each diagonal entry.
    pub diagonal: Vec<u32>,
}

impl Pattern {
    /// Makes room for a number of rows, so that no set of so many rows allocates.
    pub fn reserve(&mut self, rows: usize) {
        let (nodes, products) = (rows * MAX_NODES, rows * MAX_NODES * (2 * MAX_NODES + 1));
        for key in [&mut self.key, &mut self.next_key] {
            reserve_total(key, 2 * nodes + rows);
        }
        reserve_total(&mut self.dofs, 2 * nodes);
        reserve_total(&mut self.column_start, 2 * nodes + 1);
        reserve_total(&mut self.diagonal, 2 * nodes);
        reserve_total(&mut self.pairs, products + 2 * nodes);
        reserve_total(&mut self.row_index, products + 2 * nodes);
        reserve_total(&mut self.scatter, products);
    }

    /// Size of the block.
    pub fn size(&self) -> usize {
        self.dofs.len()
    }

    /// Local number of a touched degree of freedom; NONE when it is fixed.
    #[inline]
    pub fn local(&self, node: u32, axis: usize) -> u32 {
        self.local[node as usize][axis]
    }

    /// Brings the pattern up to date; true when it has changed.
    pub fn update(&mut self, inverse_mass: &[[f64; 2]], rows: &[Row]) -> bool {
        self.next_key.clear();
        for row in rows {
            for (node, _) in row.entries() {
                let free = inverse_mass[node as usize];
                self.next_key.extend((0..2u8).filter(|&axis| free[axis as usize] > 0.0).map(|axis| (node, axis)));
            }
            // Closes the row, so that the same degrees of freedom shared out differently make another key.
            self.next_key.push((NONE, 0));
        }
        if self.next_key == self.key {
            return false;
        }
        std::mem::swap(&mut self.key, &mut self.next_key);
        self.number(inverse_mass.len());
        self.couple(rows);
        true
    }

    fn number(&mut self, nodes: usize) {
        self.local.resize(nodes, [NONE; 2]);
        for &(node, axis) in &self.dofs {
            self.local[node as usize][axis as usize] = NONE;
        }
        self.dofs.clear();
        for &(node, axis) in self.key.iter().filter(|(node, _)| *node != NONE) {
            let local = &mut self.local[node as usize][axis as usize];
            if *local == NONE {
                *local = self.dofs.len() as u32;
                self.dofs.push((node, axis));
            }
        }
    }

    fn couple(&mut self, rows: &[Row]) {
        self.pairs.clear();
        self.pairs.extend((0..self.dofs.len() as u32).map(|i| (i, i)));
        for row in rows {
            products(&self.local, row, |i, j, _| self.pairs.push((j, i)));
        }
        self.pairs.sort_unstable();
        self.pairs.dedup();
        self.column_start.clear();
        self.row_index.clear();
        for (at, &(column, row)) in self.pairs.iter().enumerate() {
            while self.column_start.len() <= column as usize {
                self.column_start.push(at as u32);
            }
            self.row_index.push(row);
        }
        self.column_start.push(self.pairs.len() as u32);
        let place = |column, row| self.pairs.partition_point(|&pair| pair < (column, row)) as u32;
        self.diagonal.clear();
        self.diagonal.extend((0..self.dofs.len() as u32).map(|i| place(i, i)));
        self.scatter.clear();
        for row in rows {
            products(&self.local, row, |i, j, _| self.scatter.push(place(j, i)));
        }
    }

    /// Adds `P g_i g_j` of a row to the values, given its stretch of `scatter`; returns the rest of the stretch.
    pub fn add<'s>(&self, row: &Row, inertia: f64, scatter: &'s [u32], values: &mut [f64]) -> &'s [u32] {
        let mut used = 0;
        products(&self.local, row, |_, _, product| {
            values[scatter[used] as usize] += inertia * product;
            used += 1;
        });
        &scatter[used..]
    }
}

/// Room for `total` entries altogether.
pub fn reserve_total<T>(buffer: &mut Vec<T>, total: usize) {
    buffer.reserve(total.saturating_sub(buffer.len()));
}

/// Visits i, j and g_i g_j for the upper triangle (i <= j) of a row's touched degrees of freedom.
#[inline]
fn products(local: &[[u32; 2]], row: &Row, mut visit: impl FnMut(u32, u32, f64)) {
    let dofs = || {
        row.entries().flat_map(|(node, g)| {
            let local = local[node as usize];
            (0..2).filter(move |&axis| local[axis] != NONE).map(move |axis| (local[axis], g[axis]))
        })
    };
    for (a, (i, gi)) in dofs().enumerate() {
        for (j, gj) in dofs().skip(a) {
            visit(i.min(j), i.max(j), gi * gj);
        }
    }
}
