"""Contact forces that rise and fall in straight lines, and what every benchmark with one takes from them."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np

from bipenalty.exact.known import Floats, Intervals


@dataclass(frozen=True)
class Pulses:
    """A force F(t) of straight lines, zero elsewhere, and repeated with a period if one is given.

    Parameters
    ----------
    lines : (start, end, force after start, force before end) each, s and N/m, in order and apart.
    period : s; infinite for a force that is not repeated.

    Example
    -------
    >>> pulse = Pulses(((1.0, 2.0, 300.0, 500.0),))
    >>> pulse.force([0.5, 1.0, 1.5, 2.0]), pulse.impulse([1.0, 1.5, 9.0])
    (array([  0., 300., 400.,   0.]), array([  0., 175., 400.]))
    """

    lines: tuple[tuple[float, float, float, float], ...]
    period: float = np.inf

    def force(self, t: Any) -> Floats:
        """F(t), N/m, right-continuous."""
        _, within = self._fold(t)
        total = np.zeros_like(within)
        for start, end, first, last in self.lines:
            share = (within - start) / (end - start)
            total += np.where((share >= 0) & (share < 1), first + (last - first) * share, 0.0)
        return total

    def impulse(self, t: Any) -> Floats:
        """J(t), the integral of F from 0 to t, N s/m."""
        periods, within = self._fold(t)
        total = periods * sum((end - start) * (first + last) / 2 for start, end, first, last in self.lines)
        for start, end, first, last in self.lines:
            share = (np.clip(within, start, end) - start) / (end - start)
            total += (end - start) * share * (first + (last - first) * share / 2)
        return total

    def intervals(self, until: float) -> Intervals:
        """When the force acts up to a time, s; lines that follow each other without a pause are one."""
        found: list[tuple[float, float]] = []
        for n in range(1 if np.isinf(self.period) else int(np.ceil(until / self.period))):
            shift = n * self.period if n else 0.0
            for start, end, *_ in self.lines:
                if found and start + shift == found[-1][1]:
                    found[-1] = (found[-1][0], end + shift)
                elif start + shift < until:
                    found.append((start + shift, end + shift))
        return tuple(found)

    def _fold(self, t: Any) -> tuple[Floats, Floats]:
        """Whole periods passed, and the time since."""
        when = np.asarray(t, dtype=np.float64)
        if np.isinf(self.period):
            return np.zeros_like(when), when.copy()
        periods = np.floor(when / self.period)
        return periods, when - periods * self.period


class Pulsed:
    """Base of benchmarks whose contact force is known as `Pulses`."""

    @property
    @abstractmethod
    def pulses(self) -> Pulses:
        """The contact force, N/m."""

    @property
    @abstractmethod
    def t_end(self) -> float:
        """End of a run that shows everything once, s."""

    def contact_force(self, t: Any) -> Floats:
        """Contact force F(t), N/m, of the shape of t (s); at a jump, the value after it."""
        return self.pulses.force(t)

    def impulse_until(self, t: Any) -> Floats:
        """Impulse of the contact force from 0 to t, N s/m, of the shape of t (s)."""
        return self.pulses.impulse(t)

    @property
    def impulse(self) -> float:
        """Impulse of the contact force up to t_end, N s/m."""
        return float(self.impulse_until(self.t_end))

    @property
    def contact_intervals(self) -> Intervals:
        """When contact closes and opens up to t_end, s."""
        return self.pulses.intervals(self.t_end)

    @property
    def release_time(self) -> float:
        """When contact opens for the first time, s."""
        return self.contact_intervals[0][1]
