//! Penalty methods: how the penalties of a row are chosen.

pub mod cap;
pub mod damping;
pub mod mass;
pub mod stiffness;

pub use damping::Damping;
pub use mass::{Mass, R_SAFETY};
pub use stiffness::Stiffness;

use crate::enforcement::Enforcement;
use crate::error::{Error, Result};
use crate::row::{Penalties, Row};

/// A penalty method as the user states it: one rule for each penalty, and a cap on the first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Method {
    /// Stiffness penalty.
    pub stiffness: Stiffness,
    /// Most that alpha_s may be, as kappa in kappa m_e/dt^2; infinite for no cap.
    pub kappa: f64,
    /// Mass penalty.
    pub mass: Mass,
    /// Damping penalty.
    pub damping: Damping,
    /// How rows get their forces, from these penalties or without any.
    pub enforcement: Enforcement,
}

/// What a rule may know of a row.
#[derive(Debug, Clone, Copy)]
pub struct Known<'a> {
    /// The row, with what is behind it.
    pub row: &'a Row,
    /// Inverse masses (1/kg) by node and axis.
    pub inverse_mass: &'a [[f64; 2]],
    /// Time step (s).
    pub dt: f64,
}

impl Method {
    /// Checks the parameters; `object` is what messages call the method.
    ///
    /// # Errors
    /// A parameter out of its bounds, a damping ratio without a mass penalty, no cap where nothing else bounds alpha_s.
    pub fn check(&self, object: &str) -> Result<()> {
        self.stiffness.check(object)?;
        cap::check(object, self.kappa, self.stiffness)?;
        self.mass.check(object)?;
        self.damping.check(object, self.mass)?;
        self.enforcement.check(object, self)
    }

    /// Penalty ratio R (1/s^2) that the equation of motion sees; infinite without a mass penalty in it.
    pub fn ratio(&self, dt: f64) -> f64 {
        if self.enforcement == Enforcement::Penalty { self.mass.ratio(dt) } else { f64::INFINITY }
    }

    /// Penalties of a row.
    #[inline]
    pub fn penalties(&self, known: Known) -> Penalties {
        let alpha_s = cap::capped(self.stiffness.alpha_s(known), self.kappa, known);
        let alpha_m = alpha_s / self.mass.ratio(known.dt);
        let alpha_d = self.damping.alpha_d(alpha_s, alpha_m, known.dt);
        Penalties { alpha_s, alpha_m, alpha_d }
    }
}

/// Errors unless `value` is >= 0 and finite.
fn not_negative(object: &str, quantity: &str, value: f64, remedy: &str) -> Result<()> {
    let ok = value >= 0.0 && value.is_finite();
    if ok { Ok(()) } else { Err(Error::bound(object, quantity, value, ">= 0 and finite", remedy)) }
}

/// Errors unless `value` is > 0 and finite.
fn positive(object: &str, quantity: &str, value: f64, remedy: &str) -> Result<()> {
    let ok = value > 0.0 && value.is_finite();
    if ok { Ok(()) } else { Err(Error::bound(object, quantity, value, "> 0 and finite", remedy)) }
}
