"""The work of a task: some runs of one scene from start to end. What is passed to a worker and back can be pickled."""

from __future__ import annotations

import functools
import hashlib
import pickle
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bipenalty import _core, checks
from bipenalty.lower import lower
from bipenalty.model import SLICE
from bipenalty.result_dataset import package_version
from bipenalty.scene import Scene
from bipenalty.sweeps import core_batch
from bipenalty.sweeps.layout import FLAGS, HISTORIES, SECONDS, SUMMARY, WORDS
from bipenalty.sweeps.plans import Plan

Arrays = dict[str, Any]

#: Calls that were interrupted: their tasks on other threads of this process end at the next look.
STOPPED: set[str] = set()


@dataclass(frozen=True)
class Options:
    """What all runs of a call share: `samples` kept of each history, every `every` steps; threads of a task; the
    version of the package they are to be computed with; the name of the call."""

    allow_unstable: bool
    displacement_limit: float | None
    every: int
    samples: int
    threads: int
    version: str
    call: str
    isa: str = "auto"


@dataclass(frozen=True)
class Packed:
    """A scene as bytes, lowered once in every process that works on it."""

    digest: str
    data: bytes = field(compare=False, repr=False)


@dataclass(frozen=True)
class Lowered:
    """A scene as the core has it, with its initial velocity (m/s) and displacement (m), (N, 2) each."""

    core: _core.Model
    velocity: Any
    displacement: Any


def pack(scene: Scene) -> Packed:
    """The scene for sending."""
    data = pickle.dumps(scene, protocol=pickle.HIGHEST_PROTOCOL)
    return Packed(hashlib.sha256(data).hexdigest(), data)


def lowered(scene: Scene) -> Lowered:
    """The scene as the core has it."""
    return Lowered(lower(scene), scene.velocity, scene.displacement)


@functools.lru_cache(maxsize=2)
def _unpacked(packed: Packed) -> Lowered:
    return lowered(pickle.loads(packed.data))


def work(packed: Packed, plans: Sequence[Plan], options: Options) -> Arrays:
    """Do some runs; returns name -> array, first axis over the runs, second over the samples of a history.

    Raises
    ------
    InputError : the worker has another version of the package than the driver.
    """
    here, remedy = package_version(), "install the same everywhere"
    checks.within("worker", "version of bipenalty", here, here == options.version, options.version, remedy)
    arrays, interrupted = compute(_unpacked(packed), plans, options)
    if interrupted:
        raise KeyboardInterrupt
    return arrays


def compute(
    scene: Lowered, plans: Sequence[Plan], options: Options, look: Callable[[int, int], None] | None = None
) -> tuple[Arrays, bool]:
    """Do some runs; the arrays as of `work`, and whether Ctrl-C came before the end.

    `look` is told, several times a second, the node-steps done since and the runs that have ended.
    """
    batch, places, refused = _start(scene, plans, options)
    interrupted = False
    try:
        while batch is not None and batch.finished < len(batch) and not interrupted:
            done = batch.advance(min(options.threads, len(batch)), SLICE)
            if look:
                look(done, batch.finished + len(refused))
            interrupted = options.call in STOPPED
    except KeyboardInterrupt:
        interrupted = True
    arrays = _empty(len(plans), options.samples)
    for i, reason in refused.items():
        _refuse(arrays, i, reason)
    for at, i in enumerate(places):
        _keep(arrays, i, batch.observations(at), options.every)
    return arrays, interrupted


def _start(scene: Lowered, plans: Sequence[Plan], options: Options) -> tuple[Any, list[int], dict[int, str]]:
    """A batch of the runs that can start, their places, and why others cannot."""
    refused = {i: plan.refused for i, plan in enumerate(plans) if plan.refused}
    places = [i for i in range(len(plans)) if i not in refused]

    if not places:
        return None, places, refused
    batch = core_batch.start(
        scene.core,
        [plans[i] for i in places],
        scene.velocity,
        scene.displacement,
        allow_unstable=options.allow_unstable,
        displacement_limit=options.displacement_limit,
        every=options.every,
        isa=options.isa,
    )
    return batch, places, refused


def _empty(runs: int, samples: int) -> Arrays:
    arrays: Arrays = {name: np.full(runs, np.nan) for name in SUMMARY | SECONDS}
    arrays |= {name: np.full((runs, samples), np.nan) for name in HISTORIES if samples}
    arrays |= {name: np.zeros(runs, dtype=bool) for name in FLAGS}
    return arrays | {name: np.full(runs, "", dtype=object) for name in WORDS}


def _refuse(arrays: Arrays, i: int, reason: str) -> None:
    arrays["outcome"][i], arrays["reason"][i] = "refused", reason
    arrays["failed"][i], arrays["steps"][i], arrays["seconds"][i] = True, 0, 0


def _keep(arrays: Arrays, i: int, seen: dict[str, Any] | None, every: int) -> None:
    """Put what was seen of one run into its place."""
    if seen is None:
        arrays["outcome"][i], arrays["reason"][i], arrays["failed"][i] = "lost", "its thread died", True
        return
    if seen["outcome"] == "refused":
        _refuse(arrays, i, str(seen["reason"]))
        return
    for name in SUMMARY | SECONDS:
        arrays[name][i] = seen[name]
    over = seen["steps"] >= seen["planned_steps"]
    running = "finished" if over else "interrupted"
    arrays["outcome"][i] = running if seen["outcome"] == "running" else str(seen["outcome"])
    arrays["reason"][i] = str(seen["reason"])
    arrays["failed"][i] = bool(seen["stopped"])
    arrays["finished"][i] = not seen["stopped"] and over
    if every:
        # The last step is kept too, whatever the stride.
        chosen = seen["time_step"] % every == 0
        for name in HISTORIES:
            arrays[name][i][seen["time_step"][chosen] // every] = seen[name][chosen]
