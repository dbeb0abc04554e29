//! One run: step, look, go on.

use bipenalty::critical_step::rows;
use bipenalty::history::Record;
use bipenalty::run::RunSpec;
use numpy::ndarray::ArrayView2;
use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::to_python;
use crate::method::MethodIn;
use crate::model::Model;
use crate::observations;

/// A state over a model with its history.
#[pyclass(module = "bipenalty._core")]
pub struct Run {
    inner: bipenalty::run::Run,
}

/// The core's description of a run.
pub fn spec(
    method: MethodIn,
    dt: f64,
    allow_unstable: bool,
    velocity: &PyReadonlyArray2<'_, f64>,
    displacement: &PyReadonlyArray2<'_, f64>,
    displacement_limit: Option<f64>,
) -> RunSpec {
    RunSpec {
        method: method.0,
        dt,
        allow_unstable,
        velocity: velocity.as_array().iter().copied().collect(),
        displacement: displacement.as_array().iter().copied().collect(),
        displacement_limit: displacement_limit.unwrap_or(f64::INFINITY),
    }
}

#[pymethods]
impl Run {
    #[new]
    fn new(
        py: Python<'_>,
        model: &Model,
        method: MethodIn,
        dt: f64,
        allow_unstable: bool,
        velocity: PyReadonlyArray2<'_, f64>,
        displacement: PyReadonlyArray2<'_, f64>,
    ) -> PyResult<Self> {
        let spec = spec(method, dt, allow_unstable, &velocity, &displacement, None);
        let inner = bipenalty::run::Run::new(model.inner.clone(), &spec).map_err(|e| to_python(py, &e))?;
        Ok(Self { inner })
    }

    /// Says what to record from now on, and the displacement (m) that ends the run.
    fn configure(
        &mut self,
        py: Python<'_>,
        every: u64,
        energy_every: u64,
        mut snapshots: Vec<u64>,
        displacement_limit: f64,
        steps: u64,
    ) -> PyResult<()> {
        snapshots.sort_unstable();
        self.inner.set_displacement_limit(displacement_limit).map_err(|e| to_python(py, &e))?;
        self.inner.record = Record { every, energy_every: energy_every.max(1), snapshots };
        self.inner.history.reserve(&self.inner.model, &self.inner.record, steps);
        Ok(())
    }

    /// Takes up to `steps` steps without the interpreter's lock; the last one is sampled when `last` says so.
    fn advance(&mut self, py: Python<'_>, steps: u64, last: bool) {
        py.detach(|| self.inner.advance(steps, last));
    }

    /// Steps taken.
    #[getter]
    fn steps(&self) -> u64 {
        self.inner.state.steps
    }

    /// Time t_n (s).
    #[getter]
    fn time(&self) -> f64 {
        self.inner.time()
    }

    /// "running" or how the run ended.
    #[getter]
    fn outcome(&self) -> &'static str {
        self.inner.outcome.name()
    }

    /// Why it ended.
    #[getter]
    fn reason(&self) -> &str {
        self.inner.outcome.reason()
    }

    /// Penalty forces per row and their gaps (N/m, m) of the last step, for inspection.
    #[getter]
    fn rows(&self) -> Vec<(f64, f64)> {
        let forces = &self.inner.work.forces.lambda;
        self.inner.work.rows.iter().zip(forces).map(|(row, lambda)| (row.gap, *lambda)).collect()
    }

    /// Critical time step (s) with the rows of the last step active for good, and their largest E G M^-1 G'.
    fn active_limits(&self, py: Python<'_>) -> (f64, f64) {
        let (model, rows) = (&self.inner.model, &self.inner.work.rows);
        py.detach(|| {
            let omega2 = rows::largest_omega2(model, rows).upper;
            (2.0 / omega2.sqrt(), rows::largest_stiffening(model, rows))
        })
    }

    /// Displacement u_n, a read-only (n, 2) view in m; valid until the next step.
    #[getter]
    fn displacement<'py>(this: Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        view(this, |run| &run.state.displacement)
    }

    /// Velocity v_{n-1/2}, a read-only (n, 2) view in m/s; the step writes into it.
    #[getter]
    fn velocity<'py>(this: Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        view(this, |run| &run.state.velocity)
    }

    /// Everything observed so far.
    fn observations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        observations::all(py, &self.inner)
    }
}

fn view<'py>(
    this: Bound<'py, Run>,
    get: impl Fn(&bipenalty::run::Run) -> &Vec<f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let run = this.borrow();
    let values = get(&run.inner);
    let shape = [values.len() / 2, 2];
    let array = ArrayView2::from_shape(shape, values.as_slice())
        .map_err(|e| pyo3::exceptions::PyRuntimeError::new_err(e.to_string()))?;
    // SAFETY: the array keeps the run alive, and the run's buffers keep their place and length as long as it lives.
    let array = unsafe { PyArray2::borrow_from_array(&array, this.clone().into_any()) };
    array.readwrite().make_nonwriteable();
    Ok(array)
}
