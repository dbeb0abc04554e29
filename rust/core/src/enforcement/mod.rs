//! Enforcement: how active rows get their forces, one way a file; the penalties' own way is the mass block.

pub mod complementarity;
mod forward_increment;
mod predictor_corrector;
mod velocity_lagrange;

use crate::error::{Error, Result};
use crate::mass_block::RowForces;
use crate::penalty::{Damping, Mass, Method};
use crate::row::Row;
use complementarity::Complementarity;

/// How rows are enforced; chosen once for a run.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum Enforcement {
    /// By penalties on stiffness, mass and damping of the rows that penetrate at t_n.
    #[default]
    Penalty,
    /// CD-Lagrange: rows that penetrate at t_n do not approach after it (Fekak et al. 2017).
    VelocityLagrange {
        /// Approach that may be left, over the velocity change that the row's own force makes.
        tolerance: f64,
    },
    /// Forward increment: rows that would penetrate at t_{n+1} do not (Carpenter, Taylor and Katona 1991).
    ForwardIncrement {
        /// Penetration that may be left, over what the row's own force makes good.
        tolerance: f64,
    },
    /// Penalties of rows that would penetrate at t_{n+1}, masses acting on the correction alone.
    PredictorCorrector,
}

/// Rows of a step and what they act on.
#[derive(Clone, Copy)]
pub(crate) struct Rows<'a> {
    /// Inverse masses (1/kg) by node and axis.
    pub inverse_mass: &'a [[f64; 2]],
    /// Active rows.
    pub rows: &'a [Row],
    /// How many of the first of them hold in both directions.
    pub two_sided: usize,
    /// Time step (s).
    pub dt: f64,
}

impl Enforcement {
    /// Checks what the enforcement asks of its parameters and of the penalties it goes with.
    ///
    /// # Errors
    /// A tolerance out of its bounds; penalties that a predictor-corrector cannot work with.
    pub fn check(self, object: &str, method: &Method) -> Result<()> {
        match self {
            Self::Penalty => Ok(()),
            Self::VelocityLagrange { tolerance } | Self::ForwardIncrement { tolerance } => {
                if (1e-13..=1e-3).contains(&tolerance) {
                    return Ok(());
                }
                let remedy = "1e-10 is the usual choice";
                Err(Error::bound(object, "tolerance", tolerance, "in [1e-13, 1e-3]", remedy))
            }
            Self::PredictorCorrector => match (method.mass, method.damping) {
                (Mass::Critical(s2), Damping::None) if s2 <= predictor_corrector::LIMIT => Ok(()),
                (Mass::Critical(s2), Damping::None) => {
                    Err(Error::bound(object, "s2", s2, "in (0, 1]", "1 closes a gap within a step; see its docstring"))
                }
                _ => {
                    let remedy = "give s2 alone";
                    Err(Error::bound(
                        object,
                        "penalties",
                        "others",
                        "a mass penalty alpha_s dt^2/s2, no damping",
                        remedy,
                    ))
                }
            },
        }
    }

    /// True when rows are those that would penetrate at t_{n+1}, seen from where the bodies get without them.
    pub fn looks_ahead(self) -> bool {
        matches!(self, Self::ForwardIncrement { .. } | Self::PredictorCorrector)
    }

    /// What to change where rows that open and close make energy.
    pub fn remedy(self) -> &'static str {
        match self {
            Self::Penalty => "use rule=\"critical\", add damping or lower p_s",
            Self::PredictorCorrector => "lower s2 or p_s, or use one pass",
            Self::VelocityLagrange { .. } | Self::ForwardIncrement { .. } => "reduce dt",
        }
    }

    /// Row forces of any but the penalties; returns the multiplications that the solution took.
    pub(crate) fn forces(self, of: Rows, solver: &mut Complementarity, forces: &mut RowForces) -> Result<usize> {
        match self {
            Self::Penalty => Ok(0),
            Self::VelocityLagrange { tolerance } => velocity_lagrange::forces(of, tolerance, solver, forces),
            Self::ForwardIncrement { tolerance } => forward_increment::forces(of, tolerance, solver, forces),
            Self::PredictorCorrector => {
                predictor_corrector::forces(of, forces);
                Ok(0)
            }
        }
    }
}
