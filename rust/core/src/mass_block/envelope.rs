//! Order and envelope of the dual matrix: rows couple where they share nodes.

use crate::row::Row;

/// One product `g_a M^-1 g_b` of two entries on a node, and where its value belongs.
#[derive(Debug, Clone, Copy)]
pub struct Term {
    /// Place in the envelope's values.
    pub slot: u32,
    /// Row and entry of either factor.
    pub factors: [(u32, u32); 2],
    /// 2 for two different entries of one row, which the lower triangle holds once; else 1.
    pub times: f64,
}

/// Rows ordered breadth first along their couplings (Cuthill and McKee 1969) from a row at an end (George and Liu 1979);
/// the lower triangle keeps, row by row, what lies between the first coupling and the diagonal (Jennings 1966).
#[derive(Debug, Default)]
pub struct Envelope {
    /// Nodes of the rows one after the other: what tells whether the pattern has changed.
    key: Vec<u32>,
    next_key: Vec<u32>,
    /// (node, row, entry), by node.
    touched: Vec<(u32, u32, u32)>,
    /// Row at each place.
    pub order: Vec<u32>,
    place: Vec<u32>,
    /// First column of each place's envelope, and where its values start.
    pub first: Vec<u32>,
    pub start: Vec<u32>,
    /// Products that make up the matrix.
    pub terms: Vec<Term>,
    /// Nodes that the rows touch.
    pub nodes: usize,
    /// Multiplications of a factorisation.
    pub operations: usize,
    /// How often the pattern has changed.
    pub analyses: usize,
}

/// Closes a row in the key; no place yet in the order.
const NONE: u32 = u32::MAX;

impl Envelope {
    /// Brings order and envelope up to date with the rows.
    pub fn update(&mut self, rows: &[Row]) {
        self.next_key.clear();
        for row in rows {
            self.next_key.extend(row.entries().map(|(node, _)| node));
            self.next_key.push(NONE);
        }
        if self.next_key == self.key {
            return;
        }
        std::mem::swap(&mut self.key, &mut self.next_key);
        self.analyses += 1;
        self.touched.clear();
        for (number, row) in (0..).zip(rows) {
            self.touched.extend((0..).zip(row.entries()).map(|(entry, (node, _))| (node, number, entry)));
        }
        self.touched.sort_unstable();
        self.nodes = self.touched.chunk_by(|a, b| a.0 == b.0).count();
        self.number(rows);
        self.shape(rows.len());
        self.products();
    }

    fn number(&mut self, rows: &[Row]) {
        self.order.clear();
        self.place.clear();
        self.place.resize(rows.len(), NONE);
        for seed in 0..rows.len() as u32 {
            if self.place[seed as usize] != NONE {
                continue;
            }
            // The row reached last lies at an end: from there the levels are narrow.
            let first = self.order.len();
            self.spread(rows, seed);
            let end = self.order[self.order.len() - 1];
            for &row in &self.order[first..] {
                self.place[row as usize] = NONE;
            }
            self.order.truncate(first);
            self.spread(rows, end);
        }
    }

    /// Appends a row and all that couple to it, breadth first.
    fn spread(&mut self, rows: &[Row], seed: u32) {
        let mut at = self.order.len();
        self.place[seed as usize] = at as u32;
        self.order.push(seed);
        while at < self.order.len() {
            for (node, _) in rows[self.order[at] as usize].entries() {
                let from = self.touched.partition_point(|t| t.0 < node);
                for &(_, other, _) in self.touched[from..].iter().take_while(|t| t.0 == node) {
                    if self.place[other as usize] == NONE {
                        self.place[other as usize] = self.order.len() as u32;
                        self.order.push(other);
                    }
                }
            }
            at += 1;
        }
    }

    fn shape(&mut self, rows: usize) {
        self.first.clear();
        self.first.extend(0..rows as u32);
        for of_node in self.touched.chunk_by(|a, b| a.0 == b.0) {
            let least = of_node.iter().map(|t| self.place[t.1 as usize]).fold(NONE, u32::min);
            for &(_, row, _) in of_node {
                let first = &mut self.first[self.place[row as usize] as usize];
                *first = least.min(*first);
            }
        }
        self.start.clear();
        self.start.push(0);
        self.operations = 0;
        let mut total = 0;
        for (i, first) in (0..).zip(&self.first) {
            let width = i - first;
            total += width + 1;
            self.start.push(total);
            self.operations += (width * (width + 1) / 2) as usize;
        }
    }

    fn products(&mut self) {
        self.terms.clear();
        for of_node in self.touched.chunk_by(|a, b| a.0 == b.0) {
            for (i, &(_, a, entry_a)) in of_node.iter().enumerate() {
                for &(_, b, entry_b) in &of_node[i..] {
                    let (pa, pb) = (self.place[a as usize], self.place[b as usize]);
                    let (row, column) = (pa.max(pb), pa.min(pb));
                    let slot = self.start[row as usize] + column - self.first[row as usize];
                    let times = if a == b && entry_a != entry_b { 2.0 } else { 1.0 };
                    self.terms.push(Term { slot, factors: [(a, entry_a), (b, entry_b)], times });
                }
            }
        }
    }

    /// Values of `G M^-1 G'`, the lower triangle in the envelope; it must be up to date with the rows.
    pub fn gram(&self, inverse_mass: &[[f64; 2]], rows: &[Row], values: &mut Vec<f64>) {
        values.clear();
        values.resize(self.start[rows.len()] as usize, 0.0);
        for term in &self.terms {
            let [(a, ea), (b, eb)] = term.factors;
            let ((node, ga), (_, gb)) = (rows[a as usize].entry(ea), rows[b as usize].entry(eb));
            let w = inverse_mass[node as usize];
            values[term.slot as usize] += term.times * (w[0] * ga[0] * gb[0] + w[1] * ga[1] * gb[1]);
        }
    }
}
