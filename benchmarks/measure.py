"""Interleaved measurement: every round takes each case in turn, so that what slows the machine slows all alike."""

import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import bipenalty as bp
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scenes import Case

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Plan:
    """How much is measured.

    Parameters
    ----------
    segments : edges on the rim of each cylinder.
    rounds : of the single steps; every model is built anew in each, since its place in memory alone makes 10 %.
    before : steps before the measurement, so that contact is well under way.
    pieces, steps : a round times so many pieces of so many steps of each case, piece by piece in turn.
    warm : untimed steps before each piece, which bring the case back into the caches.
    script_rounds : of the comparison with the script.
    """

    segments: int = 116
    rounds: int = 41
    before: int = 200
    pieces: int = 16
    steps: int = 20
    warm: int = 3
    script_rounds: int = 9


QUICK = Plan(segments=24, rounds=3, before=20, pieces=2, steps=10, warm=1, script_rounds=2)


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
    five = [float(q) for q in np.percentile(values, [0, 25, 50, 75, 100])]
    return Spread(*five, error=1.57 * (five[3] - five[1]) / float(np.sqrt(values.size)))


def ratio(samples: Array, reference: Array) -> Spread:
    """The ratio taken round by round, in which the machine was the same for both."""
    return spread(samples / reference)


@dataclass(frozen=True)
class Claim:
    """What is expected of a ratio, with what was measured; its median decides."""

    text: str
    measured: Spread
    least: float | None = None
    most: float | None = None

    @property
    def met(self) -> bool:
        """Whether the median is within its bounds."""
        low = self.least is None or self.measured.median >= self.least
        return low and (self.most is None or self.measured.median <= self.most)

    @property
    def expected(self) -> str:
        """The bound in words."""
        return f"at least {self.least:g}" if self.least is not None else f"at most {self.most:g}"

    def as_dict(self) -> dict[str, Any]:
        """For the JSON file."""
        return asdict(self) | {"met": self.met}


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
    names = [case.name for case in cases]
    rounds = [_round(cases, plan) for _ in range(plan.rounds)]
    seconds = np.array([spent for spent, _ in rounds])
    share = float(np.median([busy for _, busy in rounds]))
    rows = [_active_rows(case, plan) for case in cases]
    columns = {name: seconds[:, i] for i, name in enumerate(names)}
    return Steps(columns, share, dict(zip(names, rows, strict=True)))


def _round(cases: Sequence[Case], plan: Plan) -> tuple[list[float], float]:
    """Seconds per step of each case, and the share of a core that the thread had."""
    models = [_started(case, plan) for case in cases]
    spent, wall = [0.0] * len(cases), 0.0
    for i in _turns(len(cases), plan.pieces):
        models[i].step(plan.warm)
        clock, start = time.perf_counter(), time.thread_time()
        models[i].step(plan.steps * cases[i].steps)
        spent[i] += time.thread_time() - start
        wall += time.perf_counter() - clock
    taken = plan.pieces * plan.steps
    share = sum(spent) / wall
    return [seconds / (taken * case.steps) for seconds, case in zip(spent, cases, strict=True)], share


def _turns(count: int, pieces: int) -> Iterator[int]:
    """Forwards and backwards in turn: a steady drift of the machine then favours no case."""
    for piece in range(pieces):
        yield from range(count) if piece % 2 == 0 else reversed(range(count))


def _started(case: Case, plan: Plan) -> bp.Model:
    """A new model, `plan.before` steps into its run."""
    model = bp.Model(case.scene, case.method)
    never = {} if case.recorded else {"every": 10**9, "energy_every": 10**9}
    model.run((plan.before - 0.5) * model.dt, show_progress=False, **never)  # what it records stays set for step()
    return model


def _active_rows(case: Case, plan: Plan) -> float:
    """Mean number of active rows over the window that is timed."""
    model = _started(case, plan)
    model.step(plan.pieces * (plan.steps + plan.warm))
    data = model.result().dataset
    return float(data["active_rows"].values[plan.before :].mean()) if case.recorded else 0.0
