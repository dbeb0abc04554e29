//! Central differences on both sides of the exact limit of a system whose active rows are fixed.
//!
//! The exact limit is 2/omega with omega the largest frequency of `(K + G'A_s G) x = omega^2 (M + G'A_m G) x`, from a
//! dense eigensolver that shares nothing with the step.

mod common;

use std::sync::Arc;

use bipenalty::constraint::linear::Linear;
use bipenalty::group::Group;
use bipenalty::model::Model;
use bipenalty::outcome::Outcome;
use bipenalty::penalty::{Damping, Mass, Method};
use bipenalty::run::RunSpec;
use bipenalty::scene::Scene;
use bipenalty::start::Start;
use bipenalty::stiffness::Isa;
use common::{body, method, rectangle, steel};
use nalgebra::{Cholesky, DMatrix};

/// A block whose left edge is tied to nothing by oblique rows, two of them sharing nodes.
fn tied_block() -> Arc<Model> {
    let mesh = rectangle([0.0; 2], [1.0, 1.0], [4, 4], 0.2, true);
    let row = |entries: &[(u32, [f64; 2])]| Linear { entries: entries.to_vec(), offset: 0.0, young: steel().young };
    let linear = vec![
        row(&[(0, [0.6, 0.8]), (5, [-0.3, -0.4]), (6, [-0.3, -0.4])]),
        row(&[(5, [1.0, 0.0])]),
        row(&[(24, [0.0, 1.0]), (19, [0.0, -1.0])]),
    ];
    Arc::new(Model::new(Scene { bodies: vec![body("block", mesh, steel())], linear, ..Scene::default() }).unwrap())
}

/// Largest frequency of the constrained system, densely.
fn exact_omega(model: &Model, alpha_s: f64, alpha_m: f64) -> f64 {
    let n = 2 * model.points.len();
    let (mut k, mut m) = (model.stiffness.to_dense(), DMatrix::zeros(n, n));
    (0..n).for_each(|i| m[(i, i)] = model.mass[i / 2]);
    for linear in &model.linear {
        let mut g = nalgebra::DVector::zeros(n);
        for (node, [x, y]) in &linear.entries {
            g[2 * *node as usize] = *x;
            g[2 * *node as usize + 1] = *y;
        }
        k += &g * g.transpose() * alpha_s;
        m += &g * g.transpose() * alpha_m;
    }
    let inverse = Cholesky::new(m).unwrap().l().try_inverse().unwrap();
    (&inverse * k * inverse.transpose()).symmetric_eigenvalues().max().sqrt()
}

fn start(model: &Arc<Model>, method: Method, dt: f64) -> Group {
    let n = 2 * model.points.len();
    let velocity = (0..n).map(|i| 1e-3 * (1.0 + i as f64).sin()).collect();
    let displacement = vec![0.0; n];
    let new = RunSpec::new(method, dt, Arc::new(Start::new(model, velocity, displacement).unwrap()));
    let spec = RunSpec { allow_unstable: true, displacement_limit: 1e3, steps: Some(20_000), ..new };
    Group::alone(model.clone(), Isa::detect(), &spec).unwrap()
}

fn check_both_sides(ps: f64, ratio: Option<f64>, damping: Damping) {
    let model = tied_block();
    let alpha_s = ps * steel().young;
    let mass = ratio.map_or(Mass::None, Mass::Ratio);
    let omega = exact_omega(&model, alpha_s, ratio.map_or(0.0, |r| alpha_s / r));
    for (factor, stable) in [(0.99, true), (1.01, false)] {
        let mut group = start(&model, method(ps, mass, damping), factor * 2.0 / omega);
        group.advance(20_000);
        let run = &group.runs[0];
        assert_eq!(run.outcome == Outcome::Running, stable, "{factor} of the limit: {:?}", run.outcome);
        if stable {
            assert!(run.history.peaks.displacement < 1.0, "{}", run.history.peaks.displacement);
        }
    }
}

#[test]
fn stiffness_penalty_is_stable_up_to_its_exact_limit() {
    for ps in [0.1, 3.0, 100.0] {
        check_both_sides(ps, None, Damping::None);
    }
}

#[test]
fn bipenalty_is_stable_up_to_its_exact_limit() {
    let omega_0 = exact_omega(&tied_block(), 0.0, 0.0);
    for ratio in [0.5, 3.0] {
        for ps in [0.1, 100.0] {
            check_both_sides(ps, Some(ratio * omega_0 * omega_0), Damping::None);
        }
    }
}

#[test]
fn centred_damping_leaves_the_limit_alone() {
    check_both_sides(3.0, None, Damping::Factor(1e-4));
    let omega_0 = exact_omega(&tied_block(), 0.0, 0.0);
    check_both_sides(3.0, Some(2.0 * omega_0 * omega_0), Damping::Ratio(0.05));
}

#[test]
fn mass_penalty_within_its_ratio_never_raises_the_frequency() {
    let model = tied_block();
    let omega_0 = exact_omega(&model, 0.0, 0.0);
    for ps in [0.1, 10.0, 1e6] {
        let alpha_s = ps * steel().young;
        let omega = exact_omega(&model, alpha_s, alpha_s / (omega_0 * omega_0));
        assert!(omega <= omega_0 * (1.0 + 1e-9), "{omega} > {omega_0}");
        assert!(exact_omega(&model, alpha_s, 0.0) > 1.0001 * omega_0);
    }
}
