//! Limits of the time step: element bound, assembled matrix, active rows, and which of them governs.

pub mod assembled;
pub mod lanczos;
pub mod rows;

use crate::model::Model;

/// Critical time step 2/omega (s) of the assembled matrix, from an upper bound of its largest frequency.
pub fn assembled_bound(model: &Model) -> f64 {
    2.0 / model.assembled_omega2().upper.sqrt()
}

/// Critical time step 2/omega (s) of the element bound (Irons and Fried 1971).
pub fn element_bound(model: &Model) -> f64 {
    2.0 / model.element_omega()
}
