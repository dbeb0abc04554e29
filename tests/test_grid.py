"""Grids: dimensions, coordinates and units; every entry is the run alone; what cannot start is an entry too."""

import math
from typing import Any

import numpy as np
import pytest
import xarray as xr

import bipenalty as bp
import scenes
from bipenalty import InputError
from bipenalty.sweeps import memory
from bipenalty.sweeps.layout import Layout, block_shape

SCENE = scenes.small_cylinders()
DT = bp.Model(SCENE).dt
PUBLISHED = bp.Bipenalty(1.0, rule="published")


def alone(method: Any, t_end: float, **options: Any) -> xr.Dataset:
    """One run by itself."""
    return bp.Model(SCENE, method, **options).run(t_end).dataset


def test_parameters_of_a_class() -> None:
    """Dimensions in the order of the axes, and each entry what the run gives by itself."""
    ps, s2 = [0.5, 1.0, 20.0], [0.5, 1.5]
    data = bp.grid(SCENE, 0.1, {"ps": ps, "s2": s2}, method=bp.Bipenalty)
    assert dict(data.sizes) == {"ps": 3, "s2": 2}
    assert data.ps.attrs == {"units": "1", "long_name": "stiffness penalty factor"}
    assert data.max_penetration.attrs["units"] == "m"
    for p in ps:
        for s in s2:
            one, there = alone(bp.Bipenalty(p, s2=s), 0.1), data.sel(ps=p, s2=s)
            for name in ("max_penetration", "max_displacement", "peak_force", "impulse", "energy_ratio", "steps"):
                assert there[name].item() == one.attrs[name], name
            assert there.outcome.item() == "finished"
            assert there.finished.item()


def test_parameters_of_an_instance() -> None:
    """What the instance says of the others stays."""
    data = bp.grid(SCENE, 0.1, {"D": [0.0, 1e-3]}, method=PUBLISHED)
    assert data.D.attrs["units"] == "s"
    for D in (0.0, 1e-3):
        one = alone(bp.Bipenalty(1.0, rule="published", D=D), 0.1)
        assert data.peak_force.sel(D=D).item() == one.attrs["peak_force"]


def test_words_among_parameters() -> None:
    data = bp.grid(SCENE, 0.05, {"ps": ["auto", 1.0]})
    assert data.ps.values.tolist() == ["auto", "1.0"]
    assert data.peak_force.sel(ps="auto").item() == alone(bp.Bipenalty(), 0.05).attrs["peak_force"]


def test_methods_steps_and_ends() -> None:
    """The time step differs: histories are over steps, and the times are a coordinate of two dimensions."""
    methods, dts, ends = [PUBLISHED, bp.Stiffness(2.0)], [DT, 0.5 * DT], [0.05, 0.1]
    axes = {"method": methods, "dt": dts, "t_end": ends}
    data = bp.grid(SCENE, None, axes, histories=True)
    assert dict(data.sizes) == {"method": 2, "dt": 2, "t_end": 2, "step": math.ceil(0.1 / (0.5 * DT))}
    assert (data.dt.attrs["units"], data.t_end.attrs["units"], data.time.dims) == ("s", "s", ("dt", "step"))
    assert "dt" not in data.attrs
    for i, method in enumerate(methods):
        assert data.method.values[i] == method.label
        for j, dt in enumerate(dts):
            assert data.R.values[i, j] == bp.Model(SCENE, method, dt=dt).R
            for k, end in enumerate(ends):
                one, there = alone(method, end, dt=dt), data.isel(method=i, dt=j, t_end=k)
                n = one.sizes["time"]
                np.testing.assert_array_equal(there.time[:n], one.time)
                np.testing.assert_array_equal(there.contact_force[:n], one.contact_force)
                np.testing.assert_array_equal(there.penetration[:n], one.penetration)
                assert np.isnan(there.contact_force[n:]).all()


def test_histories_of_every_third_step() -> None:
    """With one time step they are over time."""
    data = bp.grid(SCENE, 0.1, {"ps": [1.0, 5.0]}, histories=3)
    whole = alone(bp.Bipenalty(5.0), 0.1)
    assert data.contact_force.dims == ("ps", "time")
    np.testing.assert_array_equal(data.time, whole.time[::3])
    np.testing.assert_array_equal(data.contact_force[1], whole.contact_force[::3])
    assert data.attrs["every"] == 3


def test_refused_runs_are_entries() -> None:
    """A step above the limit, one below zero, a parameter out of its bounds: the message is the reason."""
    limit = bp.Model(SCENE).critical_step().assembled
    data = bp.grid(SCENE, 0.05, {"dt": [DT, 1.01 * limit, -1.0], "s2": [1.5, 2.5]})
    assert data.outcome.values.tolist() == [["finished", "refused"], ["refused"] * 2, ["refused"] * 2]
    assert "reduce it, or pass allow_unstable=True" in data.reason.values[1, 0]
    assert "dt = -1.0, must be > 0" in data.reason.values[2, 0]
    assert "s2 = 2.5" in data.reason.values[0, 1]
    refused = (data.outcome == "refused").values
    assert (data.failed.values == refused).all()
    assert (data.finished.values == ~refused).all()
    assert data.steps.values[refused].tolist() == [0] * 5
    assert np.isnan(data.peak_force.values[refused]).all()
    assert data.peak_force.values[0, 0] == alone(bp.Bipenalty(), 0.05).attrs["peak_force"]


def test_bodies_that_overlap_at_the_start_are_entries() -> None:
    data = bp.grid(scenes.small_cylinders(gap=-0.1), 0.05, {"ps": [1.0, 2.0]})
    assert set(data.outcome.values) == {"refused"}
    assert all("overlap" in reason for reason in data.reason.values)


def test_any_threads_and_chunk_give_the_same() -> None:
    axes = {"ps": [0.1, 1.0, 30.0], "s2": [0.5, 1.5]}
    first = bp.grid(SCENE, 0.1, axes, threads=1, histories=True).drop_vars("seconds")
    for chunk, threads in ((1, 2), (4, 1), (5, 2)):
        other = bp.grid(SCENE, 0.1, axes, chunk=chunk, threads=threads, histories=True).drop_vars("seconds")
        xr.testing.assert_equal(first, other)


@pytest.mark.parametrize(
    ("axes", "words"),
    [
        ({}, ("axes = {}", "a mapping")),
        ([1], ("axes = [1]", "a mapping")),
        ({"middle.young": [1.0]}, ("'middle.young'", "top.young")),
        ({"phi": [1.0]}, ("'phi'", "'ps'")),
        ({"ps": []}, ("number of values of ps = 0", ">= 1")),
        ({"ps": 1.0}, ("ps = float", "a list")),
        ({"dt": ["fast"]}, ("dt = 'fast'", "a number")),
        ({"top.velocity": [1.0]}, ("top.velocity = 1.0", "two numbers")),
        ({"method": [bp.Stiffness]}, ("methods[0] = the class Stiffness", "a Stiffness")),
        ({"t_end": [0.1]}, ("given as axis and as argument = ['t_end']", "one of the two")),
    ],
)
def test_bad_axes(axes: Any, words: tuple[str, ...]) -> None:
    with pytest.raises(InputError) as caught:
        bp.grid(SCENE, 0.1, axes)
    assert all(word in str(caught.value) for word in words), caught.value


def test_bad_options() -> None:
    cases: list[tuple[dict[str, Any], str]] = [
        ({"t_end": -1.0}, "t_end = -1.0"),
        ({"t_end": None}, "t_end = None"),
        ({"dt": "quick"}, "dt = 'quick'"),
        ({"method": 3}, "method = 3, must be a method class or a method"),
        ({"histories": -1}, "histories = -1"),
        ({"chunk": 0}, "chunk = 0"),
        ({"executor": 3}, "executor = int"),
        ({"store": "results.csv"}, 'store = "results.csv", must be a path ending in .zarr or .nc'),
    ]
    for options, message in cases:
        with pytest.raises(InputError) as caught:
            bp.grid(SCENE, **({"t_end": 0.1, "axes": {"ps": [1.0]}} | options))
        assert message in str(caught.value)


# ---- blocks and memory


@pytest.mark.parametrize("shape", [(1,), (7,), (5, 100, 7), (40, 65), (1000, 1), (3, 1, 200)])
@pytest.mark.parametrize("runs", [1, 8, 64, 10**6])
def test_blocks_cover_the_grid_once(shape: tuple[int, ...], runs: int) -> None:
    layout = Layout(("a", "b", "c")[: len(shape)], shape, block_shape(shape, runs), 0, "time")
    assert math.prod(layout.block) <= runs
    count = np.zeros(shape, dtype=int)
    for task in range(layout.n_tasks):
        count[layout.region(task)] += 1
        places = [tuple(i) for i in np.argwhere(count == 1)] if task == 0 else layout.indices(task)
        assert layout.indices(task) == places
    assert (count == 1).all()


def test_memory_is_stated_and_kept_to() -> None:
    """More than the arrays take, and at most some times that once there are many runs."""
    for histories in (False, True, 10):
        data = bp.grid(SCENE, 0.1, {"ps": np.geomspace(0.1, 10, 300)}, histories=histories)
        steps = int(data.steps.max())
        assert data.attrs["memory"] == bp.sweep_memory(SCENE, 300, steps, histories=histories)
        words = sum(len(text) for text in data.reason.values)
        assert data.nbytes + words < data.attrs["memory"]
    many = [bp.sweep_memory(SCENE, runs, 1000, histories=True) for runs in (100_000, 200_000)]
    assert many[1] - many[0] == pytest.approx(100_000 * 1000 * 16, rel=0.05)
    assert bp.sweep_memory(SCENE, 10**6, 1000, histories=True, stored=True) < 1e9
    flying = [
        bp.sweep_memory(SCENE, 10**6, 1000, histories=True, chunk=10, in_flight=n, stored=True) for n in (64, 128)
    ]
    assert flying[1] == 2 * flying[0] > 64 * 10 * 1000 * 16


def test_more_memory_than_there_is(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "available_memory", lambda: 10_000_000)
    methods = [bp.Bipenalty(ps) for ps in np.geomspace(0.1, 10, 1000)]
    with pytest.raises(InputError, match=r"memory = .* GB, must be at most the 0.01 GB available; give store="):
        bp.sweep(SCENE, methods, 1.0, histories=True, chunk=1)
    assert bp.sweep(SCENE, methods[:3], 0.1, histories=True).sizes["run"] == 3


def test_available_memory_is_that_of_this_machine() -> None:
    assert 1e7 < memory.available_memory() < 1e15
