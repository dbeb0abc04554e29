"""Batches as the core works them off, timed while contact is under way."""

import time
from collections.abc import Sequence

from bipenalty.methods import Method
from bipenalty.sweeps import core_batch
from bipenalty.sweeps.plans import Plan as RunPlan
from bipenalty.sweeps.work import Lowered

#: Steps that the core takes between two looks at the clock.
STRIDE = 64


def batch_seconds(ready: Lowered, methods: Sequence[Method], lanes: int, before: int, strides: int) -> float:
    """Seconds per node-step and run on one thread, over `strides` times 64 steps; keeps peaks only.

    Parameters
    ----------
    ready : the scene as the core has it.
    methods : of the runs, as many as there are lanes.
    lanes : 1, 2, 4, 8 or 16.
    before : untimed steps before, with the start and the first search, rounded up to a multiple of 64.
    """
    untimed = -(-before // STRIDE) * STRIDE
    dt, steps = 0.5 * ready.core.critical_dt, untimed + strides * STRIDE
    runs = [RunPlan(method, dt, steps) for method in methods]
    limits = {"allow_unstable": False, "displacement_limit": None, "every": 0}
    batch = core_batch.start(ready.core, runs, ready.velocity, ready.displacement, lanes=lanes, **limits)
    nodes = len(ready.velocity)
    done = 0
    while done < untimed * nodes * len(runs) and batch.finished < len(runs):
        done += batch.advance(1, 1e-6)
    clock, done = time.perf_counter(), 0
    while batch.finished < len(runs):
        done += batch.advance(1, 1e-3)
    return (time.perf_counter() - clock) / max(1, done)
