//! Broad phase: candidate node-segment pairs inside a skin, searched again only when the skin is used up.

use parry2d_f64::bounding_volume::Aabb;
use parry2d_f64::math::Vector;
use parry2d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};

use super::candidates::{Candidates, Near};
use super::gap::{dot, from_to};
use super::pair::{Pair, Primary};
use super::posed::Posed;
use super::surface::{Surface, Vertices, position};
use crate::error::{Error, Result, short};
use crate::lane::Lane;
use crate::outcome::Kind;

/// Skin over mean segment length: half a segment of travel between searches.
const SKIN: f64 = 0.5;

/// Search state of one lane: candidates of every pair, and where the surfaces were when they were found.
#[derive(Default)]
pub struct Search {
    /// Candidates of each pair.
    pub candidates: Vec<Candidates>,
    /// How often the broad phase has run.
    pub count: usize,
    watched: Vec<Watched>,
    trees: Vec<Bvh>,
    workspace: BvhWorkspace,
    near: Vec<u32>,
}

/// Surface nodes of one body and their displacements at the last search.
struct Watched {
    body: u32,
    nodes: Vec<u32>,
    then: Vec<[f64; 2]>,
}

impl Search {
    /// Watches the surfaces of the pairs; the first call of `keep` searches.
    pub fn new(pairs: &[Pair]) -> Self {
        let mut search = Self::default();
        search.candidates.extend(pairs.iter().map(|pair| Candidates::with_room(pair.secondary.len())));
        search.trees.resize_with(pairs.len(), Bvh::new);
        for pair in pairs {
            search.watch(pair.secondary_body, pair.secondary.iter().map(|s| s.node));
            if let Primary::Surface(surface) = &pair.primary {
                search.near.reserve(surface.segments.len());
            }
            if let (Primary::Surface(Surface { vertices: Vertices::Nodes(nodes), .. }), Some(body)) =
                (&pair.primary, pair.primary_body)
            {
                search.watch(body, nodes.iter().copied());
            }
        }
        search
    }

    fn watch(&mut self, body: u32, nodes: impl Iterator<Item = u32>) {
        if self.watched.iter().all(|w| w.body != body) {
            let nodes: Vec<u32> = nodes.collect();
            let then = vec![[f64::NAN; 2]; nodes.len()];
            self.watched.push(Watched { body, nodes, then });
        }
    }

    /// Searches again if the surfaces of any pair have used up its skin since the last search.
    ///
    /// # Errors
    /// A surface position that is not finite.
    pub fn keep(&mut self, pairs: &[Pair], points: &[[f64; 2]], displacement: Lane) -> Result<()> {
        if pairs.is_empty() || (self.count > 0 && !self.used_up(pairs, displacement)?) {
            return Ok(());
        }
        for watched in &mut self.watched {
            for (then, &node) in watched.then.iter_mut().zip(&watched.nodes) {
                *then = displacement.at(node);
                if !(then[0].is_finite() && then[1].is_finite()) {
                    return Err(Error::Run(Kind::NotFinite, format!("displacement of node {node} is not finite")));
                }
            }
        }
        for (i, pair) in pairs.iter().enumerate() {
            self.search(i, pair, points, displacement);
        }
        self.count += 1;
        Ok(())
    }

    /// True when the two surfaces of a pair may have come closer by more than its skin.
    ///
    /// # Errors
    /// A step in which they moved so far that a node may have crossed the primary body unseen.
    fn used_up(&self, pairs: &[Pair], displacement: Lane) -> Result<bool> {
        let moved = |body: Option<u32>| {
            let Some(watched) = self.watched.iter().find(|w| Some(w.body) == body) else { return 0.0 };
            let distance2 = |(then, &node): (&[f64; 2], &u32)| {
                let d = from_to(*then, displacement.at(node));
                dot(d, d)
            };
            // A comparison that lets NaN through to the result, unlike f64::max.
            let larger = |a: f64, b: f64| if b <= a { a } else { b };
            watched.then.iter().zip(&watched.nodes).map(distance2).fold(0.0, larger).sqrt()
        };
        let mut used_up = false;
        for pair in pairs {
            let (travel, skin) = (moved(Some(pair.secondary_body)) + moved(pair.primary_body), skin(pair));
            // The skin was not used up a step ago, so all that is beyond it was covered in this one.
            let (step, most) = (travel - skin, pair.reach());
            if step > most {
                let (step, most) = (short(step), short(most));
                let seen =
                    format!("surfaces moved {step} m in one step, contact follows {most} m: reduce dt or speed;");
                return Err(Error::Run(Kind::ContactMissed, seen));
            }
            used_up |= travel.is_nan() || travel > skin;
        }
        Ok(used_up)
    }

    fn search(&mut self, index: usize, pair: &Pair, points: &[[f64; 2]], displacement: Lane) {
        let candidates = &mut self.candidates[index];
        candidates.clear();
        match &pair.primary {
            Primary::HalfPlane { point, normal } => {
                let reach = skin(pair);
                for (index, s) in pair.secondary.iter().enumerate() {
                    if dot(from_to(*point, position(s.node, points, displacement)), *normal) <= reach {
                        candidates.push(index as u32);
                    }
                }
            }
            Primary::Surface(surface) => {
                let (tree, posed) = (&mut self.trees[index], Posed { surface, points, displacement });
                let boxes = (0..surface.segments.len()).map(|i| {
                    let [a, b] = posed.ends(i as u32).map(|x| Vector::new(x[0], x[1]));
                    (i, Aabb::new(a.min(b), a.max(b)))
                });
                if tree.is_empty() {
                    *tree = Bvh::from_iter(BvhBuildStrategy::Binned, boxes);
                } else {
                    boxes.for_each(|(i, aabb)| _ = tree.insert_or_update_partially(aabb, i as u32, 0.0));
                    tree.refit(&mut self.workspace);
                }
                let near = Near { posed, tree, skin: skin(pair) };
                for (index, secondary) in pair.secondary.iter().enumerate() {
                    near.collect(index as u32, secondary, &mut self.near, candidates);
                }
            }
        }
    }
}

/// Skin of a pair (m).
fn skin(pair: &Pair) -> f64 {
    match &pair.primary {
        Primary::Surface(surface) => SKIN * surface.mean_length,
        Primary::HalfPlane { .. } => SKIN * pair.secondary_length,
    }
}
