//! Errors of the core as the exceptions of `bipenalty.errors`.

use bipenalty::error::Error;
use pyo3::prelude::*;

/// The Python exception of an error: `InputError` (also a `ValueError`) or `RunError`.
pub fn to_python(py: Python<'_>, error: &Error) -> PyErr {
    let name = match error {
        Error::Input(_) => "InputError",
        Error::Run(..) => "RunError",
    };
    let exception = || py.import("bipenalty.errors")?.getattr(name)?.call1((error.to_string(),));
    exception().map_or_else(|other| other, PyErr::from_value)
}
