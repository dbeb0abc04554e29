"""CalculiX's input and output: the deck of the two cylinders as a slice of bricks, and the tables it prints.

Its plane elements do not move under *DYNAMIC, EXPLICIT; one layer of bricks held in the third direction is plane strain.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import bipenalty as bp
from peers.interface import DENSITY, POISSON, VELOCITY, YOUNG, Array, Case, scene, segment_length

#: Faces of a brick over the edges 1-2, 2-3, 3-4, 4-1 of its quad.
FACES = ("S3", "S4", "S5", "S6")


@dataclass(frozen=True)
class Table:
    """One printed table: what, at which time (s), of which nodes (n,), their values (n, 3)."""

    what: str
    time: float
    nodes: NDArray[np.int64]
    values: Array


def deck(mesh: bp.Mesh, case: Case, every: int) -> str:
    """The input file; the nodes of the front face are numbered as in the scene, from 1, and printed each `every` steps.

    Contact pressure is the slope times the overlap. A node carries half of that over the length that it stands for, its
    copy on the rear face the other half, so that both together are as stiff as the one of the plane problem.
    """
    bodies = scene(mesh).bodies
    nodes = sum(body.mesh.n_nodes for body in bodies)
    lines = ["*NODE, NSET=ALL"]
    for z, shift in ((0.0, 0), (1.0, nodes)):
        points = np.concatenate([body.mesh.points for body in bodies])
        lines += [f"{i + shift}, {x:.12g}, {y:.12g}, {z:g}" for i, (x, y) in enumerate(points.tolist(), start=1)]
    first_node = first_quad = 1
    for body, young in zip(bodies, YOUNG, strict=True):
        name, quads = body.name.upper(), body.mesh.quads + first_node
        lines.append(f"*ELEMENT, TYPE=C3D8, ELSET=E{name}")
        bricks = np.hstack([quads, quads + nodes])
        lines += [f"{i}, {', '.join(map(str, brick))}" for i, brick in enumerate(bricks.tolist(), start=first_quad)]
        here = first_node + np.arange(body.mesh.n_nodes)
        lines += [f"*NSET, NSET=N{name}", *rows(np.concatenate([here, here + nodes]))]
        lines += [f"*MATERIAL, NAME=M{name}", "*ELASTIC", f"{young:g}, {POISSON:g}", "*DENSITY", f"{DENSITY:g}"]
        lines += [f"*SOLID SECTION, ELSET=E{name}, MATERIAL=M{name}"]
        lines += [f"*SURFACE, NAME=S{name}, TYPE=ELEMENT", *faces(body.mesh, first_quad)]
        first_node, first_quad = first_node + body.mesh.n_nodes, first_quad + len(quads)
    lines += ["*NSET, NSET=FRONT", *rows(1 + np.arange(nodes))]
    lines += ["*SURFACE INTERACTION, NAME=PUSH", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"]
    lines += [f"{case.alpha_s / segment_length(mesh):.12g}, 0."]
    lines += ["*CONTACT PAIR, INTERACTION=PUSH, TYPE=NODE TO SURFACE", "STOP, SBOTTOM"]
    lines += ["*INITIAL CONDITIONS, TYPE=VELOCITY"]
    lines += [f"NBOTTOM, {i}, {v:.12g}" for i, v in enumerate(VELOCITY, start=1)]
    lines += ["*BOUNDARY", "ALL, 3, 3", "*STEP, INC=100000000", "*DYNAMIC, EXPLICIT"]
    lines += [f"{case.dt:.12g}, {case.t_end:.12g}, 1e-12, {case.dt:.12g}"]
    return "\n".join([*lines, f"*NODE PRINT, NSET=FRONT, FREQUENCY={every}", "U, V", "*END STEP", ""])


def rows(numbers: NDArray[np.int64]) -> list[str]:
    """Node numbers, eight to a line."""
    return [", ".join(map(str, numbers[i : i + 8])) + "," for i in range(0, len(numbers), 8)]


def faces(mesh: bp.Mesh, first: int) -> list[str]:
    """Faces over the rim, with elements numbered from `first`."""
    rim = {frozenset(edge) for edge in mesh.boundaries["rim"].tolist()}
    edges = (
        (i, k, {quad[k], quad[(k + 1) % 4]}) for i, quad in enumerate(mesh.quads.tolist(), first) for k in range(4)
    )
    return [f"{i}, {FACES[k]}" for i, k, edge in edges if edge in rim]


def tables(lines: Iterable[str]) -> Iterator[Table]:
    """The tables of a .dat file one after the other; of one that breaks off, the lines that are whole."""
    what, time = "", 0.0
    nodes: list[int] = []
    values: list[list[float]] = []
    for line in lines:
        words = line.split() if line.endswith("\n") else []
        if " (v" in line and words:
            if nodes:
                yield Table(what, time, np.array(nodes), np.array(values))
            what, time, nodes, values = words[0], number(words[-1]), [], []
        elif len(words) == 4 and words[0].isdigit():
            nodes.append(int(words[0]))
            values.append([number(word) for word in words[1:]])
    if nodes:
        yield Table(what, time, np.array(nodes), np.array(values))


def number(word: str) -> float:
    """A number as Fortran prints it: without the E where the exponent takes three digits.

    Example
    -------
    >>> number("-0.123457-104") == -0.123457e-104, number("NaN") != number("NaN")
    (True, True)
    """
    try:
        return float(word)
    except ValueError:
        cut = max(word.rfind("+"), word.rfind("-"))
        return float(f"{word[:cut]}E{word[cut:]}")
