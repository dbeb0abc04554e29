//! Rules for the damping penalty alpha_d.

use super::{Mass, not_negative};
use crate::error::{Error, Result};

/// How the damping penalty follows from the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// No damping penalty.
    None,
    /// alpha_d = D alpha_s, D in s.
    Factor(f64),
    /// alpha_d = 2 zeta sqrt(alpha_s alpha_m).
    Ratio(f64),
    /// alpha_d = 2 alpha_m/dt: zeta s = 1, the entering velocity is gone after one step.
    Critical,
}

impl Damping {
    pub(super) fn check(self, object: &str, mass: Mass) -> Result<()> {
        match self {
            Self::None => Ok(()),
            Self::Factor(d) => not_negative(object, "D", d, "D = alpha_d / alpha_s in s; leave it out for no damping"),
            Self::Ratio(zeta) if mass != Mass::None => {
                not_negative(object, "zeta", zeta, "1 is critical damping of the penalty mode")
            }
            Self::Ratio(zeta) => {
                let remedy = "give D: without a mass penalty there is no penalty mode to take the ratio of";
                Err(Error::bound(object, "zeta", zeta, "left out for the stiffness penalty method", remedy))
            }
            Self::Critical if mass != Mass::None => Ok(()),
            Self::Critical => {
                let remedy = "add a mass penalty: alpha_d = 2 alpha_m/dt";
                Err(Error::bound(object, "critical damping", "without mass", "with a mass penalty", remedy))
            }
        }
    }

    /// Damping penalty (N s/m per m).
    #[inline]
    pub(super) fn alpha_d(self, alpha_s: f64, alpha_m: f64, dt: f64) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Factor(d) => d * alpha_s,
            Self::Ratio(zeta) => 2.0 * zeta * (alpha_s * alpha_m).sqrt(),
            Self::Critical => 2.0 * alpha_m / dt,
        }
    }
}
