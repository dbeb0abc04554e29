//! Primal solution of the mass block: `(M + G'PG) a = -G'q` by sparse Cholesky (the only file that knows faer).

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::simplicial::{
    EliminationTreeRef, factorize_simplicial_numeric_llt_scratch, factorize_simplicial_numeric_llt_with_row_idx,
    prefactorize_symbolic_cholesky, prefactorize_symbolic_cholesky_scratch,
};
use faer::sparse::linalg::triangular_solve::{
    solve_lower_triangular_in_place, solve_lower_triangular_transpose_in_place,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par};

use super::RowForces;
use super::pattern::{NONE, Pattern, reserve_total};
use crate::error::{Error, Result};
use crate::outcome::Kind;
use crate::row::{MAX_NODES, Row};

/// Pattern, its symbolic factorisation and the buffers of the numeric one; they grow and are never given back.
#[derive(Default)]
pub struct Primal {
    pattern: Pattern,
    tree: Vec<i32>,
    counts: Vec<u32>,
    factor_start: Vec<u32>,
    factor_row: Vec<u32>,
    factor: Vec<f64>,
    values: Vec<f64>,
    solution: Vec<f64>,
    memory: Option<MemBuffer>,
    room: usize,
    /// Multiplications of a factorisation.
    pub operations: usize,
}

impl Primal {
    /// Fills `forces.lambda = -(q + P G a)` with a what the rows add to the acceleration, from gaps and gap rates.
    pub fn solve(&mut self, inverse_mass: &[[f64; 2]], rows: &[Row], dt: f64, forces: &mut RowForces) -> Result<()> {
        self.make_room(rows.len());
        if self.pattern.update(inverse_mass, rows) {
            self.analyse();
        }
        let RowForces { lambda, before, free } = forces;
        for ((row, before), free) in rows.iter().zip(before.iter()).zip(free.iter()) {
            let p = &row.penalties;
            lambda.push(-(p.alpha_s * row.gap + p.alpha_d * before + p.inertia(dt) * (free - before) / dt));
        }
        self.assemble(inverse_mass, rows, dt, lambda);
        self.factorise_and_solve()?;
        for (row, lambda) in rows.iter().zip(lambda) {
            *lambda -= row.penalties.inertia(dt) * self.along(row);
        }
        Ok(())
    }

    /// `G_c a` of a row over the solution.
    #[inline]
    fn along(&self, row: &Row) -> f64 {
        let component = |node, axis: usize| match self.pattern.local(node, axis) {
            NONE => 0.0,
            local => self.solution[local as usize],
        };
        row.entries().map(|(node, g)| g[0] * component(node, 0) + g[1] * component(node, 1)).sum()
    }

    /// Room for as many rows, whatever their pattern; sets larger than any before are the only ones that allocate.
    fn make_room(&mut self, rows: usize) {
        if rows <= self.room {
            return;
        }
        self.room = rows.next_power_of_two();
        let n = 2 * MAX_NODES * self.room;
        let need = prefactorize_symbolic_cholesky_scratch::<u32>(n, 0)
            .or(factorize_simplicial_numeric_llt_scratch::<u32, f64>(n));
        self.memory = Some(MemBuffer::new(need));
        self.pattern.reserve(self.room);
        reserve_total(&mut self.tree, n);
        reserve_total(&mut self.counts, n);
        reserve_total(&mut self.factor_start, n + 1);
        reserve_total(&mut self.solution, n);
        reserve_total(&mut self.values, MAX_NODES * (2 * MAX_NODES + 1) * self.room + n);
        // A full factor where that is small; in long surfaces each unknown couples to its neighbours only.
        let factor = (n * (n + 1) / 2).min(64 * n);
        reserve_total(&mut self.factor, factor);
        reserve_total(&mut self.factor_row, factor);
    }

    /// Symbolic factorisation: elimination tree and column starts of the factor.
    fn analyse(&mut self) {
        let n = self.pattern.size();
        self.tree.resize(n, 0);
        self.counts.resize(n, 0);
        let matrix = symbolic(&self.pattern);
        if let Some(memory) = &mut self.memory {
            prefactorize_symbolic_cholesky(&mut self.tree, &mut self.counts, matrix, MemStack::new(memory));
        }
        self.factor_start.clear();
        self.factor_start.push(0);
        let mut total = 0;
        self.operations = 0;
        for count in &self.counts {
            total += count;
            self.operations += (count * (count + 1) / 2) as usize;
            self.factor_start.push(total);
        }
        self.factor.resize(total as usize, 0.0);
        self.factor_row.resize(total as usize, 0);
        self.values.resize(self.pattern.row_index.len(), 0.0);
        self.solution.resize(n, 0.0);
    }

    fn assemble(&mut self, inverse_mass: &[[f64; 2]], rows: &[Row], dt: f64, push: &[f64]) {
        self.values.fill(0.0);
        self.solution.fill(0.0);
        for (&(node, axis), &diagonal) in self.pattern.dofs.iter().zip(&self.pattern.diagonal) {
            self.values[diagonal as usize] = 1.0 / inverse_mass[node as usize][axis as usize];
        }
        let mut scatter = self.pattern.scatter.as_slice();
        for (row, push) in rows.iter().zip(push) {
            scatter = self.pattern.add(row, row.penalties.inertia(dt), scatter, &mut self.values);
            for (node, g) in row.entries() {
                for (axis, g) in g.into_iter().enumerate() {
                    let local = self.pattern.local(node, axis);
                    if local != NONE {
                        self.solution[local as usize] += g * push;
                    }
                }
            }
        }
    }

    fn factorise_and_solve(&mut self) -> Result<()> {
        let matrix = SparseColMatRef::new(symbolic(&self.pattern), self.values.as_slice());
        // SAFETY: the array was filled by prefactorize_symbolic_cholesky for this very pattern and not changed since.
        let tree = unsafe { EliminationTreeRef::<u32>::from_inner(&self.tree) };
        if let Some(memory) = &mut self.memory {
            let (factor, rows, start) = (&mut self.factor, &mut self.factor_row, &self.factor_start);
            let (stack, none) = (MemStack::new(memory), LltRegularization::default());
            factorize_simplicial_numeric_llt_with_row_idx(factor, rows, start, tree, matrix, none, stack)
                .map_err(|_| Error::Run(Kind::NotFinite, "mass block is not positive definite".to_string()))?;
        }
        let n = self.solution.len();
        let pattern = SymbolicSparseColMatRef::new_unsorted_checked(n, n, &self.factor_start, None, &self.factor_row);
        let lower = SparseColMatRef::new(pattern, self.factor.as_slice());
        let mut solution = MatMut::from_column_major_slice_mut(&mut self.solution, n, 1);
        solve_lower_triangular_in_place(lower, Conj::No, solution.as_mut(), Par::Seq);
        solve_lower_triangular_transpose_in_place(lower, Conj::No, solution, Par::Seq);
        Ok(())
    }
}

/// The pattern as faer's view of an upper triangle.
fn symbolic(pattern: &Pattern) -> SymbolicSparseColMatRef<'_, u32> {
    let n = pattern.size();
    SymbolicSparseColMatRef::new_checked(n, n, &pattern.column_start, None, &pattern.row_index)
}
