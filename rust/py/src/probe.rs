//! Probes of the machine: what benchmarks compare their figures with.

use bipenalty::probe;
use bipenalty::stiffness::Isa;
use pyo3::prelude::*;

use crate::errors::to_python;
use crate::model::Model;

/// Multiply-adds a second of one core with an instruction set, each lane of a register counted.
#[pyfunction]
#[pyo3(signature = (isa = "auto"))]
pub fn probe_fma_rate(py: Python<'_>, isa: &str) -> PyResult<f64> {
    let isa = Isa::named(isa).map_err(|e| to_python(py, &e))?;
    Ok(py.detach(|| probe::fma_rate(isa)))
}

/// Bytes a second of one core over a working set of so many bytes: of a sum, and of `a = b + s c`.
#[pyfunction]
pub fn probe_bandwidth(py: Python<'_>, bytes: usize) -> PyResult<(f64, f64)> {
    let found = py.detach(|| probe::bandwidth(bytes)).map_err(|e| to_python(py, &e))?;
    Ok((found.read, found.triad))
}

/// Seconds that the bare kernel takes for `steps` passes over the nodes from `first` on, with 1, 8 or 16 lanes.
#[pyfunction]
#[pyo3(signature = (model, lanes, isa = "auto", steps = 100, first = 0))]
pub fn probe_kernel(py: Python<'_>, model: &Model, lanes: usize, isa: &str, steps: u64, first: usize) -> PyResult<f64> {
    let isa = Isa::named(isa).map_err(|e| to_python(py, &e))?;
    let nodes = first..model.inner.points.len();
    py.detach(|| probe::kernel(&model.inner, lanes, isa, steps, nodes)).map_err(|e| to_python(py, &e))
}
