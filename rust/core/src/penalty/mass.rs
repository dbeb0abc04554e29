//! Rules for the mass penalty: alpha_m = alpha_s / R.

use super::positive;
use crate::error::{Error, Result};

/// Share of 4/dt^2 that the published penalty ratio takes unless it is given.
pub const R_SAFETY: f64 = 0.9;

/// How the mass penalty follows from the stiffness penalty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mass {
    /// No mass penalty: the stiffness penalty method.
    None,
    /// R given (1/s^2).
    Ratio(f64),
    /// R = safety * 4/dt^2: within the limit of the time step (Hetherington, Rodriguez-Ferran and Askes 2012).
    RatioFromStep(f64),
    /// R = s^2/dt^2 with s^2 given: the critical rule, alpha_m = alpha_s dt^2/s^2.
    Critical(f64),
}

impl Mass {
    pub(super) fn check(self, object: &str) -> Result<()> {
        match self {
            Self::None => Ok(()),
            Self::Ratio(r) => positive(object, "R", r, "leave it out to take it from dt"),
            Self::RatioFromStep(safety) => positive(object, "R_safety", safety, "0.9 keeps dt within its limit"),
            Self::Critical(s2) if s2 > 0.0 && s2 < 2.0 => Ok(()),
            Self::Critical(s2) => {
                let remedy = "1.5 is the usual choice; from 2 on the gap crosses zero as it closes";
                Err(Error::bound(object, "s2", s2, "in (0, 2)", remedy))
            }
        }
    }

    /// Penalty ratio R (1/s^2) at a time step; infinite without a mass penalty.
    #[inline]
    pub fn ratio(self, dt: f64) -> f64 {
        match self {
            Self::None => f64::INFINITY,
            Self::Ratio(r) => r,
            Self::RatioFromStep(safety) => safety * 4.0 / (dt * dt),
            Self::Critical(s2) => s2 / (dt * dt),
        }
    }
}
