"""Hertz's line contact: width, pressure and approach of two cylinders, or of one and a plane, under a force."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from bipenalty import mesh_checks
from bipenalty.exact.known import Floats


@dataclass(frozen=True)
class LineContact:
    """Frictionless contact of parallel cylinders that stays narrow, a << R.

    Parameters
    ----------
    radius : R, m, > 0, 1/R = 1/R1 + 1/R2; that of the cylinder on a plane.
    modulus : E*, N/m^2, > 0, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2; one term on a rigid body.

    Raises
    ------
    InputError : a value out of its bounds.

    Source: Johnson, Contact Mechanics (1985), section 4.2(c): a^2 = 4PR/(pi E*), p0 = 2P/(pi a) = sqrt(P E*/(pi R)).

    Example
    -------
    >>> contact = LineContact(radius=1.0, modulus=np.pi)
    >>> [round(float(q), 6) for q in (contact.half_width(0.01), contact.peak_pressure(0.01))]
    [0.063662, 0.1]
    """

    radius: float
    modulus: float

    def __post_init__(self) -> None:
        for name in ("radius", "modulus"):
            value = mesh_checks.positive("line contact", name, getattr(self, name), "give it in SI units")
            object.__setattr__(self, name, value)

    def half_width(self, force: Any) -> Floats:
        """a, m, of the shape of the force P (N/m)."""
        return np.asarray(2 * np.sqrt(np.asarray(force) * self.radius / (np.pi * self.modulus)))

    def force(self, half_width: Any) -> Floats:
        """P, N/m, of the shape of the half-width a (m)."""
        return np.asarray(np.pi * self.modulus * np.asarray(half_width) ** 2 / (4 * self.radius))

    def peak_pressure(self, force: Any) -> Floats:
        """p0 in the middle, N/m^2, of the shape of the force P (N/m)."""
        return np.asarray(np.sqrt(np.asarray(force) * self.modulus / (np.pi * self.radius)))

    def pressure(self, x: Any, force: float) -> Floats:
        """p(x) = p0 sqrt(1 - x^2/a^2), N/m^2, of the shape of the distance x (m) from the middle."""
        inside = 1 - (np.asarray(x) / self.half_width(force)) ** 2
        return np.asarray(self.peak_pressure(force) * np.sqrt(np.maximum(inside, 0.0)))

    def approach(self, force: Any) -> Floats:
        """Approach (m) of a rigid plane to the centre of a cylinder squeezed between two such, of the shape of P (N/m).

        delta = P/(pi E*) (2 ln(4R/a) - 1): in the plane it depends on how the body is held; this is that of two equal
        and opposite forces (Johnson 1985, section 5.6). A disc that decelerates approaches otherwise.
        """
        P = np.asarray(force, dtype=np.float64)
        return np.asarray(P / (np.pi * self.modulus) * (2 * np.log(4 * self.radius / self.half_width(P)) - 1))
