"""The scene: bodies with what acts between and on them, described and not yet computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bipenalty import checks
from bipenalty.body import Body
from bipenalty.constraints import Support
from bipenalty.contact import Contact
from bipenalty.obstacles import HalfPlane, Polyline


@dataclass(frozen=True, eq=False)
class Scene:
    """Bodies with what acts between and on them.

    Parameters
    ----------
    bodies : the deformable bodies; nodes are numbered in this order.
    contacts : who may touch whom. No contact: no search.
    constraints : supports.
    obstacles : rigid half-planes and polylines.

    Raises
    ------
    InputError : wrong types here; unknown names and geometry when a `Model` is built of it.
    """

    bodies: Sequence[Body]
    contacts: Sequence[Contact] = ()
    constraints: Sequence[Support] = ()
    obstacles: Sequence[HalfPlane | Polyline] = field(default=())

    def __post_init__(self) -> None:
        kinds: dict[str, tuple[type, ...]] = {
            "bodies": (Body,),
            "contacts": (Contact,),
            "constraints": (Support,),
            "obstacles": (HalfPlane, Polyline),
        }
        for name, kind in kinds.items():
            items = checks.sequence("scene", name, getattr(self, name))
            for i, item in enumerate(items):
                expected = " or ".join(k.__name__ for k in kind)
                checks.within(
                    "scene",
                    f"{name}[{i}]",
                    type(item).__name__,
                    isinstance(item, kind),
                    f"a {expected}",
                    "check the order of the arguments",
                )
            object.__setattr__(self, name, items)
        checks.within("scene", "number of bodies", 0, len(self.bodies) > 0, ">= 1", "add a body")
        names = [o.name for o in (*self.bodies, *self.obstacles)]
        for name in names:
            checks.within("scene", "name", repr(name), names.count(name) == 1, "used once", "rename one of them")

    @property
    def n_nodes(self) -> int:
        """Number of nodes of all bodies."""
        return sum(body.mesh.n_nodes for body in self.bodies)

    @property
    def velocity(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """Initial velocity of all nodes, (N, 2) in m/s."""
        return np.concatenate([body.velocity for body in self.bodies])

    @property
    def displacement(self) -> np.ndarray[Any, np.dtype[np.float64]]:
        """Initial displacement of all nodes, (N, 2) in m."""
        return np.concatenate([body.displacement for body in self.bodies])
