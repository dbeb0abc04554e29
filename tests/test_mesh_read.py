"""Mesh files: regions, named boundaries, formats, and what is wrong with a file."""

import math
from pathlib import Path

import meshio
import numpy as np
import pytest

import bipenalty as bp
from bipenalty.errors import InputError

EXAMPLE = Path(__file__).resolve().parents[1] / "examples/meshes/wedge_and_block.msh"

# Two unit quads side by side, and the diagonal that cuts the right one:
#   3---4---5
#   |   | / |
#   0---1---2
POINTS = [[0, 0], [1, 0], [2, 0], [0, 1], [1, 1], [2, 1]]
QUAD = [[0, 1, 4, 3]]
TRIANGLES = [[1, 2, 5], [1, 5, 4]]


def test_read_regions() -> None:
    assert bp.mesh.regions(EXAMPLE) == ["anvil", "hammer"]
    hammer, anvil = bp.mesh.read(EXAMPLE, "hammer"), bp.mesh.read(EXAMPLE, region="anvil")
    assert (hammer.name, anvil.name) == ("hammer", "anvil")
    assert set(hammer.boundaries) == {"nose", "back"}
    assert set(anvil.boundaries) == {"face", "base", "hole"}
    assert (len(hammer.loops), len(anvil.loops)) == (1, 2)
    ab, ac = (anvil.points[anvil.triangles[:, i]] - anvil.points[anvil.triangles[:, 0]] for i in (1, 2))
    area = 0.5 * (ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0])
    assert area.min() > 0
    assert area.sum() == pytest.approx(0.140 * 0.055 - math.pi * 0.012**2, rel=1e-3)
    np.testing.assert_allclose(anvil.points[anvil.nodes_of("base"), 1], -0.055)
    np.testing.assert_allclose(anvil.points[anvil.nodes_of("face"), 1], 0.0, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(anvil.points[anvil.nodes_of("hole")] - [0, -0.03], axis=1), 0.012)
    np.testing.assert_allclose(np.linalg.norm(hammer.points[hammer.nodes_of("nose")] - [0.012, 0.0125], axis=1), 0.012)
    both = bp.mesh.read(EXAMPLE)
    assert (both.name, len(both.loops)) == ("wedge_and_block", 3)
    assert both.n_nodes == hammer.n_nodes + anvil.n_nodes
    assert len(both.boundaries) == 5


def test_read_drops_the_lines_of_others(tmp_path: Path) -> None:
    """Two regions that share an interface: a boundary of each, but not of the whole."""
    path = tmp_path / "shared.msh"
    lines, line_tags = [[1, 4], [3, 0]], [7, 8]
    cells = [("line", lines), ("quad", QUAD), ("triangle", TRIANGLES)]
    tags = [np.array(line_tags), np.array([1]), np.array([2, 2])]
    names = {"seam": np.array([7, 1]), "end": np.array([8, 1]), "one": np.array([1, 2])}
    meshio.Mesh(
        np.column_stack([POINTS, np.zeros(6)]),
        cells,
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data=names,
    ).write(path, file_format="gmsh22", binary=False)
    assert bp.mesh.regions(path) == ["2", "one"]  # a physical surface without a name goes by its number
    assert list(bp.mesh.read(path).boundaries) == ["end"]
    assert sorted(bp.mesh.read(path, "one").boundaries) == ["end", "seam"]
    right = bp.mesh.read(path, "2")
    assert (right.n_nodes, len(right.triangles), len(right.quads)) == (4, 2, 0)
    assert right.boundaries["seam"].tolist() == [[2, 0]]


def test_read_any_format(tmp_path: Path) -> None:
    for suffix in ("vtu", "vtk", "inp", "off"):
        cells = [("triangle", [[0, 1, 2]])]
        path = tmp_path / f"one.{suffix}"
        meshio.Mesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=float), cells).write(path)
        mesh = bp.mesh.read(path)
        assert (mesh.name, mesh.triangles.tolist()) == ("one", [[0, 1, 2]])
        assert bp.mesh.regions(path) == []
        with pytest.raises(InputError, match=r'region = "all", but the file names no region; leave region out'):
            bp.mesh.read(path, "all")


def test_read_abaqus_sets(tmp_path: Path) -> None:
    path = tmp_path / "sets.inp"
    sets = {
        "one": [np.array([0]), np.array([], dtype=int)],
        "two": [np.array([], dtype=int), np.array([0, 1])],
    }
    points = np.column_stack([POINTS, np.zeros(6)])
    meshio.Mesh(points, [("quad", QUAD), ("triangle", TRIANGLES)], cell_sets=sets).write(path)
    assert bp.mesh.regions(path) == ["one", "two"]
    assert bp.mesh.read(path, "two").n_nodes == 4


def test_bad_files(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r'mesh file ".*none.msh": does not exist; the current folder is'):
        bp.mesh.read(tmp_path / "none.msh")
    for name in ("text.msh", "text.vtu", "text.unknown"):
        (tmp_path / name).write_text("not a mesh")
        with pytest.raises(InputError, match=rf'mesh file ".*{name}": meshio cannot read it \(.+\); check'):
            bp.mesh.read(tmp_path / name)
    with pytest.raises(InputError, match=r'region = "hamer", must be one of: "anvil", "hammer"'):
        bp.mesh.read(EXAMPLE, "hamer")


def test_bad_cells(tmp_path: Path) -> None:
    def written(name: str, cells: list[tuple[str, object]], points: np.ndarray) -> Path:
        meshio.Mesh(points, cells).write(tmp_path / name)
        return tmp_path / name

    square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0, 0], [1, 0.5, 0], [0.5, 0.5, 0]])
    path = written("lines.vtu", [("line", [[0, 1], [1, 2]])], square)
    with pytest.raises(InputError, match=r"lines.vtu\": has 2 line, must have triangle or quad cells; mesh in 2-D"):
        bp.mesh.read(path)
    path = written("second.vtu", [("triangle6", [[0, 1, 2, 4, 5, 6]])], square)
    with pytest.raises(InputError, match=r"has 1 triangle6, must have .* only; .*Mesh.ElementOrder = 1"):
        bp.mesh.read(path)
    path = written("shell.vtu", [("quad", [[0, 1, 2, 3]])], square + [[0, 0, i == 2] for i in range(7)])
    with pytest.raises(InputError, match=r"z ranges from 0 to 1 m, must be constant; .*x-y plane"):
        bp.mesh.read(path)
