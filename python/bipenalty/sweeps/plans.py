"""Plans: from a place in the grid to what one run is to do."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from bipenalty import _core, checks
from bipenalty.critical_step import SAFETY, time_step
from bipenalty.errors import InputError
from bipenalty.sweeps.axes import Axis
from bipenalty.sweeps.core_batch import scaled_limit

Index = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Plan:
    """One run: method, time step (s), steps, and what it changes of the scene, a list with one entry a body.

    Attributes
    ----------
    velocity : m/s, replaces the body's initial velocity; None for a body that keeps it.
    offset : m, moves the body before the start.
    young, density : factors, -.
    refused : why the run cannot start; empty for one that can.
    """

    method: Any
    dt: float
    steps: int
    velocity: list[tuple[float, float] | None] | None = None
    offset: list[tuple[float, float]] | None = None
    young: list[float] | None = None
    density: list[float] | None = None
    refused: str = ""


class Plans:
    """All plans of a sweep, made one by one when asked for: a million of them take no memory.

    Parameters
    ----------
    core : the lowered scene.
    axes : what varies.
    bodies : number of bodies.
    method : class or instance whose parameters vary, or None with an axis of methods.
    t_end, dt, safety : as for `sweep`, where no axis says otherwise.

    Raises
    ------
    InputError : something that does not vary and is out of its bounds.
    """

    def __init__(
        self,
        core: _core.Model,
        axes: Sequence[Axis],
        bodies: int,
        method: Any,
        t_end: float | None,
        dt: str | float,
        safety: float | None,
    ) -> None:
        self.core, self.axes, self.bodies, self.method = core, tuple(axes), bodies, method
        self.dt, self.safety = dt, safety
        kinds = {axis.kind for axis in axes}
        self.t_end = None if "t_end" in kinds else end_time(t_end)
        self._made: dict[Index, Any] = {}
        self._steps: dict[Index, float] = {}
        if "dt" not in kinds:
            step = time_step(core, dt, safety)
            scaled = {"young", "density"} if isinstance(dt, str) else set()
            if self.t_end is not None and not scaled & kinds:
                steps_to(self.t_end, step)

    def axes_of(self, *kinds: str) -> list[int]:
        """Places of the axes of some kinds."""
        return [i for i, axis in enumerate(self.axes) if axis.kind in kinds]

    @property
    def step_axes(self) -> list[int]:
        """Places of the axes along which the time step differs."""
        if self.axes_of("dt"):
            return self.axes_of("dt")
        return self.axes_of("young", "density") if isinstance(self.dt, str) else []

    def plan(self, index: Index) -> Plan:
        """The plan of one place of the grid; one that is out of bounds says so in `refused`."""
        try:
            young, density = self._factors(index, "young"), self._factors(index, "density")
            method, dt = self._method_of(index), self.step_of(index)
            steps = steps_to(self._end_of(index), dt)
        except InputError as error:
            return Plan(None, math.nan, 0, refused=str(error))
        moved = self._of_bodies(index, "offset", (0.0, 0.0))
        return Plan(method, dt, steps, self._of_bodies(index, "velocity", None), moved, young, density)

    def step_of(self, index: Index) -> float:
        """Time step (s) of one place: as given, or by the rule for the bodies as scaled there.

        Raises
        ------
        InputError : a step or a factor out of its bounds.
        """
        key = tuple(index[i] for i in self.step_axes)
        if key not in self._steps:
            self._steps[key] = self._step(index)
        return self._steps[key]

    def _step(self, index: Index) -> float:
        if chosen := self.axes_of("dt"):
            return time_step(self.core, self.axes[chosen[0]].values[index[chosen[0]]], None)
        if not self.step_axes or not isinstance(self.dt, str):
            return time_step(self.core, self.dt, self.safety)
        ones = [1.0] * self.bodies
        young, density = self._factors(index, "young") or ones, self._factors(index, "density") or ones
        share = SAFETY[self.dt] if self.safety is None else self.safety
        return share * scaled_limit(self.core, self.dt, young, density)

    def _end_of(self, index: Index) -> float:
        if self.t_end is not None:
            return self.t_end
        place = self.axes_of("t_end")[0]
        return end_time(self.axes[place].values[index[place]])

    def _method_of(self, index: Index) -> Any:
        key = tuple(index[i] for i in self.axes_of("method", "parameter"))
        if key not in self._made:
            self._made[key] = self._make(index)
        return self._made[key]

    def _make(self, index: Index) -> Any:
        if chosen := self.axes_of("method"):
            return self.axes[chosen[0]].values[index[chosen[0]]]
        values = {self.axes[i].dim: self.axes[i].values[index[i]] for i in self.axes_of("parameter")}
        return self.method(**values) if isinstance(self.method, type) else dataclasses.replace(self.method, **values)

    def _factors(self, index: Index, kind: str) -> list[float] | None:
        factors: list[float] | None = self._of_bodies(index, kind, 1.0)
        for factor in factors or []:
            checks.within("grid", f"factor on {kind}", factor, 0 < factor < math.inf, "> 0 and finite", "correct it")
        return factors

    def _of_bodies(self, index: Index, kind: str, otherwise: Any) -> Any:
        chosen = self.axes_of(kind)
        if not chosen:
            return None
        values = [otherwise] * self.bodies
        for i in chosen:
            values[self.axes[i].body] = self.axes[i].values[index[i]]
        return values


def end_time(t_end: Any) -> float:
    """`t_end` in s, checked."""
    end = checks.number("sweep", "t_end", t_end)
    checks.within("sweep", "t_end", end, 0 < end < math.inf, "> 0 and finite", "give the time to run to")
    return end


def steps_to(end: float, dt: float) -> int:
    """Number of steps that reach a time, both in s."""
    checks.within("sweep", "t_end", end, end / dt < 2**53, f"at most 2^53 steps of {dt:g} s", "give a nearer time")
    return max(1, math.ceil(end / dt - 1e-9))
