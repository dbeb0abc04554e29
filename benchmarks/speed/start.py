"""The start of one run: what comes before its second step, by part, beside all of its steps."""

import math
import time
from dataclasses import dataclass

import numpy as np
import timed_scenes as scenes
from measure import Array
from plan import Plan

import bipenalty as bp
from bipenalty import _core
from bipenalty.critical_step import time_step
from bipenalty.lower import lower

#: Parts of the start; what begins with "of which" is contained in the one before.
LOWERING = "lowering: bodies, surfaces"
BODIES = "of which bodies: checks of the mesh, assembly, element frequencies"
CHECKS = "of which checks of the mesh"
STATE = "initial state, time step, overlap"
SEARCH = "first search: what the first step takes more than a later one"


@dataclass(frozen=True)
class Start:
    """What the rounds gave.

    Parameters
    ----------
    nodes, steps : of the run.
    parts : seconds of each part, (rounds,).
    whole, stepping : seconds of the start, and of all steps, (rounds,).
    """

    nodes: int
    steps: int
    parts: dict[str, Array]
    whole: Array
    stepping: Array


def measured(plan: Plan) -> Start:
    """Starts the collision and runs it, with histories of every step and energies of every tenth as a model does."""
    scene = scenes.collision(plan.segments)
    bare = bp.Scene(scene.bodies)
    rounds = []
    for _ in range(plan.start_rounds):
        taken = np.min([_clocked(scene, bare, plan.start_steps) for _ in range(plan.places)], axis=0)
        lowering, state, first, later, bodies, checks = taken.tolist()
        usual = later / (plan.start_steps - 1)
        search = max(0.0, first - usual)
        rounds.append([lowering, bodies, checks, state, search, lowering + state + search, later + usual])
    columns = np.array(rounds).T
    parts = dict(zip((LOWERING, BODIES, CHECKS, STATE, SEARCH), columns[:5], strict=True))
    return Start(scene.n_nodes, plan.start_steps, parts, columns[5], columns[6])


def _clocked(scene: bp.Scene, bare: bp.Scene, steps: int) -> list[float]:
    """Seconds: lowering, initial state, first step, later steps; lowering without contact, checks of the meshes."""
    method, clocks = bp.Bipenalty(1.0, rule="published"), [time.perf_counter()]
    core = lower(scene)
    clocks.append(time.perf_counter())
    dt = time_step(core, "element", None)
    run = _core.Run(core, method, dt, False, scene.velocity, scene.displacement, "auto", None)
    run.configure(1, 10, [], math.inf, steps)
    clocks.append(time.perf_counter())
    run.advance(1, False)
    clocks.append(time.perf_counter())
    run.advance(steps - 1, True)
    clocks.append(time.perf_counter())
    lower(bare)  # after the whole, which is not to find memory and caches prepared
    clocks.append(time.perf_counter())
    for body in scene.bodies:
        _core.check_mesh(body.mesh.points, body.mesh.triangles, body.mesh.quads)
    clocks.append(time.perf_counter())
    return np.diff(clocks).tolist()
