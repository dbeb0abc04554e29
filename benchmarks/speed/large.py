"""One model from a thousand to a million nodes: growth of the cost of a step, and share of what memory allows."""

import functools
import itertools
import math
import os
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from measure import Array
from plan import Plan

import bipenalty as bp
from bipenalty import _core
from bipenalty.lower import lower
from bipenalty.sweeps.memory import available_memory
from speed.ceilings import Counts, counts
from speed.rounds import interleaved
from speed.sweep import cores

#: Bandwidth falls by more than this from one size to the next where the larger one no longer fits into a level.
FALL = 1.5
#: Bytes a node that mesh, model and two runs take while they are built, with room to spare.
ROOM = 3000


@dataclass(frozen=True)
class Size:
    """A square plate that flies freely.

    Parameters
    ----------
    counts : of its mesh.
    level : level of memory that holds what a step goes through, 0 the nearest.
    threads : seconds per node-step by number of threads, (rounds,); 2 only on a machine with two cores.
    streaming : seconds per node-step that memory alone takes one thread, (rounds,).
    """

    counts: Counts
    level: int
    threads: dict[int, Array]
    streaming: Array


def plate(nodes: int) -> bp.Scene:
    """A unit square with about so many nodes that flies at 1 m/s.

    Example
    -------
    >>> plate(1000).n_nodes
    1024
    """
    edges = max(1, round(math.sqrt(nodes)) - 1)
    material = bp.LinearElastic(young=1000, poisson=0.2, density=0.1)
    return bp.Scene([bp.Body("plate", bp.mesh.rectangle(1, 1, edges, edges), material, velocity=(1.0, 0.0))])


def sizes(plan: Plan) -> list[Size]:
    """Measures all sizes that the memory holds, in the same rounds."""
    cases: dict[str, Callable[[], float]] = {}
    kept, room = [], available_memory()
    threads = [n for n in (1, 2) if n <= cores()]
    for nodes in plan.large_sizes:
        room -= ROOM * nodes
        if room < 0:
            break
        scene = plate(nodes)
        count, core = counts(scene), lower(scene)
        kept.append(count)
        for n in threads:
            run = _run(scene, core, n)
            cases[f"{count.nodes}, threads {n}"] = functools.partial(_step_seconds, run, count.nodes, plan.large_work)
        cases[f"{count.nodes}, memory"] = functools.partial(count.streaming, 1)
    found = interleaved(cases, plan.large_rounds)
    streaming = [found[f"{count.nodes}, memory"] for count in kept]
    levels = levels_of([count.working_set(1) for count in kept], [float(min(s)) for s in streaming], own_cache())
    return [
        Size(count, level, {n: found[f"{count.nodes}, threads {n}"] for n in threads}, memory)
        for count, level, memory in zip(kept, levels, streaming, strict=True)
    ]


def _run(scene: bp.Scene, core: _core.Model, threads: int) -> _core.Run:
    """A run that records nothing."""
    method, dt = bp.Stiffness(1.0), 0.5 * core.critical_dt
    run = _core.Run(core, method, dt, False, scene.velocity, scene.displacement, "auto", threads)
    run.configure(10**9, 10**9, [], math.inf, 10**9)
    return run


def _step_seconds(run: _core.Run, nodes: int, work: float) -> float:
    """Seconds per node-step over about `work` node-steps, the least of three stretches after some to warm up."""
    steps = max(1, round(work / nodes / 3))
    run.advance(max(1, steps // 3), False)
    spent = []
    for _ in range(3):
        clock = time.perf_counter()
        run.advance(steps, False)
        spent.append(time.perf_counter() - clock)
    return min(spent) / (steps * nodes)


def own_cache() -> int:
    """Bytes of the largest cache that a core has to itself; 0 where the system does not tell."""
    try:
        return max(0, os.sysconf("SC_LEVEL2_CACHE_SIZE"))
    except (AttributeError, OSError, ValueError):
        return 0


def levels_of(working_sets: Sequence[int], streaming: Sequence[float], own: int) -> list[int]:
    """Level of memory of each size, 0 for the core's own cache.

    Parameters
    ----------
    working_sets : bytes that a step goes through, ascending.
    streaming : least seconds per node-step that memory takes: beyond the own cache a jump begins a new level.
    own : bytes of the core's own cache; 0 if unknown, and its edge is a jump too.

    Example
    -------
    >>> levels_of([1, 2, 8, 16, 64], [1.0, 1.1, 1.4, 2.3, 9.0], own=4)
    [0, 0, 1, 2, 3]
    """
    levels, pairs = [0], itertools.pairwise(zip(working_sets, streaming, strict=True))
    for (small, sooner), (large, later) in pairs:
        over = small <= own < large
        levels.append(levels[-1] + int(over or (large > own and later > FALL * sooner)))
    return levels


def exponents(measured: list[Size], threads: int = 1) -> dict[int, Array]:
    """Exponent of the growth of a step with the nodes within each level that has two sizes, (rounds,).

    Fitted by least squares to the logarithms.
    """
    found = {}
    for level in sorted({size.level for size in measured}):
        here = [size for size in measured if size.level == level]
        if len(here) > 1:
            nodes = np.log([size.counts.nodes for size in here])
            step = np.log([size.counts.nodes * size.threads[threads] for size in here])
            found[level] = np.polyfit(nodes, step, 1)[0]
    return found
