"""The mesh type: what it finds, and one bad input for each of its rules."""

import dataclasses
import math

import numpy as np
import pytest

import bipenalty as bp
from bipenalty.errors import InputError

# Two unit quads side by side, and the diagonal that cuts the right one:
#   3---4---5
#   |   | / |
#   0---1---2
POINTS = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]]
QUAD = [[0, 1, 4, 3]]
TRIANGLES = [[1, 2, 5], [1, 5, 4]]


def pair(**changes: object) -> bp.mesh.Mesh:
    """The mesh of the sketch, with some arguments changed."""
    given: dict[str, object] = {"points": POINTS, "triangles": TRIANGLES, "quads": QUAD, "name": "pair"}
    return bp.mesh.Mesh(**{**given, **changes})  # type: ignore[arg-type]


def areas(mesh: bp.mesh.Mesh) -> np.ndarray:
    """Signed area of each element, triangles first."""
    both = []
    for cells in (mesh.triangles, mesh.quads):
        x, y = mesh.points[cells][..., 0], mesh.points[cells][..., 1]
        both.append(0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1))
    return np.concatenate(both)


def test_what_is_found() -> None:
    mesh = pair(boundaries={"left": [[0, 3]], "right": [[2, 5]], "floor": [[1, 0], [1, 2]]})
    assert (mesh.n_nodes, mesh.n_elements) == (6, 3)
    assert [loop.tolist() for loop in mesh.loops] == [[0, 1, 2, 5, 4, 3]]
    assert mesh.boundaries["left"].tolist() == [[3, 0]]  # turned: the body is on the left
    assert mesh.boundaries["right"].tolist() == [[2, 5]]
    assert mesh.boundaries["floor"].tolist() == [[0, 1], [1, 2]]
    assert mesh.nodes_of("floor").tolist() == [0, 1, 2]
    assert repr(mesh) == '<mesh "pair": 6 nodes, 2 triangles, 1 quads, 1 loops, boundaries: left, right, floor>'


def test_arrays_are_copies_and_read_only() -> None:
    points = np.array(POINTS, dtype=float)
    mesh = pair(points=points, boundaries={"left": [[3, 0]]})
    points[0] = 9
    assert mesh.points[0].tolist() == [0, 0]
    for array in (mesh.points, mesh.triangles, mesh.quads, *mesh.loops, *mesh.boundaries.values()):
        assert not array.flags.writeable
    with pytest.raises(dataclasses.FrozenInstanceError):
        mesh.name = "other"  # type: ignore[misc]


def test_triangles_alone_or_none() -> None:
    assert len(bp.mesh.Mesh(np.array(POINTS[:3]) * [1, 2] + [[0, 0], [0, 0], [0, 1]], [[0, 1, 2]]).quads) == 0
    assert len(bp.mesh.Mesh(np.array(POINTS)[[0, 1, 3, 4]], None, [[0, 1, 3, 2]]).triangles) == 0


def test_clockwise_is_turned_with_a_warning() -> None:
    with pytest.warns(UserWarning, match=r'mesh "pair": every element was clockwise.*turned round'):
        mesh = pair(
            triangles=np.array(TRIANGLES)[:, ::-1],
            quads=np.array(QUAD)[:, ::-1],
            boundaries={"left": [[0, 3]]},
        )
    assert (areas(mesh) > 0).all()
    assert mesh.boundaries["left"].tolist() == [[3, 0]]
    assert mesh.loops[0].tolist() == [0, 1, 2, 5, 4, 3]


def test_a_hole_is_a_clockwise_loop() -> None:
    around = np.array([(i, j) for j in range(4) for i in range(4)], dtype=float)
    cells = [[i + 4 * j, i + 1 + 4 * j, i + 5 + 4 * j, i + 4 + 4 * j] for j in range(3) for i in range(3)]
    del cells[4]
    loops = bp.mesh.Mesh(around, quads=cells).loops
    assert sorted(map(len, loops)) == [4, 12]
    assert min(loops, key=len).tolist() == [5, 9, 10, 6]


def test_moved_rotated_scaled() -> None:
    mesh = pair(boundaries={"left": [[3, 0]]})
    np.testing.assert_allclose(mesh.moved(2, -1).points, np.add(POINTS, [2, -1]))
    np.testing.assert_allclose(mesh.scaled(0.5).points, np.array(POINTS) / 2)
    np.testing.assert_allclose(mesh.rotated(math.pi / 2).points[2], [0, 2], atol=1e-15)
    turned = mesh.rotated(math.pi / 2, about=(1, 0))
    np.testing.assert_allclose(turned.points[[0, 1]], [[1, -1], [1, 0]], atol=1e-15)
    assert (turned.name, list(turned.boundaries)) == ("pair", ["left"])
    np.testing.assert_allclose(areas(turned), areas(mesh))


BAD_MESHES = [
    ({"points": [[0, 0], [1]]}, "points = .*must be numbers in an \\(N, 2\\) array"),
    ({"points": np.zeros((6, 3))}, r"points has shape \(6, 3\), must be \(N, 2\); .*points\[:, :2\]"),
    ({"points": [*POINTS[:5], [2, math.nan]]}, r"points\[5\] = \(2.0, nan\), must be finite; mend"),
    ({"points": [*POINTS[:5], [math.inf, 1]]}, r"points\[5\] = \(inf, 1.0\), must be finite"),
    ({"points": np.empty((0, 2))}, "points = 0, must be"),
    ({"triangles": None, "quads": []}, "number of elements = 0, must be >= 1; give triangles or quads"),
    ({"quads": [[0, 1, 4]]}, r"quads has shape \(1, 3\), must be \(count, 4\); 4 node numbers"),
    ({"quads": [0, 1, 4, 3]}, r"quads has shape \(4,\), must be \(count, 4\)"),
    ({"triangles": [[1, 2, 5], [1, 5]]}, "triangles has rows of different lengths, must be"),
    (
        {"triangles": [[1.0, 2.0, 5.0]]},
        r"triangles has dtype float64, must be of integers; use astype\(int\)",
    ),
    ({"triangles": [[1, 2, 6], [1, 5, 4]]}, r"triangle 0 node = 6, must be from 0 to 5.*; number nodes from 0"),
    ({"triangles": [[1, 2, -1], [1, 5, 4]]}, r"-1, must be .*; number nodes from 0"),
    ({"triangles": [[1, 2, 2], [1, 5, 4]]}, r"triangle 0 = \[1, 2, 2\], must be of distinct nodes; remove"),
    (
        {"triangles": [*TRIANGLES, [2, 5, 1]]},
        r"\[1, 2, 5\], must be listed once; remove the repeated element",
    ),
    ({"triangles": [[1, 2, 5], [1, 4, 5]]}, r"triangle 1 .*area = -5.000e-1 m\^2, must be > 0; order"),
    ({"quads": [[0, 1, 3, 4]]}, r"quad 0 .*area = .*, must be > 0; order its nodes"),
    ({"points": [*POINTS[:4], [2, 0.5], [2, 1]]}, r"triangle 1 .*area = .*, must be > 0"),
    ({"points": [*POINTS, [5, 5]]}, "first: node 6.* = 1, must be 0; remove them"),
    (
        {"quads": [[0, 1, 4, 3], [1, 2, 5, 4]]},
        "edge between nodes .* = [34], must be <= 2; remove overlapping",
    ),
    (
        {"triangles": [[1, 2, 5]], "points": [*POINTS[:4], [0.5, 1], [2, 1]]},
        "boundary is not closed loops.*split",
    ),
    ({"boundaries": [[0, 1]]}, r"boundaries = .*, must be a dict"),
    ({"boundaries": {"cut": [[1, 4]]}}, r'boundary "cut": edge 0 = \(1, 4\), must join .*; leave out edges'),
    ({"boundaries": {"far": [[0, 1], [5, 6]]}}, r'boundary "far": edge 1 = \(5, 6\), must join'),
    ({"boundaries": {"wide": [[0, 1, 2]]}}, r'boundary "wide" has shape \(1, 3\), must be \(count, 2\)'),
]


@pytest.mark.parametrize(("changes", "message"), BAD_MESHES)
def test_bad_mesh(changes: dict[str, object], message: str) -> None:
    with pytest.raises(InputError, match='^mesh "pair": .*' + message) as raised:
        pair(**changes)
    assert isinstance(raised.value, ValueError)
    assert str(raised.value).count("mesh") <= 3


def test_bad_boundary_name() -> None:
    with pytest.raises(InputError, match='mesh "pair": boundary = "rim", must be one of: "left"'):
        pair(boundaries={"left": [[3, 0]]}).nodes_of("rim")
    with pytest.raises(InputError, match="names no boundary"):
        pair().nodes_of("rim")


def test_bad_moves() -> None:
    with pytest.raises(InputError, match='mesh "pair": dx = nan, must be a finite number'):
        pair().moved(math.nan, 0)
    with pytest.raises(InputError, match="angle = inf, must be a finite number"):
        pair().rotated(math.inf)
    with pytest.raises(InputError, match=r"about = \(1, 2, 3\), must be two finite numbers"):
        pair().rotated(1.0, about=(1, 2, 3))  # type: ignore[arg-type]
    with pytest.raises(InputError, match=r"factor = -1, must be a finite number > 0; rotated\(math.pi\)"):
        pair().scaled(-1)
