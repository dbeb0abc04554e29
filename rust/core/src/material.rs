//! Isotropic linear elasticity in plane strain or plane stress.

use nalgebra::Matrix3;

use crate::error::{Error, Result};

/// The out-of-plane assumption.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plane {
    /// No strain out of the plane.
    Strain,
    /// No stress out of the plane.
    Stress,
}

/// Isotropic linear-elastic material.
#[derive(Debug, Clone, Copy)]
pub struct Material {
    /// Young's modulus E (N/m^2).
    pub young: f64,
    /// Poisson's ratio nu (-).
    pub poisson: f64,
    /// Mass density rho (kg/m^3).
    pub density: f64,
    /// Plane strain or plane stress.
    pub plane: Plane,
}

impl Material {
    /// Elasticity matrix C (N/m^2) of (s_xx, s_yy, s_xy) = C (e_xx, e_yy, 2 e_xy).
    pub fn elasticity(&self) -> Matrix3<f64> {
        let (e, nu) = (self.young, self.poisson);
        // Plane stress is plane strain with the first Lame constant reduced so that s_zz = 0.
        let shear = e / (2.0 * (1.0 + nu));
        let lame = match self.plane {
            Plane::Strain => e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            Plane::Stress => e * nu / (1.0 - nu * nu),
        };
        Matrix3::new(lame + 2.0 * shear, lame, 0.0, lame, lame + 2.0 * shear, 0.0, 0.0, 0.0, shear)
    }

    /// Bulk modulus E / (3 (1 - 2 nu)) (N/m^2).
    pub fn bulk_modulus(&self) -> f64 {
        self.young / (3.0 * (1.0 - 2.0 * self.poisson))
    }

    /// Checks the constants; `object` is what messages call the owner.
    ///
    /// # Errors
    /// Young's modulus or density not positive and finite, Poisson's ratio outside (-1, 0.5).
    pub fn check(&self, object: &str) -> Result<()> {
        for (quantity, value, unit) in [("young", self.young, "N/m^2"), ("density", self.density, "kg/m^3")] {
            if !(value > 0.0 && value.is_finite()) {
                let remedy = format!("give it in {unit}");
                return Err(Error::bound(object, quantity, value, "> 0 and finite", &remedy));
            }
        }
        if !(self.poisson > -1.0 && self.poisson < 0.5) {
            let remedy = "an incompressible material (0.5) has no finite wave speed: use 0.499 at most";
            return Err(Error::bound(object, "poisson", self.poisson, "in (-1, 0.5)", remedy));
        }
        Ok(())
    }
}
