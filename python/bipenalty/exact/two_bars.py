"""Two bars that collide end to end."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from bipenalty import checks, mesh_checks
from bipenalty.contact import Contact
from bipenalty.exact.bar import Bar, a_bar, along, guided, lengthwise
from bipenalty.exact.collision import collision
from bipenalty.exact.known import Floats
from bipenalty.exact.pulses import Pulsed, Pulses
from bipenalty.scene import Scene


@dataclass(frozen=True)
class TwoBars(Pulsed):
    """A bar at rest that is hit by another, of unlike impedance and length if need be.

         ____________________   v <-  ____________________    left: x in [-L1, 0], at rest
        |__|__|__|__|__|__|__| <---> |__|__|__|__|__|__|__|   right: x in [gap, gap + L2], thrown
                                gap

    At first F = Z1 Z2/(Z1 + Z2) v, until a wave is back from the nearer free end; equal bars then swap velocities.
    What follows until they part is that of `collision`.

    Source: Graff, Wave Motion in Elastic Solids (1975), section 2.4; the waves are those of `Bar`.

    Parameters
    ----------
    left, right : the bars, equally high.
    speed : v, m/s, > 0.
    gap : m, > 0.

    Raises
    ------
    InputError : a value out of its bounds.

    Example
    -------
    >>> [round(float(p), 6) + 0.0 for p in (TwoBars().contact_force(0.5), *TwoBars().momentum(1.0))]
    [150.0, -100.0, 0.0]
    >>> stiff = TwoBars(right=Bar(young=3600.0, length=40.0))
    >>> float(stiff.contact_force(0.5)), round(stiff.release_time, 6)
    (200.0, 0.667767)
    """

    name = "two bars"
    left: Bar = field(default_factory=Bar)
    right: Bar = field(default_factory=Bar)
    speed: float = 10.0
    gap: float = 0.011

    def __post_init__(self) -> None:
        a_bar(self.name, "left", self.left)
        a_bar(self.name, "right", self.right)
        object.__setattr__(self, "speed", mesh_checks.positive(self.name, "speed", self.speed, "give it in m/s"))
        object.__setattr__(self, "gap", mesh_checks.positive(self.name, "gap", self.gap))
        heights = self.left.height, self.right.height
        checks.within(self.name, "heights", heights, heights[0] == heights[1], "equal", "two bars make one section")

    @cached_property
    def pulses(self) -> Pulses:
        """The contact force."""
        return collision(self.left, self.right, self.speed, self.gap)

    @property
    def t_end(self) -> float:
        """Approach, and one and a half times there and back through the slower bar, s."""
        return self.gap / self.speed + 1.5 * max(self.left.round_trip, self.right.round_trip)

    @property
    def speed_of_sound(self) -> float:
        """The larger c, m/s."""
        return max(self.left.c, self.right.c)

    @property
    def energy(self) -> float:
        """m2 v^2/2, J/m."""
        return self.right.mass * self.speed**2 / 2

    @property
    def contact_end(self) -> tuple[str, str]:
        """The left end of the right bar."""
        return "right", "left"

    def momentum(self, t: Any) -> Floats:
        """Momentum of the left and of the right bar along x, N s/m: the shape of t (s) and (2,)."""
        gained = self.impulse_until(t)
        return np.stack([-gained, gained - self.right.mass * self.speed], axis=-1)

    def displacement(self, x: Any, t: Any) -> Floats:
        """u(x, t), m; x (m) before the collision tells the bar; x and t (s) broadcast."""
        on_left, s, when = self._place(x, t)
        right = -self.speed * when + self.right.displacement(np.where(on_left, 0.0, s), when, self.pulses)
        return np.where(on_left, -self.left.displacement(np.where(on_left, s, 0.0), when, self.pulses), right)

    def velocity(self, x: Any, t: Any) -> Floats:
        """du/dt, m/s; on a front, the value behind it."""
        on_left, s, when = self._place(x, t)
        right = -self.speed + self.right.velocity(np.where(on_left, 0.0, s), when, self.pulses)
        return np.where(on_left, -self.left.velocity(np.where(on_left, s, 0.0), when, self.pulses), right)

    def stress(self, x: Any, t: Any) -> Floats:
        """E du/dx, N/m^2, negative in compression; on a front, the value behind it."""
        on_left, s, when = self._place(x, t)
        right = self.right.young * self.right.strain(np.where(on_left, 0.0, s), when, self.pulses)
        left = self.left.young * self.left.strain(np.where(on_left, s, 0.0), when, self.pulses)
        return np.where(on_left, left, right)

    def scene(self, refinement: int) -> Scene:
        """The left bar of `refinement` elements, the right one of elements that a wave takes as long to cross."""
        like = max(1, round(refinement * self.right.round_trip / self.left.round_trip))
        left = self.left.body("left", refinement, x=-self.left.length)
        right = self.right.body("right", like, x=self.gap, velocity=(-self.speed, 0.0))
        return Scene([left, right], [Contact("right", "left")], guided(left, right))

    def displacement_at(self, points: Any, t: float) -> Floats:
        """Displacement (n, 2) in m of the (n, 2) points of the meshes, m, at t, s."""
        return lengthwise(self.displacement(along(points), t))

    def _place(self, x: Any, t: Any) -> tuple[npt.NDArray[np.bool_], Floats, Floats]:
        """Whether x is on the left bar, and how far from the end that is hit; t of the same shape."""
        place, when = np.broadcast_arrays(np.asarray(x, dtype=np.float64), np.asarray(t, dtype=np.float64))
        on_left = place < self.gap / 2
        return on_left, np.where(on_left, -place, place - self.gap), when
