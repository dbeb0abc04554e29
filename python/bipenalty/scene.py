"""The scene: bodies, contacts, supports and obstacles, described and not yet computed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bipenalty import checks
from bipenalty.materials import LinearElastic
from bipenalty.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Body:
    """A deformable body.

    Parameters
    ----------
    name : what contacts, supports and messages call it.
    mesh : its mesh.
    material : its material.
    velocity : initial velocity, m/s: one pair, or an (N, 2) array.
    displacement : initial displacement, m: none, one pair, or an (N, 2) array.
    body_force : force per volume, N/m^3, e.g. (0, -9.81 * density).
    thickness : m, > 0; 1 for a plane problem per metre of depth.

    Raises
    ------
    InputError : a value out of its bounds.

    Example
    -------
    >>> import bipenalty as bp
    >>> bp.Body("bar", bp.mesh.rectangle(10, 1, 20, 1), bp.LinearElastic(900, 0, 1), velocity=(-10, 0)).name
    'bar'
    """

    name: str
    mesh: Mesh
    material: LinearElastic
    velocity: Any = (0.0, 0.0)
    displacement: Any = None
    body_force: Any = (0.0, 0.0)
    thickness: float = 1.0

    def __post_init__(self) -> None:
        owner = f'body "{checks.text("body", "name", self.name)}"'
        checks.within(owner, "mesh", type(self.mesh).__name__, isinstance(self.mesh, Mesh), "a bipenalty.Mesh",
                      "make one with Mesh(points, triangles, quads), mesh.disc, mesh.rectangle or mesh.read")
        checks.within(owner, "material", type(self.material).__name__, isinstance(self.material, LinearElastic),
                      "a LinearElastic", "give one")
        nodes = self.mesh.n_nodes
        object.__setattr__(self, "velocity", checks.nodal(owner, "velocity", self.velocity, nodes))
        start = (0.0, 0.0) if self.displacement is None else self.displacement
        object.__setattr__(self, "displacement", checks.nodal(owner, "displacement", start, nodes))
        object.__setattr__(self, "body_force", checks.pair(owner, "body_force", self.body_force))
        object.__setattr__(self, "thickness", checks.number(owner, "thickness", self.thickness))


@dataclass(frozen=True)
class Contact:
    """Frictionless contact of a secondary body's nodes with a primary body's or obstacle's segments.

    Parameters
    ----------
    secondary, primary : names; the secondary must be a body.
    passes : 1, or 2 for the other way round as well.
    overlap_tolerance : m; overlap allowed at the start, 1e-6 of the mean segment length unless given.
    """

    secondary: str
    primary: str
    passes: int = 1
    overlap_tolerance: float | None = None

    def __post_init__(self) -> None:
        checks.text("contact", "secondary", self.secondary)
        checks.text("contact", "primary", self.primary)
        owner = f'contact "{self.secondary}" on "{self.primary}"'
        checks.within(owner, "passes", self.passes, self.passes in (1, 2), "1 or 2", "1 is the usual choice")
        if self.overlap_tolerance is not None:
            tolerance = checks.number(owner, "overlap_tolerance", self.overlap_tolerance)
            object.__setattr__(self, "overlap_tolerance", tolerance)


@dataclass(frozen=True, eq=False)
class Support:
    """Nodes of a body held in x, y or both; exact, and without cost in the step.

    Parameters
    ----------
    body : name of the body.
    on : name of one of its mesh's boundaries, or an array of its node numbers.
    x, y : which axes are held.
    """

    body: str
    on: Any
    x: bool = True
    y: bool = True


@dataclass(frozen=True)
class HalfPlane:
    """Rigid half-plane without degrees of freedom: bodies stay where (x - point) . normal >= 0.

    Parameters
    ----------
    name : what contacts call it.
    point : a point of its line, m.
    normal : out of the obstacle, any length but zero.
    """

    name: str
    point: checks.Pair
    normal: checks.Pair

    def __post_init__(self) -> None:
        owner = f'obstacle "{checks.text("obstacle", "name", self.name)}"'
        object.__setattr__(self, "point", checks.pair(owner, "point", self.point))
        object.__setattr__(self, "normal", checks.pair(owner, "normal", self.normal))


@dataclass(frozen=True)
class Polyline:
    """Rigid polyline without degrees of freedom; the obstacle lies on the left of travel.

    Parameters
    ----------
    name : what contacts call it.
    points : its vertices, m; a node past the end of an open one is not in contact.
    closed : whether the last vertex joins the first.
    """

    name: str
    points: Sequence[checks.Pair]
    closed: bool = False

    def __post_init__(self) -> None:
        owner = f'obstacle "{checks.text("obstacle", "name", self.name)}"'
        given = checks.sequence(owner, "points", self.points)
        points = tuple(checks.pair(owner, f"point {i}", p) for i, p in enumerate(given))
        object.__setattr__(self, "points", points)


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
            "bodies": (Body,), "contacts": (Contact,), "constraints": (Support,), "obstacles": (HalfPlane, Polyline),
        }
        for name, kind in kinds.items():
            items = checks.sequence("scene", name, getattr(self, name))
            for i, item in enumerate(items):
                expected = " or ".join(k.__name__ for k in kind)
                checks.within("scene", f"{name}[{i}]", type(item).__name__, isinstance(item, kind),
                              f"a {expected}", "check the order of the arguments")
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
