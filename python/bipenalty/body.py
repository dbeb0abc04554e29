"""Deformable bodies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

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
        checks.within(
            owner,
            "mesh",
            type(self.mesh).__name__,
            isinstance(self.mesh, Mesh),
            "a bipenalty.Mesh",
            "make one with Mesh(points, triangles, quads), mesh.disc, mesh.rectangle or mesh.read",
        )
        checks.within(
            owner,
            "material",
            type(self.material).__name__,
            isinstance(self.material, LinearElastic),
            "a LinearElastic",
            "give one",
        )
        nodes = self.mesh.n_nodes
        object.__setattr__(self, "velocity", checks.nodal(owner, "velocity", self.velocity, nodes))
        start = (0.0, 0.0) if self.displacement is None else self.displacement
        object.__setattr__(self, "displacement", checks.nodal(owner, "displacement", start, nodes))
        object.__setattr__(self, "body_force", checks.pair(owner, "body_force", self.body_force))
        object.__setattr__(self, "thickness", checks.number(owner, "thickness", self.thickness))
