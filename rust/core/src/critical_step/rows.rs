//! What a given set of active rows does to the largest frequency.

use nalgebra::{DMatrix, DVector};

use super::assembled::{apply, scale};
use super::lanczos::{Largest, largest};
use crate::contact::surface::Vertices;
use crate::contact::{Pair, Primary, Surface};
use crate::model::Model;
use crate::row::Row;

/// Relative error allowed for in the squared frequency of a constrained system.
const EPSILON: f64 = 0.004;

/// Largest eigenvalue of E^1/2 G M^-1 G' E^1/2 (N/m^2 per kg) over the rows, E the moduli that scale their penalties:
/// p_s times it bounds what a stiffness penalty adds to omega^2.
pub fn largest_stiffening(model: &Model, rows: &[Row]) -> f64 {
    if rows.is_empty() {
        return 0.0;
    }
    let gradient = scaled_gradients(rows, &scale(model));
    let root = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.behind.young.sqrt()));
    let root = DMatrix::from_diagonal(&root);
    (&root * gram(&gradient) * &root).symmetric_eigenvalues().max()
}

/// The same for the worst row that can come about, whatever touches what: the lightest node of one surface on the lightest
/// of the other, once for each pair that joins the two (a second pass, a contact listed twice).
pub fn worst_stiffening(model: &Model) -> f64 {
    let lightest = |nodes: &mut dyn Iterator<Item = u32>| -> f64 {
        nodes.map(|n| model.inverse_mass[n as usize].into_iter().fold(0.0, f64::max)).fold(0.0, f64::max)
    };
    let of_pair = |pair: &Pair| {
        let primary = match &pair.primary {
            Primary::Surface(Surface { vertices: Vertices::Nodes(nodes), .. }) => lightest(&mut nodes.iter().copied()),
            _ => 0.0,
        };
        primary + lightest(&mut pair.secondary.iter().map(|s| s.node))
    };
    let joins = |a: &Pair, b: &Pair| {
        let ends = |p: &Pair| (p.primary_body, Some(p.secondary_body));
        ends(a) == ends(b) || ends(a) == (ends(b).1, ends(b).0)
    };
    let together = |pair: &Pair| model.pairs.iter().filter(|p| joins(pair, p)).map(|p| p.young * of_pair(p)).sum();
    model.pairs.iter().map(together).fold(0.0, f64::max)
}

/// Largest omega^2 (1/s^2) of `K + G'A_s G` over `M + G'A_m G` with these rows active for good.
///
/// In y = M^1/2 u the mass is `1 + B'A_m B` with B = G M^-1/2. Its inverse square root is `1 - B'C B` with C from the
/// eigenvectors of `A_m^1/2 B B' A_m^1/2`, one unknown a row, so that the whole operator is symmetric.
pub fn largest_omega2(model: &Model, rows: &[Row]) -> Largest {
    let scale = scale(model);
    let gradient = scaled_gradients(rows, &scale);
    let correction = inverse_root_correction(rows, &gradient);
    let along = |x: &[f64]| -> DVector<f64> {
        let dot = |g: &Sparse| g.iter().map(|&(i, value)| value * x[i]).sum();
        DVector::from_iterator(gradient.len(), gradient.iter().map(dot))
    };
    let spread = |weights: &DVector<f64>, out: &mut [f64]| {
        for (g, w) in gradient.iter().zip(weights.iter()) {
            g.iter().for_each(|&(i, value)| out[i] += w * value);
        }
    };
    // x -> (1 - B'C B) x
    let inverse_root = |x: &mut [f64]| spread(&(-(&correction * along(x))), x);
    let mut y = vec![0.0; scale.len()];
    largest(scale.len(), EPSILON, |x, out| {
        y.copy_from_slice(x);
        inverse_root(&mut y);
        for body in &model.bodies {
            let of_body = 2 * body.nodes.start..2 * body.nodes.end;
            apply(model, body, &scale[of_body.clone()], &y[of_body.clone()], &mut out[of_body]);
        }
        let mut forces = along(&y);
        forces.iter_mut().zip(rows).for_each(|(f, row)| *f *= row.penalties.alpha_s);
        spread(&forces, out);
        inverse_root(out);
    })
}

type Sparse = Vec<(usize, f64)>;

/// Rows of G M^-1/2.
fn scaled_gradients(rows: &[Row], scale: &[f64]) -> Vec<Sparse> {
    let entries = |row: &Row| -> Sparse {
        let dofs = row.entries().flat_map(|(node, g)| [(2 * node as usize, g[0]), (2 * node as usize + 1, g[1])]);
        dofs.map(|(i, g)| (i, g * scale[i])).filter(|(_, g)| *g != 0.0).collect()
    };
    rows.iter().map(entries).collect()
}

/// B B'.
fn gram(gradient: &[Sparse]) -> DMatrix<f64> {
    let dot = |a: &Sparse, b: &Sparse| {
        let at = |i: usize| b.iter().filter(move |(j, _)| *j == i).map(|(_, g)| g).sum::<f64>();
        a.iter().map(|&(i, g)| g * at(i)).sum::<f64>()
    };
    DMatrix::from_fn(gradient.len(), gradient.len(), |i, j| dot(&gradient[i], &gradient[j]))
}

/// C with (1 + B'A B)^-1/2 = 1 - B'C B, A the diagonal of mass penalties.
///
/// With S = A^1/2, S B B' S = V diag(e) V' and f(e) = (1 - (1 + e)^-1/2)/e, C = S V diag(f) V' S.
fn inverse_root_correction(rows: &[Row], gradient: &[Sparse]) -> DMatrix<f64> {
    let root = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.penalties.alpha_m.sqrt()));
    let scaled = DMatrix::from_diagonal(&root) * gram(gradient) * DMatrix::from_diagonal(&root);
    let eigen = scaled.symmetric_eigen();
    // (1 - (1 + e)^-1/2)/e without cancellation: 1/(r (r + 1)) with r = (1 + e)^1/2.
    let weight = eigen.eigenvalues.map(|e| {
        let r = (1.0 + e.max(0.0)).sqrt();
        1.0 / (r * (r + 1.0))
    });
    let v = DMatrix::from_diagonal(&root) * &eigen.eigenvectors;
    &v * DMatrix::from_diagonal(&weight) * v.transpose()
}
