"""Limits of the time step as numbers, and what they leave for the stiffness penalty."""

from __future__ import annotations

import math
from dataclasses import dataclass

from bipenalty import _core, checks

#: Share of the limit a time step takes unless it is given.
SAFETY = {"element": 0.5, "assembled": 0.98}


@dataclass(frozen=True)
class CriticalStep:
    """Critical time steps of a model, s: central differences are stable up to the one that governs.

    Attributes
    ----------
    element : 2/omega_max of the elements, a lower bound (Irons and Fried 1971).
    assembled : 2/omega_max of the assembled matrix, from an upper bound of its largest frequency by Lanczos
        iteration (Kuczynski and Wozniakowski 1992), 0.5 % below the exact limit at most.
    rows : the same with the rows of the last step active for good; equal to `assembled` without any.
    dt : the time step in use.

    Example
    -------
    >>> limits = CriticalStep(element=2e-4, assembled=2.4e-4, rows=1.8e-4, dt=1e-4)
    >>> limits.governs, round(limits.growth, 6)
    ('active rows', 1.8)
    """

    element: float
    assembled: float
    rows: float
    dt: float

    @property
    def governs(self) -> str:
        """Which limit is the one to keep: "mesh", or "active rows" where they lower it."""
        return "active rows" if self.rows < 0.999 * self.assembled else "mesh"

    @property
    def growth(self) -> float:
        """Factor by which dt may grow."""
        return min(self.assembled, self.rows) / self.dt


def time_step(core: _core.Model, dt: str | float, safety: float | None) -> float:
    """The time step asked for, s: a share of one of the mesh's limits, or seconds.

    Parameters
    ----------
    core : the lowered scene.
    dt : "element" or "assembled", or a step in s (then `safety` is not used).
    safety : -, in (0, 1]; 0.5 of "element" or 0.98 of "assembled" unless given.

    Raises
    ------
    InputError : a value out of its bounds.
    """
    if isinstance(dt, str):
        known = dt in SAFETY
        checks.within("model", "dt", repr(dt), known, '"element", "assembled" or a number of seconds', "correct it")
        factor = SAFETY[dt] if safety is None else checks.number("model", "safety", safety)
        checks.within("model", "safety", factor, 0 < factor <= 1, "in (0, 1]", "leave it out for the usual share")
        return factor * (core.critical_dt if dt == "element" else core.assembled_critical_dt())
    step = checks.number("model", "dt", dt)
    remedy = 'give seconds, or "element" or "assembled"'
    checks.within("model", "dt", step, 0 < step < math.inf, "> 0 and finite", remedy)
    return step


def critical_ps(assembled: float, stiffening: float, dt: float) -> float:
    """Stiffness penalty factor up to which omega_0^2 + p_s lambda_max(E^1/2 G M^-1 G' E^1/2) stays within 4/dt^2, -.

    Parameters
    ----------
    assembled : critical time step of the mesh 2/omega_0, s.
    stiffening : lambda_max(E^1/2 G M^-1 G' E^1/2), N/m^2 per kg.
    dt : time step, s.

    A lower bound on what is stable for a fixed active set (Belytschko and Neal 1991); 0 when dt is past the mesh's
    own limit.

    Example
    -------
    >>> critical_ps(assembled=2.0, stiffening=3.0, dt=1.0)
    1.0
    """
    if stiffening <= 0:
        return math.inf
    return max(0.0, (4 / dt**2 - 4 / assembled**2) / stiffening)
