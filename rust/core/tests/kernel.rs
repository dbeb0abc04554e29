//! Every lane of the kernel gives bit for bit what one lane gives, on every instruction set.

mod common;

use bipenalty::model::Model;
use bipenalty::stiffness::Isa;
use bipenalty::stiffness::kernel::{Pass, advance};
use common::blocks;

fn field(n: usize, lane: usize, salt: f64) -> Vec<f64> {
    (0..n).map(|i| (salt * (1.0 + i as f64) + lane as f64).sin()).collect()
}

/// Velocity and displacement after one pass with L lanes, lane by lane.
fn pass<const L: usize>(model: &Model, isa: Isa) -> Vec<(Vec<f64>, Vec<f64>)> {
    let n = 2 * model.points.len();
    let interleave = |salt: f64| -> Vec<[f64; L]> {
        let lanes: Vec<Vec<f64>> = (0..L).map(|lane| field(n, lane, salt)).collect();
        (0..n).map(|i| std::array::from_fn(|lane| lanes[lane][i])).collect()
    };
    let (u, mut v, mut next) = (interleave(0.7), interleave(1.3), vec![[0.0; L]; n]);
    let dt: [f64; L] = std::array::from_fn(|lane| 1e-4 * (1.0 + lane as f64));
    let (stiffness, inverse_mass, load) = (&model.stiffness, &model.inverse_mass, model.load.as_deref());
    let pass = Pass { stiffness, inverse_mass, load, displacement: &u, dt, elastic_dt: dt, load_dt: dt };
    advance(isa, &pass, 0..model.points.len(), &mut v, &mut next);
    (0..L).map(|lane| (v.iter().map(|x| x[lane]).collect(), next.iter().map(|x| x[lane]).collect())).collect()
}

#[test]
fn lanes_do_not_see_each_other() {
    for body_force in [[0.0; 2], [0.3, -9.81]] {
        let mut scene = blocks(true, 1);
        scene.bodies[0].body_force = body_force;
        let model = Model::new(scene).unwrap();
        for isa in [Isa::Baseline, Isa::Avx2, Isa::Avx512] {
            let sixteen = pass::<16>(&model, isa);
            assert_eq!(pass::<1>(&model, isa)[0], sixteen[0], "{isa:?}");
            assert_eq!(pass::<8>(&model, isa), sixteen[..8], "{isa:?}");
        }
    }
}

#[test]
fn instruction_sets_agree_to_round_off() {
    let model = Model::new(blocks(false, 1)).unwrap();
    let (reference, scale) = (pass::<8>(&model, Isa::Baseline), 1.0);
    for isa in [Isa::Avx2, Isa::Avx512] {
        for (a, b) in pass::<8>(&model, isa).iter().zip(&reference) {
            let difference = a.0.iter().zip(&b.0).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
            assert!(difference < 1e-9 * scale, "{isa:?}: {difference}");
        }
    }
}

#[test]
fn one_pass_matches_the_dense_product() {
    let model = Model::new(blocks(true, 1)).unwrap();
    let n = 2 * model.points.len();
    let u = nalgebra::DVector::from_vec(field(n, 0, 0.7));
    let force = -(model.stiffness.to_dense() * &u);
    let (velocity, next) = &pass::<1>(&model, Isa::detect())[0];
    for (i, v) in field(n, 0, 1.3).into_iter().enumerate() {
        let expected = v + 1e-4 * force[i] / model.mass[i / 2];
        assert!((velocity[i] - expected).abs() < 1e-9 * expected.abs().max(1.0));
        assert!((next[i] - (u[i] + 1e-4 * expected)).abs() < 1e-12 * next[i].abs().max(1.0));
    }
}

#[test]
fn instruction_sets_are_asked_for_by_name() {
    assert_eq!(Isa::named("auto").unwrap(), Isa::detect());
    assert!(Isa::available().all(|isa| Isa::named(isa.name()).unwrap() == isa));
    assert!(Isa::available().any(|isa| isa == Isa::Baseline));
    let message = Isa::named("avx3").unwrap_err().to_string();
    for part in ["kernel", "\"avx3\"", "\"baseline\"", "\"auto\""] {
        assert!(message.contains(part), "{message}");
    }
}
