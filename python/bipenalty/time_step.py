"""The time step asked for, from the limits of the model."""

from __future__ import annotations

import math

from bipenalty import checks


def time_step(critical_dt: float, dt: str | float, safety: float) -> float:
    """The time step asked for: "element" is `safety` times the critical step of the elements.

    Parameters
    ----------
    critical_dt : 2/omega_max of the elements, s (Irons and Fried 1971).
    dt : "element", or a step in s (then `safety` is not used).
    safety : -, in (0, 1].

    Example
    -------
    >>> time_step(2e-4, "element", 0.5)
    0.0001
    """
    if isinstance(dt, str):
        checks.within("model", "dt", repr(dt), dt == "element", '"element" or a number of seconds', "correct it")
        factor = checks.number("model", "safety", safety)
        checks.within("model", "safety", factor, 0 < factor <= 1, "in (0, 1]", "0.5 leaves room for contact")
        return factor * critical_dt
    step = checks.number("model", "dt", dt)
    checks.within("model", "dt", step, 0 < step < math.inf, "> 0 and finite", 'give seconds, or "element"')
    return step
