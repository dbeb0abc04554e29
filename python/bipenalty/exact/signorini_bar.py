"""A stretched bar, held at one end, that snaps onto a rigid wall and off it again."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from bipenalty import mesh_checks
from bipenalty.constraints import Support
from bipenalty.contact import Contact
from bipenalty.exact.bar import Bar, a_bar, along, guided, lengthwise
from bipenalty.exact.known import Floats
from bipenalty.exact.pulses import Pulsed, Pulses
from bipenalty.obstacles import HalfPlane
from bipenalty.scene import Scene

#: u/U = a + b x/L + d f with f = t c/L mod 1: (a, b, d) for n = floor(t c/L mod 3) and zones I to IV of the (x, t) plane.
ZONES = np.array(
    [
        [(1, -1, 0), (1, 0, -1), (1, -1, 0), (1, 0, -1)],
        [(0, 0, -1), (0, -1, 0), (-1, 1, 0), (-1, 0, 1)],
        [(0, 0, 1), (0, 0, 1), (1, -1, 0), (1, -1, 0)],
    ],
    dtype=np.float64,
)


@dataclass(frozen=True)
class SignoriniBar(Pulsed):
    """A bar held at x = L, let go from rest with u = U (1 - x/L) before a wall at x = 0: in contact L/c of every 3 L/c.

              ______________________
        wall |__|__|__|__|__|__|__|__|  held         contact force E A U/L for L/c < t < 2L/c
             x = 0                   x = L           energy E A U^2/(2L)

    The solution is linear in x and t in each of four zones, cut by the characteristics x = c t and x = L - c t.

    Source: Chouly and Renard (2018), Adv. Model. Simul. Eng. Sci. 5:31, with E = rho = L = 1 and U = 1/2.

    Parameters
    ----------
    bar : the bar.
    opening : U, initial displacement of the end before the wall, m, > 0.

    Raises
    ------
    InputError : a value out of its bounds.

    Example
    -------
    >>> known = SignoriniBar()
    >>> known.contact_intervals, known.impulse, known.energy
    (((1.0, 2.0), (4.0, 5.0)), 1.0, 0.125)
    >>> known.displacement([0.0, 0.5, 1.0], 1.5)
    array([ 0.  , -0.25,  0.  ])
    """

    name = "Signorini bar"
    bar: Bar = field(default_factory=lambda: Bar(1.0, 1.0, 1.0, 1.0))
    opening: float = 0.5

    def __post_init__(self) -> None:
        a_bar(self.name, "bar", self.bar)
        object.__setattr__(self, "opening", mesh_checks.positive(self.name, "opening", self.opening))

    @cached_property
    def pulses(self) -> Pulses:
        """E A U/L for the second L/c of every three."""
        transit, force = self.bar.round_trip / 2, self.bar.young * self.bar.height * self.opening / self.bar.length
        return Pulses(((transit, 2 * transit, force, force),), 3 * transit)

    @property
    def t_end(self) -> float:
        """Two periods, 6 L/c, s."""
        return 2 * self.pulses.period

    @property
    def speed_of_sound(self) -> float:
        """c, m/s."""
        return self.bar.c

    @property
    def energy(self) -> float:
        """E A U^2/(2L), J/m."""
        return self.bar.young * self.bar.height * self.opening**2 / (2 * self.bar.length)

    @property
    def contact_end(self) -> tuple[str, str]:
        """The left end of the bar."""
        return "bar", "left"

    def displacement(self, x: Any, t: Any) -> Floats:
        """u(x, t), m; x in [0, L] and t (s) broadcast. The gap is u(0, t)."""
        place, f, (a, b, d) = self._zone(x, t)
        return np.asarray(self.opening * (a + b * place + d * f))

    def velocity(self, x: Any, t: Any) -> Floats:
        """du/dt, m/s; on a front, the value behind it."""
        return np.asarray(self.opening * self.bar.c / self.bar.length * self._zone(x, t)[2][2])

    def stress(self, x: Any, t: Any) -> Floats:
        """E du/dx, N/m^2, negative in compression; on a front, the value behind it."""
        return np.asarray(self.opening * self.bar.young / self.bar.length * self._zone(x, t)[2][1])

    def scene(self, refinement: int) -> Scene:
        """The bar of `refinement` elements, stretched and held at its right end, and the wall."""
        plain = self.bar.body("bar", refinement)
        stretched = self.displacement_at(plain.mesh.points, 0.0)
        bar = self.bar.body("bar", refinement, displacement=stretched)
        wall = HalfPlane("wall", point=(0.0, 0.0), normal=(1.0, 0.0))
        held = Support("bar", "right", y=False)
        return Scene([bar], [Contact("bar", "wall")], [held, *guided(bar)], [wall])

    def displacement_at(self, points: Any, t: float) -> Floats:
        """Displacement (n, 2) in m of the (n, 2) points of the mesh, m, at t, s."""
        return lengthwise(self.displacement(along(points), t))

    def _zone(self, x: Any, t: Any) -> tuple[Floats, Floats, Floats]:
        """x/L, f and (a, b, d), the latter first."""
        place, transits = np.broadcast_arrays(
            np.asarray(x, dtype=np.float64) / self.bar.length,
            np.asarray(t, dtype=np.float64) * self.bar.c / self.bar.length,
        )
        n = np.floor(transits).astype(np.int64)
        f = transits - n
        zone = (f >= place) + 2 * (f > 1 - place)
        return place, f, np.moveaxis(ZONES[n % 3, zone], -1, 0)
