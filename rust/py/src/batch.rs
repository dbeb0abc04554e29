//! Many runs over one model.

use std::time::Duration;

use bipenalty::run::RunSpec;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::to_python;
use crate::isa::named;
use crate::model::Model;
use crate::observations;
use crate::run_spec::{RunIn, record, start};

/// Runs that share a model and, up to what each says, its initial state.
#[pyclass(frozen, module = "bipenalty._core")]
pub struct Batch {
    inner: bipenalty::batch::Batch,
}

#[pymethods]
impl Batch {
    /// The runs with their time steps and numbers of steps; `every` = 0 keeps peaks only, `lanes` = 0 leaves the width of
    /// the groups to the batch.
    #[new]
    #[pyo3(signature = (model, runs, velocity, displacement, *, allow_unstable=false, displacement_limit=None,
                        every=0, energy_every=0, lanes=0, isa="auto"))]
    #[expect(clippy::too_many_arguments, reason = "the Python layer passes everything by name")]
    fn new(
        py: Python<'_>,
        model: &Model,
        runs: Vec<RunIn>,
        velocity: PyReadonlyArray2<'_, f64>,
        displacement: PyReadonlyArray2<'_, f64>,
        allow_unstable: bool,
        displacement_limit: Option<f64>,
        every: u64,
        energy_every: u64,
        lanes: usize,
        isa: &str,
    ) -> PyResult<Self> {
        let start = start(py, &model.inner, &velocity, &displacement)?;
        let (displacement_limit, bodies) = (displacement_limit.unwrap_or(f64::INFINITY), model.inner.bodies.len());
        let spec = |run: RunIn| {
            let record = record(every, energy_every, Vec::new());
            RunSpec { allow_unstable, displacement_limit, record, ..run.lower(start.clone(), bodies) }
        };
        let specs = runs.into_iter().map(spec).collect();
        Ok(Self { inner: bipenalty::batch::Batch::new(model.inner.clone(), named(py, isa)?, lanes, specs) })
    }

    /// Raises InputError unless a run can begin.
    fn check(&self, py: Python<'_>, index: usize) -> PyResult<()> {
        self.inner.check(index).map_err(|e| to_python(py, &e))
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
        let look =
            |run: &bipenalty::ended::Ended| observations::all(py, self.inner.model(), &run.summary, &run.history);
        self.inner.look(index, look).transpose()
    }
}
