"""Mesh files: any two-dimensional mesh meshio reads, by region, with its named boundaries."""

from __future__ import annotations

import contextlib
import io
import os
from pathlib import Path
from typing import Any

import numpy as np

from bipenalty.errors import InputError
from bipenalty.mesh_checks import Floats, Ints
from bipenalty.mesh_data import Mesh

# A group of cells in a file: for each cell block of the file the indices of its members.
Group = list[Ints]


def read(path: str | os.PathLike[str], region: str | None = None) -> Mesh:
    """The triangles and quads of a mesh file, coordinates taken to be in m.

    Named lines of the file (in gmsh: physical curves) become named boundaries; edges that are not on the
    boundary of what is read are left out. Nodes that belong to nothing that is read are dropped and the rest
    renumbered in the order of the file. The mesh is named after the region, or else after the file.

    Parameters
    ----------
    path : any file meshio reads (gmsh .msh, Abaqus .inp, .vtu, ...); the mesh must lie in the x-y plane.
    region : name of the region to read (in gmsh: a physical surface); None reads every region as one mesh.

    Raises
    ------
    InputError : a file that cannot be read, that has no triangles or quads, that has elements of higher order
        or that is not plane; an unknown region.

    Example
    -------
    >>> import bipenalty as bp
    >>> hammer = bp.mesh.read("examples/meshes/wedge_and_block.msh", region="hammer")
    >>> sorted(hammer.boundaries)
    ['back', 'nose']
    """
    data, where = _load(path)
    groups = _groups(data)
    chosen = _chosen(data, groups, region, where)
    triangles, quads = (_cells(data, chosen, kind) for kind in ("triangle", "quad"))
    _check_cells(data, chosen, len(triangles) + len(quads), where)

    used = np.unique(np.concatenate([triangles.ravel(), quads.ravel()]))
    points = _plane(np.asarray(data.points, dtype=np.float64), used, where)
    number = np.full(len(data.points), -1, dtype=np.int64)  # new number of each node of the file
    number[used] = np.arange(len(used))
    triangles, quads = number[triangles], number[quads]

    outer = _outer_edges(triangles, quads)
    boundaries = {}
    for name, group in groups.items():
        edges = np.sort(number[_cells(data, group, "line")], axis=1)
        edges = edges[np.isin(edges[:, 0] * len(used) + edges[:, 1], outer) & (edges[:, 0] >= 0)]
        if len(edges):
            boundaries[name] = np.unique(edges, axis=0)
    return Mesh(points, triangles, quads, boundaries, name=region or Path(path).stem)


def regions(path: str | os.PathLike[str]) -> list[str]:
    """Names of the regions `read` can pick from a mesh file; empty if the file names none.

    Example
    -------
    >>> import bipenalty as bp
    >>> bp.mesh.regions("examples/meshes/wedge_and_block.msh")
    ['anvil', 'hammer']
    """
    data, _ = _load(path)
    return _surfaces(data, _groups(data))


def _load(path: str | os.PathLike[str]) -> tuple[Any, str]:
    """The meshio mesh and the words that name the file in messages."""
    import meshio  # on first use: importing it takes longer than most meshes take to build

    where = f'mesh file "{os.fspath(path)}"'
    if not Path(path).is_file():
        raise InputError(f"{where}: does not exist; the current folder is {os.getcwd()}")
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            return meshio.read(path), where
    except (Exception, SystemExit) as error:  # meshio's readers raise anything, and exit on an unknown format
        reason = " ".join(f"{said.getvalue()} {'' if isinstance(error, SystemExit) else error}".split())
        raise InputError(
            f"{where}: meshio cannot read it ({reason or type(error).__name__}); "
            "check the file's extension and that it is complete"
        ) from error


def _groups(data: Any) -> dict[str, Group]:
    """Every named group of cells. A gmsh group without a name goes by its number."""
    groups: dict[str, Group] = {}
    for name, members in data.cell_sets.items():
        if not name.startswith("gmsh:"):
            groups[name] = [np.asarray(() if m is None else m, dtype=np.int64) for m in members]
    if "gmsh:physical" in data.cell_data:
        names = {(dim, tag): name for name, (tag, dim) in data.field_data.items()}
        for i, tags in enumerate(data.cell_data["gmsh:physical"]):
            for tag in np.unique(tags):
                name = names.get((data.cells[i].dim, tag), str(tag))
                if name in data.cell_sets:
                    continue  # already complete
                empty = [np.empty(0, dtype=np.int64) for _ in data.cells]
                groups.setdefault(name, empty)[i] = np.flatnonzero(tags == tag)
    return groups


def _surfaces(data: Any, groups: dict[str, Group]) -> list[str]:
    return sorted(
        name
        for name, group in groups.items()
        if any(len(members) and block.dim == 2 for members, block in zip(group, data.cells, strict=True))
    )


def _chosen(data: Any, groups: dict[str, Group], region: str | None, where: str) -> Group:
    if region is None:
        return [np.arange(len(block.data)) for block in data.cells]
    names = _surfaces(data, groups)
    if region not in names:
        known = ", ".join(f'"{name}"' for name in names)
        remedy = f"must be one of: {known}" if known else "but the file names no region; leave region out"
        raise InputError(f'{where}: region = "{region}", {remedy}')
    return groups[region]


def _cells(data: Any, group: Group, kind: str) -> Ints:
    """Connectivity of the group's cells of one kind, in file numbering."""
    width = {"line": 2, "triangle": 3, "quad": 4}[kind]
    found = [
        np.asarray(block.data, dtype=np.int64)[members]
        for members, block in zip(group, data.cells, strict=True)
        if block.type == kind
    ]
    return np.concatenate([np.empty((0, width), dtype=np.int64), *found])


def _check_cells(data: Any, group: Group, count: int, where: str) -> None:
    blocks = [(b, len(members)) for members, b in zip(group, data.cells, strict=True) if len(members)]
    counts: dict[str, int] = {}
    for block, n in blocks:
        counts[block.type] = counts.get(block.type, 0) + n
    has = ", ".join(f"{n} {kind}" for kind, n in counts.items()) or "no cells"
    if any(block.dim == 2 and block.type not in ("triangle", "quad") for block, _ in blocks):
        raise InputError(
            f"{where}: has {has}, must have triangle and quad cells only; "
            "mesh with linear elements (in gmsh: Mesh.ElementOrder = 1)"
        )
    if count == 0:
        raise InputError(
            f"{where}: has {has}, must have triangle or quad cells; "
            "mesh in 2-D and save the surfaces (in gmsh: -2, and a Physical Surface for each body)"
        )


def _plane(points: Floats, used: Ints, where: str) -> Floats:
    x = points[used]
    size = np.ptp(x[:, :2], axis=0).max()
    if x.shape[1] > 2 and np.ptp(x[:, 2]) > 1e-9 * size:
        raise InputError(
            f"{where}: z ranges from {x[:, 2].min():g} to {x[:, 2].max():g} m, must be constant; "
            "a two-dimensional mesh lies in the x-y plane"
        )
    return x[:, :2]


def _outer_edges(triangles: Ints, quads: Ints) -> Ints:
    """Edges of one element only, each as smaller node * number of nodes + larger node."""
    pairs = [np.stack([c, np.roll(c, -1, axis=1)], axis=-1).reshape(-1, 2) for c in (triangles, quads)]
    edges = np.sort(np.concatenate(pairs), axis=1)
    keys, count = np.unique(edges[:, 0] * (edges.max() + 1) + edges[:, 1], return_counts=True)
    once: Ints = keys[count == 1]
    return once
