//! Which way to solve for the row forces: over the rows, or over the degrees of freedom they touch.

/// A solver of the mass block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Solver {
    /// `(P^-1 + G M^-1 G') lambda = -P^-1 q`: one unknown a row, well conditioned for any P.
    Dual,
    /// `(M + G'PG) a = -G'q`: one unknown a touched degree of freedom, by sparse Cholesky.
    Primal,
}

/// Operations a row up to which the envelope of the dual is cheaper than a general sparse factorisation (measured: the
/// sparse one takes about 250 ns a row in contact, the envelope half a nanosecond an operation).
const OPERATIONS_A_ROW: usize = 500;

/// The cheaper solver for a number of rows whose envelope takes so many multiplications to factorise.
pub(super) fn solver(rows: usize, operations: usize) -> Solver {
    if operations <= OPERATIONS_A_ROW * rows { Solver::Dual } else { Solver::Primal }
}
