"""A sweep: one scene, many methods, one dataset."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
import xarray as xr

from bipenalty import _core, checks, progress
from bipenalty.critical_step import time_step
from bipenalty.errors import InputError
from bipenalty.lower import lower
from bipenalty.methods import Method
from bipenalty.model import SLICE
from bipenalty.result_dataset import method_attributes, package_version
from bipenalty.scene import Scene

#: name: (unit, long name) of what every run of a sweep leaves behind.
SUMMARY = {
    "max_penetration": ("m", "deepest penetration of the run"),
    "max_displacement": ("m", "largest displacement of the run"),
    "peak_force": ("N/m", "largest total contact force"),
    "impulse": ("N s/m", "impulse of the total contact force"),
    "energy_ratio": ("1", "total energy at the end over that at the start"),
    "energy_made": ("1", "most energy that contact had added, over what there was"),
    "steps": ("1", "steps taken"),
    "seconds": ("s", "time the run took"),
}


def sweep(
    scene: Scene,
    methods: Sequence[Method],
    t_end: float,
    *,
    dt: str | float = "element",
    safety: float | None = None,
    allow_unstable: bool = False,
    displacement_limit: float | None = None,
    histories: bool = True,
    threads: int | None = None,
    lanes: int = 0,
    show_progress: bool | None = None,
) -> xr.Dataset:
    """Run a scene with each method; a failed run is a labelled entry, never an exception for the rest.

    Parameters
    ----------
    scene, dt, safety, allow_unstable : as for `Model`; the mesh is lowered once for all runs.
    methods : penalty methods.
    t_end : s, > 0.
    displacement_limit : m; a run that passes it has failed and ends there.
    histories : keep contact force and penetration of every step (16 bytes a run and step), else peaks only.
    threads : how many; all processors unless given.
    show_progress : None for a bar on a terminal only.

    Returns
    -------
    Dataset over `run` (coordinates method, ps, R, D, zeta) with the peaks, `outcome` and `reason`, `failed` (ended
    before t_end by itself) and `finished` (got there, whatever its energy), and over `run` and `time` the histories,
    NaN after an early end. Ctrl-C returns what there is.

    Example
    -------
    >>> import bipenalty as bp
    >>> bar = bp.Body("bar", bp.mesh.rectangle(1, 1, 4, 4), bp.LinearElastic(900, 0, 1), velocity=(-1, 0))
    >>> wall = bp.HalfPlane("wall", point=(0, 0), normal=(1, 0))
    >>> scene = bp.Scene([bar], contacts=[bp.Contact("bar", "wall")], obstacles=[wall])
    >>> bp.sweep(scene, [bp.Stiffness(1.0), bp.Bipenalty(1.0)], t_end=0.1).sizes["run"]
    2
    """
    methods = [
        checks.method("sweep", f"methods[{i}]", m) for i, m in enumerate(checks.sequence("sweep", "methods", methods))
    ]
    checks.within("sweep", "number of methods", 0, len(methods) > 0, ">= 1", "give at least one method")
    workers = os.cpu_count() or 1 if threads is None else checks.whole("sweep", "threads", threads, 1)
    end = checks.number("sweep", "t_end", t_end)
    checks.within("sweep", "t_end", end, 0 < end < math.inf, "> 0 and finite", "give the time to run to")
    core = lower(scene)
    step = time_step(core, dt, safety)
    checks.within("sweep", "t_end", end, end / step < 2**53, f"at most 2^53 steps of {step:g} s", "give a nearer time")
    n = max(1, math.ceil(end / step - 1e-9))
    limit = None if displacement_limit is None else checks.number("sweep", "displacement_limit", displacement_limit)
    batch = _core.Batch(
        core,
        [SimpleNamespace(method=m, dt=step, steps=n, velocity=None, offset=None, young=None, density=None) for m in methods],
        scene.velocity,
        scene.displacement,
        allow_unstable=allow_unstable,
        displacement_limit=limit,
        every=int(histories),
        lanes=lanes,
    )
    interrupted = _work(batch, len(methods) * n * scene.n_nodes, min(workers, len(methods)), show_progress)
    attributes = {
        "dt": step,
        "critical_dt": core.critical_dt,
        "t_end": end,
        "version": package_version(),
        "displacement_limit": math.inf if limit is None else limit,
        "interrupted": int(interrupted),
    }
    seen = [batch.observations(i) for i in range(len(methods))]
    if first := next((run for run in seen if run and run["outcome"] == "refused"), None):
        raise InputError(first["reason"])
    return _dataset(seen, methods, step, n, histories, attributes)


def _work(batch: _core.Batch, node_steps: int, threads: int, show: bool | None) -> bool:
    """Work in slices short enough for Ctrl-C; true when interrupted."""
    try:
        with progress.bar(node_steps, "node-step", "sweep", show) as bar:
            while batch.finished < len(batch):
                bar.update(batch.advance(threads, SLICE))
                bar.set_postfix_str(f"{batch.finished}/{len(batch)} runs", refresh=False)
    except KeyboardInterrupt:
        return True
    return False


def _dataset(
    seen: list[dict[str, Any] | None],
    methods: list[Method],
    dt: float,
    steps: int,
    histories: bool,
    attributes: dict[str, Any],
) -> xr.Dataset:
    lost: dict[str, Any] = dict.fromkeys(SUMMARY, math.nan) | {
        "outcome": "lost",
        "reason": "its thread died",
        "planned_steps": 0,
        "stopped": True,
    }
    runs = [lost if s is None else s for s in seen]
    ended = [_outcome(run) for run in runs]
    labels = [method_attributes(m, dt) for m in methods]
    coords: dict[str, Any] = {key: ("run", [label[key] for label in labels]) for key in labels[0]}
    coords["D"] = ("run", coords["D"][1], {"units": "s", "long_name": "damping penalty factor"})
    coords["R"] = ("run", coords["R"][1], {"units": "s-2", "long_name": "penalty ratio"})
    data: dict[str, Any] = {
        name: ("run", np.array([run[name] for run in runs], dtype=float), {"units": unit, "long_name": about})
        for name, (unit, about) in SUMMARY.items()
    }
    data["outcome"] = ("run", ended)
    data["reason"] = ("run", [str(run["reason"]) for run in runs])
    data["failed"] = ("run", np.array([bool(run["stopped"]) for run in runs]))
    data["finished"] = ("run", np.array([not run["stopped"] and run["steps"] >= run["planned_steps"] for run in runs]))
    if histories:
        # As long as the longest run: one of them may have been stopped long before its end.
        steps = min(
            steps, max((1 + int(run["time_step"][-1]) for run in seen if run and len(run["time_step"])), default=0)
        )
        coords["time"] = ("time", np.arange(steps) * dt, {"units": "s", "long_name": "time"})
        for name, unit in (("contact_force", "N/m"), ("penetration", "m")):
            values = np.full((len(runs), steps), np.nan)
            for row, run in zip(values, seen, strict=True):
                if run is not None:
                    row[run["time_step"]] = run[name]
            data[name] = (("run", "time"), values, {"units": unit, "long_name": name.replace("_", " ")})
    return xr.Dataset(data, coords, attributes)


def _outcome(run: dict[str, Any]) -> str:
    if run["outcome"] != "running":
        return str(run["outcome"])
    return "finished" if run["steps"] >= run["planned_steps"] else "interrupted"
