//! The cap on the stiffness penalty: alpha_s <= kappa m_e/dt^2 with the row's effective mass m_e = 1/(G M^-1 G').
//!
//! A row much heavier in penalty than in mass throws its nodes about as it opens and closes against its neighbours;
//! beyond kappa of a few nothing is gained, because the gap already closes within a step.

use super::{Known, Stiffness};
use crate::error::{Error, Result};

/// Cap of the parameter-free method.
pub const KAPPA: f64 = 5.0;

pub(super) fn check(object: &str, kappa: f64, stiffness: Stiffness) -> Result<()> {
    if kappa.is_nan() || kappa <= 0.0 {
        return Err(Error::bound(object, "kappa", kappa, "> 0", "5 is the usual choice; infinite for no cap"));
    }
    if kappa.is_infinite() && stiffness == Stiffness::Capped {
        let remedy = "give kappa, or a stiffness penalty factor ps";
        return Err(Error::bound(object, "kappa", kappa, "finite where no ps is given", remedy));
    }
    Ok(())
}

/// `min(alpha_s, kappa m_e/dt^2)`.
#[inline]
pub(super) fn capped(alpha_s: f64, kappa: f64, known: Known) -> f64 {
    if kappa.is_infinite() {
        return alpha_s;
    }
    let inverse = known.row.inverse_mass(known.inverse_mass);
    // A row over held degrees of freedom only has no mass to move: it needs no penalty.
    if inverse > 0.0 { alpha_s.min(kappa / (inverse * known.dt * known.dt)) } else { 0.0 }
}
