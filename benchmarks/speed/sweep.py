"""The source's whole sweep: on one thread, on two, beside the bare kernel and the SciPy script."""

import functools
import os
import time
from dataclasses import dataclass

import numpy as np
import scipy_script
import timed_scenes as scenes
from measure import Array
from plan import Plan
from versus_script import PS, SEARCHES, T_END, prepared

import bipenalty as bp
from bipenalty.methods import Method
from bipenalty.sweeps.work import lowered
from speed.kernel import ABOUT, LANES, kernel_seconds
from speed.rounds import interleaved

DAMPINGS = (None, 0.01, 0.001, 0.0001)  # D, s


@dataclass(frozen=True)
class Sweep:
    """What the rounds gave.

    Parameters
    ----------
    runs, steps, nodes : of the sweep; steps of a run that gets to the end.
    node_steps : of all runs; fewer than the product where runs have failed.
    threads : seconds of the whole call by number of threads, (rounds,); 2 only on a machine with two cores.
    share : of so many cores that they had, -, (rounds,); below 1 other programs took the rest, or threads waited.
    kernel : seconds per node-step and lane of the bare kernel by number of lanes, (rounds,).
    script : seconds per node-step of the script, the faster of its searches, (rounds,).
    """

    runs: int
    steps: int
    nodes: int
    node_steps: float
    threads: dict[int, Array]
    share: dict[int, Array]
    kernel: dict[int, Array]
    script: Array


def cores() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def methods(factors: int) -> list[Method]:
    """Stiffness and bipenalty, without damping and with three, over seven decades of p_s."""
    published = functools.partial(bp.Bipenalty, rule="published")
    grid = np.logspace(-2, 5, factors)
    return [kind(ps, D=D) for kind in (bp.Stiffness, published) for D in DAMPINGS for ps in grid]


def measured(plan: Plan) -> Sweep:
    """Runs the sweep as its example does: from both sides, histories of every step."""
    scene, runs = scenes.collision(plan.segments, passes=2), methods(plan.sweep_ps)
    ready = lowered(scene)
    nodes, dt = scene.n_nodes, 0.5 * ready.core.critical_dt
    steps = int(np.ceil(T_END / dt - 1e-9))
    taken: list[float] = []
    shares: dict[int, list[float]] = {n: [] for n in (1, 2) if n <= cores()}

    def sweep(threads: int) -> float:
        clock, processor = time.perf_counter(), time.process_time()
        data = bp.sweep(
            scene, runs, T_END, displacement_limit=1.0, histories=True, threads=threads, show_progress=False
        )
        spent = time.perf_counter() - clock
        shares[threads].append((time.process_time() - processor) / (threads * spent))
        taken.append(float(data["steps"].sum()) * nodes)
        return spent

    problem = prepared(scene)

    def script() -> float:
        run = functools.partial(scipy_script.run, problem, PS * max(scenes.YOUNG), dt, steps, scene.velocity)
        return min(run(search)["seconds"] for search in SEARCHES) / (steps * nodes)

    work = 4 * plan.kernel_seconds / ABOUT
    cases = {f"threads {n}": functools.partial(sweep, n) for n in shares}
    for lanes in LANES:
        cases[f"kernel {lanes}"] = lambda k=lanes: min(kernel_seconds(ready.core, nodes, k, work) for _ in range(3))
    found = interleaved(cases | {"script": script}, plan.sweep_rounds)
    return Sweep(
        len(runs),
        steps,
        nodes,
        taken[0],
        {n: found[f"threads {n}"] for n in shares},
        {n: np.array(share) for n, share in shares.items()},
        {lanes: found[f"kernel {lanes}"] for lanes in LANES},
        found["script"],
    )
