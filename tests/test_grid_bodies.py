"""Grids over what single runs change of the bodies: each entry is a run of the scene changed by hand."""

import dataclasses
from typing import Any

import numpy as np
import pytest

import bipenalty as bp
import scenes

SCENE = scenes.small_cylinders()
SUMMARY = ("max_penetration", "peak_force", "impulse", "steps")


def changed(name: str, **fields: Any) -> bp.Scene:
    """The scene with some fields of one body changed."""
    bodies = [dataclasses.replace(b, **fields) if b.name == name else b for b in SCENE.bodies]
    return dataclasses.replace(SCENE, bodies=bodies)


def same(there: Any, scene: bp.Scene, dt: Any = "element") -> None:
    """An entry is the run of a scene."""
    one = bp.Model(scene, dt=dt).run(0.1)
    assert there.outcome.item() == one.outcome
    for name in SUMMARY:
        assert there[name].item() == pytest.approx(one.dataset.attrs[name], rel=1e-9), name


def test_velocity() -> None:
    pairs = [(0.5, 1.0), (0.0, 3.0)]
    data = bp.grid(SCENE, 0.1, {"bottom.velocity": pairs})
    assert dict(data.sizes) == {"bottom.velocity": 2}
    assert data["bottom.velocity_y"].values.tolist() == [1.0, 3.0]
    assert data["bottom.velocity_x"].attrs["units"] == "m/s"
    for i, pair in enumerate(pairs):
        same(data.isel({"bottom.velocity": i}), changed("bottom", velocity=pair))


def test_offset() -> None:
    """Moved away, and moved into the other body, which is refused."""
    pairs = [(0.0, 0.05), (0.1, 0.0), (0.0, -0.5)]
    data = bp.grid(SCENE, 0.1, {"top.offset": pairs})
    mesh = SCENE.bodies[0].mesh
    for i, pair in enumerate(pairs[:2]):
        assert data["top.offset_x"].values[i] == pair[0]
        same(data.isel({"top.offset": i}), changed("top", mesh=mesh.moved(*pair)))
    assert data.outcome.values[2] == "refused"
    assert "overlap" in data.reason.values[2]


@pytest.mark.parametrize("rule", ["element", "assembled"])
def test_young_and_density(rule: str) -> None:
    """A rule for the time step is taken anew for each pair of factors."""
    young, density = [0.5, 1.0, 4.0], [0.25, 1.0]
    data = bp.grid(SCENE, 0.1, {"top.young": young, "top.density": density}, dt=rule)
    assert data.dt.dims == ("top.young", "top.density")
    material = SCENE.bodies[0].material
    for i, e in enumerate(young):
        for j, rho in enumerate(density):
            scaled = dataclasses.replace(material, young=e * material.young, density=rho * material.density)
            scene = changed("top", material=scaled)
            assert data.dt.values[i, j] == pytest.approx(bp.Model(scene, dt=rule).dt, rel=1e-6)
            same(data.isel({"top.young": i, "top.density": j}), scene, dt=data.dt.values[i, j])


def test_factor_out_of_bounds() -> None:
    data = bp.grid(SCENE, 0.1, {"top.young": [1.0, -1.0]})
    assert data.outcome.values.tolist() == ["finished", "refused"]
    assert "factor on young = -1.0, must be > 0" in data.reason.values[1]
    assert np.isnan(data.dt.values[1])
