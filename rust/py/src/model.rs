//! The model: built once from a scene, shared by runs.

use std::sync::Arc;

use bipenalty::critical_step::rows::worst_stiffening;
use bipenalty::critical_step::{assembled_bound, element_bound};
use bipenalty::scene::Scene;
use bipenalty::variant::Variation;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;

use crate::arrays;
use crate::errors::to_python;
use crate::scene::{Body, Contact, Held, Rigid};

/// K, M, surfaces and pairs of a scene.
#[pyclass(frozen, module = "bipenalty._core")]
pub struct Model {
    pub inner: Arc<bipenalty::model::Model>,
}

#[pymethods]
impl Model {
    #[new]
    fn new(
        py: Python<'_>,
        bodies: Vec<Body<'_>>,
        contacts: Vec<Contact>,
        supports: Vec<Held>,
        obstacles: Vec<Rigid>,
    ) -> PyResult<Self> {
        let scene = Scene {
            bodies: bodies.iter().map(|body| body.lower(py)).collect::<PyResult<_>>()?,
            obstacles: obstacles.into_iter().map(Into::into).collect(),
            contacts: contacts.into_iter().map(Into::into).collect(),
            supports: supports.into_iter().map(Into::into).collect(),
            linear: Vec::new(),
        };
        let inner = py.detach(|| bipenalty::model::Model::new(scene)).map_err(|e| to_python(py, &e))?;
        Ok(Self { inner: Arc::new(inner) })
    }

    /// Critical time step 2/omega_max of the elements (s).
    #[getter]
    fn critical_dt(&self) -> f64 {
        element_bound(&self.inner)
    }

    /// Critical time step of the assembled matrix (s), from an upper bound of its largest frequency.
    fn assembled_critical_dt(&self, py: Python<'_>) -> f64 {
        py.detach(|| assembled_bound(&self.inner))
    }

    /// Either limit (s) with factors of each body's modulus and density.
    fn scaled_critical_dt(&self, py: Python<'_>, young: Vec<f64>, density: Vec<f64>, assembled: bool) -> PyResult<f64> {
        let offset = vec![[0.0; 2]; young.len()];
        let variant = self.inner.variant(&Variation { young, density, offset }).map_err(|e| to_python(py, &e))?;
        Ok(if assembled { py.detach(|| assembled_bound(&variant)) } else { element_bound(&variant) })
    }

    /// Largest E G M^-1 G' (N/m^2 per kg) that contact rows on one pair of nodes can have.
    fn worst_stiffening(&self) -> f64 {
        worst_stiffening(&self.inner)
    }

    /// Reference coordinates of all nodes of the scene, (n, 2) in m.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        arrays::pairs(py, &self.inner.order.outward(&self.inner.points))
    }

    /// Lumped mass of each node, (n,) in kg.
    #[getter]
    fn mass<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.inner.order.outward(&self.inner.mass))
    }

    /// Names of the contacts, "secondary on primary".
    #[getter]
    fn contacts(&self) -> Vec<String> {
        self.inner.contacts.iter().map(|c| format!("{} on {}", c.names[0], c.names[1])).collect()
    }
}
