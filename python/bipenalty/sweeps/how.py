"""How a sweep is done: threads or an executor, tasks, store, and the limits that all runs share."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from bipenalty import _core, checks
from bipenalty.sweeps import memory
from bipenalty.sweeps.executors import in_flight_of


@dataclass(frozen=True)
class How:
    """The keywords of `sweep` and `grid` that say nothing about single runs; `every` 0 keeps peaks only."""

    allow_unstable: bool
    displacement_limit: float | None
    every: int
    threads: int
    executor: Any
    chunk: int | None
    in_flight: int | None
    store: Path | None
    show_progress: bool | None
    isa: str = "auto"


def how(
    allow_unstable: bool,
    displacement_limit: float | None,
    histories: bool | int,
    threads: int | None,
    executor: Any,
    chunk: int | None,
    in_flight: int | None,
    store: str | os.PathLike[str] | None,
    show_progress: bool | None,
    isa: str = "auto",
) -> How:
    """The keywords, checked.

    Raises
    ------
    InputError : a value out of its bounds.
    """
    default = 1 if executor is not None else os.cpu_count() or 1
    found = How(
        bool(allow_unstable),
        None if displacement_limit is None else checks.number("sweep", "displacement_limit", displacement_limit),
        memory.stride(histories),
        default if threads is None else checks.whole("sweep", "threads", threads, 1),
        executor,
        None if chunk is None else checks.whole("sweep", "chunk", chunk, 1),
        None if in_flight is None else checks.whole("sweep", "in_flight", in_flight, 1),
        None if store is None else Path(store).absolute(),
        show_progress,
        isa,
    )
    sets = ("auto", *_core.instruction_sets())
    checks.within("sweep", "isa", repr(isa), isa in sets, f"one of {sets}", 'leave it at "auto"')
    able = executor is None or hasattr(executor, "submit")
    remedy = "give a ProcessPoolExecutor, client.get_executor() of dask, or the like"
    checks.within("sweep", "executor", type(executor).__name__, able, "an executor of concurrent.futures", remedy)
    if found.store is not None:
        known = found.store.suffix in (".zarr", ".nc")
        checks.within("sweep", "store", f'"{store}"', known, "a path ending in .zarr or .nc", "name it so")
    if executor is None:
        return replace(found, in_flight=None)
    return replace(found, in_flight=found.in_flight or in_flight_of(executor))
