"""One run alone: its steps in flight and in contact beside the bare kernel, as a model records and as a sweep does."""

import time
from collections.abc import Callable
from dataclasses import dataclass

import timed_scenes as scenes
from measure import Array, started
from plan import Plan
from timed_scenes import Case

import bipenalty as bp
from bipenalty.methods import Method
from bipenalty.sweeps.work import lowered
from speed.batch import STRIDE, batch_seconds
from speed.kernel import ABOUT, kernel_seconds
from speed.rounds import interleaved

BARE = "bare kernel"
PEAKS = ", peaks only"
METHODS: dict[str, Method] = {
    scenes.STIFFNESS: bp.Stiffness(1.0),
    scenes.BIPENALTY: bp.Bipenalty(1.0, rule="published"),
}


@dataclass(frozen=True)
class Single:
    """What the rounds gave: nodes, steps timed, and seconds per node-step by name, (rounds,) each."""

    nodes: int
    steps: int
    seconds: dict[str, Array]


def measured(plan: Plan) -> Single:
    """Times a window of contact, which stiffness and bipenalty go through with the same time step."""
    strides = -(-plan.pieces * plan.steps // STRIDE)
    steps = strides * STRIDE
    together, apart = (scenes.collision(plan.segments, gap) for gap in (0.0, scenes.FAR))
    nodes, work = together.n_nodes, plan.kernel_seconds / ABOUT

    def of_model(scene: bp.Scene, method: Method) -> float:
        model = started(Case("", scene, method), plan)
        clock = time.perf_counter()
        model.step(steps)
        return (time.perf_counter() - clock) / (steps * nodes)

    flight, contact = lowered(apart), lowered(together)
    cases: dict[str, Callable[[], float]] = {
        BARE: lambda: kernel_seconds(flight.core, nodes, 1, work),
        scenes.APART: lambda: of_model(apart, METHODS[scenes.STIFFNESS]),
        scenes.APART + PEAKS: lambda: batch_seconds(flight, [METHODS[scenes.STIFFNESS]], 1, plan.before, strides),
    }
    for name, method in METHODS.items():
        cases[name] = lambda m=method: of_model(together, m)
        cases[name + PEAKS] = lambda m=method: batch_seconds(contact, [m], 1, plan.before, strides)
    return Single(nodes, steps, interleaved(cases, plan.single_rounds, plan.places))
