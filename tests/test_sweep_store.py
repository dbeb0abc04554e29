"""Stores: killed at any moment, the same call goes on, and what it leaves is what an undisturbed one leaves."""

import contextlib
import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import bipenalty as bp
import sweep_driver
from bipenalty import InputError
from sweep_driver import AXES, SCENE, TASKS, call

KINDS = ["zarr", "nc"]


def tree(path: Path) -> dict[str, bytes]:
    """Every file of a store with its content; a store that is one file is itself."""
    files = [path] if path.is_file() else [file for file in path.rglob("*") if file.is_file()]
    return {str(file.relative_to(path)): file.read_bytes() for file in files}


def left_over(path: Path) -> set[str]:
    """What else lies beside a store, logs left out."""
    return {item.name for item in path.parent.iterdir() if item.suffix != ".log"} - {path.name}


def done(path: Path) -> set[int]:
    """Tasks that a store has marked."""
    if path.suffix == ".nc":
        return {int(part.stem) for part in path.with_name(path.name + ".parts").glob("*.npz")}
    marks = path.glob("tasks/done/c/*/*")
    return {int(mark.parent.name) * len(AXES["s2"]) + int(mark.name) for mark in marks}


def computed(log: str) -> list[int]:
    """Tasks that a driver has computed, from its log."""
    return [int(task) for task in re.findall(r"^task (\d+): 1 runs computed$", log, re.MULTILINE)]


@contextlib.contextmanager
def driver(store: Path, log: Path, *arguments: str) -> Iterator[subprocess.Popen[bytes]]:
    """The sweep in a process group of its own, of which nothing is left at the end."""
    script = [sys.executable, "-W", "error", sweep_driver.__file__, str(store), str(log), *arguments]
    process = subprocess.Popen(script, start_new_session=True, stderr=subprocess.PIPE)
    try:
        yield process
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


def until(condition: Callable[[], bool], seconds: float = 60) -> None:
    """Wait for a condition."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "waited in vain"
        time.sleep(0.002)


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """A store of either kind that was made in one go."""
    folder = tmp_path_factory.mktemp("undisturbed")
    for kind in KINDS:
        call(folder / f"run.{kind}")
    return lambda kind: folder / f"run.{kind}"


@pytest.mark.parametrize("kind", KINDS)
def test_store_holds_what_memory_would(kind: str, undisturbed: Callable[[str], Path]) -> None:
    """Read by the call itself, and by xarray alone."""
    wanted = call(None).drop_vars("seconds")
    found = call(undisturbed(kind))
    xr.testing.assert_equal(wanted, found)
    assert {name: wanted[name].attrs for name in wanted.variables} == {n: found[n].attrs for n in found.variables}
    assert wanted.attrs.items() - {("memory", wanted.attrs["memory"])} <= found.attrs.items()
    assert left_over(undisturbed(kind)) <= {"run.zarr", "run.nc"}
    with xr.open_dataset(undisturbed(kind), engine="zarr" if kind == "zarr" else "netcdf4") as plain:
        assert dict(plain.sizes) == dict(wanted.sizes)
        assert set(plain.variables) == set(wanted.variables)
        np.testing.assert_array_equal(plain.peak_force, wanted.peak_force)
        assert plain.outcome.values.tolist() == wanted.outcome.values.tolist()


def test_zarr_store_is_read_where_it_is_used(undisturbed: Callable[[str], Path]) -> None:
    """The histories are not in memory when the call returns."""
    data = call(undisturbed("zarr"))
    assert not data.contact_force.variable._in_memory
    assert np.isfinite(data.contact_force.isel(ps=0, s2=0, time=slice(0, 10))).all()


@pytest.mark.parametrize("kind", KINDS)
def test_resume_does_nothing_new(
    kind: str, undisturbed: Callable[[str], Path], caplog: pytest.LogCaptureFixture
) -> None:
    before = tree(undisturbed(kind))
    with caplog.at_level("INFO", logger="bipenalty.sweeps"):
        data = call(undisturbed(kind), chunk=5)  # the store's own blocks count
    assert caplog.messages == []
    assert data.attrs["interrupted"] == 0
    assert tree(undisturbed(kind)) == before


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_killed_again_and_again(kind: str, tmp_path: Path, undisturbed: Callable[[str], Path]) -> None:
    """Three drivers are killed once they have marked some tasks; none computes what another has marked."""
    store, seen = tmp_path / f"run.{kind}", list[set[int]]()
    for i, enough in enumerate((1, 4, 6)):
        with driver(store, tmp_path / f"{i}.log") as process:
            until(lambda enough=enough: len(done(store)) >= enough)  # type: ignore[misc]
            process.kill()
            process.wait()
        seen.append(done(store))
        assert len(seen[-1]) < TASKS
    call(store)
    assert tree(store) == tree(undisturbed(kind))
    assert left_over(store) == set()
    for i in (1, 2):
        assert not seen[i - 1] & set(computed((tmp_path / f"{i}.log").read_text(encoding="utf-8")))


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "count"), [("zarr", n) for n in (1, 28, 57, 64)] + [("nc", 6)])
def test_killed_at_a_file(
    kind: str, count: int, tmp_path: Path, undisturbed: Callable[[str], Path], caplog: pytest.LogCaptureFixture
) -> None:
    """While the store is made, between the arrays of a task, before and after its mark."""
    store = tmp_path / f"run.{kind}"
    with driver(store, tmp_path / "killed.log", "--die-at", str(count)) as process:
        assert process.wait(60) == -signal.SIGKILL
    before = done(store)
    assert len(before) < TASKS
    with caplog.at_level("INFO", logger="bipenalty.sweeps"):
        call(store)
    assert sorted([*computed("\n".join(caplog.messages)), *before]) == list(range(TASKS))
    assert tree(store) == tree(undisturbed(kind))
    assert left_over(store) == set()


@pytest.mark.parametrize("step", ["assembled", "written", "removed"])
def test_killed_while_the_file_is_made(
    step: str, tmp_path: Path, undisturbed: Callable[[str], Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    """All parts are there, and the end comes before, just after, or amid the removal of the parts."""
    from bipenalty.sweeps import store_netcdf

    store, write, remove = tmp_path / "run.nc", store_netcdf.write_netcdf, store_netcdf.shutil.rmtree

    def die(*_: Any, **__: Any) -> None:
        raise SystemExit("killed")

    def half(folder: Path, **_: Any) -> None:
        next(folder.glob("*.npz")).unlink()
        die()

    def after(*given: Any) -> None:
        write(*given)
        die()

    with monkeypatch.context() as patch:
        if step == "removed":
            patch.setattr(store_netcdf.shutil, "rmtree", half)
        else:
            patch.setattr(store_netcdf, "write_netcdf", die if step == "assembled" else after)
        with pytest.raises(SystemExit):
            call(store)
    assert store_netcdf.shutil.rmtree is remove
    call(store)
    assert tree(store) == tree(undisturbed("nc"))
    assert left_over(store) == set()


@pytest.mark.parametrize("kind", KINDS)
def test_two_drivers(kind: str, tmp_path: Path, undisturbed: Callable[[str], Path]) -> None:
    """The second is told which process has the store; after kill -9 of the first the store is free."""
    store = tmp_path / f"run.{kind}"
    with driver(store, tmp_path / "first.log") as process:
        until(lambda: len(done(store)) >= 1)
        process.send_signal(signal.SIGSTOP)  # at work for as long as this test wants it to be
        assert len(done(store)) < TASKS
        with pytest.raises(InputError, match=rf"run.{kind}\": is in use by process {process.pid} on .*wait for it"):
            call(store)
        process.kill()
        process.wait()
    call(store)
    assert tree(store) == tree(undisturbed(kind))


def test_two_threads(tmp_path: Path) -> None:
    """The lock keeps threads of one process apart too, and the loser does not free it."""
    from bipenalty.sweeps.lock import locked

    path, refusals = tmp_path / "run.zarr", list[str]()

    def take() -> None:
        try:
            with locked(path):
                refusals.append("none")
        except InputError as error:
            refusals.append(str(error))

    with locked(path):
        for _ in range(2):
            other = threading.Thread(target=take)
            other.start()
            other.join()
    take()
    assert ["another thread" in said for said in refusals] == [True, True, False]
    assert left_over(path) == set()


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_driver_with_workers_is_killed(kind: str, tmp_path: Path, undisturbed: Callable[[str], Path]) -> None:
    """Its workers outlive it; the store is free nevertheless."""
    store = tmp_path / f"run.{kind}"
    with driver(store, tmp_path / "first.log", "--workers", "2") as process:
        until(lambda: len(done(store)) >= 2)
        process.kill()
        process.wait()
        before = done(store)
        call(store)
    assert 2 <= len(before) < TASKS
    assert tree(store) == tree(undisturbed(kind))


@pytest.mark.parametrize("kind", KINDS)
def test_ctrl_c_returns_what_has_finished(kind: str, tmp_path: Path, undisturbed: Callable[[str], Path]) -> None:
    """The rest is labelled, not stored, and comes with the next call."""
    store = tmp_path / f"run.{kind}"
    before = signal.signal(signal.SIGINT, signal.default_int_handler)

    def press() -> None:
        until(lambda: len(done(store)) >= 3)
        os.kill(os.getpid(), signal.SIGINT)

    finger = threading.Thread(target=press)
    finger.start()
    try:
        data = call(store)
    finally:
        finger.join()
        signal.signal(signal.SIGINT, before)
    assert data.attrs["interrupted"] == 1
    assert 3 <= len(done(store)) < TASKS
    there = np.isin(np.arange(TASKS), list(done(store))).reshape(data.outcome.shape)
    assert ((data.outcome.values != "interrupted") == there).all()
    assert not data.failed.values[~there].any()
    assert not data.finished.values[~there].any()
    assert not data.steps.values[~there].any()
    assert call(store).attrs["interrupted"] == 0
    assert tree(store) == tree(undisturbed(kind))


@pytest.mark.parametrize("kind", KINDS)
def test_another_call_on_the_same_path(kind: str, tmp_path: Path) -> None:
    store, axes = tmp_path / f"a.{kind}", {"ps": [1.0, 2.0]}
    bp.grid(SCENE, 0.05, axes, store=store)
    before = tree(store)
    others: list[dict[str, Any]] = [
        {"t_end": 0.06},
        {"axes": {"ps": [1.0, 3.0]}},
        {"axes": {"ps": [1.0]}},
        {"histories": True},
        {"displacement_limit": 1.0},
        {"allow_unstable": True},
        {"method": bp.Stiffness},
        {"dt": 1e-5},
        {"scene": sweep_driver.scenes.small_cylinders(gap=0.002)},
        {"scene": sweep_driver.scenes.small_cylinders(passes=2)},
    ]
    for change in others:
        given = {"scene": SCENE, "t_end": 0.05, "axes": axes} | change
        with pytest.raises(InputError, match=r"fingerprint = .*give another path, or remove it to start anew"):
            bp.grid(store=store, **given)
    assert tree(store) == before
    assert bp.grid(SCENE, 0.05, {"ps": (1, 2)}, store=store, threads=1).sizes["ps"] == 2


@pytest.mark.parametrize("kind", KINDS)
def test_path_that_holds_something_else(kind: str, tmp_path: Path) -> None:
    path = tmp_path / f"a.{kind}"
    xr.Dataset({"a": ("x", [1.0])}).to_netcdf(path) if kind == "nc" else (path / "b").mkdir(parents=True)
    before = tree(path)
    with pytest.raises(InputError, match="holds no sweep, must be new or made by sweep or grid; give another path"):
        bp.grid(SCENE, 0.05, {"ps": [1.0]}, store=path)
    assert tree(path) == before


def test_zarr_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "zarr", None)
    with pytest.raises(
        InputError, match=r"\"zarr\" is missing.*install bipenalty\[sweep\], or give a path ending in .nc"
    ):
        bp.grid(SCENE, 0.05, {"ps": [1.0]}, store=tmp_path / "a.zarr")
    assert bp.grid(SCENE, 0.05, {"ps": [1.0]}, store=tmp_path / "a.nc").sizes["ps"] == 1


def test_sweep_into_a_store(tmp_path: Path) -> None:
    """Dimension `run`, labels with spaces, infinities among the coordinates."""
    methods = [bp.Stiffness(1.0), bp.Bipenalty(), bp.Stiffness(1e4)]
    wanted = bp.sweep(SCENE, methods, 0.1, displacement_limit=1.0).drop_vars("seconds")
    for kind in KINDS:
        found = bp.sweep(SCENE, methods, 0.1, displacement_limit=1.0, store=tmp_path / f"a.{kind}")
        xr.testing.assert_equal(wanted, found)
    about = json.loads((tmp_path / "a.zarr" / "zarr.json").read_text())["attributes"]
    assert about["t_end"] == 0.1
