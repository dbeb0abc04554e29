"""The package against the SciPy script on the same arrays: equal forces first, then the ratio of the times."""

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy_script
from measure import Array
from plan import Plan
from timed_scenes import DENSITY, FAR, POISSON, YOUNG, collision

import bipenalty as bp

SEARCHES = ("brute", "lists")
T_END = 0.18  # s
PS = 1.0  # alpha_s = PS times the larger modulus

#: Largest difference of the two force histories, over the peak force, at which results count as equal.
EQUAL = 1e-6


@dataclass(frozen=True)
class Duel:
    """One scene, run by both.

    Parameters
    ----------
    scene : what it is called.
    steps, dt : of both; dt in s.
    loop : seconds of the time loop alone, by search of the script, (rounds, 2): package, script.
    call : seconds of the whole call with its result, likewise.
    difference : largest difference of the force histories over the peak force, by search; NaN without contact.
    """

    scene: str
    steps: int
    dt: float
    loop: dict[str, Array]
    call: dict[str, Array]
    difference: dict[str, float]


def duels(plan: Plan) -> list[Duel]:
    """The collision, then the same bodies in free flight."""
    return [_duel(f"collision, {T_END:g} s", plan, 0.0), _duel(f"free flight, {T_END:g} s", plan, FAR)]


def _duel(name: str, plan: Plan, gap: float) -> Duel:
    scene = collision(plan.segments, gap)
    problem = prepared(scene)
    loop: dict[str, list[list[float]]] = {search: [] for search in SEARCHES}
    call: dict[str, list[list[float]]] = {search: [] for search in SEARCHES}
    difference = {}
    for _ in range(plan.script_rounds):
        for search in SEARCHES:  # each run of the script follows one of the package: A B A C, and again
            model = bp.Model(scene, bp.Stiffness(PS))
            clock = time.perf_counter()
            result = model.run(T_END, show_progress=False)
            ours = time.perf_counter() - clock
            clock = time.perf_counter()
            script = scipy_script.run(problem, PS * max(YOUNG), model.dt, model.steps, scene.velocity, search)
            theirs = time.perf_counter() - clock
            loop[search].append([result.dataset.attrs["seconds"], script["seconds"]])
            call[search].append([ours, theirs])
            difference[search] = apart(result.dataset["contact_force"].values, script["contact_force"])
    loops, calls = ({search: np.array(pairs) for search, pairs in times.items()} for times in (loop, call))
    return Duel(name, model.steps, model.dt, loops, calls, difference)


def prepared(scene: bp.Scene) -> dict[str, Any]:
    """The script's problem from the arrays of the scene's meshes."""
    top, bottom = (body.mesh for body in scene.bodies)
    return scipy_script.prepare(
        np.concatenate([top.points, bottom.points]),
        np.concatenate([top.quads, bottom.quads + top.n_nodes]),
        np.repeat([0, 1], [top.n_nodes, bottom.n_nodes]),
        np.array(YOUNG),
        POISSON,
        DENSITY,
        top.loops[0],
        bottom.loops[0] + top.n_nodes,
    )


def apart(ours: Array, theirs: Array) -> float:
    """Largest difference over the peak of both; NaN when both are zero throughout.

    Example
    -------
    >>> apart(np.array([0.0, 2.0]), np.array([0.0, 1.0]))
    0.5
    """
    peak = max(np.abs(ours).max(), np.abs(theirs).max())
    return float(np.abs(ours - theirs).max() / peak) if peak > 0 else float("nan")
