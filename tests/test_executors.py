"""Executors: threads, processes, a cluster; the same numbers from each, also when workers are killed on the way."""

import concurrent.futures as cf
import contextlib
import os
import re
import signal
import threading
import time
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest
import xarray as xr

import bipenalty as bp
import sweep_driver
from bipenalty import InputError, progress
from bipenalty.sweeps import executors, work
from bipenalty.sweeps.executors import ATTEMPTS, BARREN, Lost, completed
from sweep_driver import TASKS, call


@cache
def wanted() -> xr.Dataset:
    """The sweep without an executor."""
    return call(None).drop_vars("seconds")


def same(data: xr.Dataset) -> None:
    """Bit for bit; only how long runs took differs."""
    xr.testing.assert_equal(data.drop_vars("seconds"), wanted())


@contextlib.contextmanager
def killing(pids: Callable[[], list[int]], victims: int, after: float = 0.05) -> Iterator[list[int]]:
    """Kill -9 so many workers while the block runs, each as soon as it is there."""
    killed, over = list[int](), threading.Event()

    def hunt() -> None:
        while len(killed) < victims and not over.wait(after):
            fresh = [pid for pid in pids() if pid not in killed]
            if fresh:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(fresh[0], signal.SIGKILL)
                    killed.append(fresh[0])

    hunter = threading.Thread(target=hunt)
    hunter.start()
    try:
        yield killed
    finally:
        over.set()
        hunter.join()


@pytest.mark.parametrize("chunk", [1, 5, None])
def test_threads(chunk: int | None) -> None:
    with cf.ThreadPoolExecutor(3) as executor:
        same(call(None, executor=executor, chunk=chunk, threads=None))


@pytest.mark.slow
def test_processes() -> None:
    with sweep_driver.pool(2) as executor:
        for chunk in (1, 4):
            same(call(None, executor=executor, chunk=chunk, in_flight=chunk))


@pytest.mark.slow
def test_worker_of_a_pool_is_killed() -> None:
    """The pool takes no more work; another one like it does the rest, and is gone in the end."""
    with sweep_driver.pool(2) as executor:
        executor.submit(int).result()
        with killing(lambda: list(executor._processes or []), 1) as killed:
            same(call(None, executor=executor))
        assert len(killed) == 1
        with pytest.raises(cf.process.BrokenProcessPool):
            executor.submit(int)


@pytest.fixture(scope="module")
def cluster() -> Iterator[Any]:
    """Two worker processes on this machine."""
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, host="127.0.0.1") as local,
        distributed.Client(local) as client,
    ):
        yield client


@pytest.mark.slow
def test_cluster(cluster: Any) -> None:
    for chunk in (1, 4):
        same(call(None, executor=cluster.get_executor(), chunk=chunk))


@pytest.mark.slow
def test_worker_of_a_cluster_is_killed(cluster: Any) -> None:
    def pids() -> list[int]:
        return [int(pid) for pid in cluster.run(os.getpid).values()]

    victims = pids()
    with killing(lambda: victims, 1) as killed:
        same(call(None, executor=cluster.get_executor()))
    assert len(killed) == 1


# ---- what the loop does with deaths, without processes


class Scripted(cf.Executor):
    """Answers at once: the work's result, unless the script says that a worker dies of a task."""

    def __init__(self, deaths: dict[int, int]) -> None:
        self.deaths, self.seen, self.refuses = dict(deaths), list[int](), ""

    def submit(self, task: Any, /, *_: Any, **__: Any) -> cf.Future[Any]:
        if self.refuses:
            raise RuntimeError(self.refuses)
        self.seen.append(task)
        future: cf.Future[Any] = cf.Future()
        if self.deaths.get(task, 0) > 0:
            self.deaths[task] -= 1
            future.set_exception(cf.BrokenExecutor("a worker was killed"))
        else:
            future.set_result(10 * task)
        return future


def results(executor: Any, tasks: int, in_flight: int = 4) -> dict[int, Any]:
    """Results of a loop over some tasks, each once."""
    found = list(completed(executor, lambda e, task: e.submit(task), range(tasks), in_flight))
    assert sorted(task for task, _ in found) == list(range(tasks))
    return dict(found)


def test_task_is_tried_again() -> None:
    executor = Scripted({2: ATTEMPTS - 1, 5: 1})
    assert results(executor, 8) == {task: 10 * task for task in range(8)}
    assert len(executor.seen) == 8 + ATTEMPTS


def test_task_that_kills_its_workers_is_lost() -> None:
    """The others are not, although they were in flight beside it."""
    found = results(Scripted({3: 10**6}), 8)
    lost = found.pop(3)
    assert isinstance(lost, Lost)
    assert "3 of its workers died, the last with BrokenExecutor: a worker was killed" in lost.reason
    assert found == {task: 10 * task for task in range(8) if task != 3}


def test_executor_that_loses_every_worker_is_given_up() -> None:
    """After some in a row, not after three times as many as there are tasks."""
    executor = Scripted(dict.fromkeys(range(1000), 10**6))
    found = results(executor, 1000)
    assert all(isinstance(lost, Lost) for lost in found.values())
    assert "lost its workers 10 times in a row" in found[999].reason
    assert len(executor.seen) <= BARREN + 2 * 4


def test_executor_that_takes_no_more_work() -> None:
    executor = Scripted({})
    executor.refuses = "cannot schedule new futures after shutdown"
    found = results(executor, 3)
    assert {lost.reason for lost in found.values()} == {f"the executor takes no more work: {executor.refuses}"}


def test_error_of_the_work_is_raised() -> None:
    executor = cf.ThreadPoolExecutor(1)
    with executor, pytest.raises(ZeroDivisionError):
        list(completed(executor, lambda e, task: e.submit(lambda: 1 / task), range(3), 1))


def test_names_of_deaths_are_those_of_the_libraries() -> None:
    distributed = pytest.importorskip("distributed")
    from distributed.client import FutureCancelledError
    from distributed.scheduler import KilledWorker

    assert distributed.__version__
    errors = [KilledWorker("a", None, 3), FutureCancelledError("a", None), cf.process.BrokenProcessPool()]
    assert all(executors._died(error) for error in errors)
    assert not executors._died(MemoryError())


def test_number_in_flight_is_bounded() -> None:
    """Never more than asked for, whatever completes when."""
    running, most, lock = [0], [0], threading.Lock()

    def task(n: int) -> int:
        with lock:
            most[0] = max(most[0], running[0])
        time.sleep(0.001)
        with lock:
            running[0] -= 1
        return n

    def submit(executor: Any, n: int) -> Any:
        with lock:
            running[0] += 1
        return executor.submit(task, n)

    with cf.ThreadPoolExecutor(8) as executor:
        found = dict(completed(executor, submit, range(100), 3))
    assert found == {n: n for n in range(100)}
    assert 1 < most[0] <= 3


# ---- lost runs and Ctrl-C in a sweep


class Mortal(Scripted):
    """Does the work here, but for chosen submissions whose worker dies."""

    def submit(self, work: Any, /, *given: Any, **more: Any) -> cf.Future[Any]:
        ps = given[1][0].method.ps if given[1][0].method else None
        if ps == 10.0:
            return super().submit(0)
        future: cf.Future[Any] = cf.Future()
        future.set_result(work(*given, **more))
        return future


@pytest.mark.parametrize("kind", [None, "zarr", "nc"])
def test_lost_runs_are_labelled_and_come_with_the_next_call(kind: str | None, tmp_path: Any) -> None:
    store = tmp_path / f"a.{kind}" if kind else None
    data = call(store, executor=Mortal({0: 10**6}))
    lost = (data.outcome == "lost").values
    assert lost.tolist() == [[False] * 3, [False] * 3, [True, True, False], [False] * 3]
    assert all("3 of its workers died" in reason for reason in data.reason.values[lost])
    assert data.failed.values[lost].all()
    assert np.isnan(data.peak_force.values[lost]).all()
    xr.testing.assert_equal(data.peak_force.where(~lost), wanted().peak_force.where(~lost))
    if store:
        xr.testing.assert_equal(call(store), wanted())


def test_ctrl_c_with_an_executor() -> None:
    """What has finished is there; threads that are at work end soon, and the executor can be used again."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    scene, methods = sweep_driver.SCENE, [bp.Bipenalty(ps) for ps in (0.5, 1.0, 2.0)]
    dt = bp.Model(scene).dt
    with cf.ThreadPoolExecutor(2) as executor:
        finger = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        finger.start()
        try:
            data = bp.grid(scene, None, {"t_end": [0.01, 1e8 * dt], "ps": [0.5, 1.0]}, executor=executor, chunk=1)
        finally:
            finger.join()
            signal.signal(signal.SIGINT, before)
        assert data.attrs["interrupted"] == 1
        assert data.outcome.values.tolist() == [["finished"] * 2, ["interrupted"] * 2]
        again = bp.sweep(scene, methods, 0.05, executor=executor)
    assert set(again.outcome.values) == {"finished"}


def test_call_that_is_wrong_reaches_no_worker() -> None:
    with cf.ThreadPoolExecutor(1) as executor, pytest.raises(InputError, match="allow_unstable"):
        bp.sweep(sweep_driver.SCENE, [bp.Stiffness()], 1.0, dt=1.0, executor=executor)


def test_worker_with_another_version_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Numbers of two versions do not get into one dataset."""
    monkeypatch.setattr(work, "package_version", lambda: "0.0.1")
    with (
        cf.ThreadPoolExecutor(1) as executor,
        pytest.raises(InputError, match=r"worker: version of .* = 0.0.1, must be"),
    ):
        call(None, executor=executor)


@pytest.mark.parametrize("pooled", [False, True])
def test_progress_says_runs_and_node_steps(
    pooled: bool, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Runs done of all beside the rate; the bar ends full although runs stop early or do not start."""
    bars, make = [], progress.bar
    monkeypatch.setattr(progress, "bar", lambda *given: bars.append(make(*given)) or bars[-1])
    with cf.ThreadPoolExecutor(1) as executor:
        data = call(None, show_progress=True, executor=executor if pooled else None)
    said = capsys.readouterr().err
    assert re.search(rf"\d/{TASKS} runs", said)
    assert "node-step/s" in said
    assert bars[0].n == data.steps.sum() * sweep_driver.SCENE.n_nodes
    assert bars[0].total == pytest.approx(bars[0].n)
