//! Checking a mesh before it has a body.

use bipenalty::boundary::boundary_loops;
use bipenalty::mesh::Mesh;
use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

use crate::arrays::{connectivity, points};
use crate::errors::to_python;

type Checked<'py> = (Bound<'py, PyArray2<i64>>, Bound<'py, PyArray2<i64>>, bool, Vec<Bound<'py, PyArray1<i64>>>);

/// Triangles and quads counter-clockwise, whether they were turned round for that, and the outward boundary loops.
#[pyfunction]
#[pyo3(signature = (points_, triangles, quads, /))]
pub fn check_mesh<'py>(
    py: Python<'py>,
    points_: PyReadonlyArray2<'py, f64>,
    triangles: PyReadonlyArray2<'py, i64>,
    quads: PyReadonlyArray2<'py, i64>,
) -> PyResult<Checked<'py>> {
    let mesh = lowered(py, &points_, &triangles, &quads)?;
    let (mesh, turned) = mesh.checked().map_err(|e| to_python(py, &e))?;
    let loops = boundary_loops(&mesh).map_err(|e| to_python(py, &e))?;
    let ring = |nodes: Vec<usize>| PyArray1::from_iter(py, nodes.into_iter().map(|n| n as i64));
    let loops = loops.into_iter().map(ring).collect();
    Ok((numbers(py, &mesh.triangles)?, numbers(py, &mesh.quads)?, turned, loops))
}

/// The arrays as a mesh of the core, not yet checked.
pub fn lowered(
    py: Python<'_>,
    coordinates: &PyReadonlyArray2<'_, f64>,
    triangles: &PyReadonlyArray2<'_, i64>,
    quads: &PyReadonlyArray2<'_, i64>,
) -> PyResult<Mesh> {
    Ok(Mesh {
        points: points(py, coordinates)?,
        triangles: connectivity(py, triangles, "triangle")?,
        quads: connectivity(py, quads, "quad")?,
    })
}

fn numbers<'py, const N: usize>(py: Python<'py>, rows: &[[usize; N]]) -> PyResult<Bound<'py, PyArray2<i64>>> {
    use numpy::PyArrayMethods;
    PyArray1::from_iter(py, rows.as_flattened().iter().map(|&n| n as i64)).reshape([rows.len(), N])
}
