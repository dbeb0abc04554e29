"""The `Mesh` type: nodes, linear triangles and quads, and the boundary they enclose."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from bipenalty import _core
from bipenalty import mesh_checks as check
from bipenalty.errors import InputError
from bipenalty.mesh_checks import Floats, Ints

_Scalar = TypeVar("_Scalar", bound=np.generic)


@dataclass(frozen=True, eq=False, repr=False)
class Mesh:
    """A two-dimensional mesh of linear triangles and bilinear quads, in metres.

    Every array is copied and read-only. `loops` is found, not given: closed boundary loops as node numbers
    without the repeated first one, the body on the left, so the outward normal is to the right of travel.
    A mesh that is clockwise throughout is turned round, with a warning.

    Parameters
    ----------
    points : (N, 2) coordinates, m.
    triangles : (T, 3) node numbers, anticlockwise.
    quads : (Q, 4) node numbers, anticlockwise.
    boundaries : named sets of boundary edges, name -> (E, 2) node numbers. The two nodes of an edge may come
        in either order; they are stored with the body on the left.
    name : what messages call this mesh.

    Raises
    ------
    InputError : a wrong shape or type, coordinates that are not finite, connectivity that is out of range or
        repeated, inverted or zero-area elements, nodes that no element uses, a boundary that is not a set of
        simple closed loops, a named edge that is not on the boundary.

    Example
    -------
    >>> import bipenalty as bp
    >>> square = bp.mesh.Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], quads=[[0, 1, 2, 3]], name="square")
    >>> square.loops[0].tolist()
    [0, 1, 2, 3]
    >>> square.scaled(2).moved(1, 0).points.max(axis=0).tolist()
    [3.0, 2.0]
    """

    points: Floats
    triangles: Ints = field(default_factory=lambda: np.empty((0, 3), dtype=np.int64))
    quads: Ints = field(default_factory=lambda: np.empty((0, 4), dtype=np.int64))
    boundaries: Mapping[str, Ints] = field(default_factory=dict)
    name: str = "mesh"
    loops: list[Ints] = field(init=False)

    def __post_init__(self) -> None:
        who = str(self)
        points = check.coordinates(who, self.points)
        given_triangles = check.connectivity(who, "triangles", self.triangles, 3)
        given_quads = check.connectivity(who, "quads", self.quads, 4)
        try:
            triangles, quads, turned, loops = _core.check_mesh(points, given_triangles, given_quads)
        except InputError as error:
            raise InputError(f"{self}: {str(error).removeprefix('mesh: ')}") from None
        if turned:
            warnings.warn(
                f"{self}: every element was clockwise; the mesh has been turned round. "
                "List the nodes of each element anticlockwise to silence this.",
                stacklevel=3,
            )
        self._set("points", _frozen(points))
        self._set("triangles", _frozen(triangles))
        self._set("quads", _frozen(quads))
        self._set("loops", [_frozen(loop) for loop in loops])
        self._set("boundaries", self._oriented(self.boundaries))

    @property
    def n_nodes(self) -> int:
        """Number of nodes."""
        return len(self.points)

    @property
    def n_elements(self) -> int:
        """Number of elements, triangles and quads together."""
        return len(self.triangles) + len(self.quads)

    def nodes_of(self, boundary_name: str) -> Ints:
        """Node numbers of a named boundary, each once, in increasing order."""
        if boundary_name not in self.boundaries:
            known = ", ".join(f'"{name}"' for name in self.boundaries) or "none: this mesh names no boundary"
            raise InputError(f'{self}: boundary = "{boundary_name}", must be one of: {known}')
        return np.unique(self.boundaries[boundary_name])

    def moved(self, dx: float, dy: float) -> Mesh:
        """The mesh moved by (dx, dy) in m."""
        shift = np.array([check.finite(str(self), "dx", dx), check.finite(str(self), "dy", dy)])
        return self._with_points(self.points + shift)

    def rotated(self, angle: float, about: tuple[float, float] = (0, 0)) -> Mesh:
        """The mesh turned anticlockwise by `angle` in rad about the point `about` in m."""
        turn = check.finite(str(self), "angle", angle)
        centre = check.point(str(self), "about", about)
        c, s = math.cos(turn), math.sin(turn)
        return self._with_points((self.points - centre) @ np.array([[c, s], [-s, c]]) + centre)

    def scaled(self, factor: float) -> Mesh:
        """The mesh with every coordinate multiplied by `factor` > 0."""
        remedy = "rotated(math.pi) turns a mesh round"
        return self._with_points(self.points * check.positive(str(self), "factor", factor, remedy))

    def __str__(self) -> str:
        return f'mesh "{self.name}"'

    def __repr__(self) -> str:
        names = ", ".join(self.boundaries) or "none named"
        return (
            f"<{self}: {self.n_nodes} nodes, {len(self.triangles)} triangles, {len(self.quads)} quads, "
            f"{len(self.loops)} loops, boundaries: {names}>"
        )

    def _set(self, name: str, value: object) -> None:
        object.__setattr__(self, name, value)  # the only way into a frozen dataclass

    def _with_points(self, points: Floats) -> Mesh:
        return Mesh(points, self.triangles, self.quads, self.boundaries, self.name)

    def _oriented(self, given: Any) -> dict[str, Ints]:
        """Named edges, each checked to be on a loop and ordered as the loop travels."""
        if not isinstance(given, Mapping):
            raise InputError(f"{self}: boundaries = {given!r}, must be a dict of name -> (E, 2) node numbers")
        start, end = np.concatenate(self.loops), np.concatenate([np.roll(loop, -1) for loop in self.loops])
        travel = start * self.n_nodes + end  # one integer for each directed boundary edge
        named: dict[str, Ints] = {}
        for name, value in given.items():
            edges = check.connectivity(str(self), f'boundary "{name}"', value, 2)
            forward = np.isin(edges[:, 0] * self.n_nodes + edges[:, 1], travel)
            backward = np.isin(edges[:, 1] * self.n_nodes + edges[:, 0], travel)
            in_range = ((edges >= 0) & (edges < self.n_nodes)).all(axis=1)
            bad = np.flatnonzero(~(in_range & (forward | backward)))
            if len(bad):
                edge = tuple(edges[bad[0]].tolist())
                raise InputError(
                    f'{self}: boundary "{name}": edge {bad[0]} = {edge}, must join two neighbouring nodes of '
                    f"the outer boundary; leave out edges inside the mesh ({len(bad)} such edges)"
                )
            named[str(name)] = _frozen(np.where(forward[:, None], edges, edges[:, ::-1]))
        return named


def _frozen(array: npt.NDArray[_Scalar]) -> npt.NDArray[_Scalar]:
    array = np.ascontiguousarray(array)
    array.flags.writeable = False
    return array
