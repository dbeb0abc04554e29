//! LDL' of a matrix in an envelope, and the solution with it.

use super::envelope::Envelope;

/// Round-off that a pivot may carry, over the diagonal it came from.
const ROUND_OFF: f64 = 8.0 * f64::EPSILON;

/// `values` become L below the diagonal and `pivots`, which come with what is added to the diagonal, D; `solution` comes
/// with the right-hand side. Every pivot is at least what was added, however redundant the rows.
pub fn factorise_and_solve(envelope: &Envelope, values: &mut [f64], pivots: &mut [f64], solution: &mut [f64]) {
    let Envelope { first, start, .. } = envelope;
    for i in 0..first.len() {
        let (fi, si) = (first[i] as usize, start[i] as usize);
        let (done, current) = values.split_at_mut(si);
        for j in fi..i {
            let (fj, sj) = (first[j] as usize, start[j] as usize);
            let from = fi.max(fj);
            let (a, b) = (&current[from - fi..j - fi], &done[sj + from - fj..sj + j - fj]);
            current[j - fi] -= a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        }
        let diagonal = current[i - fi];
        let (mut pivot, mut x) = (pivots[i] + diagonal, solution[i]);
        for j in fi..i {
            let scaled = current[j - fi] / pivots[j];
            pivot -= scaled * current[j - fi];
            x -= scaled * solution[j];
            current[j - fi] = scaled;
        }
        let least = pivots[i] + ROUND_OFF * diagonal;
        pivots[i] = if pivot > least { pivot } else { least };
        solution[i] = x;
    }
    for (x, pivot) in solution.iter_mut().zip(&*pivots) {
        *x /= pivot;
    }
    for i in (0..first.len()).rev() {
        let (fi, si, x) = (first[i] as usize, start[i] as usize, solution[i]);
        for j in fi..i {
            solution[j] -= values[si + j - fi] * x;
        }
    }
}
