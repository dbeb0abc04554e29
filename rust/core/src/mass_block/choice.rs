//! Which way to solve for the row forces: over the rows, or over the degrees of freedom they touch.

/// A solver of the mass block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solver {
    /// `(P^-1 + G M^-1 G') lambda = -P^-1 q`: one unknown a row, well conditioned for any P.
    Dual,
    /// `(M + G'PG) a = -G'q`: one unknown a touched degree of freedom, by sparse Cholesky.
    Primal,
}

/// Rows a touched node from which the primal is the cheaper. Measured, in microseconds a step, dual and primal: 100 rows on
/// 160 nodes 2.8 and 42 (neighbours coupled), 100 on 100 nodes 36 and 1100 (all coupled), 40 on 8 nodes 7.9 and 7.3, 100 on
/// 30 nodes 64 and 50, 60 on 8 nodes 20 and 10, 100 on 8 nodes 80 and 16.
const ROWS_A_NODE: usize = 3;

/// The cheaper solver for a number of rows on a number of nodes.
pub(super) fn solver(rows: usize, nodes: usize) -> Solver {
    if rows <= ROWS_A_NODE * nodes { Solver::Dual } else { Solver::Primal }
}
