"""Interleaved measurement: every round takes each case in turn, so that what slows the machine slows all alike."""

import random
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from plan import Plan
from timed_scenes import Case

import bipenalty as bp

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Spread:
    """Order statistics of the rounds; `error` is the half-width of the median's 95 % interval."""

    smallest: float
    lower: float
    median: float
    upper: float
    largest: float
    error: float


def spread(samples: ArrayLike) -> Spread:
    """Least, quartiles and largest of the samples; error 1.57 IQR/sqrt(n) (McGill, Tukey and Larsen 1978, eq. 2).

    Example
    -------
    >>> spread([3.0, 1.0, 2.0]).median
    2.0
    """
    values = np.asarray(samples, dtype=float)
    least, lower, median, upper, largest = (float(q) for q in np.percentile(values, [0, 25, 50, 75, 100]))
    return Spread(least, lower, median, upper, largest, 1.57 * (upper - lower) / values.size**0.5)


def ratio(samples: Array, reference: Array) -> Spread:
    """The ratio taken round by round, in which the machine was the same for both."""
    return spread(samples / reference)


@dataclass(frozen=True)
class Steps:
    """What the rounds gave.

    Parameters
    ----------
    seconds : per step of each case, (rounds,).
    share : of a core that the timed thread had, -; below 1 other programs took the rest.
    rows : mean number of active rows of each case over the timed window.
    """

    seconds: dict[str, Array]
    share: float
    rows: dict[str, float]


def time_steps(cases: Sequence[Case], plan: Plan) -> Steps:
    """Time single steps of all cases, one thread, in the thread's own processor time."""
    rounds = [_round(cases, plan, number) for number in range(plan.rounds)]
    seconds = np.array([spent for spent, _ in rounds])
    rows = {case.name: _active_rows(case, plan) for case in cases}
    columns = {case.name: seconds[:, i] for i, case in enumerate(cases)}
    return Steps(columns, float(np.median([share for _, share in rounds])), rows)


def _round(cases: Sequence[Case], plan: Plan, number: int) -> tuple[list[float], float]:
    """Seconds per step of each case, and the share of a core that the thread had."""
    order = [i for i in range(len(cases)) for _ in range(plan.places)]
    random.Random(number).shuffle(order)
    models = [started(cases[i], plan) for i in order]
    spent, wall = [0.0] * len(models), 0.0
    for turn in _turns(len(models), plan.pieces):
        model, steps = models[turn], plan.steps * cases[order[turn]].steps
        model.step(plan.warm)
        clock, start = time.perf_counter(), time.thread_time()
        model.step(steps)
        spent[turn] += (time.thread_time() - start) / (steps * plan.pieces)
        wall += time.perf_counter() - clock
    fastest = [min(t for t, j in zip(spent, order, strict=True) if j == i) for i in range(len(cases))]
    busy = sum(t * plan.steps * cases[i].steps * plan.pieces for t, i in zip(spent, order, strict=True))
    return fastest, busy / wall


def _turns(count: int, pieces: int) -> Iterator[int]:
    """Forwards and backwards in turn: a steady drift of the machine then favours no case."""
    for piece in range(pieces):
        yield from range(count) if piece % 2 == 0 else reversed(range(count))


def started(case: Case, plan: Plan) -> bp.Model:
    """A new model, `plan.before` steps into its run."""
    model = bp.Model(case.scene, case.method)
    every, energy_every = (1, 10) if case.recorded else (10**9, 10**9)
    before = (plan.before - 0.5) * model.dt
    model.run(before, every=every, energy_every=energy_every, show_progress=False)  # step() goes on recording so
    return model


def _active_rows(case: Case, plan: Plan) -> float:
    """Mean number of active rows over the window that is timed."""
    if not case.recorded:
        return 0.0
    model = started(case, plan)
    model.step(plan.pieces * (plan.steps + plan.warm))
    return float(model.result().dataset["active_rows"].values[plan.before :].mean())
