//! Where runs start from: initial velocity and displacement, checked once for all runs that share them.

use std::sync::OnceLock;

use crate::body::Body;
use crate::contact::overlap::check_overlap;
use crate::error::{Error, Result};
use crate::lane::Lane;
use crate::model::Model;

/// Initial state of all nodes, two values a node, in the model's node numbers.
#[derive(Debug)]
pub struct Start {
    /// Velocity v_0 (m/s).
    pub velocity: Vec<f64>,
    /// Displacement u_0 (m).
    pub displacement: Vec<f64>,
    /// K u_0 (N) before each body's own factor; none where u_0 = 0.
    elastic: Option<Vec<[f64; 2]>>,
    overlap: OnceLock<Result<()>>,
}

impl Start {
    /// A start of a model and of its variants; the arrays have the scene's node numbers.
    ///
    /// # Errors
    /// Arrays of the wrong length, values that are not finite.
    pub fn new(model: &Model, velocity: Vec<f64>, displacement: Vec<f64>) -> Result<Self> {
        for (name, values) in [("velocity", &velocity), ("displacement", &displacement)] {
            if values.len() != 2 * model.points.len() {
                let (what, bound) = (format!("length of {name}"), format!("{} (two a node)", 2 * model.points.len()));
                return Err(Error::bound("initial state", &what, values.len(), &bound, "resize it"));
            }
            if let Some(i) = values.iter().position(|x| !x.is_finite()) {
                let what = format!("{name} of node {}", i / 2);
                return Err(Error::bound("initial state", &what, values[i], "finite", "mend the array"));
            }
        }
        let (velocity, displacement) = (model.order.flat_inward(velocity), model.order.flat_inward(displacement));
        let product = |node: usize| {
            model.stiffness.row(node).fold([0.0; 2], |sum, (column, k)| {
                let force = k.times([displacement[2 * column], displacement[2 * column + 1]]);
                [sum[0] + force[0], sum[1] + force[1]]
            })
        };
        let moved = displacement.iter().any(|u| *u != 0.0);
        let elastic = moved.then(|| (0..model.points.len()).map(product).collect());
        Ok(Self { velocity, displacement, elastic, overlap: OnceLock::new() })
    }

    /// Nodal force f - K u_0 (N).
    #[inline]
    pub fn force(&self, model: &Model, body: &Body, node: usize) -> [f64; 2] {
        let f = model.load.as_ref().map_or([0.0; 2], |load| load[node]);
        let ku = self.elastic.as_ref().map_or([0.0; 2], |elastic| elastic[node]);
        [f[0] - body.young_factor * ku[0], f[1] - body.young_factor * ku[1]]
    }

    /// Checks that no bodies of the model overlap; `moved` is a variant with bodies elsewhere, checked on its own.
    ///
    /// # Errors
    /// An overlap above the contact's tolerance.
    pub fn check_overlap(&self, model: &Model, moved: bool) -> Result<()> {
        let check = || check_overlap(model, Lane::new(&self.displacement, 1, 0));
        if moved { check() } else { self.overlap.get_or_init(check).clone() }
    }
}
