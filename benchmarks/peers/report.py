"""The tables of docs/peers.md: the collision, and what wrong penalties do to it."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from report import table

from peers.judge import Verdict

HEAD = (
    "program",
    "time loop, s",
    "steps",
    "ns per node-step",
    "deepest penetration, m",
    "impulse, N s/m",
    "force error",
    "momentum error",
    "energy out/in",
    "outcome",
)
NONE = "–"


@dataclass
class Row:
    """One program: `version` None where it is not installed, `wrong` by the factor on the penalty."""

    name: str
    version: str | None
    install: str
    better: str
    seconds: list[float] = field(default_factory=list)
    verdict: Verdict | None = None
    wrong: dict[float, Verdict] = field(default_factory=dict)

    @property
    def title(self) -> str:
        """Name and version."""
        return f"{self.name} {self.version}" if self.version else self.name


def number(value: float, form: str = ".3g") -> str:
    """A figure, or a dash where there is none.

    Example
    -------
    >>> number(0.25), number(float("nan")), number(float("inf"))
    ('0.25', '–', 'inf')
    """
    return NONE if math.isnan(value) else format(value, form)


def ratio(energy: float) -> str:
    """An energy ratio: digits near one, powers of ten far from it.

    Example
    -------
    >>> ratio(0.99983), ratio(2.0231), ratio(1e45)
    ('0.9998', '2.02', '1e+45')
    """
    return number(energy, ".4f" if abs(energy - 1) < 0.1 else ".2f" if abs(energy) < 100 else ".0e")


def percent(value: float) -> str:
    """An error in per cent."""
    return NONE if math.isnan(value) else f"{100 * value:.1f} %" if abs(value) < 10 else f"{value:.0e}"


def cells(row: Row, nodes: int) -> list[str]:
    """The program's line of the table."""
    if row.version is None or row.verdict is None:
        return [row.title, "not installed", *[NONE] * (len(HEAD) - 2)]
    seen, times = row.verdict, row.seconds
    median = float(np.median(times))
    return [
        row.title,
        f"{median:.3g} ({min(times):.3g} to {max(times):.3g}, n = {len(times)})",
        str(seen.steps),
        f"{1e9 * median / (seen.steps * nodes):.3g}",
        number(seen.penetration, ".2e"),
        f"{number(seen.impulse, '.4f')} ({100 * seen.impulse_error:+.2f} %)",
        percent(seen.force_error),
        number(seen.momentum_error, ".0e"),
        ratio(seen.energy_ratio),
        seen.words,
    ]


def collisions(rows: Sequence[Row], nodes: int) -> str:
    """The table of the collision with a sensible penalty."""
    return table(HEAD, [cells(row, nodes) for row in rows])


def wrongs(rows: Sequence[Row]) -> str:
    """The table of wrong penalties, and what the programs said of them."""
    factors = sorted({factor for row in rows for factor in row.wrong})
    head = ["program", *(f"{what}, penalty x {factor:.0e}" for factor in factors for what in ("outcome", "energy"))]
    lines, words = [], []
    for row in rows:
        line = [row.title]
        for factor in factors:
            seen = row.wrong.get(factor)
            line += [seen.words, ratio(seen.energy_ratio)] if seen else ["not installed", NONE]
            words += [f"- {row.name}, x {factor:.0e}: {seen.said}"] if seen and seen.said else []
        lines.append(line)
    said = "\n".join(["What they said themselves:", "", *words]) if words else "None of them said anything."
    return f"{table(head, lines)}\n\n{said}"
