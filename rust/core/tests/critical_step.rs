//! Limits of the time step against dense eigenvalues.

mod common;

use std::sync::Arc;

use bipenalty::critical_step::assembled::EPSILON;
use bipenalty::critical_step::{element_bound, lanczos, rows};
use bipenalty::model::Model;
use bipenalty::penalty::{Damping, Mass};
use bipenalty::row::{Behind, Penalties, Row};
use common::{blocks, method, start};
use nalgebra::{Cholesky, DMatrix, DVector};

/// Dense largest omega^2 of `K + G'A_s G` over `M + G'A_m G`.
fn dense(model: &Model, rows: &[Row]) -> f64 {
    let n = 2 * model.points.len();
    let (mut k, mut m) = (model.stiffness.to_dense(), DMatrix::zeros(n, n));
    (0..n).for_each(|i| m[(i, i)] = model.mass[i / 2]);
    for row in rows {
        let mut g = DVector::zeros(n);
        for (node, [x, y]) in row.entries() {
            g[2 * node as usize] = x;
            g[2 * node as usize + 1] = y;
        }
        k += &g * g.transpose() * row.penalties.alpha_s;
        m += &g * g.transpose() * row.penalties.alpha_m;
    }
    let inverse = Cholesky::new(m).unwrap().l().try_inverse().unwrap();
    (&inverse * k * inverse.transpose()).symmetric_eigenvalues().max()
}

#[test]
fn assembled_bound_holds_and_is_sharp() {
    for quads in [true, false] {
        let model = Model::new(blocks(quads, 1)).unwrap();
        let (exact, bound) = (dense(&model, &[]), model.assembled_omega2());
        assert!(bound.found <= exact * (1.0 + 1e-12) && bound.found >= exact * (1.0 - EPSILON), "{bound:?} {exact}");
        assert!(bound.upper >= exact && bound.upper <= exact * (1.0 + 1.1 * EPSILON), "{bound:?} {exact}");
        assert!(bound.upper < model.element_omega().powi(2) && element_bound(&model) < 2.0 / bound.upper.sqrt());
    }
}

#[test]
fn exhausted_space_is_exact() {
    let values = [3.0, 1.0, 7.0];
    let bound = lanczos::largest(3, 0.01, |x, out| (0..3).for_each(|i| out[i] = values[i] * x[i]));
    assert!((bound.found - 7.0).abs() < 1e-12);
    assert!(lanczos::steps(2_000_000, 0.01) < 170);
}

#[test]
fn active_rows_within_half_a_percent() {
    for quads in [true, false] {
        let model = Arc::new(Model::new(blocks(quads, 2)).unwrap());
        for (ps, mass) in [
            (1.0, Mass::None),
            (30.0, Mass::None),
            (30.0, Mass::RatioFromStep(0.9)),
            (1e5, Mass::RatioFromStep(0.9)),
            (1e3, Mass::RatioFromStep(3.0)),
        ] {
            let mut run = start(&model, method(ps, mass, Damping::Factor(1e-3)), 0, [0.3, -2.0], 0.5);
            while common::rows(&run).len() < 5 {
                run.advance(1);
            }
            let (exact, found) = (dense(&model, common::rows(&run)), rows::largest_omega2(&model, common::rows(&run)));
            assert!(
                found.found <= exact * (1.0 + 1e-9) && found.found >= 0.996 * exact,
                "{ps} {mass:?}: {found:?} {exact}"
            );
            assert!(found.upper >= exact);
            let added = rows::largest_stiffening(&model, common::rows(&run)) * ps;
            assert!(exact <= dense(&model, &[]) + added + 1e-9 * exact);
        }
    }
}

/// Uniform deviates in (-1, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn below(&mut self, n: usize) -> usize {
        ((self.next() + 1.0) * 0.5 * n as f64) as usize % n
    }
}

#[test]
fn bipenalty_never_passes_the_larger_of_mesh_and_ratio() {
    let mut random = Random(7);
    for case in 0..3000 {
        let cells = [1 + random.below(3), 1 + random.below(3)];
        let mesh = common::rectangle([0.0; 2], [1.0, 1.0], cells, 0.3, case % 2 == 0);
        let scene = bipenalty::scene::Scene {
            bodies: vec![common::body("block", mesh, common::steel())],
            ..Default::default()
        };
        let model = Model::new(scene).unwrap();
        let omega2 = dense(&model, &[]);
        let ratio = omega2 * 10f64.powf(random.next());
        let n = model.points.len();
        let make = |random: &mut Random| {
            let entries: Vec<(u32, [f64; 2])> = (0..1 + random.below(3))
                .map(|_| (random.below(n) as u32, [random.next(), random.next()]))
                .fold(Vec::new(), |mut list, entry| {
                    if list.iter().all(|(node, _)| *node != entry.0) {
                        list.push(entry);
                    }
                    list
                });
            let mut row = Row::new(&entries, 0, 0.0, Behind::default());
            let alpha_s = 10f64.powf(8.0 * random.next());
            row.penalties = Penalties { alpha_s, alpha_m: alpha_s / ratio, alpha_d: 0.0 };
            row
        };
        let mut rows: Vec<Row> = (0..1 + random.below(6)).map(|_| make(&mut random)).collect();
        if case % 3 == 0 {
            rows.push(rows[0]);
        }
        let omega2_with_rows = dense(&model, &rows);
        let bound = omega2.max(ratio);
        assert!(omega2_with_rows <= bound * (1.0 + 1e-6), "case {case}: {omega2_with_rows} > {bound}");
    }
}
