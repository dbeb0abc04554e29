"""The bare kernel: one pass over K for 1, 8 and 16 lanes, beside multiply-adds and memory at their best."""

from collections.abc import Callable
from dataclasses import dataclass

import timed_scenes as scenes
from measure import Array
from plan import Plan

from bipenalty import _core
from bipenalty.lower import lower
from speed.ceilings import Counts, counts, multiply_add
from speed.rounds import interleaved

LANES = (1, 8, 16)
#: Seconds that a node-step of a lane takes about, from which the steps of a measurement follow.
ABOUT = 3e-9


@dataclass(frozen=True)
class Cell:
    """The kernel on one mesh with one number of lanes.

    Parameters
    ----------
    counts, lanes : of what.
    seconds : per node-step and lane, (rounds,).
    streaming : seconds per node-step and lane that memory alone takes, (rounds,).
    multiply_add : seconds of one, (rounds,).
    """

    counts: Counts
    lanes: int
    seconds: Array
    streaming: Array
    multiply_add: Array


def kernel_seconds(core: _core.Model, nodes: int, lanes: int, work: float) -> float:
    """Seconds per node-step and lane over about `work` node-steps of all lanes."""
    steps = max(2, round(work / (nodes * lanes)))
    return _core.probe_kernel(core, lanes, steps=steps) / (steps * nodes * lanes)


def cells(plan: Plan) -> list[Cell]:
    """Measures the small mesh and the usual one, all in the same rounds."""
    cases: dict[str, Callable[[], float]] = {"multiply-add": multiply_add}
    work, keys = plan.kernel_seconds / ABOUT, []
    for segments in (plan.small, plan.segments):
        scene = scenes.collision(segments, scenes.FAR)
        core, count = lower(scene), counts(scene)
        for lanes in LANES:
            keys.append((f"{count.nodes}, {lanes}", count, lanes))
            cases[f"kernel {keys[-1][0]}"] = lambda c=core, n=count.nodes, k=lanes: kernel_seconds(c, n, k, work)
            cases[f"memory {keys[-1][0]}"] = lambda c=count, k=lanes: c.streaming(k) / k
    ceilings = [name for name in cases if not name.startswith("kernel")]
    found = interleaved(cases, plan.kernel_rounds, plan.places, once=ceilings)
    madd = found["multiply-add"]
    return [Cell(c, lanes, found[f"kernel {key}"], found[f"memory {key}"], madd) for key, c, lanes in keys]
