//! Rules for the stiffness penalty alpha_s.

use super::{Known, not_negative, positive};
use crate::error::Result;

/// How the stiffness penalty of a row is chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stiffness {
    /// alpha_s = p_s E_max: a factor of the stiffer body's modulus.
    Factor(f64),
    /// As stiff as the cap kappa m_e/dt^2 allows: no parameter of the user's.
    Capped,
    /// alpha_s = f_s K A^2/V with the bulk modulus K, area A and volume V of the element behind the primary segment
    /// (Hallquist, Goudreau and Benson 1985).
    Element(f64),
    /// alpha_s = 0.5 SOFSCL m*/dt^2 with m* the smallest nodal mass of the row: the time-step based stiffness of
    /// codes in use (soft constraint formulation).
    NodalMass(f64),
}

impl Stiffness {
    pub(super) fn check(self, object: &str) -> Result<()> {
        match self {
            Self::Capped => Ok(()),
            Self::Factor(ps) => not_negative(object, "ps", ps, "p_s = alpha_s / E_max; try 1"),
            Self::Element(scale) => positive(object, "scale", scale, "0.1 is in use"),
            Self::NodalMass(scale) => positive(object, "scale", scale, "0.1 is in use"),
        }
    }

    /// Stiffness penalty (N/m per m) before the cap; infinite where only the cap speaks.
    #[inline]
    pub(super) fn alpha_s(self, known: Known) -> f64 {
        match self {
            Self::Factor(ps) => ps * known.row.behind.young,
            Self::Capped => f64::INFINITY,
            Self::Element(scale) => scale * known.row.behind.element_stiffness,
            Self::NodalMass(scale) => 0.5 * scale * known.row.smallest_mass(known.inverse_mass) / (known.dt * known.dt),
        }
    }
}
