//! Row forces from the block against the dense solution of the whole system.

mod common;

use std::sync::Arc;

use bipenalty::mass_block::{MassBlock, RowForces, Solver};
use bipenalty::model::Model;
use bipenalty::penalty::{Damping, Mass, Method};
use bipenalty::row::Row;
use bipenalty::state::State;
use common::{bipenalty, blocks, method, rows, start};
use nalgebra::{DMatrix, DVector};

/// Row forces of `[M + G'PG] a = f - K u - G'(A_s g + A_d G v)` over all degrees of freedom, densely.
fn dense(model: &Model, rows: &[Row], state: &State, dt: f64) -> DVector<f64> {
    let n = 2 * model.points.len();
    let (u, v) = (DVector::from_column_slice(&state.displacement), DVector::from_column_slice(&state.velocity));
    let mut g = DMatrix::zeros(rows.len(), n);
    for (c, row) in rows.iter().enumerate() {
        for (node, [x, y]) in row.entries() {
            g[(c, 2 * node as usize)] = x;
            g[(c, 2 * node as usize + 1)] = y;
        }
    }
    let diagonal = |f: &dyn Fn(usize) -> f64| DMatrix::from_diagonal(&DVector::from_fn(rows.len(), |c, _| f(c)));
    let (a_s, a_d) = (diagonal(&|c| rows[c].penalties.alpha_s), diagonal(&|c| rows[c].penalties.alpha_d));
    let p = diagonal(&|c| rows[c].penalties.inertia(dt));
    let gap = DVector::from_fn(rows.len(), |c, _| rows[c].gap);
    let mut mass = g.transpose() * &p * &g;
    (0..n).for_each(|i| mass[(i, i)] += model.mass[i / 2]);
    let known = &a_s * gap + &a_d * (&g * &v);
    let rhs = -(model.stiffness.to_dense() * u) - g.transpose() * &known;
    let a = mass.cholesky().unwrap().solve(&rhs);
    -(known + &p * (&g * a))
}

/// Largest error of the row forces over a run, relative to the largest force of the step.
fn largest_error(scene: bipenalty::scene::Scene, method: Method, solver: Solver) -> f64 {
    let model = Arc::new(Model::new(scene).unwrap());
    let mut group = start(&model, method, 0, [0.3, -2.0], 0.5);
    group.lanes[0].block.forced = Some(solver);
    let (mut worst, mut seen) = (0.0_f64, 0);
    for _ in 0..300 {
        let state = group.state.clone();
        group.advance(1);
        if !rows(&group).is_empty() {
            seen = seen.max(rows(&group).len());
            let lambda = dense(&model, rows(&group), &state, group.lanes[0].dt);
            let error = (lambda.clone() - DVector::from_column_slice(&group.lanes[0].forces.lambda)).amax();
            worst = worst.max(error / lambda.amax().max(1e-12));
            assert_eq!(group.lanes[0].block.used(), Some(solver));
        }
    }
    assert!(seen >= 5, "the blocks must meet: {seen} rows");
    worst
}

#[test]
fn both_solvers_agree_with_the_whole_system() {
    for quads in [true, false] {
        for passes in [1, 2] {
            for method in [
                bipenalty(1.0),
                bipenalty(100.0),
                method(5.0, Mass::None, Damping::Factor(1e-3)),
                method(5.0, Mass::RatioFromStep(0.9), Damping::Ratio(1.0)),
            ] {
                for solver in [Solver::Dual, Solver::Primal] {
                    let error = largest_error(blocks(quads, passes), method, solver);
                    assert!(error < 1e-10, "{method:?}, quads {quads}, {passes} passes, {solver:?}: {error}");
                }
            }
        }
    }
}

/// Rows that oppose the same pair of nodes, and one beside them.
fn redundant(alpha_s: f64, r: f64) -> Vec<Row> {
    let row = |entries: &[(u32, [f64; 2])]| {
        let mut row = Row::new(entries, 0, -1e-4, Default::default());
        row.penalties.alpha_s = alpha_s;
        row.penalties.alpha_m = alpha_s / r;
        row
    };
    let pair = [(0, [0.0, 1.0]), (1, [0.0, -1.0])];
    vec![row(&pair), row(&pair), row(&[(1, [0.0, 1.0]), (2, [0.6, -0.8])])]
}

#[test]
fn the_dual_stays_right_for_any_penalty_and_redundant_rows() {
    // As alpha_s grows at constant R, the impulse tends to that of the rigid limit: G v+ = R dt g-like, the same for all.
    let (inverse_mass, dt, r) = (vec![[2.0; 2]; 3], 1e-3, 1e6);
    let mut limit = None;
    for exponent in [10, 14, 18, 60, 200] {
        let rows = redundant(10f64.powi(exponent), r);
        let mut forces = RowForces { before: vec![-1.0, -1.0, 0.5], free: vec![-1.1, -1.1, 0.4], lambda: Vec::new() };
        let mut block = MassBlock::default();
        block.forced = Some(Solver::Dual);
        block.forces(&inverse_mass, &rows, dt, &mut forces).unwrap();
        // What the redundant rows share is told apart by round-off; what they do together is not.
        let together = [forces.lambda[0] + forces.lambda[1], forces.lambda[2]];
        let known = *limit.get_or_insert(together);
        for (a, b) in together.iter().zip(known) {
            assert!((a - b).abs() < 2e-3 * b.abs(), "1e{exponent}: {together:?} {known:?}");
        }
    }
}

#[test]
fn the_order_is_kept_while_the_pattern_lasts() {
    let model = Arc::new(Model::new(blocks(true, 1)).unwrap());
    let mut group = start(&model, bipenalty(1.0), 0, [0.0, -2.0], 0.5);
    let mut previous: Vec<Vec<u32>> = Vec::new();
    let mut changes = 0;
    for _ in 0..300 {
        group.advance(1);
        let nodes = |row: &Row| row.entries().map(|(node, _)| node).collect::<Vec<_>>();
        let pattern: Vec<Vec<u32>> = rows(&group).iter().map(nodes).collect();
        if !pattern.is_empty() {
            changes += usize::from(pattern != previous);
            previous = pattern;
        }
        assert_eq!(group.lanes[0].block.analyses(), changes);
    }
    assert!(changes > 1 && changes < 150, "{changes}");
}

#[test]
fn rows_without_mass_or_damping_need_no_block() {
    let model = Arc::new(Model::new(blocks(true, 1)).unwrap());
    let mut group = start(&model, method(1.0, Mass::None, Damping::None), 0, [0.0, -2.0], 0.5);
    group.advance(300);
    assert!(group.runs[0].history.peaks.force > 0.0);
    assert_eq!(group.lanes[0].block.analyses(), 0);
    assert_eq!(group.lanes[0].block.used(), None);
}

#[test]
fn many_rows_on_few_nodes_are_solved_over_the_nodes() {
    // 12 rows on two nodes: the primal is chosen, and gives what the dual gives.
    let row = |i: usize| {
        let angle = 0.5 * i as f64;
        let entries = [(0, [angle.cos(), angle.sin()]), (1, [-angle.sin(), angle.cos()])];
        let mut row = Row::new(&entries, 0, -1e-4 * i as f64, Default::default());
        (row.penalties.alpha_s, row.penalties.alpha_m) = (1e4, 0.1);
        row
    };
    let rows: Vec<Row> = (0..12).map(row).collect();
    let solve = |forced| {
        let rates = |scale: f64| rows.iter().map(|row| scale * row.gap).collect();
        let mut forces = RowForces { before: rates(1e3), free: rates(1.1e3), lambda: Vec::new() };
        let mut block = MassBlock::default();
        block.forced = forced;
        block.forces(&[[2.0; 2]; 2], &rows, 1e-3, &mut forces).unwrap();
        (DVector::from_vec(forces.lambda), block.used())
    };
    let ((chosen, used), (dual, _)) = (solve(None), solve(Some(Solver::Dual)));
    assert_eq!(used, Some(Solver::Primal));
    assert!((&chosen - &dual).amax() < 1e-9 * dual.amax());
}
