//! Methods: how the penalties of a pair follow from p_s, R and D or zeta.

use crate::error::{Error, Result};
use crate::row::Penalties;

/// Share of 4/dt^2 that the penalty ratio takes unless it is given.
pub const R_SAFETY: f64 = 0.9;

/// How the mass penalty follows from the stiffness penalty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Mass {
    /// No mass penalty: the stiffness penalty method.
    None,
    /// alpha_m = alpha_s / R with R given (1/s^2).
    Ratio(f64),
    /// R = safety * 4/dt^2: within the limit of the time step (Hetherington et al. 2012).
    RatioFromStep(f64),
}

/// How the damping penalty follows from the others.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Damping {
    /// No damping penalty.
    None,
    /// alpha_d = D alpha_s, D in s.
    Factor(f64),
    /// alpha_d = 2 zeta sqrt(alpha_s alpha_m).
    Ratio(f64),
}

/// A penalty method as the user states it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Method {
    /// Stiffness penalty factor p_s = alpha_s / (E_max 1 m) (-).
    pub ps: f64,
    /// Mass penalty.
    pub mass: Mass,
    /// Damping penalty.
    pub damping: Damping,
}

impl Method {
    /// Checks the parameters; `object` is what messages call the method.
    ///
    /// # Errors
    /// p_s, D or zeta negative or not finite, R or its safety factor not positive and finite, zeta without mass.
    pub fn check(&self, object: &str) -> Result<()> {
        let not_negative = |quantity: &str, value: f64, remedy: &str| {
            if value >= 0.0 && value.is_finite() {
                Ok(())
            } else {
                Err(Error::bound(object, quantity, value, ">= 0 and finite", remedy))
            }
        };
        not_negative("ps", self.ps, "p_s = alpha_s / E_max; try 1")?;
        match self.mass {
            Mass::None => {}
            Mass::Ratio(r) | Mass::RatioFromStep(r) if r > 0.0 && r.is_finite() => {}
            Mass::Ratio(r) => {
                return Err(Error::bound(object, "R", r, "> 0 and finite", "leave it out to take it from dt"));
            }
            Mass::RatioFromStep(s) => {
                return Err(Error::bound(object, "R_safety", s, "> 0 and finite", "0.9 keeps dt within its limit"));
            }
        }
        match self.damping {
            Damping::None => Ok(()),
            Damping::Factor(d) => not_negative("D", d, "D = alpha_d / alpha_s in s; 0 leaves damping out"),
            Damping::Ratio(zeta) if self.mass == Mass::None => {
                let remedy = "give D: without a mass penalty there is no penalty mode to take the ratio of";
                Err(Error::bound(object, "zeta", zeta, "left out for the stiffness penalty method", remedy))
            }
            Damping::Ratio(zeta) => not_negative("zeta", zeta, "1 is critical damping of the penalty mode"),
        }
    }

    /// Penalty ratio R (1/s^2) at a time step; infinite without a mass penalty.
    pub fn ratio(&self, dt: f64) -> f64 {
        match self.mass {
            Mass::None => f64::INFINITY,
            Mass::Ratio(r) => r,
            Mass::RatioFromStep(safety) => safety * 4.0 / (dt * dt),
        }
    }

    /// Penalties of the rows of a pair whose stiffer body has Young's modulus `young` (N/m^2).
    pub fn penalties(&self, young: f64, dt: f64) -> Penalties {
        let alpha_s = self.ps * young;
        let alpha_m = alpha_s / self.ratio(dt);
        let alpha_d = match self.damping {
            Damping::None => 0.0,
            Damping::Factor(d) => d * alpha_s,
            Damping::Ratio(zeta) => 2.0 * zeta * (alpha_s * alpha_m).sqrt(),
        };
        Penalties { alpha_s, alpha_m, alpha_d }
    }
}
