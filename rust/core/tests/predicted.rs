//! Predicted against observed: runs at 0.98 and 1.02 of the limit that `critical_step` gives hold and blow up.
//!
//! Rows are fixed: random ones on random meshes, and those of a collision frozen at an instant. Rows of multipliers cost no
//! time step; those of the predictor-corrector have a limit of their own.

mod common;

use std::sync::Arc;

use bipenalty::constraint::linear::Linear;
use bipenalty::critical_step::{assembled_bound, rows};
use bipenalty::group::Group;
use bipenalty::model::Model;
use bipenalty::outcome::Outcome;
use bipenalty::penalty::{Damping, Mass, Method};
use bipenalty::run::RunSpec;
use bipenalty::scene::Scene;
use bipenalty::start::Start;
use bipenalty::stiffness::Isa;
use common::{
    bipenalty, blocks, body, cd_lagrange, forward_increment, method, predictor_corrector, rectangle, start, steel,
};

/// A run of small random velocities; `growth` says how far displacements may go.
fn run(model: &Arc<Model>, method: Method, dt: f64) -> Group {
    let n = 2 * model.points.len();
    let velocity = (0..n).map(|i| 1e-3 * (1.7 * i as f64 + 0.3).sin()).collect();
    let start = Arc::new(Start::new(model, velocity, vec![0.0; n]).unwrap());
    let new = RunSpec::new(method, dt, start);
    let spec = RunSpec { allow_unstable: true, displacement_limit: 1e3, steps: Some(30_000), ..new };
    let mut run = Group::alone(model.clone(), Isa::detect(), &spec).unwrap();
    run.advance(30_000);
    run
}

/// Limit of the model with its linear rows, predicted.
fn predicted(model: &Arc<Model>, method: Method, dt: f64) -> f64 {
    let mut run = start(model, method, 0, [0.0; 2], dt * model.element_omega() / 2.0);
    run.advance(1);
    2.0 / rows::largest_omega2(model, common::rows(&run)).upper.sqrt()
}

fn check_both_sides(model: &Arc<Model>, ps: f64, mass: Mass, what: &str) {
    let method = method(ps, mass, Damping::None);
    let limit = predicted(model, method, 0.5 * assembled_bound(model));
    let held = run(model, method, 0.98 * limit);
    assert_eq!(held.runs[0].outcome, Outcome::Running, "{what}, p_s = {ps}");
    assert!(
        held.runs[0].history.peaks.displacement < 1.0,
        "{what}, p_s = {ps}: {}",
        held.runs[0].history.peaks.displacement
    );
    assert!(run(model, method, 1.02 * limit).runs[0].outcome != Outcome::Running, "{what}, p_s = {ps}");
}

#[test]
fn random_rows_on_random_meshes() {
    let mut seed = 11_u64;
    let mut random = move || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    for case in 0..24 {
        let cells = [2 + (3.0 * random()) as usize, 2 + (3.0 * random()) as usize];
        let mesh = rectangle([0.0; 2], [1.0, 0.8], cells, 0.3, case % 2 == 0);
        let nodes = mesh.points.len();
        let linear = (0..1 + case % 5)
            .map(|i| {
                let node = |k: usize| ((nodes as f64 * random()) as usize / 3 * 3 + k) % nodes;
                let mut node = node;
                let at = [node(i), node(i + 1)];
                let mut entries: Vec<(u32, [f64; 2])> = Vec::new();
                for n in at {
                    if entries.iter().all(|(other, _)| *other != n as u32) {
                        entries.push((n as u32, [random() - 0.5, random() - 0.5]));
                    }
                }
                Linear { entries, offset: 0.0, young: steel().young }
            })
            .collect();
        let scene = Scene { bodies: vec![body("block", mesh, steel())], linear, ..Scene::default() };
        let model = Arc::new(Model::new(scene).unwrap());
        let omega2 = model.element_omega().powi(2);
        for (ps, mass) in [(0.3, Mass::None), (20.0, Mass::None), (20.0, Mass::Ratio(4.0 * omega2))] {
            check_both_sides(&model, ps, mass, &format!("case {case}"));
        }
    }
}

#[test]
fn a_collision_frozen_at_an_instant() {
    for (quads, passes) in [(true, 1), (true, 2), (false, 1)] {
        let model = Arc::new(Model::new(blocks(quads, passes)).unwrap());
        let mut moving = start(&model, bipenalty(1.0), 0, [0.3, -2.0], 0.5);
        while common::rows(&moving).len() < 5 {
            moving.advance(1);
        }
        let young = 1000.0;
        let freeze = |row: &bipenalty::row::Row| Linear { entries: row.entries().collect(), offset: 0.0, young };
        let linear = common::rows(&moving).iter().map(freeze).collect();
        let frozen = Arc::new(Model::new(Scene { linear, contacts: Vec::new(), ..blocks(quads, passes) }).unwrap());
        let omega2 = model.element_omega().powi(2);
        for (ps, mass) in [(1.0, Mass::None), (30.0, Mass::None), (1e3, Mass::Ratio(3.0 * omega2))] {
            check_both_sides(&frozen, ps, mass, &format!("quads {quads}, {passes} passes"));
        }
    }
}

/// Two blocks held together at the middle of their sides, by `copies` of one row.
fn joined(copies: usize) -> Arc<Model> {
    let bodies = [0.0, 1.0].map(|x| {
        body(if x == 0.0 { "left" } else { "right" }, rectangle([x, 0.0], [1.0, 1.0], [4, 4], 0.2, true), steel())
    });
    let entries = vec![(14, [-1.0, 0.0]), (25 + 10, [1.0, 0.0])];
    let linear = vec![Linear { entries, offset: 0.0, young: steel().young }; copies];
    Arc::new(Model::new(Scene { bodies: bodies.into(), linear, ..Scene::default() }).unwrap())
}

#[test]
fn multipliers_cost_no_time_step() {
    for method in [cd_lagrange(), forward_increment()] {
        for copies in [1, 2] {
            let model = joined(copies);
            let limit = assembled_bound(&model);
            let held = run(&model, method, 0.98 * limit);
            assert_eq!(held.runs[0].outcome, Outcome::Running, "{method:?}");
            assert!(held.runs[0].history.peaks.displacement < 1.0, "{}", held.runs[0].history.peaks.displacement);
            assert!(run(&model, method, 1.02 * limit).runs[0].outcome != Outcome::Running, "{method:?}");
        }
    }
}

#[test]
fn the_predictor_corrector_holds_while_rows_on_the_same_nodes_correct_no_more_than_the_gap() {
    for copies in [2, 3] {
        let model = joined(copies);
        for (courant, beyond) in [(0.1, 1.4), (0.6, 1.15), (0.9, 1.15)] {
            let dt = courant * assembled_bound(&model);
            let outcome = |share: f64| {
                let group = run(&model, predictor_corrector(1e9, share / copies as f64), dt);
                (group.runs[0].outcome == Outcome::Running, group.runs[0].history.peaks.displacement)
            };
            let (held, most) = outcome(0.99);
            assert!(held && most < 1.0, "{copies} copies, {courant}: {most}");
            // Slow growth from 1 on, the faster the larger the time step; at once from 4/3 on.
            assert!(!outcome(beyond).0, "{copies} copies, {courant}");
        }
    }
}
