"""The layout of a sweep: shape of the grid, the blocks it is worked off in, and the arrays it fills."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

from bipenalty.sweeps.plans import Index

#: name: (unit, long name) of the numbers that every run leaves behind.
SUMMARY = {
    "max_penetration": ("m", "deepest penetration of the run"),
    "max_displacement": ("m", "largest displacement of the run"),
    "peak_force": ("N/m", "largest total contact force"),
    "impulse": ("N s/m", "impulse of the total contact force"),
    "energy_ratio": ("1", "total energy at the end over that at the start"),
    "energy_made": ("1", "most energy that contact had added, over what there was"),
    "steps": ("1", "steps taken"),
    "row_steps": ("1", "active rows, summed over the steps"),
    "block_operations": ("1", "multiplications that factorise the mass block, summed over the steps"),
}
SECONDS = {"seconds": ("s", "time the run took")}
HISTORIES = {"contact_force": ("N/m", "contact force"), "penetration": ("m", "penetration")}
WORDS = {"reason": "why the run ended", "outcome": "how the run ended"}
FLAGS = {"failed": "ended before t_end by itself", "finished": "got to t_end, whatever its energy"}

#: Outcome of a run that has not been computed.
PENDING = "pending"


@dataclass(frozen=True)
class Variable:
    """One array of a sweep: `kind` is "number", "flag", "word" or "history", the last with one more dimension."""

    name: str
    kind: str
    attrs: dict[str, str]

    @property
    def fill(self) -> float | bool | str:
        """What stands where no run has been computed."""
        if self.kind == "word":
            return PENDING if self.name == "outcome" else ""
        return False if self.kind == "flag" else math.nan


@dataclass(frozen=True)
class Layout:
    """Dimensions and shape of a grid, cut into blocks; a task is one block, its runs in C order.

    Parameters
    ----------
    dims, shape : of the grid.
    block : shape of a task's block.
    samples : kept of each history; 0 for peaks only.
    time_dim : "time", or "step" where the time step differs between runs.

    Example
    -------
    >>> layout = Layout(("ps", "dt"), (3, 4), block_shape((3, 4), 8), samples=0, time_dim="time")
    >>> layout.block, layout.n_tasks, layout.indices(1)[0]
    ((2, 4), 2, (2, 0))
    """

    dims: tuple[str, ...]
    shape: tuple[int, ...]
    block: tuple[int, ...]
    samples: int
    time_dim: str

    @property
    def n_runs(self) -> int:
        """Number of runs."""
        return math.prod(self.shape)

    @property
    def blocks(self) -> tuple[int, ...]:
        """Number of blocks along each dimension."""
        return tuple(-(-n // b) for n, b in zip(self.shape, self.block, strict=True))

    @property
    def n_tasks(self) -> int:
        """Number of tasks."""
        return math.prod(self.blocks)

    def place(self, task: int) -> Index:
        """Place of a task among the blocks."""
        place: list[int] = []
        for n in reversed(self.blocks):
            task, i = divmod(task, n)
            place.insert(0, i)
        return tuple(place)

    def region(self, task: int) -> tuple[slice, ...]:
        """Part of the grid that a task fills."""
        sizes = zip(self.place(task), self.block, self.shape, strict=True)
        return tuple(slice(i * b, min((i + 1) * b, n)) for i, b, n in sizes)

    def region_shape(self, task: int) -> tuple[int, ...]:
        """Shape of that part."""
        return tuple(s.stop - s.start for s in self.region(task))

    def indices(self, task: int) -> list[Index]:
        """Places in the grid of a task's runs, in their order."""
        return list(itertools.product(*(range(s.start, s.stop) for s in self.region(task))))

    def variables(self, timed: bool) -> list[Variable]:
        """The arrays, `outcome` last; with the seconds that runs took when `timed`."""
        numbers = SUMMARY | (SECONDS if timed else {})
        found = [Variable(n, "number", {"units": unit, "long_name": about}) for n, (unit, about) in numbers.items()]
        if self.samples:
            for name, (unit, about) in HISTORIES.items():
                found.append(Variable(name, "history", {"units": unit, "long_name": about}))
        found += [Variable(name, "flag", {"long_name": about}) for name, about in FLAGS.items()]
        return found + [Variable(name, "word", {"long_name": about}) for name, about in WORDS.items()]


def block_shape(shape: Index, runs: int) -> Index:
    """Shape of blocks of at most so many runs: whole trailing axes, then even parts of one, then single places."""
    block: list[int] = []
    for n in reversed(shape):
        parts = -(-n // max(1, runs))
        block.insert(0, -(-n // parts))
        runs = runs // n
    return tuple(block)
