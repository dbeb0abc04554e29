//! Travel: how far the surfaces have moved since each lane's last search, all lanes in one pass.

use super::pair::{Pair, Primary};
use super::surface::{Surface, Vertices};
use crate::nodal_sums::by_node;
use crate::stiffness::simd::{Isa, Loop, Madd, dispatch};

/// Surface nodes of the bodies that pairs are about, and where they were when each lane last searched.
#[derive(Debug, Clone, Default)]
pub struct Travel {
    lanes: usize,
    watched: Vec<Watched>,
}

/// Surface of one body.
#[derive(Debug, Clone)]
struct Watched {
    body: u32,
    nodes: Vec<u32>,
    /// Displacement (m) at the last search, [node][axis][lane].
    then: Vec<f64>,
    /// Largest distance (m) of a node from there, by lane; NaN where a displacement is.
    far: Vec<f64>,
}

impl Travel {
    /// Watches the surfaces of the pairs.
    pub fn new(pairs: &[Pair], lanes: usize) -> Self {
        let mut travel = Self { lanes, watched: Vec::new() };
        for pair in pairs {
            travel.watch(pair.secondary_body, pair.secondary.iter().map(|s| s.node));
            if let (Primary::Surface(Surface { vertices: Vertices::Nodes(nodes), .. }), Some(body)) =
                (&pair.primary, pair.primary_body)
            {
                travel.watch(body, nodes.iter().copied());
            }
        }
        travel
    }

    fn watch(&mut self, body: u32, nodes: impl Iterator<Item = u32>) {
        if self.watched.iter().all(|w| w.body != body) {
            let nodes: Vec<u32> = nodes.collect();
            let (then, far) = (vec![0.0; 2 * nodes.len() * self.lanes], vec![0.0; self.lanes]);
            self.watched.push(Watched { body, nodes, then, far });
        }
    }

    /// Brings the distances up to date with the displacement, [node][axis][lane].
    pub fn measure(&mut self, isa: Isa, displacement: &[f64]) {
        for watched in &mut self.watched {
            match self.lanes {
                1 => dispatch(isa, Pass::<1> { watched, displacement }),
                2 => dispatch(isa, Pass::<2> { watched, displacement }),
                4 => dispatch(isa, Pass::<4> { watched, displacement }),
                8 => dispatch(isa, Pass::<8> { watched, displacement }),
                _ => dispatch(isa, Pass::<16> { watched, displacement }),
            }
        }
    }

    /// How far (m) the two surfaces of a pair have moved in a lane, together; a rigid obstacle has not.
    pub fn of(&self, pair: &Pair, lane: usize) -> f64 {
        let far = |body| self.watched.iter().find(|w| Some(w.body) == body).map_or(0.0, |w| w.far[lane]);
        far(Some(pair.secondary_body)) + far(pair.primary_body)
    }

    /// Counts a lane's travel from this displacement on.
    pub fn restart(&mut self, lane: usize, displacement: &[f64]) {
        for watched in &mut self.watched {
            for (then, &node) in watched.then.chunks_exact_mut(2 * self.lanes).zip(&watched.nodes) {
                let now = 2 * node as usize * self.lanes + lane;
                (then[lane], then[lane + self.lanes]) = (displacement[now], displacement[now + self.lanes]);
            }
            watched.far[lane] = 0.0;
        }
    }

    /// Copies one lane over another.
    pub fn copy_lane(&mut self, from: usize, to: usize) {
        for watched in &mut self.watched {
            watched.then.chunks_exact_mut(self.lanes).for_each(|lanes| lanes[to] = lanes[from]);
            watched.far[to] = watched.far[from];
        }
    }

    /// The same lanes in another width.
    pub fn resized(&self, lanes: usize) -> Self {
        let resized = |w: &Watched| {
            let (then, far) = (crate::state::resized(&w.then, self.lanes, lanes), w.far.iter().copied());
            let far = far.chain(std::iter::repeat(0.0)).take(lanes).collect();
            Watched { body: w.body, nodes: w.nodes.clone(), then, far }
        };
        Self { lanes, watched: self.watched.iter().map(resized).collect() }
    }
}

struct Pass<'a, const L: usize> {
    watched: &'a mut Watched,
    displacement: &'a [f64],
}

impl<const L: usize> Loop for Pass<'_, L> {
    type Output = ();

    #[inline(always)]
    fn run<M: Madd>(self) {
        let (u, then) = (by_node::<L>(self.displacement), by_node::<L>(&self.watched.then));
        let (mut largest, mut sum) = ([0.0; L], [0.0; L]);
        for (&node, then) in self.watched.nodes.iter().zip(then) {
            let now = &u[node as usize];
            for lane in 0..L {
                let d = [now[0][lane] - then[0][lane], now[1][lane] - then[1][lane]];
                let distance2 = d[0] * d[0] + d[1] * d[1];
                largest[lane] = if distance2 > largest[lane] { distance2 } else { largest[lane] };
                sum[lane] += distance2;
            }
        }
        for lane in 0..L {
            // A comparison passes over what is not a number; a sum does not.
            self.watched.far[lane] = if sum[lane].is_nan() { f64::NAN } else { largest[lane].sqrt() };
        }
    }
}
