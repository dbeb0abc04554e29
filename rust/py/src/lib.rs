//! Python bindings of `bipenalty`: arrays in, arrays out, no numerics.

mod arrays;
mod batch;
mod checks;
mod errors;
mod isa;
mod mesh;
mod method;
mod model;
mod observations;
mod probe;
mod run;
mod run_spec;
mod scene;

use pyo3::prelude::*;

#[pymodule]
mod _core {
    #[pymodule_export]
    use super::batch::Batch;
    #[pymodule_export]
    use super::checks::{check_elastic, check_method};
    #[pymodule_export]
    use super::mesh::check_mesh;
    #[pymodule_export]
    use super::model::Model;
    #[pymodule_export]
    use super::probe::{probe_bandwidth, probe_fma_rate, probe_kernel};
    #[pymodule_export]
    use super::run::Run;

    use bipenalty::stiffness::Isa;

    use super::*;

    /// Instruction sets that this machine has, narrowest first, by the names they are asked for.
    #[pyfunction]
    fn instruction_sets() -> Vec<&'static str> {
        Isa::available().map(Isa::name).collect()
    }

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))?;
        module.add("instruction_set", Isa::detect().name())
    }
}
