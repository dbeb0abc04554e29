//! Multipliers and the predictor-corrector: what they promise of a step, over whole collisions.

mod common;

use std::sync::Arc;

use bipenalty::enforcement::Enforcement;
use bipenalty::group::Group;
use bipenalty::lane::Lane;
use bipenalty::model::Model;
use bipenalty::outcome::Outcome;
use bipenalty::penalty::{Damping, Mass, Method};
use bipenalty::row::Row;
use bipenalty::scene::Scene;
use common::{
    bipenalty, blocks, body, cd_lagrange, contact, forward_increment, method, predictor_corrector, rectangle, rows,
    start, steel, wall,
};
use nalgebra::{DMatrix, DVector};

/// W = G M^-1 G' of the rows of the last step, densely.
fn gram(model: &Model, rows: &[Row]) -> DMatrix<f64> {
    let n = 2 * model.points.len();
    let mut g = DMatrix::zeros(rows.len(), n);
    for (c, row) in rows.iter().enumerate() {
        for (node, [x, y]) in row.entries() {
            g[(c, 2 * node as usize)] = x;
            g[(c, 2 * node as usize + 1)] = y;
        }
    }
    let inverse = DVector::from_fn(n, |i, _| model.inverse_mass[i / 2][i % 2]);
    &g * DMatrix::from_diagonal(&inverse) * g.transpose()
}

/// W x + q of `0 <= x _|_ W x + q >= 0` by another way than the one tested: projected Gauss-Seidel, to the end.
fn reference(w: &DMatrix<f64>, q: &DVector<f64>) -> DVector<f64> {
    let mut x = DVector::<f64>::zeros(q.len());
    for _ in 0..200_000 {
        let mut change = 0.0_f64;
        for c in 0..q.len() {
            let next = (x[c] - (w.row(c).transpose().dot(&x) + q[c]) / w[(c, c)]).max(0.0);
            change = change.max(w[(c, c)] * (next - x[c]).abs());
            x[c] = next;
        }
        if change < 1e-15 * q.amax() {
            break;
        }
    }
    w * x + q
}

/// Most rows of a collision in which each step keeps complementarity and agrees with the reference, and most and mean
/// factorisations of a step.
fn check_complementarity(scene: Scene, method: Method, mut each: impl FnMut(&Group)) -> (usize, usize, f64) {
    let model = Arc::new(Model::new(scene).unwrap());
    let mut group = start(&model, method, 0, [0.3, -2.0], 0.5);
    let (mut most, mut iterations, mut total, mut steps) = (0, 0, 0, 0);
    for _ in 0..300 {
        group.advance(1);
        let (lane, rows) = (&group.lanes[0], rows(&group));
        if rows.is_empty() {
            continue;
        }
        let taken = lane.multipliers.iterations;
        (most, iterations, total, steps) = (most.max(rows.len()), iterations.max(taken), total + taken, steps + 1);
        let (w, vector) = (gram(&model, rows), |values: &[f64]| DVector::from_column_slice(values));
        let impulse = vector(&lane.forces.lambda) * lane.dt;
        // What is complementary to the impulse: the rate after the step, or what is left of the gap over dt.
        let (after, q) = if method.enforcement.looks_ahead() {
            let left = DVector::from_fn(rows.len(), |c, _| rows[c].gap / lane.dt);
            (left.clone(), left - &w * &impulse)
        } else {
            let v = Lane::new(&group.state.velocity, 1, 0);
            (DVector::from_fn(rows.len(), |c, _| rows[c].along(v)), vector(&lane.forces.free))
        };
        let own = DVector::from_fn(rows.len(), |c, _| w[(c, c)] * impulse[c]);
        let scale = 1e-8 * q.amax().max(own.amax());
        for c in 0..rows.len() {
            assert!(impulse[c] >= 0.0 && after[c] >= -scale, "row {c}: {} {}", own[c], after[c]);
            assert!(own[c].min(after[c]) <= scale, "row {c}: {} {}", own[c], after[c]);
        }
        let known = reference(&w, &q);
        assert!((after.clone() - &known).amax() <= 10.0 * scale, "{after} {known}");
        each(&group);
    }
    assert_eq!(group.runs[0].outcome, Outcome::Running);
    (most, iterations, total as f64 / steps as f64)
}

#[test]
fn complementarity_holds_at_every_step_of_a_collision() {
    for method in [cd_lagrange(), forward_increment()] {
        for (quads, passes) in [(true, 1), (true, 2), (false, 1), (false, 2)] {
            let (rows, most, mean) = check_complementarity(blocks(quads, passes), method, |_| {});
            assert!(rows >= 5, "the blocks must meet: {rows} rows");
            assert!(most <= 2 * rows && mean < 3.0, "{most} factorisations for {rows} rows, {mean} in the mean");
        }
    }
}

/// The contact twice over: every row has a copy of itself.
#[test]
fn redundant_rows_share_the_force_of_one() {
    for method in [cd_lagrange(), forward_increment()] {
        let mut doubled = blocks(true, 1);
        doubled.contacts.push(contact("upper", "lower", 1));
        let single = Arc::new(Model::new(blocks(true, 1)).unwrap());
        let mut single = start(&single, method, 0, [0.3, -2.0], 0.5);
        check_complementarity(doubled, method, |group| {
            while single.runs[0].steps < group.runs[0].steps {
                single.advance(1);
            }
            let scale = single.state.velocity.iter().fold(0.0, |a: f64, v| a.max(v.abs()));
            for (a, b) in single.state.velocity.iter().zip(group.state.velocity.iter()) {
                assert!((a - b).abs() < 1e-6 * scale, "{a} {b}");
            }
        });
    }
}

#[test]
fn momentum_is_exact() {
    for method in [cd_lagrange(), forward_increment(), predictor_corrector(1e3, 0.6)] {
        let model = Arc::new(Model::new(blocks(false, 2)).unwrap());
        let mut group = start(&model, method, 0, [0.3, -2.0], 0.5);
        let momentum = |group: &Group| {
            let of = |axis| (0..model.points.len()).map(|n| model.mass[n] * group.state.velocity[2 * n + axis]).sum();
            [of(0), of(1)]
        };
        let before: [f64; 2] = momentum(&group);
        group.advance(300);
        assert!(group.runs[0].history.peaks.impulse > 0.01);
        for (a, b) in before.iter().zip(momentum(&group)) {
            assert!((a - b).abs() < 1e-12 * before[1].abs(), "{method:?}: {a} {b}");
        }
    }
}

/// A block of one element that flies at a wall; in so few of so small steps its nodes are point masses.
fn point_masses(at: f64) -> Scene {
    let block = rectangle([at, 0.0], [1.0, 1.0], [1, 1], 0.0, true);
    Scene {
        bodies: vec![body("block", block, steel())],
        obstacles: vec![wall()],
        contacts: vec![contact("block", "wall", 1)],
        ..Scene::default()
    }
}

#[test]
fn a_node_on_a_wall_stops() {
    // The wall is at x = 0; at every phase of entry the left nodes end at rest, restitution 0.
    for method in [cd_lagrange(), forward_increment(), predictor_corrector(1e18, 1.0)] {
        for phase in [0.01, 0.3, 0.77] {
            let probe = Arc::new(Model::new(point_masses(1.0)).unwrap());
            let step = 1e-4 * bipenalty::critical_step::element_bound(&probe);
            let speed = 1e-3 / step;
            let model = Arc::new(Model::new(point_masses(1e-3 * (3.0 + phase))).unwrap());
            let mut group = start(&model, method, 0, [-speed, 0.0], 1e-4);
            group.advance(8);
            let v = Lane::new(&group.state.velocity, 1, 0);
            let (x, left) = (Lane::new(&group.state.displacement, 1, 0), [0, 2]);
            for node in left {
                assert!(v.at(node)[0].abs() < 1e-6 * speed, "{method:?}, phase {phase}: {}", v.at(node)[0] / speed);
                let gap = model.points[node as usize][0] + x.at(node)[0];
                let deepest = if method.enforcement.looks_ahead() { 1e-9 } else { (1.0 - phase) * 1e-3 + 1e-9 };
                assert!(gap < 1e-9 && gap > -deepest, "{method:?}, phase {phase}: gap {gap}");
            }
            assert!((v.at(1)[0] + speed).abs() < 1e-6 * speed, "the others fly on");
        }
    }
}

#[test]
fn the_forward_increment_closes_gaps() {
    // Against a wall the gap is linear: what presses is on the wall to round-off. Nothing pulls.
    let tall = rectangle([0.0005, 0.0], [0.6, 1.0], [6, 8], 0.1, true);
    let scene = Scene {
        bodies: vec![body("block", tall, steel())],
        obstacles: vec![wall()],
        contacts: vec![contact("block", "wall", 1)],
        ..Scene::default()
    };
    let model = Arc::new(Model::new(scene).unwrap());
    let mut group = start(&model, forward_increment(), 0, [-1.0, 0.4], 0.5);
    let mut pressed = 0;
    for _ in 0..200 {
        group.advance(1);
        let u = Lane::new(&group.state.displacement, 1, 0);
        for (row, lambda) in rows(&group).iter().zip(&group.lanes[0].forces.lambda) {
            let node = row.first_node();
            let gap = model.points[node as usize][0] + u.at(node)[0];
            assert!(*lambda >= 0.0 && gap >= -1e-12, "{lambda} {gap}");
            assert!(*lambda == 0.0 || gap.abs() < 1e-12, "{lambda} {gap}");
            pressed += u32::from(*lambda > 0.0);
        }
    }
    assert!(pressed > 100, "{pressed}");
    assert!(group.runs[0].history.peaks.penetration < 1e-12);
}

#[test]
fn row_steps_and_operations_are_counted() {
    let model = Arc::new(Model::new(blocks(true, 2)).unwrap());
    let plain = method(3.0, Mass::None, Damping::None);
    for (method, solves) in
        [(plain, false), (bipenalty(1.0), true), (cd_lagrange(), true), (predictor_corrector(1.0, 0.5), false)]
    {
        let mut group = start(&model, method, 0, [0.3, -2.0], 0.5);
        let mut seen = 0;
        for _ in 0..300 {
            group.advance(1);
            seen += rows(&group).len() as u64;
        }
        let summary = bipenalty::ended::Summary::of(&group.runs[0], &group.lanes[0]);
        assert!(seen > 100);
        assert_eq!(summary.row_steps, seen);
        assert_eq!(summary.block_operations > 0, solves, "{method:?}");
    }
}

#[test]
fn parameters_out_of_bounds_are_refused() {
    let check = |method: Method| method.check("method").map_err(|e| e.to_string());
    for tolerance in [0.0, -1.0, 0.1, f64::NAN] {
        for enforcement in [Enforcement::VelocityLagrange { tolerance }, Enforcement::ForwardIncrement { tolerance }] {
            let message = check(common::lagrange(enforcement)).unwrap_err();
            assert!(message.contains("tolerance") && message.contains("1e-10"), "{message}");
        }
    }
    assert!(check(predictor_corrector(1.0, 1.4)).unwrap_err().contains("s2 = 1.4"));
    let other = Method { enforcement: Enforcement::PredictorCorrector, ..bipenalty(1.0) };
    assert!(check(other).unwrap_err().contains("penalties"));
}
