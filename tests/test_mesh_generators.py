"""Generators: counts, areas, orientation, quality, the time step of the disc, and bad input."""

import math
import re

import numpy as np
import pytest

import bipenalty as bp
from bipenalty.errors import InputError
from oracle import Body, element_bound


def areas(mesh: bp.mesh.Mesh) -> np.ndarray:
    """Signed area of each element, triangles first."""
    both = []
    for cells in (mesh.triangles, mesh.quads):
        x, y = mesh.points[cells][..., 0], mesh.points[cells][..., 1]
        both.append(0.5 * (x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(axis=1))
    return np.concatenate(both)


def corner_sines(mesh: bp.mesh.Mesh) -> np.ndarray:
    """Sine of the angle at each corner of each quad; 1 is a right angle."""
    edges = np.roll(mesh.points[mesh.quads], -1, axis=1) - mesh.points[mesh.quads]
    edges /= np.linalg.norm(edges, axis=2, keepdims=True)
    before = -np.roll(edges, 1, axis=1)
    return edges[..., 0] * before[..., 1] - edges[..., 1] * before[..., 0]


@pytest.mark.parametrize("element", ["quad", "triangle"])
@pytest.mark.parametrize("segments", [4, 8, 12, 36, 40, 116])
def test_disc(segments: int, element: str) -> None:
    mesh = bp.mesh.disc(radius=2.0, segments=segments, element=element, centre=(3, 4))
    quads = (segments // 4) ** 2 + max(1, round(5 * segments / 116)) * segments
    assert (len(mesh.quads), len(mesh.triangles)) == ((quads, 0) if element == "quad" else (0, 2 * quads))
    assert (areas(mesh) > 0).all()
    polygon = 0.5 * segments * 2.0**2 * math.sin(2 * math.pi / segments)
    assert areas(mesh).sum() == pytest.approx(polygon, rel=1e-12)
    (loop,) = mesh.loops
    assert len(loop) == segments
    assert np.array_equal(np.sort(loop), mesh.nodes_of("rim"))
    np.testing.assert_allclose(np.linalg.norm(mesh.points[loop] - [3, 4], axis=1), 2.0)
    sides = np.linalg.norm(mesh.points[np.roll(loop, -1)] - mesh.points[loop], axis=1)
    np.testing.assert_allclose(sides, 4 * math.sin(math.pi / segments))


def test_disc_time_step_of_the_colliding_cylinders() -> None:
    """E = 1000 N/m^2, nu = 0.2, rho = 0.1 kg/m^3, plane strain, radius 1 m: half of 2/omega is 9.46e-5 s."""

    def half_critical(segments: int) -> float:
        mesh = bp.mesh.disc(segments=segments)
        body = Body(mesh.points, quads=mesh.quads, young=1000.0, poisson=0.2, density=0.1)
        return 0.5 * 2 / element_bound([body])

    assert half_critical(116) == pytest.approx(9.46e-5, rel=0.005)
    assert half_critical(232) / half_critical(116) == pytest.approx(0.5, abs=0.07)


def test_disc_quality() -> None:
    mesh = bp.mesh.disc()
    assert 1200 <= mesh.n_nodes <= 1500
    assert corner_sines(mesh).min() > math.sin(math.radians(120)) - 0.01
    edges = np.linalg.norm(np.roll(mesh.points[mesh.quads], -1, axis=1) - mesh.points[mesh.quads], axis=2)
    assert (edges.max(axis=1) / edges.min(axis=1)).max() < 2.5
    rim = np.isin(mesh.quads, mesh.nodes_of("rim")).sum(axis=1) == 2
    assert np.ptp(areas(mesh)[rim]) / areas(mesh)[rim].mean() < 0.25  # an even layer under the rim


@pytest.mark.parametrize("element", ["quad", "triangle"])
def test_rectangle(element: str) -> None:
    mesh = bp.mesh.rectangle(3.0, 1.0, 6, 4, element=element, origin=(1, -1))
    assert mesh.n_nodes == 7 * 5
    assert mesh.n_elements == (24 if element == "quad" else 48)
    np.testing.assert_allclose(areas(mesh), 3.0 / mesh.n_elements)
    coordinate = {"left": (0, 1.0), "right": (0, 4.0), "bottom": (1, -1.0), "top": (1, 0.0)}
    for name, (axis, value) in coordinate.items():
        nodes = mesh.nodes_of(name)
        assert len(nodes) == (5 if axis == 0 else 7)
        np.testing.assert_allclose(mesh.points[nodes, axis], value)
    outward = {"left": (-1, 0), "right": (1, 0), "bottom": (0, -1), "top": (0, 1)}
    for name, normal in outward.items():
        travel = np.diff(mesh.points[mesh.boundaries[name]], axis=1)[:, 0]
        side = np.stack([travel[:, 1], -travel[:, 0]], axis=1) / np.linalg.norm(travel, axis=1, keepdims=True)
        np.testing.assert_allclose(side, np.broadcast_to(normal, side.shape), atol=1e-12)


def test_rectangle_diagonals_alternate() -> None:
    mesh = bp.mesh.rectangle(2.0, 2.0, 2, 2, element="triangle")
    assert np.bincount(mesh.triangles.ravel()).tolist() == [2, 2, 2, 2, 8, 2, 2, 2, 2]


BAD_GENERATORS = [
    (lambda: bp.mesh.disc(radius=0.0), "disc: radius = 0.0, must be a finite number > 0; give a length in m"),
    (lambda: bp.mesh.disc(radius=math.inf), "disc: radius = inf, must be a finite number > 0"),
    (
        lambda: bp.mesh.disc(segments=115),
        "disc: segments = 115, must be a positive multiple of 4; 116 would do",
    ),
    (lambda: bp.mesh.disc(segments=0), "disc: segments = 0, must be a positive multiple of 4; 4 would do"),
    (
        lambda: bp.mesh.disc(segments=16.0),
        "disc: segments = 16.0, must be a positive multiple of 4; 16 would do",
    ),
    (lambda: bp.mesh.disc(element="tri"), 'disc: element = \'tri\', must be "quad" or "triangle"'),
    (lambda: bp.mesh.disc(centre=(0, math.nan)), "disc: centre = (0, nan), must be two finite numbers"),
    (lambda: bp.mesh.rectangle(-1, 1, 1, 1), "rectangle: width = -1, must be a finite number > 0"),
    (lambda: bp.mesh.rectangle(1, 0, 1, 1), "rectangle: height = 0, must be a finite number > 0"),
    (lambda: bp.mesh.rectangle(1, 1, 0, 1), "rectangle: nx = 0, must be an integer >= 1; 1 would do"),
    (lambda: bp.mesh.rectangle(1, 1, 1, 2.5), "rectangle: ny = 2.5, must be an integer >= 1; 2 would do"),
    (
        lambda: bp.mesh.rectangle(1, 1, 1, 1, element=4),
        'rectangle: element = 4, must be "quad" or "triangle"',
    ),
    (lambda: bp.mesh.rectangle(1, 1, 1, 1, origin=3), "rectangle: origin = 3, must be two finite numbers"),
]


@pytest.mark.parametrize(("make", "message"), BAD_GENERATORS)
def test_bad_generator(make: object, message: str) -> None:
    with pytest.raises(InputError, match="^" + re.escape(message)):
        make()  # type: ignore[operator]
