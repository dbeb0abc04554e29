"""A bar that falls on a rigid wall, bounces with its whole length ringing, and bounces back to where it was."""

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

#: Time of fall over the time L/c of a wave along the bar: with a whole number a flight ends in the phase it began.
FALL = 3


@dataclass(frozen=True)
class BouncingBar(Pulsed):
    """A bar under gravity, dropped on a rigid wall from rest; it comes to rest at the top again after 16 L/c.

             g <-  ____________________      falls for 3 L/c, is in contact for 2 L/c, flies for 6 L/c, is in contact
        wall |<-->|__|__|__|__|__|__|__|     for 2 L/c and rises for 3 L/c
             height                          u(x, t) = height - g t^2/2 + w(x, t), w of `Bar` under the contact force

    The contact pressure is rho c (v + g s) at s after the first closing and before the last opening, v the speed of
    fall: 300 to 500 and 500 to 300 N/m^2 unless given. The second contact is the first in reverse.

    Source: Doyen, Ern and Piperno (2011), SIAM J. Sci. Comput. 33, 223-249, second benchmark. Theirs is an
    infinite series; d'Alembert's waves give the same in closed form, with nothing left out.

    Parameters
    ----------
    bar : the bar.
    gravity : g, m/s^2, > 0, towards the wall.

    Raises
    ------
    InputError : a value out of its bounds.

    Example
    -------
    >>> known = BouncingBar()
    >>> known.height, round(known.t_end, 6), [round(float(t), 4) for pair in known.contact_intervals for t in pair]
    (5.0, 5.333333, [1.0, 1.6667, 3.6667, 4.3333])
    >>> known.contact_force([0.5, 1.0, 1.5])
    array([  0., 300., 450.])
    """

    name = "bouncing bar"
    bar: Bar = field(default_factory=Bar)
    gravity: float = 10.0

    def __post_init__(self) -> None:
        a_bar(self.name, "bar", self.bar)
        gravity = mesh_checks.positive(self.name, "gravity", self.gravity, "give it in m/s^2, towards the wall")
        object.__setattr__(self, "gravity", gravity)

    @property
    def fall(self) -> float:
        """Time of fall 3 L/c, s."""
        return FALL * self.bar.round_trip / 2

    @property
    def height(self) -> float:
        """Height of fall, m: that of `fall`."""
        return self.gravity * self.fall**2 / 2

    @cached_property
    def pulses(self) -> Pulses:
        """rho c A (v + g s), rising and then in reverse, once every 16 L/c."""
        closing, contact, period = self.fall, self.bar.round_trip, 4 * self.fall + 2 * self.bar.round_trip
        soft, hard = (self.bar.impedance * self.gravity * (self.fall + s) for s in (0.0, contact))
        again = period - closing - contact
        return Pulses(((closing, closing + contact, soft, hard), (again, again + contact, hard, soft)), period)

    @property
    def t_end(self) -> float:
        """One period, 16 L/c, s."""
        return self.pulses.period

    @property
    def speed_of_sound(self) -> float:
        """c, m/s."""
        return self.bar.c

    @property
    def energy(self) -> float:
        """m g height, J/m: load potential zero where the bar touches the wall undeformed."""
        return self.bar.mass * self.gravity * self.height

    @property
    def contact_end(self) -> tuple[str, str]:
        """The left end of the bar."""
        return "bar", "left"

    def displacement(self, x: Any, t: Any) -> Floats:
        """u(x, t), m; x in [0, L] and t (s) broadcast. The gap is u(0, t)."""
        s = np.mod(t, self.t_end)
        return np.asarray(self.height - self.gravity * s**2 / 2) + self.bar.displacement(x, s, self._once)

    def velocity(self, x: Any, t: Any) -> Floats:
        """du/dt, m/s; on a front, the value behind it."""
        s = np.mod(t, self.t_end)
        return np.asarray(-self.gravity * s) + self.bar.velocity(x, s, self._once)

    def stress(self, x: Any, t: Any) -> Floats:
        """E du/dx, N/m^2, negative in compression; on a front, the value behind it."""
        return self.bar.young * self.bar.strain(x, np.mod(t, self.t_end), self._once)

    def scene(self, refinement: int) -> Scene:
        """The bar of `refinement` elements and the wall; the height is an initial displacement."""
        weight = (-self.bar.density * self.gravity, 0.0)
        bar = self.bar.body("bar", refinement, displacement=(self.height, 0.0), body_force=weight)
        wall = HalfPlane("wall", point=(0.0, 0.0), normal=(1.0, 0.0))
        return Scene([bar], [Contact("bar", "wall")], guided(bar), [wall])

    def displacement_at(self, points: Any, t: float) -> Floats:
        """Displacement (n, 2) in m of the (n, 2) points of the mesh, m, at t, s."""
        return lengthwise(self.displacement(along(points), t))

    @property
    def _once(self) -> Pulses:
        """The contact force of one period."""
        return Pulses(self.pulses.lines)
