//! Many runs over one model.

use std::time::Duration;

use bipenalty::history::Record;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::to_python;
use crate::method::MethodIn;
use crate::model::Model;
use crate::observations;
use crate::run::spec;

/// Runs that share a model and its initial state.
#[pyclass(frozen, module = "bipenalty._core")]
pub struct Batch {
    inner: bipenalty::batch::Batch,
}

#[pymethods]
impl Batch {
    /// One run a method and time step, each with its number of steps; `every` = 0 keeps peaks only.
    #[new]
    #[expect(clippy::too_many_arguments, reason = "the Python layer passes everything by name")]
    fn new(
        py: Python<'_>,
        model: &Model,
        runs: Vec<(MethodIn, f64, u64)>,
        allow_unstable: bool,
        velocity: PyReadonlyArray2<'_, f64>,
        displacement: PyReadonlyArray2<'_, f64>,
        displacement_limit: Option<f64>,
        every: u64,
        energy_every: u64,
    ) -> PyResult<Self> {
        let mut started = Vec::with_capacity(runs.len());
        for (method, dt, steps) in runs {
            let spec = spec(method, dt, allow_unstable, &velocity, &displacement, displacement_limit);
            let run = bipenalty::run::Run::new(model.inner.clone(), &spec).map_err(|e| to_python(py, &e))?;
            started.push((run, steps));
        }
        for (run, _) in &mut started {
            run.record = Record { every, energy_every: energy_every.max(1), snapshots: Vec::new() };
        }
        Ok(Self { inner: bipenalty::batch::Batch::new(started) })
    }

    /// Works for about `seconds` on `threads` threads; returns the node-steps done.
    fn advance(&self, py: Python<'_>, threads: usize, seconds: f64) -> u64 {
        let budget = Duration::from_secs_f64(seconds.clamp(0.0, 3600.0));
        py.detach(|| self.inner.advance(threads, budget))
    }

    /// Number of runs that have ended.
    #[getter]
    fn finished(&self) -> usize {
        self.inner.finished()
    }

    /// Number of runs.
    fn __len__(&self) -> usize {
        self.inner.len()
    }

    /// Everything observed of one run, with the steps it was to take and its seconds; None if its thread died.
    fn observations<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Option<Bound<'py, PyDict>>> {
        let look = |run: &bipenalty::run::Run, steps: u64, seconds: f64| {
            let dict = observations::all(py, run)?;
            dict.set_item("planned_steps", steps)?;
            dict.set_item("seconds", seconds)?;
            Ok(dict)
        };
        self.inner.look(index, look).transpose()
    }
}
