"""Filling a store: its missing tasks, in this process or on an executor, with a bar, until done or Ctrl-C."""

from __future__ import annotations

import logging
import math
from collections.abc import Generator, Sequence
from contextlib import closing
from typing import Any

import numpy as np

from bipenalty import progress
from bipenalty.scene import Scene
from bipenalty.sweeps.executors import Lost, completed
from bipenalty.sweeps.how import How
from bipenalty.sweeps.layout import Layout
from bipenalty.sweeps.plans import Plans
from bipenalty.sweeps.store_memory import MemoryStore
from bipenalty.sweeps.store_netcdf import NetcdfStore
from bipenalty.sweeps.store_zarr import ZarrStore
from bipenalty.sweeps.work import STOPPED, Arrays, Lowered, Options, compute, pack, work

Store = MemoryStore | NetcdfStore | ZarrStore

logger = logging.getLogger("bipenalty.sweeps")


def fill(
    store: Store, plans: Plans, scene: Scene, lowered: Lowered, options: Options, how: How, mean: float
) -> tuple[dict[int, str], bool]:
    """Compute what a store does not have; returns the tasks that were lost, with reasons, and whether Ctrl-C came.

    `mean` : steps of a run on average, for the bar.
    """
    layout, done, lost = store.layout, store.done(), dict[int, str]()
    todo = [task for task in range(layout.n_tasks) if task not in done]
    runs = sum(math.prod(layout.region_shape(task)) for task in todo)
    with progress.bar(mean * runs * scene.n_nodes, "node-step", "sweep", how.show_progress) as bar:
        seen = _Progress(bar, runs, mean, scene.n_nodes)
        try:
            if how.executor is None:
                return lost, _here(store, plans, lowered, options, todo, seen)
            with closing(_there(layout, plans, scene, options, how, todo)) as results:
                for task, found in results:
                    if isinstance(found, Lost):
                        lost[task] = found.reason
                        logger.warning("task %d lost: %s", task, found.reason)
                    else:
                        _put(store, task, found)
                        seen.task(found, counted=False)
        except KeyboardInterrupt:
            STOPPED.add(options.call)
            return lost, True
    return lost, False


def _here(store: Store, plans: Plans, lowered: Lowered, options: Options, todo: Sequence[int], seen: _Progress) -> bool:
    """All tasks in this process, one after the other; true when interrupted."""
    for task in todo:
        chosen = [plans.plan(index) for index in store.layout.indices(task)]
        arrays, interrupted = compute(lowered, chosen, options, seen.look)
        if not interrupted or store.keeps_partial:
            _put(store, task, arrays)
        if interrupted:
            return True
        seen.task(arrays, counted=True)
    return False


def _there(
    layout: Layout, plans: Plans, scene: Scene, options: Options, how: How, todo: Sequence[int]
) -> Generator[tuple[int, Any], None, None]:
    """All tasks on the executor, as they complete."""
    packed = pack(scene)

    def submit(executor: Any, task: int) -> Any:
        return executor.submit(work, packed, [plans.plan(index) for index in layout.indices(task)], options)

    return completed(how.executor, submit, todo, how.in_flight or 1)


def _put(store: Store, task: int, arrays: Arrays) -> None:
    store.put(task, arrays)
    logger.info("task %d: %d runs computed", task, len(arrays["outcome"]))


class _Progress:
    """A bar of node-steps, whose total follows what runs really take, with the runs that have ended beside it."""

    def __init__(self, bar: Any, runs: int, mean: float, nodes: int) -> None:
        self.bar, self.runs, self.mean, self.nodes, self.ended = bar, runs, mean, nodes, 0

    def look(self, node_steps: int, ended: int) -> None:
        """So many more node-steps; so many runs of the present task have ended."""
        self.bar.set_postfix_str(f"{self.ended + ended}/{self.runs} runs", refresh=False)
        self.bar.update(node_steps)

    def task(self, arrays: Arrays, counted: bool) -> None:
        """A task is done; its node-steps are `counted` already or not."""
        count = len(arrays["outcome"])
        taken = float(np.nansum(arrays["steps"])) * self.nodes
        self.bar.total += taken - count * self.mean * self.nodes
        self.ended += count
        self.look(0 if counted else int(taken), 0)
