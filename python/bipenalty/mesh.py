"""Meshes: the `Mesh` type, the generators `disc` and `rectangle`, and `read` for files.

Example
-------
>>> import bipenalty as bp
>>> disc = bp.mesh.disc(radius=1.0, segments=116).moved(0, 2)
>>> disc.n_nodes, disc.n_elements, len(disc.nodes_of("rim"))
(1480, 1421, 116)
"""

from bipenalty.mesh_data import Mesh
from bipenalty.mesh_generators import disc, rectangle
from bipenalty.mesh_read import read, regions

__all__ = ["Mesh", "disc", "read", "rectangle", "regions"]
