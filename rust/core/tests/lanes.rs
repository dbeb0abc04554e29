//! A run in a batch gives bit for bit what it gives alone: whatever its lane, its neighbours, the width and the threads.

mod common;

use std::sync::Arc;
use std::time::Duration;

use bipenalty::batch::Batch;
use bipenalty::crew::Crew;
use bipenalty::critical_step::element_bound;
use bipenalty::ended::{Ended, Summary};
use bipenalty::enforcement::Enforcement;
use bipenalty::group::{Group, WIDTHS};
use bipenalty::history::Record;
use bipenalty::model::Model;
use bipenalty::penalty::{Damping, Mass, Method, Stiffness};
use bipenalty::run::RunSpec;
use bipenalty::stiffness::Isa;
use bipenalty::variant::Variation;
use common::{blocks, method, moving};

const METHODS: usize = 7;

fn parameter_free() -> Method {
    Method {
        stiffness: Stiffness::Capped,
        kappa: 5.0,
        mass: Mass::Critical(1.5),
        damping: Damping::Critical,
        enforcement: Enforcement::Penalty,
    }
}

/// Runs that differ in all that may differ: method, dt, number of steps, velocity, moduli, densities, places; some fail.
fn specs(model: &Model, count: usize) -> Vec<RunSpec> {
    let start = moving(model, 0, [0.3, -2.0]);
    let one = |i: usize| {
        let method = match i % METHODS {
            0 => method(1.0, Mass::None, Damping::None),
            1 => parameter_free(),
            2 => method(3.0, Mass::RatioFromStep(0.9), Damping::None),
            // Past its limit: it ends early, and its lane takes another.
            3 => method(3e3, Mass::None, Damping::None),
            4 => Method { enforcement: Enforcement::VelocityLagrange { tolerance: 1e-9 }, ..parameter_free() },
            5 => method(10.0, Mass::RatioFromStep(0.9), Damping::Ratio(1.0)),
            _ => method(1.0, Mass::None, Damping::Factor(1e-4)),
        };
        let mut spec = RunSpec::new(method, (0.3 + 0.002 * i as f64) * element_bound(model), start.clone());
        spec.steps = Some(700 + 37 * (i as u64 % 7));
        spec.record = Record { every: 1, energy_every: 10, snapshots: vec![5, 600] };
        if i.is_multiple_of(2) {
            spec.velocity = Some(vec![Some([0.1 * i as f64 / count as f64, -1.5]), None]);
        }
        if i.is_multiple_of(3) {
            let x = 0.01 * i as f64 / count as f64;
            let (young, density) = (vec![1.0 - x, 1.0 + x], vec![1.0 + 3.0 * x, 1.0]);
            spec.variation = Some(Variation { young, density, offset: vec![[x, x], [0.0; 2]] });
        }
        spec
    };
    (0..count).map(one).collect()
}

fn alone(model: &Arc<Model>, isa: Isa, spec: &RunSpec) -> Ended {
    let mut group = Group::alone(model.clone(), isa, spec).unwrap();
    group.advance(spec.steps.unwrap());
    let summary = Summary::of(&group.runs[0], &group.lanes[0]);
    Ended { summary, history: group.runs[0].history.clone() }
}

/// All that is observed, as bits, but for the time it took.
fn bits(run: &Ended) -> (String, Vec<u64>) {
    let (s, h) = (&run.summary, &run.history);
    let words = format!("{:?} {:?} {} {:?} {:?}", s.conclusion, s.stopped, s.steps, h.steps, h.active);
    let energies = h.energies.iter().flat_map(|e| [e.kinetic, e.strain, e.penalty, e.half_step, e.max_displacement]);
    let snapshots = h.snapshots.iter().flat_map(|s| s.displacement.iter().chain(&s.velocity)).copied();
    let peaks = [s.peaks.force, s.peaks.impulse, s.peaks.penetration, s.energy_ratio, s.energy_made];
    let histories = h.force.iter().chain(&h.penetration).chain(h.momentum.as_flattened()).copied();
    (words, histories.chain(energies).chain(snapshots).chain(peaks).map(f64::to_bits).collect())
}

fn batch(model: &Arc<Model>, isa: Isa, width: usize, threads: usize, specs: &[RunSpec]) -> Vec<Ended> {
    let batch = Batch::new(model.clone(), isa, width, specs.to_vec());
    while batch.finished() < batch.len() {
        batch.advance(threads, Duration::from_millis(20));
    }
    (0..batch.len()).map(|i| batch.look(i, Ended::clone).unwrap()).collect()
}

#[test]
fn a_run_in_a_batch_is_the_run_alone() {
    for (passes, quads) in [(1, true), (2, false)] {
        let model = Arc::new(Model::new(blocks(quads, passes)).unwrap());
        let specs = specs(&model, 37);
        let expected: Vec<_> = specs.iter().map(|spec| bits(&alone(&model, Isa::detect(), spec))).collect();
        let failed = expected.iter().filter(|(words, _)| words.contains("Failed")).count();
        assert!((5..=20).contains(&failed), "{failed} runs fail");
        for (width, threads) in WIDTHS.into_iter().flat_map(|width| [(width, 1), (width, 2)]) {
            for (i, run) in batch(&model, Isa::detect(), width, threads, &specs).iter().enumerate() {
                assert!(bits(run) == expected[i], "run {i} in {width} lanes on {threads} threads");
            }
        }
    }
}

#[test]
fn each_instruction_set_repeats_itself_in_lanes() {
    let mut scene = blocks(true, 1);
    scene.bodies[1].body_force = [0.3, -2.0];
    let model = Arc::new(Model::new(scene).unwrap());
    let specs = specs(&model, 12);
    for isa in Isa::available() {
        for (i, run) in batch(&model, isa, 8, 1, &specs).iter().enumerate() {
            assert!(bits(run) == bits(&alone(&model, isa, &specs[i])), "run {i}, {}", isa.name());
        }
    }
}

#[test]
fn a_run_out_of_its_bounds_is_an_entry() {
    let model = Arc::new(Model::new(blocks(true, 1)).unwrap());
    let mut specs = specs(&model, 9);
    specs[2].dt = 3.0 * element_bound(&model);
    specs[5].variation = Some(Variation { offset: vec![[0.0, -0.5], [0.0; 2]], ..Variation::none(2) });
    specs[6].variation = Some(Variation { young: vec![-1.0, 1.0], ..Variation::none(2) });
    let runs = batch(&model, Isa::detect(), 4, 2, &specs);
    for (i, run) in runs.iter().enumerate() {
        let refused = [2, 5, 6].contains(&i);
        assert_eq!(run.summary.conclusion.name() == "refused", refused, "run {i}: {:?}", run.summary.conclusion);
    }
    assert!(runs[5].summary.conclusion.reason().contains("overlap"));
}

#[test]
fn a_variant_is_the_scene_built_with_its_constants() {
    let mut scene = blocks(true, 1);
    let model = Arc::new(Model::new(scene.clone()).unwrap());
    let (young, density, offset) = (vec![1.3, 0.8], vec![0.9, 1.2], vec![[0.02, 0.01], [0.0; 2]]);
    for (i, body) in scene.bodies.iter_mut().enumerate() {
        body.material.young *= young[i];
        body.material.density *= density[i];
        body.mesh.points.iter_mut().for_each(|x| *x = [x[0] + offset[i][0], x[1] + offset[i][1]]);
    }
    let built = Arc::new(Model::new(scene).unwrap());
    let mut spec = specs(&model, 2).remove(1);
    (spec.velocity, spec.steps) = (None, Some(900));
    let direct = alone(&built, Isa::detect(), &spec);
    spec.variation = Some(Variation { young, density, offset });
    let varied = alone(&model, Isa::detect(), &spec);
    assert!(direct.summary.peaks.force > 0.0);
    assert!((direct.summary.peaks.force / varied.summary.peaks.force - 1.0).abs() < 1e-6);
    assert!((direct.summary.peaks.impulse / varied.summary.peaks.impulse - 1.0).abs() < 1e-8);
    let limits = |model: &Model| (model.element_omega(), model.assembled_omega2().found);
    let variant = model.variant(spec.variation.as_ref().unwrap()).unwrap();
    let ((a, b), (c, d)) = (limits(&built), limits(&variant));
    assert!((a / c - 1.0).abs() < 1e-9 && (b / d - 1.0).abs() < 5e-3, "{a} {c} {b} {d}");
}

#[test]
fn threads_share_the_steps_of_a_model_without_a_trace() {
    let model = Arc::new(Model::new(blocks(true, 2)).unwrap());
    let spec = &specs(&model, 2)[1];
    let expected = bits(&alone(&model, Isa::detect(), spec));
    for threads in [2, 3] {
        let mut group = Group::alone(model.clone(), Isa::detect(), spec).unwrap();
        group.crew = Crew::new(threads).unwrap();
        group.advance(spec.steps.unwrap());
        let summary = Summary::of(&group.runs[0], &group.lanes[0]);
        assert!(bits(&Ended { summary, history: group.runs[0].history.clone() }) == expected, "{threads} threads");
    }
}
