"""A sweep into a store that tests start as a process of its own, to kill it: python sweep_driver.py STORE LOG [...].

--workers N : on a pool of so many processes. --die-at N : kill -9 of itself at the N-th file that takes its name.
"""

import argparse
import concurrent.futures as cf
import logging
import multiprocessing
import os
import signal
from pathlib import Path
from typing import Any

import xarray as xr

import bipenalty as bp
import scenes

SCENE = scenes.small_cylinders()
AXES = {"ps": [0.1, 1.0, 10.0, 100.0], "s2": [0.5, 1.5, 2.5]}  # the last cannot start
TASKS = 12


def call(store: Path | None, **options: Any) -> xr.Dataset:
    """The sweep: 12 tasks of one run, 8 of them with 39 000 steps."""
    dt = bp.Model(SCENE).dt / 300
    return bp.grid(SCENE, 0.1, AXES, dt=dt, histories=300, **({"chunk": 1, "threads": 1} | options), store=store)


def die_at(count: int) -> None:
    """Kill this process when a file or folder takes its name for the `count`-th time, before odd and after even."""
    left = [count]

    def deadly(real: Any) -> Any:
        def rename(source: Any, target: Any, **more: Any) -> None:
            left[0] -= 1
            if left[0] == 0 and count % 2:
                os.kill(os.getpid(), signal.SIGKILL)
            real(source, target, **more)
            if left[0] == 0:
                os.kill(os.getpid(), signal.SIGKILL)

        return rename

    os.replace, os.rename = deadly(os.replace), deadly(os.rename)


def pool(workers: int) -> cf.ProcessPoolExecutor:
    """Processes started afresh: a fork of a process with threads may hang."""
    return cf.ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn"))


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("store", type=Path)
    parser.add_argument("log", type=Path)
    parser.add_argument("--workers", type=int, default=0)
    parser.add_argument("--die-at", type=int, default=0)
    chosen = parser.parse_args()
    logging.basicConfig(filename=chosen.log, level=logging.INFO, format="%(message)s")
    if chosen.die_at:
        die_at(chosen.die_at)
    if chosen.workers:
        with pool(chosen.workers) as executor:
            call(chosen.store, executor=executor)
    else:
        call(chosen.store)
