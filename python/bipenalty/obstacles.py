"""Rigid obstacles without degrees of freedom."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from bipenalty import checks


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
