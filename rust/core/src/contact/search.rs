//! Broad phase: candidate node-segment pairs inside a skin, searched again only when the skin is used up.

use parry2d_f64::bounding_volume::Aabb;
use parry2d_f64::math::Vector;
use parry2d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};

use super::candidates::{Candidates, Near};
use super::crossing::missed;
use super::gap::{dot, from_to};
use super::pair::{Pair, Primary};
use super::posed::Posed;
use super::surface::{Surface, Vertices, position};
use crate::error::{Error, Result};
use crate::lane::Lane;
use crate::outcome::Kind;

/// Skin over mean segment length: half a segment of travel between searches.
const SKIN: f64 = 0.5;

/// Round-off of a gap over the skin.
const ROUND_OFF: f64 = 1e-6;

/// Search state of one lane: candidates of every pair.
#[derive(Default)]
pub struct Search {
    /// Candidates of each pair.
    pub candidates: Vec<Candidates>,
    /// How often the broad phase has run.
    pub count: usize,
    trees: Vec<Bvh>,
    workspace: BvhWorkspace,
    near: Vec<u32>,
}

impl Search {
    /// No candidates yet: the first call of `keep` searches.
    pub fn new(pairs: &[Pair]) -> Self {
        let mut search = Self::default();
        search.candidates.extend(pairs.iter().map(|pair| Candidates::with_room(pair.secondary.len())));
        search.trees.resize_with(pairs.len(), Bvh::new);
        let segments = |pair: &Pair| match &pair.primary {
            Primary::Surface(surface) => surface.segments.len(),
            Primary::HalfPlane { .. } => 0,
        };
        search.near.reserve(pairs.iter().map(segments).max().unwrap_or(0));
        search
    }

    /// Searches again if the surfaces of any pair have used up its skin since the last search, and says whether it did;
    /// `travel` is the distance (m) that a pair's surfaces have moved since, together.
    ///
    /// # Errors
    /// A surface position that is not finite; a step in which surfaces moved so far that a node may have crossed the
    /// primary body unseen.
    pub fn keep(
        &mut self,
        pairs: &[Pair],
        points: &[[f64; 2]],
        displacement: Lane,
        travel: impl Fn(&Pair) -> f64,
    ) -> Result<bool> {
        if pairs.is_empty() || (self.count > 0 && !used_up(pairs, &travel)?) {
            return Ok(false);
        }
        for pair in pairs {
            check_finite(pair, displacement)?;
        }
        for (i, pair) in pairs.iter().enumerate() {
            let since = if self.count == 0 { f64::INFINITY } else { travel(pair) };
            self.search(i, pair, points, displacement, since);
        }
        self.count += 1;
        Ok(true)
    }

    fn search(&mut self, index: usize, pair: &Pair, points: &[[f64; 2]], displacement: Lane, travel: f64) {
        let candidates = &mut self.candidates[index];
        candidates.clear();
        match &pair.primary {
            Primary::HalfPlane { point, normal } => {
                let reach = skin(pair);
                for (index, s) in pair.secondary.iter().enumerate() {
                    let gap = dot(from_to(*point, position(s.node, points, displacement)), *normal);
                    if gap <= reach {
                        candidates.push(index as u32, gap - ROUND_OFF * reach);
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
                let closed = surface.is_closed();
                let travel = if closed { travel } else { f64::INFINITY };
                let near = Near { posed, tree, skin: skin(pair), travel, closed };
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

/// True when the two surfaces of a pair may have come closer by more than its skin.
fn used_up(pairs: &[Pair], travel: &impl Fn(&Pair) -> f64) -> Result<bool> {
    let mut used_up = false;
    for pair in pairs {
        let (travel, skin) = (travel(pair), skin(pair));
        // The skin was not used up a step ago, so all that is beyond it was covered in this one.
        let (step, most) = (travel - skin, pair.reach());
        if step > most {
            return Err(Error::Run(Kind::ContactMissed, missed(step, most)));
        }
        used_up |= travel.is_nan() || travel > skin;
    }
    Ok(used_up)
}

/// Boxes that are not finite would spoil the tree.
fn check_finite(pair: &Pair, displacement: Lane) -> Result<()> {
    let primary = match &pair.primary {
        Primary::Surface(Surface { vertices: Vertices::Nodes(nodes), .. }) => nodes.as_slice(),
        _ => &[],
    };
    let mut nodes = pair.secondary.iter().map(|s| s.node).chain(primary.iter().copied());
    match nodes.find(|node| !displacement.at(*node).iter().all(|u| u.is_finite())) {
        Some(node) => {
            let number = pair.order.outer(node as usize);
            Err(Error::Run(Kind::NotFinite, format!("displacement of node {number} is not finite")))
        }
        None => Ok(()),
    }
}
