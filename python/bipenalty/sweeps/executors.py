"""Tasks on an executor: a few in flight, results as they complete, another try for those whose worker died."""

from __future__ import annotations

import concurrent.futures as cf
import contextlib
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

#: A task is given up when this many of its workers have died.
ATTEMPTS = 3
#: An executor is given up when this many tasks in a row have lost their workers while they were alone on it.
BARREN = 10
#: What says that the worker died and not that the work is wrong, by name: no library is imported for it.
DEATHS = {"BrokenExecutor", "BrokenProcessPool", "CancelledError", "FutureCancelledError", "KilledWorker"}

Submit = Callable[[Any, int], "cf.Future[Any]"]


@dataclass(frozen=True)
class Lost:
    """A task that no worker has survived, or that could no longer be submitted, with the reason."""

    reason: str


def in_flight_of(executor: Any) -> int:
    """Tasks to have submitted at a time: two a worker where their number is known, 64 where it may grow."""
    workers = getattr(executor, "_max_workers", None)
    if isinstance(workers, int):
        return 2 * workers
    with contextlib.suppress(Exception):
        return max(64, 2 * int(sum(executor._client.nthreads().values())))
    return 64


def completed(
    executor: Any, submit: Submit, tasks: Iterable[int], in_flight: int
) -> Generator[tuple[int, Any], None, None]:
    """Submit tasks and yield each with its result, or with `Lost`, as they complete.

    Raises
    ------
    Exception : whatever a task has raised itself.
    """
    flow = _Flow(executor, submit, in_flight, deque(tasks))
    try:
        yield from flow.results()
    finally:
        for future in flow.running:
            future.cancel()
        flow.close()


@dataclass
class _Flow:
    executor: Any
    submit: Submit
    in_flight: int
    fresh: deque[int]
    suspects: deque[int] = field(default_factory=deque)
    running: dict[Any, int] = field(default_factory=dict)
    deaths: dict[int, int] = field(default_factory=dict)
    barren: int = 0
    own: bool = False
    closed: str = ""

    def results(self) -> Iterator[tuple[int, Any]]:
        while self.fresh or self.suspects or self.running:
            self._fill()
            if self.closed and not self.running:
                for task in (*self.suspects, *self.fresh):
                    yield task, Lost(self.closed)
                return
            alone = len(self.running) == 1
            finished, _ = cf.wait(self.running, return_when=cf.FIRST_COMPLETED)
            for future in finished:
                task = self.running.pop(future)
                error = _error(future)
                if error is None:
                    self.barren = 0
                    yield task, future.result()
                elif not _died(error):
                    raise error
                else:
                    self.barren += alone
                    yield from self._again(task, error)
            if self.barren >= BARREN:
                self.closed = f"the executor lost its workers {self.barren} times in a row"

    def _fill(self) -> None:
        """Submit up to the limit; a task whose worker died goes alone, so that no other is blamed for it."""
        while not self.closed and (self.fresh or self.suspects):
            if len(self.running) >= (1 if self.suspects else self.in_flight):
                return
            queue = self.suspects or self.fresh
            try:
                future = self.submit(self.executor, queue[0])
            except (cf.BrokenExecutor, RuntimeError) as error:
                if self.running:
                    return  # the rest of a broken pool comes back first
                self._renew(error)
                continue
            self.running[future] = queue.popleft()

    def _again(self, task: int, error: BaseException) -> Iterator[tuple[int, Any]]:
        self.deaths[task] = self.deaths.get(task, 0) + 1
        if self.deaths[task] < ATTEMPTS:
            self.suspects.append(task)
        else:
            yield task, Lost(f"{ATTEMPTS} of its workers died, the last with {type(error).__name__}: {error}")

    def _renew(self, error: BaseException) -> None:
        """A process pool with a dead worker takes no more work: another one like it does."""
        pool = self.executor
        if not isinstance(pool, cf.ProcessPoolExecutor) or not isinstance(error, cf.BrokenExecutor):
            self.closed = f"the executor takes no more work: {error}"
            return
        alike: Any = vars(pool)
        self.close()
        self.executor = cf.ProcessPoolExecutor(
            alike["_max_workers"], alike["_mp_context"], alike["_initializer"], alike["_initargs"]
        )
        self.own = True

    def close(self) -> None:
        """Shut down a pool that was made here; the caller's own is the caller's."""
        if self.own:
            self.executor.shutdown(wait=not self.running, cancel_futures=True)


def _error(future: Any) -> BaseException | None:
    try:
        error: BaseException | None = future.exception()
    except cf.CancelledError as cancelled:
        return cancelled
    return error


def _died(error: BaseException) -> bool:
    return any(kind.__name__ in DEATHS for kind in type(error).__mro__)
