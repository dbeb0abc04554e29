//! Limits of the time step: the element bound and what the active rows add to it.

use crate::model::Model;
use crate::row::Row;

/// Critical time step 2/omega (s) of the element bound (Irons and Fried 1971).
pub fn element_bound(model: &Model) -> f64 {
    2.0 / model.element_omega()
}

/// Largest single-row frequency squared (1/s^2) among the rows: `alpha_s w / (1 + alpha_m w)`, w = G M^-1 G'.
///
/// Below R for any row with a mass penalty (Hetherington, Rodriguez-Ferran and Askes 2012).
pub fn row_omega2(model: &Model, rows: &[Row]) -> f64 {
    let omega2 = |row: &Row| {
        let w = row.inverse_mass(&model.inverse_mass);
        row.penalties.alpha_s * w / (1.0 + row.penalties.alpha_m * w)
    };
    rows.iter().map(omega2).fold(0.0, f64::max)
}
