//! Checks of the core, so that Python objects can be refused where they are made.

use pyo3::prelude::*;

use crate::errors::to_python;
use crate::method::MethodIn;
use crate::scene::Elastic;

/// Raises InputError unless the constants of a material are within their bounds.
#[pyfunction]
pub fn check_elastic(py: Python<'_>, object: &str, material: Elastic) -> PyResult<()> {
    material.lower(object).and_then(|m| m.check(object)).map_err(|e| to_python(py, &e))
}

/// Raises InputError unless the parameters of a penalty method are within their bounds.
#[pyfunction]
pub fn check_method(py: Python<'_>, object: &str, method: MethodIn) -> PyResult<()> {
    method.0.check(object).map_err(|e| to_python(py, &e))
}
