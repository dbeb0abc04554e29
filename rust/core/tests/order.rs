//! Nodes renumbered inside the model: outside, everything speaks the scene's numbers.

mod common;

use std::sync::Arc;

use bipenalty::constraint::linear::Linear;
use bipenalty::constraint::support::Support;
use bipenalty::contact::search::Search;
use bipenalty::critical_step::element_bound;
use bipenalty::ended::Ended;
use bipenalty::group::Group;
use bipenalty::history::Record;
use bipenalty::lane::Lane;
use bipenalty::mesh::Mesh;
use bipenalty::model::Model;
use bipenalty::penalty::{Damping, Mass, Method};
use bipenalty::run::RunSpec;
use bipenalty::scene::{Obstacle, Scene};
use bipenalty::start::Start;
use bipenalty::stiffness::Isa;
use common::{bipenalty, body, contact, method, rectangle, steel};

/// Too many nodes to be at hand all at once.
const CELLS: [usize; 2] = [60, 40];

/// Numbers 0..count in an irregular order (Fisher and Yates; Steele, Lea and Flood 2014 for the random numbers).
fn shuffled(count: usize) -> Vec<usize> {
    let (mut order, mut state): (Vec<usize>, u64) = ((0..count).collect(), 1);
    for i in (1..count).rev() {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        order.swap(i, ((z ^ (z >> 31)) % (i as u64 + 1)) as usize);
    }
    order
}

/// The same mesh with node i numbered `number[i]`, its elements in the same order.
fn numbered(mesh: &Mesh, number: &[usize]) -> Mesh {
    let mut out = mesh.clone();
    for (point, &new) in mesh.points.iter().zip(number) {
        out.points[new] = *point;
    }
    out.triangles.as_flattened_mut().iter_mut().for_each(|node| *node = number[*node]);
    out.quads.as_flattened_mut().iter_mut().for_each(|node| *node = number[*node]);
    out
}

fn large(quads: bool) -> Mesh {
    rectangle([0.0, 0.0], [1.5, 1.0], CELLS, 0.1, quads)
}

/// A small block, a large one with the numbers given, held at its foot, and the small one again on its other side.
fn scene(number: &[usize], quads: bool) -> Scene {
    let (mesh, foot) = (large(quads), (0..=CELLS[0]).map(|i| number[i]).collect());
    let block = |x: f64| rectangle([x, 0.2], [0.3, 0.5], [4, 5], 0.1, quads);
    let mut bodies = vec![
        body("left", block(-0.301), steel()),
        body("large", numbered(&mesh, number), steel()),
        body("right", block(1.502), steel()),
    ];
    bodies[1].body_force = [0.0, -0.5];
    let (first, top) = (bodies[0].mesh.points.len(), CELLS[1] * (CELLS[0] + 1));
    let node = |i: usize| (first + number[i]) as u32;
    let hinge =
        Linear { entries: vec![(node(top), [0.0, 1.0]), (node(top + 3), [0.0, -1.0])], offset: 0.0, young: 1.0 };
    Scene {
        bodies,
        contacts: vec![contact("left", "large", 2), contact("large", "right", 1)],
        supports: vec![Support { body: "large".into(), nodes: foot, fixed: [false, true] }],
        linear: vec![hinge],
        ..Scene::default()
    }
}

/// Number of all nodes of the scene in a renumbered one.
fn of_scene(model: &Model, number: &[usize]) -> Vec<usize> {
    let large = model.bodies[1].nodes.clone();
    let all = 0..model.points.len();
    all.map(|i| if large.contains(&i) { large.start + number[i - large.start] } else { i }).collect()
}

/// Values two a node in the numbers given.
fn renumbered(values: &[f64], number: &[usize]) -> Vec<f64> {
    let mut out = vec![0.0; values.len()];
    for (pair, &new) in values.as_chunks::<2>().0.iter().zip(number) {
        out[2 * new..2 * new + 2].copy_from_slice(pair);
    }
    out
}

fn ended(model: &Arc<Model>, dt: f64, start: Start) -> Ended {
    let mut spec = RunSpec::new(bipenalty(1.0), dt, Arc::new(start));
    spec.record = Record { every: 1, energy_every: 7, snapshots: vec![0, 60, 199] };
    spec.steps = Some(200);
    let mut group = Group::alone(model.clone(), Isa::detect(), &spec).unwrap();
    assert_eq!(group.advance(200), 200);
    let (run, lane) = group.take(0);
    Ended::new(run, &lane)
}

fn assert_close(a: impl IntoIterator<Item = f64>, b: impl IntoIterator<Item = f64>, what: &str) {
    let (a, b): (Vec<f64>, Vec<f64>) = (a.into_iter().collect(), b.into_iter().collect());
    let size = a.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    assert!(size > 0.0 && a.len() == b.len(), "{what}: nothing to compare");
    let error = a.iter().zip(&b).fold(0.0_f64, |most, (x, y)| most.max((x - y).abs()));
    assert!(error < 1e-9 * size, "{what}: {error:e} of {size:e}");
}

#[test]
fn numbers_of_the_scene_change_nothing() {
    for quads in [true, false] {
        let number = shuffled(large(quads).points.len());
        let plain = Arc::new(Model::new(scene(&(0..number.len()).collect::<Vec<_>>(), quads)).unwrap());
        let mixed = Arc::new(Model::new(scene(&number, quads)).unwrap());
        assert!(plain.order.is_kept() && !mixed.order.is_kept());
        let (all, n) = (of_scene(&plain, &number), 2 * plain.points.len());
        assert_eq!(renumbered(plain.points.as_flattened(), &all), mixed.order.outward(&mixed.points).as_flattened());

        let velocity: Vec<f64> = (0..n).map(|i| if i < 60 { 2.0 } else { 0.1 * (0.01 * i as f64).sin() }).collect();
        let displacement: Vec<f64> = (0..n).map(|i| 1e-4 * (0.02 * i as f64).cos()).collect();
        let of = |model: &Model, number: &[usize]| {
            Start::new(model, renumbered(&velocity, number), renumbered(&displacement, number)).unwrap()
        };
        let dt = 0.5 * element_bound(&plain);
        let same: Vec<usize> = (0..all.len()).collect();
        let (a, b) = (ended(&plain, dt, of(&plain, &same)), ended(&mixed, dt, of(&mixed, &all)));
        let (a, b) = (a.history, b.history);

        assert!(a.peaks.force > 0.0 && a.active == b.active);
        assert_close(a.force, b.force, "force");
        assert_close(a.force_on.into_iter().flatten(), b.force_on.into_iter().flatten(), "force on bodies");
        assert_close(a.penetration, b.penetration, "penetration");
        assert_close(a.momentum.into_iter().flatten(), b.momentum.into_iter().flatten(), "momentum");
        assert_close(a.energies.iter().map(|e| e.strain), b.energies.iter().map(|e| e.strain), "strain energy");
        assert_close(a.energies.iter().map(|e| e.kinetic), b.energies.iter().map(|e| e.kinetic), "kinetic energy");
        assert_eq!(a.snapshots.len(), 3);
        for (a, b) in a.snapshots.iter().zip(b.snapshots) {
            assert_close(renumbered(&a.displacement, &all), b.displacement, "displacement");
            assert_close(renumbered(&a.velocity, &all), b.velocity, "velocity");
        }
    }
}

/// The large block alone, its node 0 at the corner next to a wall that it reaches into by `depth` (m).
fn at_a_wall(number: &[usize], depth: f64) -> Model {
    let wall = Obstacle::HalfPlane { point: [0.5_f64.sqrt() * depth; 2], normal: [1.0, 1.0] };
    let bodies = vec![body("block", numbered(&large(true), number), steel())];
    let (contacts, obstacles) = (vec![contact("block", "wall", 1)], vec![("wall".to_string(), wall)]);
    Model::new(Scene { bodies, contacts, obstacles, ..Scene::default() }).unwrap()
}

#[test]
fn messages_name_the_nodes_of_the_scene() {
    let number = shuffled(large(true).points.len());
    let (corner, n) = (number[0], 2 * number.len());
    let named = |message: &str, node: usize| message.contains(&format!("node {node} "));
    let model = Arc::new(at_a_wall(&number, -1e-4));
    assert_ne!(model.order.inner(corner), corner);

    let mut values = vec![0.0; n];
    values[2 * corner] = f64::NAN;
    let error = Start::new(&model, values.clone(), vec![0.0; n]).unwrap_err().to_string();
    assert!(named(&error, corner), "{error}");

    let inside = model.order.inward(values.as_chunks::<2>().0).into_owned().into_flattened();
    let mut search = Search::new(&model.pairs);
    let error = search.keep(&model.pairs, &model.points, Lane::new(&inside, 1, 0), |_| 0.0).unwrap_err().to_string();
    assert!(named(&error, corner), "{error}");

    let spec = |model: &Model, method: Method| {
        let toward: Vec<f64> = vec![-1.0; n];
        RunSpec::new(method, 0.5 * element_bound(model), Arc::new(Start::new(model, toward, vec![0.0; n]).unwrap()))
    };
    let overlapping = Arc::new(at_a_wall(&number, 1e-3));
    let begun = Group::alone(overlapping.clone(), Isa::detect(), &spec(&overlapping, bipenalty(1.0)));
    let error = begun.err().expect("an overlap").to_string();
    assert!(named(&error, corner), "{error}");

    let stiff = spec(&model, method(1e5, Mass::None, Damping::None));
    let mut group = Group::alone(model.clone(), Isa::detect(), &stiff).unwrap();
    while group.runs[0].watch.row_omega2 == 0.0 {
        assert_eq!(group.advance(1), 1);
    }
    let conclusion = group.runs[0].conclusion(&group.lanes[0]);
    assert!(named(conclusion.reason(), corner), "{}", conclusion.reason());

    let mut beyond = scene(&number, true);
    beyond.supports[0].nodes.push(number.len());
    let error = Model::new(beyond).unwrap_err().to_string();
    assert!(named(&error.replace("node = ", "node ").replace(',', " "), number.len()), "{error}");
}

/// Share of the nodes whose row and the next have nine columns each, six of them in common.
fn pairs(model: &Model) -> f64 {
    let columns = |node: usize| model.stiffness.row(node).map(|(column, _)| column).collect::<Vec<_>>();
    let pair = |node: &usize| {
        let (a, b) = (columns(*node), columns(*node + 1));
        a.len() == 9 && b.len() == 9 && a.iter().filter(|column| b.contains(column)).count() == 6
    };
    (0..model.points.len() - 1).filter(pair).count() as f64 / model.points.len() as f64
}

#[test]
fn a_good_order_is_kept_and_a_bad_one_becomes_as_good() {
    let of = |mesh| Model::new(Scene { bodies: vec![body("alone", mesh, steel())], ..Scene::default() }).unwrap();
    for quads in [true, false] {
        // Along the short and along the long side.
        for cells in [CELLS, [40, 60], [1500, 4], [4, 1500]] {
            assert!(of(rectangle([0.0; 2], [1.0; 2], cells, 0.0, quads)).order.is_kept(), "{cells:?}");
        }
        let few = rectangle([0.0; 2], [1.0; 2], [10, 10], 0.0, quads);
        assert!(of(numbered(&few, &shuffled(few.points.len()))).order.is_kept());
    }
    let (mesh, number) = (large(true), shuffled(large(true).points.len()));
    let (plain, mixed) = (of(mesh.clone()), of(numbered(&mesh, &number)));
    assert!(pairs(&mixed) > 0.9 * pairs(&plain), "{} of {}", pairs(&mixed), pairs(&plain));
}
