//! Instruction sets by name.

use bipenalty::stiffness::Isa;
use pyo3::prelude::*;

use crate::errors::to_python;

/// The instruction set of a name, or the widest this machine has for "auto".
pub fn named(py: Python<'_>, name: &str) -> PyResult<Isa> {
    Isa::named(name).map_err(|e| to_python(py, &e))
}
