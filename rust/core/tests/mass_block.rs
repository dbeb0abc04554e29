//! Row forces from the block against the dense solution of the whole system.

mod common;

use std::sync::Arc;

use bipenalty::lane::Lane;
use bipenalty::model::Model;
use bipenalty::penalty::{Damping, Mass, Method};
use bipenalty::step::row_forces;
use common::{bipenalty, blocks, method, start};
use nalgebra::{DMatrix, DVector};

/// Largest error of the row forces over a run, relative to the largest force, against `[M + G'PG] a = r`.
fn largest_error(scene: bipenalty::scene::Scene, method: Method) -> f64 {
    let model = Arc::new(Model::new(scene).unwrap());
    let mut run = start(&model, method, 0, [0.3, -2.0], 0.5);
    let (n, mut worst, mut seen) = (2 * model.points.len(), 0.0_f64, 0);
    for _ in 0..300 {
        row_forces(&model, &run.settings, &run.state, &mut run.work).unwrap();
        let (rows, dt) = (&run.work.rows, run.settings.dt);
        if !rows.is_empty() {
            seen = seen.max(rows.len());
            let u = DVector::from_column_slice(&run.state.displacement);
            let v = DVector::from_column_slice(&run.state.velocity);
            let mut g = DMatrix::zeros(rows.len(), n);
            for (c, row) in rows.iter().enumerate() {
                for (node, [x, y]) in row.entries() {
                    g[(c, 2 * node as usize)] = x;
                    g[(c, 2 * node as usize + 1)] = y;
                }
            }
            let diagonal =
                |f: &dyn Fn(usize) -> f64| DMatrix::from_diagonal(&DVector::from_fn(rows.len(), |c, _| f(c)));
            let (a_s, a_d) = (diagonal(&|c| rows[c].penalties.alpha_s), diagonal(&|c| rows[c].penalties.alpha_d));
            let p = diagonal(&|c| rows[c].penalties.inertia(dt));
            let gap = DVector::from_fn(rows.len(), |c, _| rows[c].gap);
            let mut mass = g.transpose() * &p * &g;
            (0..n).for_each(|i| mass[(i, i)] += model.mass[i / 2]);
            let known = &a_s * gap + &a_d * (&g * &v);
            let rhs = -(model.stiffness.to_dense() * u) - g.transpose() * &known;
            let a = mass.cholesky().unwrap().solve(&rhs);
            let lambda = -(known + &p * (&g * a));
            let error = (lambda.clone() - DVector::from_column_slice(&run.work.forces.lambda)).amax();
            worst = worst.max(error / lambda.amax().max(1e-12));
        }
        run.advance(1, false);
    }
    assert!(seen >= 5, "the blocks must meet: {seen} rows");
    worst
}

#[test]
fn block_agrees_with_the_whole_system() {
    for quads in [true, false] {
        for passes in [1, 2] {
            for method in [
                bipenalty(1.0),
                bipenalty(100.0),
                method(5.0, Mass::None, Damping::Factor(1e-3)),
                method(5.0, Mass::RatioFromStep(0.9), Damping::Ratio(1.0)),
            ] {
                let error = largest_error(blocks(quads, passes), method);
                assert!(error < 1e-10, "{method:?}, quads {quads}, {passes} passes: {error}");
            }
        }
    }
}

#[test]
fn symbolic_factorisation_is_reused_while_the_pattern_lasts() {
    let model = Arc::new(Model::new(blocks(true, 1)).unwrap());
    let mut run = start(&model, bipenalty(1.0), 0, [0.0, -2.0], 0.5);
    let mut previous: Vec<Vec<u32>> = Vec::new();
    let mut changes = 0;
    for _ in 0..300 {
        row_forces(&model, &run.settings, &run.state, &mut run.work).unwrap();
        let nodes = |row: &bipenalty::row::Row| row.entries().map(|(node, _)| node).collect::<Vec<_>>();
        let pattern: Vec<Vec<u32>> = run.work.rows.iter().map(nodes).collect();
        if !pattern.is_empty() {
            changes += usize::from(pattern != previous);
            previous = pattern;
        }
        assert_eq!(run.work.block.analyses(), changes);
        run.advance(1, false);
    }
    assert!(changes > 1 && changes < 150, "{changes}");
}

#[test]
fn rows_without_mass_or_damping_need_no_block() {
    let model = Arc::new(Model::new(blocks(true, 1)).unwrap());
    let mut run = start(&model, method(1.0, Mass::None, Damping::None), 0, [0.0, -2.0], 0.5);
    run.advance(300, true);
    assert!(run.history.peaks.force > 0.0);
    assert_eq!(run.work.block.analyses(), 0);
    let u = Lane::new(&run.state.displacement, 1, 0);
    assert!(u.at(0)[1] != 0.0);
}
