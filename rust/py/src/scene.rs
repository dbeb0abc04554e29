//! The Python scene's objects as the core's descriptions, read attribute by attribute.

use bipenalty::constraint::support::Support;
use bipenalty::error::Error;
use bipenalty::material::{Material, Plane};
use bipenalty::scene::{BodySpec, ContactSpec, Obstacle};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::errors::to_python;
use crate::mesh::lowered;

#[derive(FromPyObject)]
pub struct Mesh<'py> {
    points: PyReadonlyArray2<'py, f64>,
    triangles: PyReadonlyArray2<'py, i64>,
    quads: PyReadonlyArray2<'py, i64>,
}

#[derive(FromPyObject)]
pub struct Elastic {
    young: f64,
    poisson: f64,
    density: f64,
    plane: String,
}

impl Elastic {
    /// The material as the core describes it; `object` is what messages call its owner.
    pub fn lower(&self, object: &str) -> Result<Material, Error> {
        let plane = match self.plane.as_str() {
            "strain" => Plane::Strain,
            "stress" => Plane::Stress,
            other => {
                let (value, bound) = (format!("\"{other}\""), "\"strain\" or \"stress\"");
                return Err(Error::bound(object, "plane", value, bound, "name one of the two"));
            }
        };
        Ok(Material { young: self.young, poisson: self.poisson, density: self.density, plane })
    }
}

#[derive(FromPyObject)]
pub struct Body<'py> {
    name: String,
    mesh: Mesh<'py>,
    material: Elastic,
    thickness: f64,
    body_force: (f64, f64),
}

impl Body<'_> {
    /// The body as the core describes it.
    pub fn lower(&self, py: Python<'_>) -> PyResult<BodySpec> {
        let object = format!("body \"{}\"", self.name);
        Ok(BodySpec {
            name: self.name.clone(),
            mesh: lowered(py, &self.mesh.points, &self.mesh.triangles, &self.mesh.quads)?,
            material: self.material.lower(&object).map_err(|e| to_python(py, &e))?,
            thickness: self.thickness,
            body_force: self.body_force.into(),
        })
    }
}

#[derive(FromPyObject)]
pub struct Contact {
    secondary: String,
    primary: String,
    passes: u32,
    overlap_tolerance: Option<f64>,
}

impl From<Contact> for ContactSpec {
    fn from(c: Contact) -> Self {
        let Contact { secondary, primary, passes, overlap_tolerance } = c;
        Self { secondary, primary, passes, overlap_tolerance }
    }
}

#[derive(FromPyObject)]
pub enum Rigid {
    Polyline { name: String, points: Vec<(f64, f64)>, closed: bool },
    HalfPlane { name: String, point: (f64, f64), normal: (f64, f64) },
}

impl From<Rigid> for (String, Obstacle) {
    fn from(rigid: Rigid) -> Self {
        match rigid {
            Rigid::Polyline { name, points, closed } => {
                (name, Obstacle::Polyline { points: points.into_iter().map(Into::into).collect(), closed })
            }
            Rigid::HalfPlane { name, point, normal } => {
                (name, Obstacle::HalfPlane { point: point.into(), normal: normal.into() })
            }
        }
    }
}

/// A support with its boundary already resolved to nodes: body, nodes, held axes.
#[derive(FromPyObject)]
pub struct Held(String, Vec<usize>, (bool, bool));

impl From<Held> for Support {
    fn from(held: Held) -> Self {
        Self { body: held.0, nodes: held.1, fixed: held.2.into() }
    }
}
