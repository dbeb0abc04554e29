"""Lowering: a scene to the core's model."""

from __future__ import annotations

from typing import Any

import numpy as np

from bipenalty import _core, checks
from bipenalty.constraints import Support
from bipenalty.errors import InputError
from bipenalty.scene import Scene


def lower(scene: Scene) -> _core.Model:
    """The core's model of a scene.

    Raises
    ------
    InputError : unknown names, bad geometry; the message names the object, value, bound and remedy.
    """
    checks.within("scene", "type", type(scene).__name__, isinstance(scene, Scene), "a Scene", "wrap the bodies in one")
    held = [(s.body, _nodes(scene, s), (bool(s.x), bool(s.y))) for s in scene.constraints]
    return _core.Model(list(scene.bodies), list(scene.contacts), held, list(scene.obstacles))


def _nodes(scene: Scene, support: Support) -> list[int]:
    owner = f'support of "{support.body}"'
    body = next((b for b in scene.bodies if b.name == support.body), None)
    if body is None:
        known = [b.name for b in scene.bodies]
        raise InputError(f'{owner}: body = "{support.body}", must be one of {known}; correct the name')
    if isinstance(support.on, str):
        return [int(n) for n in body.mesh.nodes_of(support.on)]
    nodes: Any = np.asarray(support.on)
    ok = nodes.ndim == 1 and np.issubdtype(nodes.dtype, np.integer)
    checks.within(
        owner,
        "on",
        f"{nodes.dtype} array of shape {nodes.shape}",
        ok,
        "a boundary name or node numbers",
        f"boundaries of the mesh: {sorted(body.mesh.boundaries)}",
    )
    low = int(nodes.min(initial=0))
    checks.within(owner, "node", low, low >= 0, ">= 0", "number nodes from 0")
    return [int(n) for n in nodes]
