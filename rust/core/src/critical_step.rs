//! Limits of the time step.

use crate::model::Model;

/// Critical time step 2/omega (s) of the element bound (Irons and Fried 1971).
pub fn element_bound(model: &Model) -> f64 {
    2.0 / model.element_omega()
}
