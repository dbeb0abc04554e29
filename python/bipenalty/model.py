"""A model: a scene with a method and a time step, ready to step or to run."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable
from typing import Any

import numpy as np

from bipenalty import _core, checks, progress
from bipenalty.critical_step import CriticalStep, critical_ps, time_step
from bipenalty.errors import InputError, RunError
from bipenalty.lower import lower
from bipenalty.methods import Bipenalty, Method
from bipenalty.methods.method import by_penalty, penalty_ratio
from bipenalty.result import Result
from bipenalty.result_dataset import run_dataset
from bipenalty.scene import Scene

FloatArray = np.ndarray[Any, np.dtype[np.float64]]

#: Seconds that the core works before it lets the interpreter look at signals and the progress bar.
SLICE = 0.05


class Model:
    """A scene advanced by central differences with one penalty method.

    Parameters
    ----------
    scene : what there is.
    method : how contact is enforced.
    dt : "element" or "assembled" for `safety` times that limit of the mesh, or seconds.
    safety : share of the limit, in (0, 1]; 0.5 of "element" and 0.98 of "assembled" unless given.
    allow_unstable : accept a dt above the mesh's limit.
    isa : instruction set, "auto" or one of `_core.instruction_sets()`: a run is the same to the last bit on every
        machine that has it.
    threads : threads that share each step; all processors from 50,000 nodes on, else one, unless given.

    Raises
    ------
    InputError : anything in the scene, the method or dt that is out of its bounds.

    Example
    -------
    >>> import bipenalty as bp
    >>> bar = bp.Body("bar", bp.mesh.rectangle(10, 1, 20, 1), bp.LinearElastic(900, 0, 1), velocity=(-10, 0))
    >>> wall = bp.HalfPlane("wall", point=(-1, 0), normal=(1, 0))
    >>> scene = bp.Scene([bar], contacts=[bp.Contact("bar", "wall")], obstacles=[wall])
    >>> result = bp.Model(scene, bp.Bipenalty(ps=1.0)).run(1.0)
    >>> result.outcome
    'finished'
    """

    def __init__(
        self,
        scene: Scene,
        method: Method | None = None,
        dt: str | float = "element",
        safety: float | None = None,
        allow_unstable: bool = False,
        isa: str = "auto",
        threads: int | None = None,
    ) -> None:
        self.scene = scene
        self.method: Method = checks.method("model", "method", Bipenalty() if method is None else method)
        self._core = lower(scene)
        self.critical_dt: float = self._core.critical_dt
        self.dt = time_step(self._core, dt, safety)
        start = (scene.velocity, scene.displacement)
        crew = None if threads is None else checks.whole("model", "threads", threads, 1)
        self._run = _core.Run(self._core, self.method, self.dt, allow_unstable, *start, isa, crew)
        self._seconds = 0.0

    @property
    def time(self) -> float:
        """Time t_n, s."""
        return self._run.time

    @property
    def steps(self) -> int:
        """Steps taken."""
        return self._run.steps

    @property
    def R(self) -> float:
        """Penalty ratio, 1/s^2; infinite without a mass penalty."""
        return penalty_ratio(self.method, self.dt)

    def critical_step(self) -> CriticalStep:
        """Limits of the time step: elements, assembled matrix, and the rows active in the last step.

        Rows of multipliers cost none: they take degrees of freedom away and add no stiffness. Nor do those of the
        predictor-corrector, whose own limit does not depend on dt (see its docstring).
        """
        mesh = self._core.assembled_critical_dt()
        # A ratio that follows the time step keeps omega^2 <= max(omega_0^2, R) at every one: rows cost nothing.
        limit = 4 / self.dt**2
        follows = self.method.mass_rule[0] in ("ratio from step", "critical") and limit >= self.R
        costly = by_penalty(self.method) and not follows
        rows = self._run.active_limits()[0] if self._run.rows and costly else mesh
        return CriticalStep(self.critical_dt, mesh, min(mesh, rows), self.dt)

    def critical_ps(self, dt: float | None = None) -> float:
        """Stiffness penalty factor up to which the stiffness method is stable at a time step, -; whatever the model's.

        Parameters
        ----------
        dt : s; the model's own unless given.

        With rows active in the last step it speaks of those; before any, of the worst single row that the two
        lightest surface nodes can make. A fixed active set is stable below it (see `critical_step.critical_ps`).
        """
        rows = self._run.active_limits()[1] if self._run.rows else self._core.worst_stiffening()
        step = self.dt if dt is None else checks.number("critical_ps", "dt", dt)
        checks.within("critical_ps", "dt", step, 0 < step < math.inf, "> 0 and finite", "give seconds")
        return critical_ps(self._core.assembled_critical_dt(), rows, step)

    @property
    def displacement(self) -> FloatArray:
        """Displacement u_n, read-only (N, 2) view (a copy where nodes were renumbered), m; ask again after a step."""
        return self._run.displacement

    @property
    def velocity(self) -> FloatArray:
        """Velocity v_{n-1/2}, read-only (N, 2) view (a copy where nodes were renumbered), m/s; ask again after a step."""
        return self._run.velocity

    @property
    def outcome(self) -> str:
        """ "running", or how the run has ended."""
        return self._run.outcome

    def step(self, n: int = 1) -> None:
        """Advance n steps in place.

        Raises
        ------
        InputError : n is not a whole number >= 0.
        RunError : the state has diverged; the message says why.
        """
        if self._advance(checks.whole("step", "n", n, 0), False, last=False):
            raise KeyboardInterrupt
        if self._run.outcome != "running":
            raise RunError(f"{self._run.outcome}: {self._run.reason}", self.result())

    def run(
        self,
        t_end: float,
        *,
        snapshots: Iterable[float] = (),
        every: int = 1,
        energy_every: int = 10,
        displacement_limit: float | None = None,
        show_progress: bool | None = None,
        throw: bool = False,
    ) -> Result:
        """Run until t_end and return what was observed; Ctrl-C stops within a second and keeps what there is.

        Parameters
        ----------
        t_end : s, after the present time.
        snapshots : times (s) at which displacement and velocity are kept, at the nearest step.
        every : contact histories every so many steps.
        energy_every : energies every so many steps, and at the last.
        displacement_limit : m; a run that passes it ends there with that outcome.
        show_progress : None for a bar on a terminal only.
        throw : raise a RunError that carries the result unless the run finished (or was interrupted).

        Returns
        -------
        Result, whatever the outcome: `result.outcome` and `result.reason` say how it ended.
        """
        steps = self._steps_to(t_end)
        strides = checks.whole("run", "every", every, 1), checks.whole("run", "energy_every", energy_every, 1)
        kept = sorted({self._nearest_step(t, t_end, steps) for t in checks.sequence("run", "snapshots", snapshots)})
        limit = math.inf if displacement_limit is None else displacement_limit
        self._run.configure(*strides, kept, checks.number("run", "displacement_limit", limit), steps)
        interrupted = self._advance(steps, show_progress)
        result = self.result(interrupted=interrupted)
        if throw and result.outcome not in ("finished", "interrupted"):
            raise RunError(f"{result.outcome}: {result.reason}", result)
        return result

    def _steps_to(self, t_end: float) -> int:
        end = checks.number("run", "t_end", t_end)
        checks.within(
            "run",
            "t_end",
            end,
            self.time < end < math.inf,
            f"finite and after now ({self.time:g} s)",
            "give a later time",
        )
        steps = (end - self.time) / self.dt
        checks.within(
            "run", "t_end", end, steps < 2**53, f"at most 2^53 steps of {self.dt:g} s away", "give a nearer time"
        )
        return max(1, math.ceil(steps - 1e-9))

    def _nearest_step(self, t: float, t_end: float, steps: int) -> int:
        when = checks.number("run", "snapshot", t)
        checks.within(
            "run",
            "snapshot",
            when,
            self.time <= when <= t_end * (1 + 1e-9),
            f"between now ({self.time:g} s) and t_end ({t_end:g} s)",
            "choose times within the run",
        )
        return min(round(when / self.dt), self.steps + steps - 1)

    def _advance(self, steps: int, show: bool | None, last: bool = True) -> bool:
        """Work in slices short enough for Ctrl-C; true when interrupted. The last step is sampled if `last`."""
        done, chunk = 0, 64
        try:
            with progress.bar(steps, "step", "run", show) as bar:
                while done < steps and self._run.outcome == "running":
                    n = min(chunk, steps - done)
                    start = time.perf_counter()
                    self._run.advance(n, last and done + n == steps)
                    elapsed = time.perf_counter() - start
                    self._seconds += elapsed
                    done += n
                    bar.update(n)
                    chunk = max(1, min(4 * chunk, int(chunk * SLICE / max(elapsed, 1e-6))))
        except KeyboardInterrupt:
            return True
        return False

    def result(self, interrupted: bool = False) -> Result:
        """What has been observed so far."""
        if self.steps == 0 and not interrupted and self.outcome == "running":
            raise InputError("result: number of steps = 0, must be >= 1; step or run first")
        seen = self._run.observations()
        seen["seconds"] = self._seconds
        if interrupted and not seen["stopped"]:
            seen["outcome"], seen["reason"] = "interrupted", f"stopped by the user at t = {self.time:.4g} s"
        elif seen["outcome"] == "running":
            seen["outcome"] = "finished"
        return Result(run_dataset(self, self._core, seen))
