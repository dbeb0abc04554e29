//! The history of a run as a dictionary of arrays.

use bipenalty::ended::Summary;
use bipenalty::energy::Energies;
use bipenalty::history::History;
use bipenalty::model::Model;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;

/// Contact histories, energies, snapshots and peaks.
pub fn all<'py>(py: Python<'py>, model: &Model, run: &Summary, h: &History) -> PyResult<Bound<'py, PyDict>> {
    let dict = summary(py, run)?;
    dict.set_item("time_step", PyArray1::from_slice(py, &h.steps))?;
    dict.set_item("contact_force", PyArray1::from_slice(py, &h.force))?;
    dict.set_item("penetration", PyArray1::from_slice(py, &h.penetration))?;
    dict.set_item("active_rows", PyArray1::from_slice(py, &h.active))?;
    dict.set_item("force_on", arrays::grouped(py, &h.force_on, h.steps.len(), model.contacts.len())?)?;
    dict.set_item("energy_step", PyArray1::from_slice(py, &h.energy_steps))?;
    let energy = |get: fn(&Energies) -> f64| PyArray1::from_iter(py, h.energies.iter().map(get));
    dict.set_item("kinetic_energy", energy(|e| e.kinetic))?;
    dict.set_item("strain_energy", energy(|e| e.strain))?;
    dict.set_item("penalty_energy", energy(|e| e.penalty))?;
    dict.set_item("mass_penalty_energy", energy(|e| e.mass_penalty))?;
    dict.set_item("load_potential", energy(|e| e.load_potential))?;
    dict.set_item("largest_displacement", energy(|e| e.max_displacement))?;
    dict.set_item("damping_loss", PyArray1::from_slice(py, &h.damping_loss))?;
    dict.set_item("momentum", arrays::grouped(py, &h.momentum, h.energies.len(), model.bodies.len())?)?;
    dict.set_item("snapshot_step", PyArray1::from_iter(py, h.snapshots.iter().map(|s| s.step)))?;
    let snapshots = |get: fn(&bipenalty::history::Snapshot) -> &[f64]| {
        h.snapshots.iter().map(|s| arrays::nodal(py, get(s))).collect::<PyResult<Vec<_>>>()
    };
    dict.set_item("displacement", snapshots(|s| &s.displacement)?)?;
    dict.set_item("velocity", snapshots(|s| &s.velocity)?)?;
    Ok(dict)
}

/// Peaks, energy ratio and outcome.
fn summary<'py>(py: Python<'py>, run: &Summary) -> PyResult<Bound<'py, PyDict>> {
    let (dict, peaks) = (PyDict::new(py), &run.peaks);
    dict.set_item("steps", run.steps)?;
    dict.set_item("planned_steps", run.planned)?;
    dict.set_item("seconds", run.seconds)?;
    dict.set_item("max_penetration", peaks.penetration)?;
    dict.set_item("max_displacement", peaks.displacement)?;
    dict.set_item("peak_force", peaks.force)?;
    dict.set_item("impulse", peaks.impulse)?;
    dict.set_item("energy_ratio", run.energy_ratio)?;
    dict.set_item("outcome", run.conclusion.name())?;
    dict.set_item("reason", run.conclusion.reason())?;
    dict.set_item("stopped", run.stopped)?;
    dict.set_item("energy_made", run.energy_made)?;
    dict.set_item("row_steps", run.row_steps)?;
    dict.set_item("block_operations", run.block_operations)?;
    Ok(dict)
}
