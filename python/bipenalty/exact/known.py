"""What a benchmark with a known answer offers, the same for all, so that a study can loop over them."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from bipenalty.scene import Scene

Floats = npt.NDArray[np.float64]

#: When contact closes and opens, s.
Intervals = tuple[tuple[float, float], ...]


class Known(Protocol):
    """A scene whose solution is known; what has no meaning for a benchmark is None.

    A run of `scene(refinement)` compares as follows:

    | of the `Result` | exact |
    |---|---|
    | `contact_force` at `time`, N/m | `contact_force(t)`, or its impulse over any interval by `impulse_until(t)` |
    | `impulse`, N s/m | `impulse` |
    | `displacement` of a snapshot at `snapshot_time`, m | `displacement_at(result.points, t)` |
    | sum of kinetic and strain energy and load potential, J/m | `energy` |

    Forces are total, per metre of depth: on a bar, pressure times height.

    Example
    -------
    >>> import bipenalty as bp
    >>> for known in bp.exact.BENCHMARKS:
    ...     print(f"{known.name}: {known.impulse or np.nan:.4g} N s/m by {known.t_end:.4g} s, {known.energy:.4g} J/m")
    thrown bar: 200 N s/m by 1.833 s, 500 J/m
    bouncing bar: 533.3 N s/m by 5.333 s, 500 J/m
    Signorini bar: 1 N s/m by 6 s, 0.125 J/m
    two bars: 100 N s/m by 1.001 s, 500 J/m
    Hertz disc: nan N s/m by 0.09487 s, 0.1571 J/m
    """

    @property
    def name(self) -> str:
        """What tables and legends call it."""

    @property
    def t_end(self) -> float:
        """End of a run that shows everything once, s."""

    @property
    def speed_of_sound(self) -> float:
        """The largest speed of a wave, m/s."""

    @property
    def energy(self) -> float:
        """Kinetic and strain energy and load potential as a `Result` counts them, J/m; constant."""

    @property
    def impulse(self) -> float | None:
        """Impulse of the contact force up to t_end, N s/m."""

    @property
    def contact_intervals(self) -> Intervals | None:
        """When contact closes and opens up to t_end, s."""

    @property
    def release_time(self) -> float | None:
        """When contact opens for the first time, s."""

    @property
    def contact_end(self) -> tuple[str, str]:
        """Body that comes into contact, and the boundary of its mesh that does."""

    def scene(self, refinement: int) -> Scene:
        """The scene; `refinement` counts the elements of a bar, or the segments on the rim of a disc."""

    def contact_force(self, t: Any) -> Floats | None:
        """Contact force, N/m, of the shape of t (s); at a jump, the value after it."""

    def impulse_until(self, t: Any) -> Floats | None:
        """Impulse of the contact force from 0 to t, N s/m, of the shape of t (s)."""

    def displacement_at(self, points: Any, t: float) -> Floats | None:
        """Displacement (n, 2) in m of the (n, 2) points of the meshes, m, at a time t, s."""
