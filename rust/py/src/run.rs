//! One run: step, look, go on.

use bipenalty::crew::Crew;
use bipenalty::critical_step::rows;
use bipenalty::ended::Summary;
use bipenalty::group::Group;
use bipenalty::run::RunSpec;
use numpy::ndarray::ArrayView2;
use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::errors::to_python;
use crate::isa::named;
use crate::method::MethodIn;
use crate::model::Model;
use crate::observations;
use crate::run_spec::{record, start};

/// A run alone in its group.
#[pyclass(module = "bipenalty._core")]
pub struct Run {
    group: Group,
}

#[pymethods]
impl Run {
    #[new]
    #[expect(clippy::too_many_arguments, reason = "the Python layer passes everything by name")]
    fn new(
        py: Python<'_>,
        model: &Model,
        method: MethodIn,
        dt: f64,
        allow_unstable: bool,
        velocity: PyReadonlyArray2<'_, f64>,
        displacement: PyReadonlyArray2<'_, f64>,
        isa: &str,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let start = start(py, &model.inner, &velocity, &displacement)?;
        let spec = RunSpec { allow_unstable, ..RunSpec::new(method.0, dt, start) };
        let mut group = Group::alone(model.inner.clone(), named(py, isa)?, &spec).map_err(|e| to_python(py, &e))?;
        let all = || std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let crew = threads.map_or_else(|| Crew::fitting(model.inner.points.len(), all()), Crew::new);
        group.crew = crew.map_err(|e| to_python(py, &e))?;
        Ok(Self { group })
    }

    /// Says what to record from now on, and the displacement (m) that ends the run.
    fn configure(
        &mut self,
        py: Python<'_>,
        every: u64,
        energy_every: u64,
        snapshots: Vec<u64>,
        displacement_limit: f64,
        steps: u64,
    ) -> PyResult<()> {
        let run = &mut self.group.runs[0];
        run.set_displacement_limit(displacement_limit).map_err(|e| to_python(py, &e))?;
        run.record = record(every, energy_every.max(1), snapshots);
        run.history.reserve(&self.group.model, &run.record, steps);
        Ok(())
    }

    /// Takes up to `steps` steps without the interpreter's lock; the last one is sampled when `last` says so.
    fn advance(&mut self, py: Python<'_>, steps: u64, last: bool) {
        let run = &mut self.group.runs[0];
        run.end = last.then_some(run.steps + steps);
        py.detach(|| self.group.advance(steps));
    }

    /// Steps taken.
    #[getter]
    fn steps(&self) -> u64 {
        self.group.runs[0].steps
    }

    /// Time t_n (s).
    #[getter]
    fn time(&self) -> f64 {
        self.group.runs[0].steps as f64 * self.group.lanes[0].dt
    }

    /// "running" or how the run ended.
    #[getter]
    fn outcome(&self) -> &'static str {
        self.group.runs[0].outcome.name()
    }

    /// Why it ended.
    #[getter]
    fn reason(&self) -> &str {
        self.group.runs[0].outcome.reason()
    }

    /// Penalty forces per row and their gaps (N/m, m) of the last step, for inspection.
    #[getter]
    fn rows(&self) -> Vec<(f64, f64)> {
        let lane = &self.group.lanes[0];
        lane.rows.iter().zip(&lane.forces.lambda).map(|(row, lambda)| (row.gap, *lambda)).collect()
    }

    /// Critical time step (s) with the rows of the last step active for good, and their largest E G M^-1 G'.
    fn active_limits(&self, py: Python<'_>) -> (f64, f64) {
        let (model, rows) = (&self.group.model, &self.group.lanes[0].rows);
        py.detach(|| {
            let omega2 = rows::largest_omega2(model, rows).upper;
            (2.0 / omega2.sqrt(), rows::largest_stiffening(model, rows))
        })
    }

    /// Displacement u_n, a read-only (n, 2) view in m, valid until the next step; a copy where nodes were renumbered.
    #[getter]
    fn displacement<'py>(this: Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        view(this, |group| &group.state.displacement)
    }

    /// Velocity v_{n-1/2}, a read-only (n, 2) view in m/s, which the step writes into; a copy where nodes were renumbered.
    #[getter]
    fn velocity<'py>(this: Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        view(this, |group| &group.state.velocity)
    }

    /// Everything observed so far.
    fn observations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (run, lane) = (&self.group.runs[0], &self.group.lanes[0]);
        observations::all(py, &self.group.model, &Summary::of(run, lane), &run.history)
    }
}

fn view<'py>(this: Bound<'py, Run>, get: impl Fn(&Group) -> &[f64]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let run = this.borrow();
    let (values, order) = (get(&run.group), &run.group.model.order);
    if !order.is_kept() {
        let copy = arrays::pairs(this.py(), &order.outward(values.as_chunks().0))?;
        copy.readwrite().make_nonwriteable();
        return Ok(copy);
    }
    let shape = [values.len() / 2, 2];
    let array =
        ArrayView2::from_shape(shape, values).map_err(|e| pyo3::exceptions::PyRuntimeError::new_err(e.to_string()))?;
    // SAFETY: the array keeps the run alive, and the run's buffers keep their place and length as long as it lives.
    let array = unsafe { PyArray2::borrow_from_array(&array, this.clone().into_any()) };
    array.readwrite().make_nonwriteable();
    Ok(array)
}
