"""Displacements at points of the bodies, so that runs on unlike meshes compare."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from bipenalty.scene import Scene

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


def centroids(scene: Scene) -> tuple[Floats, Ints]:
    """Centroids of all elements, (p, 2) in m, and the body of each, (p,): points well inside the bodies."""
    places = [_triangles(body.mesh)[0].mean(axis=1) for body in scene.bodies]
    owners = np.repeat(np.arange(len(places)), [len(part) for part in places])
    return np.concatenate(places), owners


class Sampler:
    """Linear interpolation of nodal values at points of the undeformed bodies; quads are cut in two.

    Parameters
    ----------
    scene : the bodies.
    points : (p, 2), m; one just outside a body is extrapolated to.
    bodies : (p,) number of the body of each.

    Example
    -------
    >>> import bipenalty as bp
    >>> bar = bp.Body("bar", bp.mesh.rectangle(2, 1, 4, 2), bp.LinearElastic(900, 0, 1))
    >>> at = Sampler(bp.Scene([bar]), np.array([[1.3, 0.4]]), np.array([0]))
    >>> at(bar.mesh.points).round(12)
    array([[1.3, 0.4]])
    """

    def __init__(self, scene: Scene, points: Floats, bodies: Ints) -> None:
        self.nodes = np.empty((len(points), 3), dtype=np.int64)
        self.weights = np.empty((len(points), 3))
        first = 0
        for b, body in enumerate(scene.bodies):
            own = np.flatnonzero(bodies == b)
            corners, nodes = _triangles(body.mesh)
            origin, sides = corners[:, 2], corners[:, :2] - corners[:, 2:]
            inverse = np.linalg.inv(sides.transpose(0, 2, 1))
            for i in own:
                two = np.einsum("tij,tj->ti", inverse, points[i] - origin)
                shares = np.column_stack([two, 1 - two.sum(axis=1)])
                best = int(shares.min(axis=1).argmax())
                self.nodes[i], self.weights[i] = nodes[best] + first, shares[best]
            first += body.mesh.n_nodes

    def __call__(self, values: Any) -> Floats:
        """Values (..., N, 2) of the nodes at the points, (..., p, 2)."""
        return np.asarray((np.asarray(values)[..., self.nodes, :] * self.weights[:, :, None]).sum(axis=-2))


def _triangles(mesh: Any) -> tuple[Floats, Ints]:
    """Corners (t, 3, 2) in m and nodes (t, 3) of the triangles and of the halves of the quads."""
    nodes = np.concatenate([mesh.triangles, mesh.quads[:, [0, 1, 2]], mesh.quads[:, [0, 2, 3]]])
    return mesh.points[nodes], nodes
