"""Rounds: every case takes its turn in each, in another order, so that what slows the machine slows all alike."""

import random
from collections.abc import Callable, Collection, Mapping

import numpy as np
from measure import Array

Cases = Mapping[str, Callable[[], float]]


def interleaved(cases: Cases, rounds: int, places: int = 1, once: Collection[str] = ()) -> dict[str, Array]:
    """Seconds of each case by round, (rounds,): the least of `places` in a round, each with new arrays in memory.

    Other programs and an unlucky place in memory only ever slow a case down. Cases in `once`, which take the best of
    several by themselves, have one turn a round.

    Example
    -------
    >>> times = iter([3.0, 1.0, 2.0, 4.0])
    >>> interleaved({"a": lambda: next(times)}, rounds=2, places=2)["a"].tolist()
    [1.0, 2.0]
    """
    columns = np.array([_round(cases, number, places, once) for number in range(rounds)]).T
    return dict(zip(cases, columns, strict=True))


def _round(cases: Cases, number: int, places: int, once: Collection[str]) -> list[float]:
    order = [name for name in cases for _ in range(1 if name in once else places)]
    random.Random(number).shuffle(order)
    least = dict.fromkeys(cases, float("inf"))
    for name in order:
        least[name] = min(least[name], cases[name]())
    return list(least.values())
