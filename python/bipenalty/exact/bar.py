"""An elastic bar: its constants, its row of quads, and the waves in it when its end is pushed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from bipenalty import checks, mesh_checks
from bipenalty.body import Body
from bipenalty.constraints import Support
from bipenalty.exact.known import Floats
from bipenalty.exact.pulses import Pulses
from bipenalty.materials import LinearElastic
from bipenalty.mesh import rectangle


@dataclass(frozen=True)
class Bar:
    """A bar of elastic material; the defaults are those of Doyen, Ern and Piperno (2011), c = 30 m/s.

    Parameters
    ----------
    length : L, m, > 0.
    young : E, N/m^2, > 0.
    density : rho, kg/m^3, > 0.
    height : A, section per metre of depth, m, > 0.

    Raises
    ------
    InputError : a value out of its bounds.

    With its far end free and the near one (s = 0) pushed by a force F(t), the displacement away from the push is

        w(s, t) = 1/Z sum_{k >= 0} J(t - s/c - kT) + J(t + s/c - (k + 1) T),   J = int F dt,  Z = rho c A,  T = 2L/c,

    d'Alembert's waves that run out from the push and come back (Graff, Wave Motion in Elastic Solids, 1975, chapter 2).

    Example
    -------
    >>> bar = Bar()
    >>> bar.c, bar.impedance, round(bar.round_trip, 6)
    (30.0, 30.0, 0.666667)
    >>> push = Pulses(((0.0, 1.0, 300.0, 300.0),))
    >>> bar.velocity([0.0, 3.0], 0.05, push)  # the front is at 1.5 m
    array([10.,  0.])
    """

    length: float = 10.0
    young: float = 900.0
    density: float = 1.0
    height: float = 1.0

    def __post_init__(self) -> None:
        for each in fields(self):
            value = mesh_checks.positive("bar", each.name, getattr(self, each.name), "give it in SI units")
            object.__setattr__(self, each.name, value)

    @property
    def c(self) -> float:
        """Speed of sound c = sqrt(E/rho), m/s."""
        return float(np.sqrt(self.young / self.density))

    @property
    def impedance(self) -> float:
        """Z = rho c A, kg/s per metre of depth."""
        return self.density * self.c * self.height

    @property
    def round_trip(self) -> float:
        """T = 2L/c of a wave there and back, s."""
        return 2 * self.length / self.c

    @property
    def mass(self) -> float:
        """rho A L, kg per metre of depth."""
        return self.density * self.height * self.length

    def displacement(self, s: Any, t: Any, push: Pulses) -> Floats:
        """w(s, t) away from the push, m; s (m) from the pushed end and t (s) broadcast."""
        out, back = self._waves(s, t, push.impulse)
        return (out + back) / self.impedance

    def velocity(self, s: Any, t: Any, push: Pulses) -> Floats:
        """dw/dt, m/s; on a front, the value behind it."""
        out, back = self._waves(s, t, push.force)
        return (out + back) / self.impedance

    def strain(self, s: Any, t: Any, push: Pulses) -> Floats:
        """dw/ds, negative in compression, -; on a front, the value behind it."""
        out, back = self._waves(s, t, push.force)
        return (back - out) / (self.impedance * self.c)

    def body(self, name: str, elements: int, x: float = 0.0, **start: Any) -> Body:
        """One row of quads from x (m) on with nu = 0, which moves as a bar; `start` goes to the `Body`."""
        mesh = rectangle(self.length, self.height, elements, 1, origin=(x, 0.0))
        return Body(name, mesh, LinearElastic(self.young, 0.0, self.density), **start)

    def _waves(self, s: Any, t: Any, of: Callable[[Any], Floats]) -> tuple[Floats, Floats]:
        """Sums over the round trips of the wave on its way out, and on its way back."""
        place, when = np.broadcast_arrays(np.asarray(s, dtype=np.float64), np.asarray(t, dtype=np.float64))
        off = np.abs(place / self.length - 0.5).max(initial=0.0) * self.length - self.length / 2
        remedy = "give coordinates before deformation"
        checks.within("bar", "distance past an end", off, off <= 1e-9 * self.length, "0 m", remedy)
        out, back = np.zeros(place.shape), np.zeros(place.shape)
        for k in range(int(np.ceil(when.max(initial=0.0) / self.round_trip)) + 1):
            out += of(when - place / self.c - k * self.round_trip)
            back += of(when + place / self.c - (k + 1) * self.round_trip)
        return out, back


def a_bar(owner: str, name: str, value: Any) -> None:
    """Raise unless `value` is a Bar."""
    what = type(value).__name__
    checks.within(owner, name, what, isinstance(value, Bar), "a Bar", "make one with bipenalty.exact.Bar(length)")


def guided(*bodies: Body) -> list[Support]:
    """Supports that keep every node on its line y = const., so that round-off cannot bend a bar; free of cost."""
    return [Support(body.name, range(body.mesh.n_nodes), x=False) for body in bodies]


def along(points: Any) -> Floats:
    """The x coordinates of (n, 2) points, m."""
    array = np.asarray(points, dtype=np.float64)
    ok = array.ndim == 2 and array.shape[1] == 2
    checks.within("displacement_at", "shape of points", array.shape, ok, "(n, 2)", "give the points of the result")
    return array[:, 0]


def lengthwise(u: Floats) -> Floats:
    """Displacements along x (n,) as (n, 2)."""
    return np.column_stack([u, np.zeros_like(u)])
