"""One run alone: steps in flight and in contact beside the bare kernel, as a model records and as a sweep does."""

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
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


@dataclass(frozen=True)
class Start:
    """What comes before the first step, by part, and the steps themselves: seconds, (rounds,) each.

    Parameters
    ----------
    nodes, steps : of the run.
    parts : of the start; they add up to `whole`.
    whole, stepping : the start, and all steps.
    """

    nodes: int
    steps: int
    parts: dict[str, Array]
    whole: Array
    stepping: Array


#: Parts of the start.
BODIES, SURFACES, STATE, SEARCH = (
    "bodies: checks of the mesh, assembly, element frequencies",
    "contact: surfaces, bodies apart",
    "initial state and time step",
    "first search, by how much the first step is longer",
)


def of_start(plan: Plan) -> Start:
    """Starts a model and runs it; its parts by what smaller parts of a scene take."""
    scene = scenes.collision(plan.segments)
    bare = bp.Scene(scene.bodies)
    rounds = []
    for _ in range(plan.start_rounds):
        taken = np.min([_one_start(scene, bare, plan.start_steps) for _ in range(plan.places)], axis=0)
        bodies, lowering, model, first, rest = taken
        usual = rest / (plan.start_steps - 1)
        parts = [bodies, max(0.0, lowering - bodies), max(0.0, model - max(lowering, bodies)), max(0.0, first - usual)]
        rounds.append([*parts, model + max(0.0, first - usual), rest + usual])
    columns = np.array(rounds).T
    parts = dict(zip((BODIES, SURFACES, STATE, SEARCH), columns, strict=False))
    return Start(scene.n_nodes, plan.start_steps, parts, columns[4], columns[5])


def _one_start(scene: bp.Scene, bare: bp.Scene, steps: int) -> list[float]:
    """Seconds of lowering without and with contact, of a model, of its first step, and of the others."""
    clocks = [time.perf_counter()]
    lowered(bare)
    clocks.append(time.perf_counter())
    lowered(scene)
    clocks.append(time.perf_counter())
    model = bp.Model(scene, METHODS[scenes.BIPENALTY])
    clocks.append(time.perf_counter())
    model.step()
    clocks.append(time.perf_counter())
    model.run((steps - 0.5) * model.dt, show_progress=False)
    clocks.append(time.perf_counter())
    return np.diff(clocks).tolist()
