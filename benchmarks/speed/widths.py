"""Numbers of lanes: which is fastest, by method and by size of the mesh, with contact from both sides."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import timed_scenes as scenes
from measure import Array
from plan import Plan

import bipenalty as bp
from bipenalty.methods import Method
from bipenalty.sweeps.work import Lowered, lowered
from speed.batch import batch_seconds
from speed.rounds import interleaved

WIDTHS = (1, 2, 4, 8, 16)
Make = Callable[[float], Method]

#: Methods of the table, each from p_s.
METHODS: dict[str, Make] = {
    "stiffness": bp.Stiffness,
    "stiffness with damping": lambda ps: bp.Stiffness(ps, D=scenes.DAMPING),
    "bipenalty": lambda ps: bp.Bipenalty(ps, rule="published"),
    "bipenalty with damping": lambda ps: bp.Bipenalty(ps, D=scenes.DAMPING, rule="published"),
    "bipenalty, default rule": bp.Bipenalty,
}


@dataclass(frozen=True)
class Widths:
    """One row of the table.

    Parameters
    ----------
    name, nodes : the method, and the nodes of the mesh.
    seconds : per node-step and run, by number of lanes, (rounds,).
    """

    name: str
    nodes: int
    seconds: dict[int, Array]

    @property
    def best(self) -> int:
        """The number of lanes with the least median."""
        return min(self.seconds, key=lambda lanes: float(np.median(self.seconds[lanes])))


def by_method(plan: Plan) -> list[Widths]:
    """All methods on the usual mesh."""
    ready = lowered(scenes.collision(plan.segments, passes=2))
    return _measured([(name, ready, make) for name, make in METHODS.items()], plan)


def by_size(plan: Plan) -> list[Widths]:
    """Bipenalty on meshes from one that stays in a core's own cache to one that does not."""
    name = "bipenalty"
    meshes = [lowered(scenes.collision(segments, passes=2)) for segments in plan.width_segments]
    return _measured([(name, ready, METHODS[name]) for ready in meshes], plan)


def _measured(rows: Sequence[tuple[str, Lowered, Make]], plan: Plan) -> list[Widths]:
    cases = {}
    for number, (_, ready, make) in enumerate(rows):
        for lanes in WIDTHS:
            methods = [make(float(ps)) for ps in np.geomspace(0.8, 1.25, lanes + 2)[1:-1]]  # alike, not equal
            before = plan.before // (1 + len(ready.velocity) // 10_000)  # large meshes take their time
            cases[f"{number}, {lanes}"] = lambda r=ready, m=methods, b=before: batch_seconds(
                r, m, len(m), b, plan.width_strides if b == plan.before else 1
            )
    found = interleaved(cases, plan.width_rounds, places=2)
    return [
        Widths(name, len(ready.velocity), {lanes: found[f"{number}, {lanes}"] for lanes in WIDTHS})
        for number, (name, ready, _) in enumerate(rows)
    ]
