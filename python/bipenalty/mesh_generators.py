"""Mesh generators: a disc (O-grid) and a rectangle, of quads or triangles."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from bipenalty import mesh_checks as check
from bipenalty.errors import InputError
from bipenalty.mesh_checks import Floats, Ints
from bipenalty.mesh_data import Mesh

Element = Literal["quad", "triangle"]

# The shape of the O-grid on the unit disc. At the four nodes where the core's corner meets two rings the
# angles are close to 3 x 120 degrees, the best three quads can do, and the layer under the rim is even.
CORE_CORNER = 0.8815  # distance of the core's corners from the centre
CORE_AXIS = 0.705  # half-width of the core on the axes; its sides bulge
RIM_SLOPE = 0.15  # thickness of a ring at the rim, times the number of rings
SEGMENTS_PER_RING = 116 / 5


def disc(
    radius: float = 1.0,
    segments: int = 116,
    element: Element = "quad",
    centre: tuple[float, float] = (0.0, 0.0),
) -> Mesh:
    """A disc with `segments` equal edges on its boundary, "rim".

    A square core of (segments / 4)^2 quads with bulging sides, inside rings that carry it to the circle.
    Triangles come from cutting each quad along its shorter diagonal.

    The default, with E = 1000 N/m^2, nu = 0.2, rho = 0.1 kg/m^3 in plane strain, has a critical time step of
    1.892e-4 s by the element bound, so half of it is the 9.46e-5 s of the colliding cylinders. Twice the
    segments have a little under half the time step.

    Parameters
    ----------
    radius : m, > 0.
    segments : number of edges on the rim, a positive multiple of 4.
    element : "quad" or "triangle".
    centre : m.

    Raises
    ------
    InputError : a value out of its bounds.

    Example
    -------
    >>> import bipenalty as bp
    >>> bp.mesh.disc(radius=0.5, segments=40).n_elements
    180
    """
    radius = check.positive("disc", "radius", radius)
    segments = check.count("disc", "segments", segments, multiple_of=4)
    middle = check.point("disc", "centre", centre)

    core, core_nodes = _core_grid(segments // 4)
    around = np.concatenate([core_nodes[0, :-1], core_nodes[:-1, -1], core_nodes[-1, :0:-1], core_nodes[:0:-1, 0]])
    rings = max(1, round(segments / SEGMENTS_PER_RING))
    layers = _ring_points(core[around], rings)
    ring_nodes = len(core) + np.arange(rings * segments).reshape(rings, segments)
    ring_nodes = np.vstack([ring_nodes[::-1], around])  # from the rim inwards: anticlockwise quads
    ring_nodes = np.hstack([ring_nodes, ring_nodes[:, :1]])  # closed

    points = radius * np.vstack([core, *layers]) + middle
    rim = np.stack([ring_nodes[0, :-1], ring_nodes[0, 1:]], axis=1)
    return _mesh(points, [core_nodes, ring_nodes], element, {"rim": rim}, "disc")


def rectangle(
    width: float,
    height: float,
    nx: int,
    ny: int,
    element: Element = "quad",
    origin: tuple[float, float] = (0.0, 0.0),
) -> Mesh:
    """A rectangle of nx by ny equal cells; its boundaries are "left", "right", "bottom", "top".

    Triangles come from cutting each cell in two, the diagonals alternating so that no direction is preferred.

    Parameters
    ----------
    width, height : m, > 0.
    nx, ny : number of cells along each, >= 1.
    element : "quad" or "triangle".
    origin : lower left corner, m.

    Raises
    ------
    InputError : a value out of its bounds.

    Example
    -------
    >>> import bipenalty as bp
    >>> bp.mesh.rectangle(2.0, 1.0, 4, 2).nodes_of("left").tolist()
    [0, 5, 10]
    """
    width = check.positive("rectangle", "width", width)
    height = check.positive("rectangle", "height", height)
    nx, ny = check.count("rectangle", "nx", nx), check.count("rectangle", "ny", ny)
    corner = check.point("rectangle", "origin", origin)

    x, y = np.meshgrid(np.linspace(0, width, nx + 1), np.linspace(0, height, ny + 1))
    nodes = np.arange(x.size).reshape(x.shape)
    points = np.stack([x.ravel(), y.ravel()], axis=1) + corner
    lines = {"left": nodes[:, 0], "right": nodes[:, -1], "bottom": nodes[0], "top": nodes[-1]}
    boundaries = {name: np.stack([line[:-1], line[1:]], axis=1) for name, line in lines.items()}
    return _mesh(points, [nodes], element, boundaries, "rectangle")


def _core_grid(n: int) -> tuple[Floats, Ints]:
    """The core of the unit disc: points and their (n+1, n+1) node numbers, rows upwards.

    The transfinite patch between four equal parabolas: x = s b(t), y = t b(s) for s, t in [-1, 1].
    """
    half_side = CORE_CORNER / math.sqrt(2)
    s, t = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1))
    x = s * (CORE_AXIS + (half_side - CORE_AXIS) * t**2)
    y = t * (CORE_AXIS + (half_side - CORE_AXIS) * s**2)
    return np.stack([x.ravel(), y.ravel()], axis=1), np.arange(x.size).reshape(x.shape)


def _ring_points(inner: Floats, rings: int) -> list[Floats]:
    """Points of the rings from the core's boundary `inner` (anticlockwise from -135 degrees) to the rim."""
    angle = -0.75 * math.pi + 2 * math.pi * np.arange(len(inner)) / len(inner)
    rim = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    gap = 1 - np.linalg.norm(inner, axis=1, keepdims=True)
    layers = []
    for ring in range(1, rings + 1):
        # Depth under the rim: the same slope at the rim all round, and the whole gap at the core.
        e = 1 - ring / rings
        depth = RIM_SLOPE * e + (gap - RIM_SLOPE) * e**2
        layers.append(rim + (inner - rim) * (depth / gap))
    return layers


def _mesh(points: Floats, grids: list[Ints], element: str, boundaries: dict[str, Ints], name: str) -> Mesh:
    """The mesh whose quads are the cells of the given grids of node numbers, cut in two for triangles."""
    if element not in ("quad", "triangle"):
        raise InputError(f'{name}: element = {element!r}, must be "quad" or "triangle"')
    cells = [np.stack([g[:-1, :-1], g[:-1, 1:], g[1:, 1:], g[1:, :-1]], axis=-1) for g in grids]
    quads = np.vstack([cell.reshape(-1, 4) for cell in cells])
    if element == "quad":
        return Mesh(points, quads=quads, boundaries=boundaries, name=name)
    odd = np.concatenate([np.indices(cell.shape[:2]).sum(axis=0).ravel() % 2 for cell in cells])
    return Mesh(points, triangles=_cut(points, quads, odd == 1), boundaries=boundaries, name=name)


def _cut(points: Floats, quads: Ints, odd: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> Ints:
    """Two triangles from each quad, along the shorter diagonal; equal diagonals alternate with `odd`."""
    a, b, c, d = quads.T
    first, second = (np.linalg.norm(points[p] - points[q], axis=1) for p, q in ((a, c), (b, d)))
    equal = np.isclose(first, second, rtol=1e-9)
    along_first = np.where(equal, ~odd, first < second)[:, None]
    lower = np.where(along_first, np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    upper = np.where(along_first, np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    return np.stack([lower, upper], axis=1).reshape(-1, 3)
