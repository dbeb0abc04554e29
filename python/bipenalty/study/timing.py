"""What runs cost: processor time of interleaved rounds on one thread, and counts that no machine disturbs."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Mapping
from typing import Any

import numpy as np

from bipenalty.errors import RunError
from bipenalty.methods import Bipenalty, Method
from bipenalty.model import Model
from bipenalty.scene import Scene


def model(scene: Scene, method: Method, dt: float) -> Model:
    """A model at a time step (s) that may be past a limit: a run that fails is an answer too."""
    return Model(scene, method, dt, allow_unstable=True)


def setup(scene: Scene, limit: tuple[str, float], repeats: int) -> tuple[float, float]:
    """Processor time of making a model at a share of a limit, median of the repeats, and its time step; both s."""
    spent = []
    for _ in range(repeats):
        start = time.thread_time()
        made = Model(scene, Bipenalty(), limit[0], limit[1])
        spent.append(time.thread_time() - start)
    return float(np.median(spent)), made.dt


def interleaved(
    scene: Scene, dt: float, runs: Mapping[tuple[int, int], tuple[Method, int]], repeats: int
) -> dict[tuple[int, int], list[float]]:
    """Processor times (s) of each run, of so many steps: every round takes all, forwards and backwards in turn."""
    spent: dict[tuple[int, int], list[float]] = {key: [] for key in runs}
    for number in range(repeats):
        order = list(runs)[:: 1 if number % 2 == 0 else -1]
        for key in order:
            method, steps = runs[key]
            made = model(scene, method, dt)
            start = time.thread_time()
            with contextlib.suppress(RunError):  # it stops where it stopped before
                made.step(steps)
            spent[key].append(time.thread_time() - start)
    return spent


def counts(told: Mapping[str, Any], nodes: int) -> dict[str, Any]:
    """Outcome and operation counts of a run: those it tells itself where it does, else from its histories."""
    return {
        "outcome": told["outcome"],
        "reason": told["reason"],
        "steps": told["steps"],
        "node_steps": nodes * told["steps"],
        "row_steps": told.get("row_steps", float(np.sum(told["active_rows"]))),
        "block_operations": told.get("block_operations", float("nan")),
    }
