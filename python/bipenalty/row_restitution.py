"""The discrete restitution map: how fast one row throws back what enters it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from bipenalty import checks
from bipenalty.errors import InputError

Floats = npt.NDArray[np.float64]

#: Most steps a row may stay closed; a decay of 1 - s^2/2 a step is far below round-off by then.
MOST_STEPS = 20_000


def restitution(theta: Any, s: Any, zeta: Any) -> Floats:
    """Exit speed over entry speed of one row in the limit alpha_s -> infinity.

    A row met with relative velocity -v is first seen at g = -theta v dt. In units v = dt = 1 and with
    s = sqrt(R) dt, central differences give

        w' = [(1 - zeta s) w - s^2 g] / (1 + zeta s),    g' = g + w',

    until g >= 0; w is then the restitution e. |e| > 1: contact makes energy though every frequency is inside the
    limit s <= 2. With zeta s = 1 the entering velocity is gone after one step and the gap decays without crossing
    zero: e = 0 for every theta.

    Parameters
    ----------
    theta : phase of entry, -, in (0, 1].
    s : sqrt(R) dt, -, in (0, 2].
    zeta : damping ratio of the penalty mode, -, >= 0.

    Returns
    -------
    e, of the shape the arguments broadcast to; 0 where the row never opens.

    Raises
    ------
    InputError : an argument out of its bounds.

    Example
    -------
    >>> from bipenalty import restitution
    >>> float(restitution(0.3, 1.0, 1.0))
    0.0
    >>> bool(restitution(0.1, np.sqrt(3.6), 0.0) > 1)
    True
    """
    theta, s, zeta = _bounded(theta, s, zeta)
    shape = np.broadcast_shapes(theta.shape, s.shape, zeta.shape)
    gap = np.broadcast_to(-theta, shape).copy().ravel()
    s, zeta = np.broadcast_to(s, shape).ravel(), np.broadcast_to(zeta, shape).ravel()
    velocity, exit_speed, closed = -np.ones(gap.shape), np.zeros(gap.shape), np.arange(gap.size)
    for _ in range(MOST_STEPS):
        velocity = ((1 - zeta * s) * velocity - s**2 * gap) / (1 + zeta * s)
        gap = gap + velocity
        opened = gap >= 0
        # A row whose gap and velocity have both died away stays closed.
        still = np.maximum(np.abs(gap), np.abs(velocity)) > 1e-15
        exit_speed[closed[opened]] = np.where(still[opened], velocity[opened], 0.0)
        keep = ~opened & still
        if not keep.any():
            break
        closed, gap, velocity, s, zeta = (x[keep] for x in (closed, gap, velocity, s, zeta))
    return exit_speed.reshape(shape)


@dataclass(frozen=True)
class RestitutionMap:
    """Largest |e| and mean e^2 over the phase of entry, over s^2 = R dt^2 and zeta.

    s2 : (m,), zeta : (n,), largest : (n, m), mean_square : (n, m).
    """

    s2: Floats
    zeta: Floats
    largest: Floats
    mean_square: Floats


def restitution_map(s2: Any, zeta: Any, phases: int = 400) -> RestitutionMap:
    """Restitution over a grid of s^2 and zeta.

    Parameters
    ----------
    s2 : values of R dt^2, -, each in (0, 4].
    zeta : values of the damping ratio, -, each >= 0.
    phases : how many phases of entry in (0, 1], evenly spread.

    Example
    -------
    >>> chart = restitution_map([1.0, 3.6], [0.0, 1.0])
    >>> float(chart.largest[1, 0]), bool(chart.largest[0, 1] > 2.5)
    (0.0, True)
    """
    s2, zeta = np.atleast_1d(np.asarray(s2, float)), np.atleast_1d(np.asarray(zeta, float))
    theta = (np.arange(checks.whole("restitution_map", "phases", phases, 1)) + 1) / phases
    e = restitution(theta, np.sqrt(s2)[None, :, None], zeta[:, None, None])
    return RestitutionMap(s2, zeta, np.abs(e).max(axis=-1), (e**2).mean(axis=-1))


def _bounded(theta: Any, s: Any, zeta: Any) -> tuple[Floats, Floats, Floats]:
    arrays = []
    bounds = {"theta": (theta, 0.0, 1.0, "in (0, 1]"), "s": (s, 0.0, 2.0, "in (0, 2]: above, R is past 4/dt^2"),
              "zeta": (zeta, -1e-300, np.inf, ">= 0 and finite")}  # fmt: skip
    for name, (value, low, high, bound) in bounds.items():
        array = np.asarray(value, dtype=np.float64)
        bad = ~(np.isfinite(array) & (array > low) & (array <= high))
        if bad.any():
            raise InputError(f"restitution: {name} = {array[bad].flat[0]}, must be {bound}; mend the argument")
        arrays.append(array)
    return arrays[0], arrays[1], arrays[2]
