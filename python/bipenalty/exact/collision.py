"""The force between two bars that collide, followed from one returning wave to the next."""

from __future__ import annotations

import numpy as np

from bipenalty.exact.bar import Bar
from bipenalty.exact.pulses import Pulses

#: Less than this share of the speed or the round trip is round-off.
ROUND_OFF = 1e-9


def collision(left: Bar, right: Bar, speed: float, gap: float) -> Pulses:
    """Contact force of two free bars that approach at `speed` (m/s) over `gap` (m).

    Without contact the ends would approach at

        v(t) = speed - sum_i 2/Z_i sum_{k >= 1} F(t - k T_i),

    from the waves that are back. As long as they touch F = v/(1/Z1 + 1/Z2), constant between the returns of earlier
    jumps of F, so nothing is approximated. Contact ends when that is no longer compression, within the longer round
    trip, and for good: waves from free ends only draw the bars apart. (The last is not proved here but tested on
    random pairs of bars, as is all else by the laws it must fulfil.)

    Source: Graff, Wave Motion in Elastic Solids (1975), section 2.4, up to the first return; the rest is derived.

    Example
    -------
    >>> soft, stiff = Bar(), Bar(young=3600.0)
    >>> [tuple(round(float(v), 4) for v in line) for line in collision(soft, stiff, 10.0, 0.01).lines]
    [(0.001, 0.3343, 200.0, 200.0), (0.3343, 0.6677, 66.6667, 66.6667)]
    """
    bars, lines, jumps = (left, right), list[tuple[float, float, float, float]](), list[float]()
    now, force = gap / speed, 0.0
    while True:
        after = min(_return(jump, bar.round_trip, now) for jump in [now, *jumps] for bar in bars)
        approach = speed - sum(_recoil(bar, (now + after) / 2, Pulses(tuple(lines))) for bar in bars)
        if approach <= ROUND_OFF * speed:
            return Pulses(tuple(lines))
        before, force = force, approach / (1 / left.impedance + 1 / right.impedance)
        if force != before:
            jumps.append(now)
        lines.append((now, after, force, force))
        now = after


def _return(jump: float, round_trip: float, now: float) -> float:
    """When the wave of a jump is next back, s."""
    return jump + round_trip * (int((now - jump) / round_trip + ROUND_OFF) + 1)


def _recoil(bar: Bar, t: float, push: Pulses) -> float:
    """Velocity away from the other bar that the returned waves give an end, m/s."""
    back = t - bar.round_trip * np.arange(1, int(t / bar.round_trip) + 1)
    return 2 / bar.impedance * float(push.force(back).sum())
