//! A variant of a model: bodies stiffer, denser or elsewhere, on the same mesh and the same K.

use crate::contact::Primary;
use crate::error::{Error, Result};
use crate::model::Model;

/// What may vary from run to run without touching the mesh: one entry a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Variation {
    /// Factor of each body's modulus.
    pub young: Vec<f64>,
    /// Factor of each body's density.
    pub density: Vec<f64>,
    /// Shift (m) of each body in the reference configuration.
    pub offset: Vec<[f64; 2]>,
}

impl Variation {
    /// Nothing varied.
    pub fn none(bodies: usize) -> Self {
        Self { young: vec![1.0; bodies], density: vec![1.0; bodies], offset: vec![[0.0; 2]; bodies] }
    }

    fn check(&self, model: &Model) -> Result<()> {
        let bodies = model.bodies.len();
        for (name, count) in
            [("young", self.young.len()), ("density", self.density.len()), ("offset", self.offset.len())]
        {
            if count != bodies {
                let bound = format!("{bodies} (one a body)");
                return Err(Error::bound("variation", &format!("length of {name}"), count, &bound, "give one a body"));
            }
        }
        for (i, body) in model.bodies.iter().enumerate() {
            let object = format!("body \"{}\"", body.name);
            for (name, factor) in [("young", self.young[i]), ("density", self.density[i])] {
                if !(factor > 0.0 && factor.is_finite()) {
                    let (what, remedy) = (format!("factor of {name}"), "1 leaves the body as it is");
                    return Err(Error::bound(&object, &what, factor, "> 0 and finite", remedy));
                }
            }
            if let Some(x) = self.offset[i].into_iter().find(|x| !x.is_finite()) {
                return Err(Error::bound(&object, "offset", x, "finite", "give metres"));
            }
        }
        Ok(())
    }
}

impl Model {
    /// The model with its bodies varied; K stays shared, each body's factor of it is kept beside it.
    ///
    /// # Errors
    /// Factors that are not positive, offsets that are not finite, not one entry a body.
    pub fn variant(&self, by: &Variation) -> Result<Self> {
        by.check(self)?;
        let mut model = self.clone();
        for (i, body) in model.bodies.iter_mut().enumerate() {
            let (e, r, shift) = (by.young[i], by.density[i], by.offset[i]);
            body.young *= e;
            body.young_factor *= e;
            body.density_factor *= r;
            body.element_omega *= (e / r).sqrt();
            body.edge_stiffness.iter_mut().for_each(|k| *k *= e);
            for node in body.nodes.clone() {
                model.mass[node] *= r;
                model.inverse_mass[node] = model.inverse_mass[node].map(|w| w / r);
                let x = model.points[node];
                model.points[node] = [x[0] + shift[0], x[1] + shift[1]];
            }
        }
        for pair in &mut model.pairs {
            let young = |body: u32| model.bodies[body as usize].young;
            pair.young = pair.primary_body.map_or(0.0, young).max(young(pair.secondary_body));
            pair.node_stiffness.values_mut().for_each(|k| *k *= by.young[pair.secondary_body as usize]);
            if let (Primary::Surface(surface), Some(body)) = (&mut pair.primary, pair.primary_body) {
                surface.element_stiffness.iter_mut().for_each(|k| *k *= by.young[body as usize]);
            }
        }
        Ok(model)
    }
}
