//! Candidates inside a skin give the same rows as a search at every step.

mod common;

use std::sync::Arc;

use bipenalty::contact::search::Search;
use bipenalty::lane::Lane;
use bipenalty::model::Model;
use bipenalty::scene::{Obstacle, Scene};
use common::{bipenalty, blocks, body, contact, rectangle, start, steel, wall};

type Seen = Vec<(Vec<(u32, [f64; 2])>, f64)>;

fn rows_agree_with_fresh_searches(scene: Scene, velocity: [f64; 2], steps: usize) -> (usize, usize) {
    let model = Arc::new(Model::new(scene).unwrap());
    let mut run = start(&model, bipenalty(3.0), 0, velocity, 0.5);
    let mut most = 0;
    for n in 0..steps {
        run.advance(1);
        let u = Lane::new(&run.state.other, 1, 0);
        let mut fresh = Search::new(&model.pairs);
        fresh.keep(&model.pairs, &model.points, u, |_| 0.0).unwrap();
        let mut rows = Vec::new();
        for (pair, candidates) in model.pairs.iter().zip(&fresh.candidates) {
            pair.rows(candidates, &model.points, u, &mut rows);
        }
        let describe = |rows: &[bipenalty::row::Row]| -> Seen {
            rows.iter().map(|row| (row.entries().collect(), row.gap)).collect()
        };
        assert_eq!(describe(&rows), describe(common::rows(&run)), "step {n}");
        most = most.max(rows.len());
    }
    (most, run.lanes[0].search.count)
}

#[test]
fn body_on_body() {
    for passes in [1, 2] {
        let (rows, searches) = rows_agree_with_fresh_searches(blocks(true, passes), [0.5, -2.0], 1500);
        assert!(rows >= 8, "{rows}");
        assert!(searches > 3 && searches < 150, "{searches}");
    }
}

#[test]
fn body_on_rigid_obstacles() {
    let block = || vec![body("block", rectangle([0.001, 0.0], [1.0, 1.0], [6, 6], 0.2, true), steel())];
    let ridge = Obstacle::Polyline { points: vec![[-1.0, -2.0], [0.0, 0.4], [-1.0, 3.0]], closed: true };
    for obstacle in [wall(), ("wall".to_string(), ridge)] {
        let contacts = vec![contact("block", "wall", 1)];
        let scene = Scene { bodies: block(), contacts, obstacles: vec![obstacle], ..Scene::default() };
        let (rows, searches) = rows_agree_with_fresh_searches(scene, [-2.0, 0.3], 1500);
        assert!(rows >= 2 && searches > 1 && searches < 150, "{rows} {searches}");
    }
}

#[test]
fn bodies_far_apart_have_no_candidates() {
    let mut scene = blocks(true, 2);
    scene.bodies[0].mesh = rectangle([0.1, 9.0], [0.8, 0.5], [9, 5], 0.0, true);
    let model = Arc::new(Model::new(scene).unwrap());
    let mut run = start(&model, bipenalty(1.0), 0, [0.0, 0.0], 0.5);
    run.advance(100);
    assert_eq!(run.lanes[0].search.count, 1);
    assert!(run.lanes[0].search.candidates.iter().all(|c| c.iter().count() == 0));
}
