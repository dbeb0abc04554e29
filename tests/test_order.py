"""Meshes whose nodes come in any order: the core may renumber them, and nobody sees it."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import bipenalty as bp

Floats = NDArray[np.float64]


def field(points: Floats) -> Floats:
    """An initial velocity that differs from node to node, m/s."""
    return np.column_stack([-1 + 0.3 * points[:, 1], 0.2 * points[:, 0]])


def model(points: Floats, quads: Any, held: Any) -> bp.Model:
    """A disc with these nodes that is thrown at a wall, some of them held in y."""
    mesh = bp.Mesh(points, quads=quads)
    disc = bp.Body("disc", mesh, bp.LinearElastic(100, 0.2, 0.1), velocity=field(points))
    wall = bp.HalfPlane("wall", point=(-1.001, 0), normal=(1, 0))
    support = bp.Support("disc", on=held, x=False)
    return bp.Model(bp.Scene([disc], [bp.Contact("disc", "wall")], [support], [wall]), bp.Bipenalty(ps=1.0))


@dataclass
class Both:
    """The same disc with its own node numbers and in a random order: node i of `mixed` is node order[i] of `plain`."""

    plain: bp.Model
    mixed: bp.Model
    order: NDArray[np.int64]


@pytest.fixture
def both() -> Both:
    """Fine enough for the order to matter."""
    mesh = bp.mesh.disc(1.0, 160)
    held = np.flatnonzero(np.abs(mesh.points[:, 1]) < 1e-9)
    assert len(held) > 3
    order = np.random.default_rng(5).permutation(mesh.n_nodes)
    number = np.argsort(order)
    plain = model(mesh.points, mesh.quads, held)
    return Both(plain, model(mesh.points[order], number[mesh.quads], number[held]), order)


def test_the_state_is_in_the_scenes_numbers(both: Both) -> None:
    """At the start and under way; what is handed out cannot be written."""
    np.testing.assert_array_equal(both.mixed._core.points, both.plain._core.points[both.order])
    np.testing.assert_allclose(both.mixed._core.mass, both.plain._core.mass[both.order], rtol=1e-12)
    for n in (0, 1, 100):
        both.plain.step(n)
        both.mixed.step(n)
        for name in ("displacement", "velocity"):
            a, b = getattr(both.plain, name)[both.order], getattr(both.mixed, name)
            np.testing.assert_allclose(b, a, rtol=0, atol=1e-10 * max(np.abs(a).max(), 1e-300))
            assert not b.flags.writeable
    assert both.plain._run.rows
    assert np.abs(both.plain.displacement).max() > 1e-3


def test_results_are_in_the_scenes_numbers(both: Both) -> None:
    """Contact histories and energies agree, snapshots node by node."""
    a, b = (m.run(0.02, snapshots=[0.0, 0.01, 0.02]) for m in (both.plain, both.mixed))
    assert a.active_rows.values.max() > 1
    for name in ("contact_force", "penetration", "momentum", "kinetic_energy", "strain_energy"):
        x, y = a.dataset[name].values, b.dataset[name].values
        np.testing.assert_allclose(y, x, rtol=0, atol=1e-9 * np.abs(x).max(), err_msg=name)
    for name in ("points", "displacement", "velocity"):
        x, y = (result.dataset[name].transpose("node", ...).values for result in (a, b))
        np.testing.assert_allclose(y, x[both.order], rtol=0, atol=1e-9 * np.abs(x).max(), err_msg=name)


def test_an_ordinary_mesh_is_looked_at_without_a_copy(both: Both) -> None:
    """Its arrays belong to the run; those of a renumbered mesh are the caller's."""
    for name in ("displacement", "velocity"):
        assert getattr(both.plain, name).base is both.plain._run
        assert np.shares_memory(getattr(both.plain, name), getattr(both.plain, name))
        assert not np.shares_memory(getattr(both.mixed, name), getattr(both.mixed, name))
