//! Vectors of the core as NumPy arrays.

use bipenalty::error::Error;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::errors::to_python;

/// Pairs as an (n, 2) array.
pub fn pairs<'py>(py: Python<'py>, values: &[[f64; 2]]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    PyArray1::from_slice(py, values.as_flattened()).reshape([values.len(), 2])
}

/// Pairs as a (rows, groups, 2) array; there may be no groups.
pub fn grouped<'py>(
    py: Python<'py>,
    values: &[[f64; 2]],
    rows: usize,
    groups: usize,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    PyArray1::from_slice(py, values.as_flattened()).reshape([rows, groups, 2])
}

/// Flat nodal values as an (n, 2) array.
pub fn nodal<'py>(py: Python<'py>, values: &[f64]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    PyArray1::from_slice(py, values).reshape([values.len() / 2, 2])
}

/// Rows of a connectivity array of known width; negative numbers are refused.
pub fn connectivity<const N: usize>(
    py: Python<'_>,
    array: &PyReadonlyArray2<'_, i64>,
    kind: &str,
) -> PyResult<Vec<[usize; N]>> {
    let input = |message: String| to_python(py, &Error::Input(message));
    let view = array.as_array();
    if view.ncols() != N {
        let columns = view.ncols();
        return Err(input(format!("mesh: {kind} has {columns} columns, must be {N}; give one row an element")));
    }
    let mut rows = Vec::with_capacity(view.nrows());
    for (e, row) in view.rows().into_iter().enumerate() {
        let mut nodes = [0; N];
        for (node, &value) in nodes.iter_mut().zip(row) {
            *node = usize::try_from(value)
                .map_err(|_| input(format!("mesh: {kind} {e} node = {value}, must be >= 0; number nodes from 0")))?;
        }
        rows.push(nodes);
    }
    Ok(rows)
}

/// Points of an (n, 2) array.
pub fn points(py: Python<'_>, array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<[f64; 2]>> {
    let view = array.as_array();
    if view.ncols() != 2 {
        let message = format!("mesh: points have {} columns, must be 2; give x and y", view.ncols());
        return Err(to_python(py, &Error::Input(message)));
    }
    Ok(view.rows().into_iter().map(|row| [row[0], row[1]]).collect())
}
