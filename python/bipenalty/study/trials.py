"""Runs of many methods on one mesh at one time step, and what each got wrong."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from bipenalty.methods import Method
from bipenalty.model import Model
from bipenalty.scene import Scene
from bipenalty.study import errors, timing
from bipenalty.study.case import Case
from bipenalty.study.sampling import Sampler

#: Longest and shortest of the time steps of the phases of entry differ by this share.
JITTER = 0.02


def run_all(case: Case, scene: Scene, dt: float, methods: Sequence[Method]) -> list[dict[str, Any]]:
    """Errors, counts, outcome and reason of each method; of several phases of entry the root mean square.

    Parameters
    ----------
    case : what runs are held against.
    scene : of one refinement of it.
    dt : s.
    methods : to run.

    The outcome is that of the first phase that did not finish, if any; errors are NaN if a phase stopped early.

    Example
    -------
    >>> import bipenalty as bp
    >>> case = Case.of(bp.exact.ThrownBar())
    >>> trial = run_all(case, case.scene(20), 0.01, [bp.Bipenalty()])[0]
    >>> trial["outcome"], trial["node_steps"], 0.01 < trial["impulse"] < 0.1
    ('finished', 7728, True)
    """
    sampler = None if case.probes is None else Sampler(scene, *case.probes)
    steps = dt * (1 - JITTER * np.arange(case.phases) / max(1, case.phases - 1))
    points = np.concatenate([body.mesh.points for body in scene.bodies])
    found: list[list[dict[str, Any]]] = [[] for _ in methods]
    for step in map(float, steps):
        wanted = None
        for method, trials in zip(methods, found, strict=True):
            told, seen = observed(timing.model(scene, method, step), case)
            trial: dict[str, Any] = dict.fromkeys(errors.MEASURES, float("nan"))
            if len(seen.force) * step > case.t_end - step:  # else stopped early: its error has no number
                wanted = errors.pictures(seen.times, points, case) if wanted is None else wanted
                trial |= errors.of(seen, case, sampler, wanted)
                if case.footprint is not None:
                    pair = errors.footprints(case.footprint, timing.model(scene, method, step))
                    trial |= dict(zip(("half_width", "pressure"), pair, strict=True))
            trials.append(trial | timing.counts(told, scene.n_nodes))
    return [_together(trials) for trials in found]


def observed(model: Model, case: Case) -> tuple[dict[str, Any], errors.Seen]:
    """What the core tells of a run, and what errors are taken of; a `Result` would cost more than a short run."""
    steps = max(1, math.ceil(case.t_end / model.dt - 1e-9))
    kept = sorted({min(round(float(t) / model.dt), steps - 1) for t in errors.snapshots(case)})
    model._run.configure(1, 10, kept, math.inf, steps)
    model._advance(steps, False)
    told = model._run.observations()
    moved = np.array(told["displacement"], dtype=np.float64).reshape(-1, model.scene.n_nodes, 2)
    force, times = np.array(told["contact_force"]), np.array(told["snapshot_step"]) * model.dt
    ratio, deepest = float(told["energy_ratio"]), float(told["max_penetration"])
    told["outcome"] = "finished" if told["outcome"] == "running" else told["outcome"]
    return told, errors.Seen(force, model.dt, ratio, deepest, times, moved)


def _together(trials: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """The trials of the phases as one, with the counts of the first."""
    if len(trials) == 1:
        return trials[0]
    one = dict(next((trial for trial in trials if trial["outcome"] != "finished"), trials[0]))
    for name in errors.MEASURES:
        values = np.array([trial[name] for trial in trials])
        one[name] = float(np.sqrt(np.mean(values**2))) * (1 if name != "energy" else float(np.sign(values.sum()) or 1))
    return one | {name: trials[0][name] for name in ("steps", "node_steps", "row_steps", "block_operations")}
