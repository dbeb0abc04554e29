//! What tells runs apart, as Python passes it on.

use std::sync::Arc;

use bipenalty::history::Record;
use bipenalty::run::RunSpec;
use bipenalty::start::Start;
use bipenalty::variant::Variation;
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;

use crate::errors::to_python;
use crate::method::MethodIn;

/// Read from the attributes `method`, `dt`, `steps`, `velocity`, `offset`, `young` and `density`.
#[derive(FromPyObject)]
pub struct RunIn {
    method: MethodIn,
    dt: f64,
    steps: u64,
    /// By body: what replaces its initial velocity (m/s).
    velocity: Option<Vec<Option<[f64; 2]>>>,
    /// By body: its shift (m).
    offset: Option<Vec<[f64; 2]>>,
    /// By body: factor of its modulus.
    young: Option<Vec<f64>>,
    /// By body: factor of its density.
    density: Option<Vec<f64>>,
}

impl RunIn {
    /// The core's description of the run.
    pub fn lower(self, start: Arc<Start>, bodies: usize) -> RunSpec {
        let none = Variation::none(bodies);
        let varied = self.offset.is_some() || self.young.is_some() || self.density.is_some();
        let variation = varied.then(|| Variation {
            young: self.young.unwrap_or(none.young),
            density: self.density.unwrap_or(none.density),
            offset: self.offset.unwrap_or(none.offset),
        });
        let (steps, velocity) = (Some(self.steps), self.velocity);
        RunSpec { steps, velocity, variation, ..RunSpec::new(self.method.0, self.dt, start) }
    }
}

/// Initial velocity and displacement of all nodes.
pub fn start(
    py: Python<'_>,
    model: &bipenalty::model::Model,
    velocity: &PyReadonlyArray2<'_, f64>,
    displacement: &PyReadonlyArray2<'_, f64>,
) -> PyResult<Arc<Start>> {
    let flat = |array: &PyReadonlyArray2<'_, f64>| array.as_array().iter().copied().collect();
    let start = Start::new(model, flat(velocity), flat(displacement)).map_err(|e| to_python(py, &e))?;
    Ok(Arc::new(start))
}

/// What to record: contact every so many steps (0 for peaks alone), energies every so many, snapshots at chosen ones.
pub fn record(every: u64, energy_every: u64, mut snapshots: Vec<u64>) -> Record {
    snapshots.sort_unstable();
    Record { every, energy_every, snapshots }
}
