//! A penalty method as Python passes it on: the name and value of the rule for each penalty.

use bipenalty::enforcement::Enforcement;
use bipenalty::penalty::{Damping, Mass, Method, Stiffness};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

/// Read from the attributes `stiffness_rule`, `kappa_rule`, `mass_rule` and `damping_rule`, and from `enforcement_rule`
/// of methods whose rows do not get their forces from penalties alone.
pub struct MethodIn(pub Method);

impl<'py> FromPyObject<'_, 'py> for MethodIn {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let rule = |name: &str| -> PyResult<(String, f64)> { object.getattr(name)?.extract() };
        let unknown = |what: &str, name: &str| PyTypeError::new_err(format!("unknown {what} rule {name:?}"));
        let (name, value) = rule("stiffness_rule")?;
        let stiffness = match name.as_str() {
            "none" => Stiffness::Factor(0.0),
            "factor" => Stiffness::Factor(value),
            "capped" => Stiffness::Capped,
            "element" => Stiffness::Element(value),
            "nodal mass" => Stiffness::NodalMass(value),
            other => return Err(unknown("stiffness", other)),
        };
        let (name, value) = rule("mass_rule")?;
        let mass = match name.as_str() {
            "none" => Mass::None,
            "ratio" => Mass::Ratio(value),
            "ratio from step" => Mass::RatioFromStep(value),
            "critical" => Mass::Critical(value),
            other => return Err(unknown("mass", other)),
        };
        let (name, value) = rule("damping_rule")?;
        let damping = match name.as_str() {
            "none" => Damping::None,
            "factor" => Damping::Factor(value),
            "ratio" => Damping::Ratio(value),
            "critical" => Damping::Critical,
            other => return Err(unknown("damping", other)),
        };
        let enforcement = match object.getattr_opt("enforcement_rule")? {
            None => Enforcement::Penalty,
            Some(rule) => {
                let (name, tolerance): (String, f64) = rule.extract()?;
                match name.as_str() {
                    "penalty" => Enforcement::Penalty,
                    "velocity Lagrange" => Enforcement::VelocityLagrange { tolerance },
                    "forward increment" => Enforcement::ForwardIncrement { tolerance },
                    "predictor-corrector" => Enforcement::PredictorCorrector,
                    other => return Err(unknown("enforcement", other)),
                }
            }
        };
        let kappa = object.getattr("kappa_rule")?.extract()?;
        Ok(Self(Method { stiffness, kappa, mass, damping, enforcement }))
    }
}
