//! Every lane of the kernel gives bit for bit what one lane gives, on every instruction set.

mod common;

use bipenalty::model::Model;
use bipenalty::scene::Scene;
use bipenalty::stiffness::Isa;
use bipenalty::stiffness::kernel::{Pass, advance};
use common::{blocks, body, rectangle, steel};

/// Velocity and displacement of one lane.
type Motion = (Vec<f64>, Vec<f64>);

fn field(n: usize, lane: usize, salt: f64) -> Vec<f64> {
    (0..n).map(|i| (salt * (1.0 + i as f64) + lane as f64).sin()).collect()
}

/// Velocity and displacement after one pass over `range` with L lanes, lane by lane; time steps and scales differ.
fn pass_over<const L: usize>(model: &Model, isa: Isa, range: std::ops::Range<usize>) -> Vec<Motion> {
    let n = 2 * model.points.len();
    let interleave = |salt: f64| -> Vec<[f64; L]> {
        let lanes: Vec<Vec<f64>> = (0..L).map(|lane| field(n, lane, salt)).collect();
        (0..n).map(|i| std::array::from_fn(|lane| lanes[lane][i])).collect()
    };
    let (u, mut v, mut next) = (interleave(0.7), interleave(1.3), vec![[0.0; L]; n]);
    let dt: [f64; L] = std::array::from_fn(|lane| 1e-4 * (1.0 + lane as f64));
    let scaled = |factor: f64| std::array::from_fn(|lane| dt[lane] * (1.0 + factor * lane as f64));
    let (stiffness, inverse_mass, load) = (&model.stiffness, &model.inverse_mass, model.load.as_deref());
    let (elastic_dt, load_dt) = (scaled(0.3), scaled(-0.02));
    let pass = Pass { stiffness, inverse_mass, load, displacement: &u, dt, elastic_dt, load_dt };
    let own = 2 * range.start..2 * range.end;
    advance(isa, &pass, range, &mut v[own.clone()], &mut next[own]);
    (0..L).map(|lane| (v.iter().map(|x| x[lane]).collect(), next.iter().map(|x| x[lane]).collect())).collect()
}

fn pass<const L: usize>(model: &Model, isa: Isa) -> Vec<Motion> {
    pass_over::<L>(model, isa, 0..model.points.len())
}

/// Quads of two bodies with and without loads, triangles, a single element, and a mesh one element wide.
fn models() -> Vec<Model> {
    let mut scenes = vec![blocks(true, 1), blocks(true, 1), blocks(false, 1)];
    scenes[1].bodies[0].body_force = [0.3, -9.81];
    for (cells, quads) in [([1, 1], true), ([1, 1], false), ([1, 9], true), ([2, 2], true), ([14, 3], true)] {
        let mesh = rectangle([0.0; 2], [1.0, 2.0], cells, 0.1, quads);
        scenes.push(Scene { bodies: vec![body("alone", mesh, steel())], ..Scene::default() });
    }
    scenes.into_iter().map(|scene| Model::new(scene).unwrap()).collect()
}

#[test]
fn lanes_do_not_see_each_other() {
    for model in models() {
        for isa in Isa::available() {
            let sixteen = pass::<16>(&model, isa);
            assert_eq!(pass::<8>(&model, isa), sixteen[..8], "{isa:?}");
            assert_eq!(pass::<1>(&model, isa)[0], sixteen[0], "{isa:?}");
        }
    }
}

#[test]
fn ranges_put_together_give_the_whole() {
    fn check<const L: usize>(model: &Model, isa: Isa) {
        let (n, whole) = (model.points.len(), pass::<L>(model, isa));
        for cut in [0, 1, n / 3, n / 2, n - 1, n] {
            let parts = [pass_over::<L>(model, isa, 0..cut), pass_over::<L>(model, isa, cut..n)];
            for (lane, whole) in whole.iter().enumerate() {
                let joined = |get: fn(&Motion) -> &Vec<f64>| {
                    [&get(&parts[0][lane])[..2 * cut], &get(&parts[1][lane])[2 * cut..]].concat()
                };
                assert_eq!((joined(|x| &x.0), joined(|x| &x.1)), *whole, "{isa:?}, {L} lanes, cut at {cut}");
            }
        }
    }
    let model = Model::new(blocks(true, 1)).unwrap();
    for isa in Isa::available() {
        check::<1>(&model, isa);
        check::<8>(&model, isa);
        check::<16>(&model, isa);
    }
}

#[test]
fn instruction_sets_agree_to_round_off() {
    for model in models() {
        let reference = pass::<8>(&model, Isa::Baseline);
        for isa in Isa::available() {
            for (a, b) in pass::<8>(&model, isa).iter().zip(&reference) {
                for (x, y) in a.0.iter().zip(&b.0) {
                    assert!((x - y).abs() < 1e-12 * x.abs().max(1.0), "{isa:?}: {x}, {y}");
                }
            }
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
