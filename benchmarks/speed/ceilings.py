"""What a step needs of the machine, counted from the mesh, and how long the machine's ceilings make that take."""

from dataclasses import dataclass

import numpy as np

import bipenalty as bp
from bipenalty import _core


@dataclass(frozen=True)
class Counts:
    """Nodes and 2x2 blocks of a stiffness matrix, and what a step with them takes.

    Per node-step the kernel reads blocks (32 bytes) with their columns (4), the start of the row (4) and the inverse
    mass (16), whatever the number of lanes. Per lane it reads u_n and v and writes v and u_{n+1}, 16 bytes each.

    Example
    -------
    >>> one = Counts(nodes=1, blocks=9)
    >>> one.multiply_adds, one.read, one.moved, one.resident(lanes=1)
    (40.0, 344.0, 64, 393.0)
    """

    nodes: int
    blocks: int

    @property
    def multiply_adds(self) -> float:
        """Per node-step and lane: four a block, two each for the new velocity and displacement."""
        return 4 * self.blocks / self.nodes + 4

    @property
    def read(self) -> float:
        """Bytes read per node-step whatever the number of lanes."""
        return 36 * self.blocks / self.nodes + 20

    @property
    def moved(self) -> int:
        """Bytes read and written per node-step and lane."""
        return 64

    def resident(self, lanes: int) -> float:
        """Bytes a node that a step goes through: one more for the pairing of rows, 48 a lane for u, u_{n+1} and v."""
        return self.read + 1 + 48 * lanes

    def working_set(self, lanes: int) -> int:
        """Bytes that a step goes through."""
        return round(self.nodes * self.resident(lanes))

    def streaming(self, lanes: int) -> float:
        """Seconds per node-step to read the matrix and move the state of all lanes at the probed bandwidths."""
        read, triad = _core.probe_bandwidth(self.working_set(lanes))
        return self.read / read + lanes * self.moved / triad


def counts(scene: bp.Scene) -> Counts:
    """Counts of a scene: each node couples with itself, both ways along edges and along diagonals of quads.

    Example
    -------
    >>> material = bp.LinearElastic(young=1, poisson=0.2, density=1)
    >>> counts(bp.Scene([bp.Body("plate", bp.mesh.rectangle(1, 1, 2, 2), material)]))
    Counts(nodes=9, blocks=49)
    """
    blocks = scene.n_nodes
    for body in scene.bodies:
        mesh = body.mesh
        edges = [np.stack([e, np.roll(e, -1, axis=1)], axis=-1).reshape(-1, 2) for e in (mesh.triangles, mesh.quads)]
        ends = np.sort(np.concatenate(edges).astype(np.int64), axis=1)
        blocks += 2 * len(np.unique(ends[:, 0] * mesh.n_nodes + ends[:, 1])) + 4 * len(mesh.quads)
    return Counts(scene.n_nodes, blocks)


def multiply_add() -> float:
    """Seconds per multiply-add of one core at its best."""
    return 1 / _core.probe_fma_rate()
