"""A bar thrown at a rigid wall."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from bipenalty import mesh_checks
from bipenalty.contact import Contact
from bipenalty.exact.bar import Bar, a_bar, along, guided, lengthwise
from bipenalty.exact.known import Floats
from bipenalty.exact.pulses import Pulsed, Pulses
from bipenalty.obstacles import HalfPlane
from bipenalty.scene import Scene


@dataclass(frozen=True)
class ThrownBar(Pulsed):
    """A bar thrown at a rigid wall: pressure rho c v for 2L/c, after which it leaves as it came.

             v <-  ____________________      x = 0 at its end, which begins at u = gap and may not pass u = 0
        wall |<-->|__|__|__|__|__|__|__|
              gap                            u(x, t) = gap - v t + w(x, t), w of `Bar` under the contact force

    Source: Doyen, Ern and Piperno (2011), SIAM J. Sci. Comput. 33, 223-249, first benchmark. Theirs has a gap of 5 m;
    a millimetre more keeps contact from beginning on a whole step.

    Parameters
    ----------
    bar : the bar.
    speed : v, m/s, > 0.
    gap : m, > 0.

    Raises
    ------
    InputError : a value out of its bounds.

    Example
    -------
    >>> known = ThrownBar(gap=5.0)
    >>> known.contact_force([0.4, 0.6, 1.1, 1.2])
    array([  0., 300., 300.,   0.])
    >>> round(known.release_time, 5), round(known.impulse, 9)
    (1.16667, 200.0)
    """

    name = "thrown bar"
    bar: Bar = field(default_factory=Bar)
    speed: float = 10.0
    gap: float = 5.001

    def __post_init__(self) -> None:
        a_bar(self.name, "bar", self.bar)
        object.__setattr__(self, "speed", mesh_checks.positive(self.name, "speed", self.speed, "give it in m/s"))
        object.__setattr__(self, "gap", mesh_checks.positive(self.name, "gap", self.gap))

    @cached_property
    def pulses(self) -> Pulses:
        """rho c v A from gap/v on, for the time of a wave there and back."""
        start, force = self.gap / self.speed, self.bar.impedance * self.speed
        return Pulses(((start, start + self.bar.round_trip, force, force),))

    @property
    def t_end(self) -> float:
        """Approach, contact, and as long again in flight, s."""
        return self.gap / self.speed + 2 * self.bar.round_trip

    @property
    def speed_of_sound(self) -> float:
        """c, m/s."""
        return self.bar.c

    @property
    def energy(self) -> float:
        """m v^2/2, J/m: the bar leaves without vibration."""
        return self.bar.mass * self.speed**2 / 2

    @property
    def contact_end(self) -> tuple[str, str]:
        """The left end of the bar."""
        return "bar", "left"

    def displacement(self, x: Any, t: Any) -> Floats:
        """u(x, t), m; x in [0, L] and t (s) broadcast. The gap is u(0, t)."""
        return self.gap - self.speed * np.asarray(t) + self.bar.displacement(x, t, self.pulses)

    def velocity(self, x: Any, t: Any) -> Floats:
        """du/dt, m/s; on a front, the value behind it."""
        return -self.speed + self.bar.velocity(x, t, self.pulses)

    def stress(self, x: Any, t: Any) -> Floats:
        """E du/dx, N/m^2, negative in compression; on a front, the value behind it."""
        return self.bar.young * self.bar.strain(x, t, self.pulses)

    def scene(self, refinement: int) -> Scene:
        """The bar of `refinement` elements and the wall; the gap is an initial displacement."""
        bar = self.bar.body("bar", refinement, velocity=(-self.speed, 0.0), displacement=(self.gap, 0.0))
        wall = HalfPlane("wall", point=(0.0, 0.0), normal=(1.0, 0.0))
        return Scene([bar], [Contact("bar", "wall")], guided(bar), [wall])

    def displacement_at(self, points: Any, t: float) -> Floats:
        """Displacement (n, 2) in m of the (n, 2) points of the mesh, m, at t, s."""
        return lengthwise(self.displacement(along(points), t))
